function c = dtg_calibrate(passport, signers, currents, varargin)
% DTG_CALIBRATE  Verify a passport and calibrate a gyro by least squares. For MATLAB and for Octave 7 or later.
%
%   c = dtg_calibrate(passport, signers, currents, 'serial', '0017', 'laboratory', 'laboratory.yaml')
%   c = dtg_calibrate(passport, signers, 'run.csv', 'gyro', 'gyro.yaml', 'drift', true, ...
%                     'exclude', '2,4,1,3', 'why', 'door opened')
%
% currents has rows i, j, J_x, J_y, currents in mA, or is the path of a CSV file, which may also have cycle, visit and
% time_s. Options are those of dtg_load, and laboratory, gyro, model, anisoelasticity, drift, exclude, why, gyro-serial,
% operator, date, temperature-c and previous (the path of an earlier result) of `dtg-passport calibrate`. Without a
% laboratory the uncertainties are those of c.document.assumed_meter. c has K (deg/(h*mA)), omega_0 (deg/h), omega_g and omega_k
% (deg/h per local g) or in the general model G, u with their standard uncertainties, and document with everything that
% `dtg-passport calibrate --format json` prints.
%
% The error dtg:inconsistent means that the readings do not fit the stand, and dtg:mistake that an error such as currents in
% another unit explains the parameters. Other remarks are warnings dtg:remark.
    file = currents;
    if ~ischar(currents) && ~isa(currents, 'string')
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
    end
    known = {'laboratory', 'gyro', 'model', 'anisoelasticity', 'drift', 'exclude', 'why', 'gyro-serial', 'operator', ...
             'date', 'temperature-c', 'previous'};
    c.document = jsondecode(dtg_run('calibrate', {'--method=least-squares'}, signers, varargin, known, {passport, file}));
    remarks = {};
    if isfield(c.document, 'remarks')
        remarks = cellstr(c.document.remarks);
    end
    if ~c.document.consistent
        error('dtg:inconsistent', '%s', strjoin(remarks(:)', '\n'));
    elseif isfield(c.document, 'mistake')
        error('dtg:mistake', '%s', strjoin(remarks(:)', '\n'));
    end
    for k = 1:numel(remarks)
        warning('dtg:remark', '%s', remarks{k});
    end
    c.u = parameters(struct(), c.document.results.standard_uncertainty);
    c = parameters(c, c.document.results);
end

function to = parameters(to, from)
    names = {'K', 'omega_0', 'omega_g', 'omega_k', 'G'};
    keys = {'k_deg_per_h_per_ma', 'omega0_deg_per_h', 'omega_g_deg_per_h_per_g', 'omega_k_deg_per_h_per_g', ...
            'g_matrix_deg_per_h_per_g'};
    for k = find(isfield(from, keys))
        to.(names{k}) = from.(keys{k});
    end
end
