function c = dtg_calibrate(passport, signers, currents, varargin)
% DTG_CALIBRATE  Verify a passport and calibrate a gyro by least squares. For MATLAB and for Octave 7 or later.
%
%   c = dtg_calibrate(passport, signers, currents, 'serial', '0017', 'laboratory', 'laboratory.yaml')
%
% currents has rows i, j, J_x, J_y, currents in mA. Options are those of dtg_load, and laboratory and gyro, paths of
% files. c has K (deg/(h*mA)), omega_0 (deg/h), omega_g and omega_k (deg/h per local g), u with their standard
% uncertainties, and document with everything that `dtg-passport calibrate --format json` prints.
    file = [tempname(), '.csv'];
    remove = onCleanup(@() delete(file));
    id = fopen(file, 'w');
    fprintf(id, 'i,j,jx_ma,jy_ma\n');
    fprintf(id, '%d,%d,%.17g,%.17g\n', currents');
    fclose(id);
    options = [varargin, {'method', 'least-squares'}];
    c.document = jsondecode(dtg_run('calibrate', passport, {file, '--format=json'}, signers, options));
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
