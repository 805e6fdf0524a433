function p = dtg_load(passport, signers, varargin)
% DTG_LOAD  Verify a passport and return its content. For MATLAB and for Octave 7 or later.
%
%   p = dtg_load(passport, signers)
%   p = dtg_load(passport, signers, 'serial', '0017', 'at', [55.7660, 37.6850], 'time', '2026-11-20')
%
% passport and signers are paths: of the passport and of the trusted keys (OpenSSH allowed_signers). Options are those
% of the command `dtg-passport export`, which must be on the PATH: serial, at, time, issuer, revoked and register,
% the path of the stand's register or of a folder of passports. The fields of p are verified, sha256, not_asked, remarks,
% checks, register (the one that was asked) and the keys of the passport: p.matrices.b_deg_per_h,
% p.positions(1).alpha_arcsec and so on. Remarks are also warnings dtg:remark.
%
% Errors: dtg:refused if a check failed, dtg:unusable if a file cannot be used, dtg:option for an unknown option.
    p = jsondecode(dtg_run('export', {'--to=json'}, signers, varargin, {}, {passport}));
    for k = 1:numel(p.remarks)
        warning('dtg:remark', '%s', p.remarks{k});
    end
end
