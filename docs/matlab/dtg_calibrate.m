function c = dtg_calibrate(passport, signers, currents, varargin)
% DTG_CALIBRATE  Verify a passport and calibrate a gyro by least squares. For MATLAB and for Octave 7 or later.
%
%   c = dtg_calibrate(passport, signers, currents, 'serial', '0017', 'laboratory', 'laboratory.yaml')
%
% currents has rows i, j, J_x, J_y, currents in mA. Options are those of dtg_load, and laboratory and gyro, paths of
% files. c has K (deg/(h*mA)), omega_0 (deg/h), omega_g and omega_k (deg/h per local g), u with their standard
% uncertainties, and document with everything that `dtg-passport calibrate --format json` prints.
%
% The warning dtg:inconsistent means that the readings do not fit the stand; the parameters are then not valid.
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
    if ~c.document.consistent
        warning('dtg:inconsistent', 'the readings are not consistent with this stand: %s', c.document.hint);
    elseif isfield(c.document, 'mistake')
        warning('dtg:mistake', 'the parameters are far from the gyro''s, although the readings fit; see document.mistake');
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
