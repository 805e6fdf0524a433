// Uses target/web/verify.html in Chromium for tests/bindings/test_web.py: reads {page, cases: [{files, fields, drops}]} on
// standard input (files are chosen, then drops are dropped one straight after the other, else the button is pressed), prints what the page says, every request, violations of axe-core, and how long a verification takes.
const fs = require("fs");
const { pathToFileURL } = require("url");
const { chromium } = require("playwright-core");
const { HtmlValidate } = require("html-validate");
const axe = fs.readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

(async () => {
  const { page: path, cases } = JSON.parse(fs.readFileSync(0, "utf8"));
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
  const context = await browser.newContext({ bypassCSP: false });
  const page = await context.newPage();
  const requests = [];
  const errors = [];
  page.on("request", (request) => requests.push(request.url()));
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => { if (message.type() === "error") errors.push(message.text()); });
  page.on("dialog", (dialog) => { errors.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  const results = [];
  for (const { files, fields, drops } of cases) {
    await page.goto(pathToFileURL(path).href);
    for (const [id, value] of Object.entries(fields)) await page.fill(`#${id}`, value);
    for (const [id, file] of Object.entries(files)) await page.setInputFiles(`#${id}`, file);
    if (drops) {
      const given = drops.map((files) => files.map((file) => [file.split("/").at(-1), fs.readFileSync(file, "latin1")]));
      await page.evaluate((drops) => {
        for (const given of drops) {
          const transfer = new DataTransfer();
          for (const [name, text] of given) transfer.items.add(new File([Uint8Array.from(text, (c) => c.charCodeAt(0))], name));
          document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
        }
      }, given);
    } else {
      await page.click("button[type=submit]");
    }
    await page.waitForSelector("#result h2");
    await page.waitForTimeout(300);
    const result = await page.evaluate(() => ({
      text: document.querySelector("#result").innerText,
      chosen: Object.fromEntries([...document.querySelectorAll("input[type=file]")].map((input) => [input.id, [...input.files].map((file) => file.name)])),
      focus: document.activeElement.id,
      headings: [...document.querySelectorAll("#result h2")].map((heading) => heading.textContent),
      rows: [...document.querySelectorAll("#result table")].map((table) => [...table.tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.textContent))),
      scripts: document.querySelectorAll("#result script, #result img").length,
      frame: document.querySelector("iframe") && document.querySelector("iframe").srcdoc.length,
    }));
    const frame = page.frames().find((one) => one !== page.mainFrame());
    result.printed = frame ? await frame.evaluate(() => document.body.innerText.slice(0, 2000)).catch(() => null) : null;
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => axe.run(document, { iframes: false }));
    result.violations = violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 200))}`);
    results.push(result);
  }
  // Whatever the page tries to fetch is refused, before it goes out.
  const asked = [...requests];
  const before = errors.length;
  const fetched = await page.evaluate(async () => {
    const tries = [() => fetch("https://example.org/"), () => fetch("data:text/plain,x"), () => new Promise((resolve, reject) => {
      const image = new Image(); image.onload = resolve; image.onerror = reject; image.src = "https://example.org/x.png"; })];
    return Promise.all(tries.map((attempt) => attempt().then(() => "went out", () => "refused")));
  });
  const validator = new HtmlValidate({ extends: ["html-validate:recommended"], rules: { "void-style": "off", "long-title": "off", "no-inline-style": "off" } });
  const report = await validator.validateFile(path);
  const messages = report.results.flatMap((one) => one.messages.map((m) => `${m.ruleId} ${m.line}: ${m.message}`));
  // The time of one verification, by the module of the page.
  await page.goto("about:blank");
  const text = fs.readFileSync(path.replace("verify.html", "dtg_passport.mjs"), "base64");
  const times = await page.evaluate(async ([text, passport, signers]) => {
    const { verify } = await import(`data:text/javascript;base64,${text}`);
    const bytes = new TextEncoder().encode(passport);
    const times = [];
    for (let k = 0; k < 21; k++) {
      const begin = performance.now();
      const { valid } = await verify(bytes, signers, { time: "2026-11-20" });
      if (!valid) throw new Error("refused");
      times.push(performance.now() - begin);
    }
    return times.sort((a, b) => a - b)[10];
  }, [text, fs.readFileSync(cases[0].files.passport, "utf8"), fs.readFileSync(cases[0].files["signers-file"], "utf8")]);
  await browser.close();
  console.log(JSON.stringify({ results, requests: asked, errors: errors.slice(0, before), refusals: errors.slice(before), fetched, messages, times }));
})();
