function text = dtg_run(verb, passport, files, signers, options)
% DTG_RUN  Run dtg-passport and return its JSON; used by dtg_load and dtg_calibrate.
    known = {'serial', 'at', 'time', 'issuer', 'revoked', 'laboratory', 'gyro', 'method'};
    words = [{passport}, files, {['--trust=', signers]}];
    for k = 1:2:numel(options)
        if ~ismember(options{k}, known)
            error('dtg:option', 'unknown option %s, expected one of: %s', options{k}, strjoin(known, ', '));
        end
        words{end + 1} = ['--', options{k}, '=', char(options{k + 1})];
    end
    words = cellfun(@quoted, words, 'UniformOutput', false);
    [status, text] = system(['dtg-passport ', verb, ' ', strjoin(words, ' ')]);
    if status == 1 && strcmp(verb, 'calibrate') && any(strfind(text, '"passport_id"'))
        status = 0;  % the gyro fails its type; the result says so
    end
    if status == 1
        error('dtg:refused', 'refused: %s', text);
    elseif status ~= 0
        error('dtg:unusable', 'exit code %d: %s', status, text);
    end
end

function word = quoted(word)
% Return a word as the shell passes it on unchanged.
    if ispc()
        if any(ismember(word, '"%')) || any(word < 32)
            error('dtg:unusable', 'a path or an option contains a character that cannot be quoted: %s', word);
        end
        word = ['"', word, '"'];
    else
        word = ['''', strrep(word, '''', '''\'''''), ''''];
    end
end
