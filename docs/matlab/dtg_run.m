function text = dtg_run(verb, words, signers, options, known, files)
% DTG_RUN  Run dtg-passport and return its JSON; used by dtg_load and dtg_calibrate.
    known = [{'serial', 'at', 'time', 'issuer', 'revoked', 'register'}, known];
    if mod(numel(options), 2) ~= 0
        error('dtg:option', 'expected pairs of the name of an option and its value');
    end
    for k = 1:2:numel(options)
        [name, value] = options{k:k + 1};
        name = char(name);  % also strings of MATLAB, in double quotes
        if ~ismember(name, known)
            error('dtg:option', 'unknown option %s, expected one of: %s', name, strjoin(known, ', '));
        elseif any(strcmp(name, {'at', 'temperature-c'})) && isnumeric(value)
            value = strjoin(strsplit(strtrim(sprintf('%.10f ', value))), ',');
        elseif islogical(value)
            if value
                words{end + 1} = ['--', name];
            end
            continue
        elseif isnumeric(value)
            error('dtg:option', 'option %s is a number, expected text such as ''0017''', name);
        end
        words{end + 1} = ['--', name, '=', char(value)];
    end
    files = cellfun(@char, files, 'UniformOutput', false);
    words = cellfun(@quoted, [words, {['--trust=', char(signers)], '--'}, files], 'UniformOutput', false);
    % MATLAB would put the messages on standard error into the JSON.
    messages = tempname();
    remove = onCleanup(@() delete(messages));
    [status, text] = system(['dtg-passport ', verb, ' --format=json ', strjoin(words, ' '), ' 2>', quoted(messages)]);
    if isempty(text), text = fileread(messages); end
    if status == 1 && strcmp(verb, 'calibrate') && any(strfind(text, '"passport_id"'))
        status = 0;  % the gyro fails its type, or the result is not valid; it says so
    end
    if status ~= 0
        identifiers = {'dtg:refused', 'dtg:unusable'};
        error(identifiers{min(status, 2)}, 'exit code %d: %s', status, message(text));
    end
end

function words = message(text)
% Return the message in the JSON of a refusal; another answer as it is.
    words = text;
    try
        found = jsondecode(text);
        if isfield(found, 'error')
            words = found.error.message;
        else
            failed = found.checks(arrayfun(@(check) isequal(check.passed, false), found.checks));
            words = strjoin({failed.detail}, '; ');
            for k = 1:numel(found.remarks)
                words = [words, '; ', found.remarks{k}];
            end
        end
    catch
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
