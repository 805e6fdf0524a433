function c = dtg_calibrate(passport, signers, currents, varargin)
% DTG_CALIBRATE  Verify a passport and calibrate a gyro by least squares. For MATLAB and for Octave 7 or later.
%
%   c = dtg_calibrate(passport, signers, currents, 'serial', '0017', 'laboratory', 'laboratory.yaml')
%
% currents has rows i, j, J_x, J_y, currents in mA. Options are those of dtg_load, and laboratory and gyro, paths of
% files. c has K (deg/(h*mA)), omega_0 (deg/h), omega_g and omega_k (deg/h per local g), u with their standard
% uncertainties, and document with everything that `dtg-passport calibrate --format json` prints.
%
% The warning dtg:inconsistent means that the readings do not fit the stand, and dtg:mistake that an error such as currents
% in another unit explains the parameters; they are then not valid. Other remarks are warnings dtg:remark.
    if ~isnumeric(currents) || ~isreal(currents)
        error('dtg:unusable', 'currents are not real numbers');
    end
    if size(currents, 2) ~= 4
        error('dtg:unusable', 'currents have %d columns, expected 4: i, j, J_x, J_y', size(currents, 2));
    end
    file = [tempname(), '.csv'];
    remove = onCleanup(@() delete(file));
    id = fopen(file, 'w');
    fprintf(id, 'i,j,jx_ma,jy_ma\n');
    fprintf(id, '%.17g,%.17g,%.17g,%.17g\n', currents');
    fclose(id);
    known = {'serial', 'at', 'time', 'issuer', 'revoked', 'laboratory', 'gyro'};
    fixed = {'--method=least-squares', ['--trust=', signers]};
    c.document = jsondecode(dtg_run('calibrate', fixed, varargin, known, {passport, file}));
    remarks = {};
    if isfield(c.document, 'remarks')
        remarks = cellstr(c.document.remarks);
    end
    ids = repmat({'dtg:remark'}, size(remarks));
    % The first remark says why the parameters are not valid.
    if ~c.document.consistent
        ids{1} = 'dtg:inconsistent';
    elseif isfield(c.document, 'mistake')
        ids{1} = 'dtg:mistake';
    end
    % It comes last, where lastwarn finds it.
    for k = numel(remarks):-1:1
        warning(ids{k}, '%s', remarks{k});
    end
    result = c.document.results;
    c = parameters(c, result);
    c.u = parameters(struct(), result.standard_uncertainty);
end

function to = parameters(to, from)
    to.K = from.k_deg_per_h_per_ma;
    to.omega_0 = from.omega0_deg_per_h;
    to.omega_g = from.omega_g_deg_per_h_per_g;
    to.omega_k = from.omega_k_deg_per_h_per_g;
end
