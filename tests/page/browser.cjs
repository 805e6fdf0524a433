// Looks at pages in the system's Chromium: what they say, whether anything is cut off, what axe and the validator find, what
// they ask of the network, how they print. Needs pdftotext.
//
// usage: node browser.cjs CHROMIUM FOLDER NAME...   reads FOLDER/NAME.html, writes FOLDER/NAME*.{pdf,png}, prints JSON. With
// SCREENS=write the screens are written too, to look at.

const fs = require("fs");
const { execFileSync } = require("child_process");
const os = require("os");
const path = require("path");
const { chromium } = require("playwright-core");
const { HtmlValidate } = require("html-validate");
const axe = fs.readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

const WIDTHS = { phone: 390, sheet: 794, screen: 1280 };
// Void elements without a slash, styles in attributes (one rect's), and the two attributes that are long by nature are a
// matter of taste; everything else of the recommended rules counts.
const RULES = {
  extends: ["html-validate:recommended"],
  rules: { "void-style": "off", "long-title": "off", "no-inline-style": "off", "tel-non-breaking": "off" },
};

/** Waits until the browser has drawn two more frames. */
const frames = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** What the page says: numbers with their values, days, words of the file, all other words, the annex. */
function said() {
  const text = (element) => {
    const copy = element.cloneNode(true);
    copy.querySelectorAll(".pad").forEach((pad) => pad.remove());
    return copy.textContent;
  };
  // What only a telephone shows is not printed.
  const printed = (element) => {
    const copy = element.cloneNode(true);
    copy.querySelectorAll(".narrow-only").forEach((part) => part.remove());
    return copy.textContent;
  };
  const all = (selector) => [...document.querySelectorAll(selector)];
  const words = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const parent = node.parentElement;
    if (!node.data.trim() || parent.closest("data, [data-value], time, .given, .number, code, pre, .pad, style")) continue;
    const section = parent.closest("section");
    words.push({
      text: node.data,
      lang: parent.closest("[lang]").getAttribute("lang"),
      section: section ? section.id : "",
      picture: parent.closest("svg") !== null,
      drawn: parent.closest("text") !== null,
    });
  }
  for (const picture of all("svg[aria-label], span[aria-label], div[aria-label]")) {
    words.push({ text: picture.getAttribute("aria-label"), lang: picture.closest("[lang]").getAttribute("lang"), section: "", picture: true, drawn: false });
  }
  // Words in the margins of printed sheets: strings of CSS.
  const style = [...document.querySelectorAll("style")].map((element) => element.textContent).join("");
  const margins = [...style.matchAll(/@(?:top|bottom)-\w+ \{ content: "([^"]*)"/g)]
    .map(([, words]) => words.replace(/\\([0-9a-f]+) /g, (_, code) => String.fromCodePoint(parseInt(code, 16))));
  const link = document.querySelector("a[download]");
  return {
    title: document.title,
    margins,
    lang: document.documentElement.lang,
    // The page's first language writes the numbers, that of a sentence those within it.
    numbers: all("data, [data-value]").map((data) => ({
      value: data.value ?? data.dataset.value,
      text: text(data),
      // A coordinate has a letter instead of a sign.
      negative: /°\u00a0(?:S|W|ю|з)/.test((data.closest(".quantity") ?? data).textContent),
      lang: (data.closest("p[lang], :is(dd, li, caption) span[lang]") ?? document.documentElement).lang,
    })),
    tables: all("table").map((table) => ({
      caption: table.caption ? table.caption.textContent : "",
      heads: [...[...table.tHead.rows].at(-1).cells].map(text),
      // The heading of its group above each column; empty where there is none.
      groups: [...table.tHead.rows].length < 2 ? [] : [...table.tHead.rows[0].cells].flatMap((cell) => Array(cell.colSpan).fill(text(cell))),
      rows: [...table.tBodies[0].rows].map((row) =>
        [...row.cells].map((cell) => ({ text: text(cell), values: [...cell.querySelectorAll("data")].map((data) => data.value) })),
      ),
    })),
    both: document.querySelector(".second") !== null,
    days: all("time").map((time) => ({ value: time.dateTime, text: text(time) })),
    given: all(".given").map(text),
    codes: all("code").map(text),
    words,
    sections: all("h2 .number").map(text),
    headings: all("h1, h2, h3, caption").map((heading) => heading.textContent),
    blocks: all("p, dt, dd, th, td, caption, h1, h2, h3, li")
      .filter((block) => !block.closest(".unseen, .save, .screen, svg, tfoot") && !block.querySelector("sub, sup, p, .pad, .unseen, .save, svg text"))
      .map(printed),
    annex: document.querySelector("pre").textContent,
    annexPrinted: document.querySelector("pre").closest(".save") === null,
    download: { name: link.download, address: link.href },
    greens: all(".passed").map(text),
    // The serial number of the gyro among the fields, where it is seen.
    serials: all("dt").filter((name) => /^(Serial number of the gyro|Заводской номер гироскопа)/.test(name.textContent) && name.checkVisibility())
      .map((name) => name.nextElementSibling.textContent),
    verdicts: all(".verdict").map(text),
    headline: document.querySelector(".headline").textContent,
    status: (document.querySelector(".band > div") || document.body).textContent,
    refused: document.querySelector(".verdict.refused") !== null,
  };
}

/** What does not fit: elements beyond the page's edge, text wider than its box, words of a picture outside it, decisions that are
 * seen only after scrolling sideways, names of rows that scroll away. */
function unfit() {
  const found = [];
  const name = (element) => `${element.tagName.toLowerCase()}.${element.getAttribute("class") || ""} ${element.textContent.slice(0, 60)}`;
  const width = document.documentElement.clientWidth;
  for (const link of document.querySelectorAll("a[href^='#']")) {
    const target = document.getElementById(link.hash.slice(1));
    const seen = (element) => element !== null && element.getClientRects().length > 0;
    if (seen(link) && !seen(target)) found.push(`a link to what is not seen: ${name(link)}`);
  }
  if (document.documentElement.scrollWidth > width) found.push(`the page scrolls sideways: ${document.documentElement.scrollWidth} > ${width}`);
  // What the page answers stands above its list of contents.
  const tops = [".verdict, .band", ".screen"].map((selector) => document.querySelector(selector).getBoundingClientRect()).filter((box) => box.height > 0);
  if (tops.length === 2 && tops[0].top > tops[1].top) found.push("the contents stand above the verdict");
  // Commands, designations and the parts of ids stand on one line, where the line is long enough.
  for (const element of document.querySelectorAll(".n")) {
    if (element.closest("pre") || element.textContent.length > 30) continue;
    const range = document.createRange();
    range.selectNodeContents(element);
    // An index stands lower, though less than a line.
    const tops = [...range.getClientRects()].filter((box) => box.width > 0).map((box) => box.top);
    const lower = Math.max(...tops) - Math.min(...tops);
    if (lower >= parseFloat(getComputedStyle(element).fontSize)) found.push(`broken: ${name(element)}`);
  }
  // A value stands on the line of its symbol; the value of another, with words between, need not.
  for (const value of document.querySelectorAll("sub + .quantity")) {
    if (/\p{L}/u.test(value.previousSibling.data ?? "")) continue;
    const [symbol, first] = [value.previousElementSibling, value].map((element) => element.getClientRects()[0]);
    if (first && Math.abs(symbol.top - first.top) >= parseFloat(getComputedStyle(value).fontSize)) found.push(`torn: ${name(value)}`);
  }
  // The kind of the document is not broken before its last word.
  const kind = document.createRange();
  kind.selectNodeContents(document.querySelector(".kind > span") ?? document.querySelector(".kind"));
  const lines = [...kind.getClientRects()].map((line) => line.width);
  if (lines.at(-1) < 0.4 * Math.max(...lines)) found.push(`a short last line: ${lines}`);
  for (const row of document.querySelectorAll(".result:not(.past) tbody tr")) {
    const seen = [...row.querySelectorAll("th .state, td:nth-last-child(2) .state")].some((mark) => {
      const box = mark.getBoundingClientRect();
      return box.width > 0 && box.left >= 0 && box.right <= width;
    });
    if (!seen) found.push(`a decision out of sight: ${name(row)}`);
  }
  // The numbers beside the names fade only while a table is scrolled.
  for (const name of document.querySelectorAll(".scroll th")) {
    const { content, opacity } = getComputedStyle(name, "::after");
    if (content !== "none" && opacity !== "0") found.push(`faded without scrolling: ${name.textContent}`);
  }
  // A table that has been scrolled to its end still shows the names of its rows, one after the other.
  for (const table of document.querySelectorAll(".scroll:has(tbody th)")) {
    if (table.scrollWidth <= table.clientWidth || getComputedStyle(table).overflowX === "visible") continue;
    table.scrollLeft = table.scrollWidth;
    const left = table.getBoundingClientRect().left;
    for (const row of table.querySelectorAll("tbody tr")) {
      const boxes = [...row.querySelectorAll("th")].map((cell) => {
        const range = document.createRange();
        range.selectNodeContents(cell);
        return range.getBoundingClientRect();
      });
      const stays = boxes.every((box, place) => box.left >= (place === 0 ? left - 1 : boxes[place - 1].right));
      if (!stays) found.push(`names scrolled away: ${name(row)}`);
    }
    table.scrollLeft = 0;
  }
  for (const element of document.querySelectorAll("body *")) {
    if (element.closest(".unseen, .pad, thead") && getComputedStyle(element.closest(".unseen, .pad, thead")).position === "absolute") continue;
    const svg = element.ownerSVGElement;
    const box = element.getBoundingClientRect();
    if (box.width === 0) continue;
    if (svg) {
      const frame = svg.getBoundingClientRect();
      const out = box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 || box.bottom > frame.bottom + 1;
      if (element.tagName === "text" && out) found.push(`outside its picture: ${name(element)}`);
      continue;
    }
    const scrolls = element.parentElement.closest(".scroll");
    if (!scrolls && (box.right > width + 1 || box.left < -1)) found.push(`beyond the edge: ${name(element)}`);
    const style = getComputedStyle(element);
    const boxed = style.display !== "inline" && !element.matches(".scroll, html, body");
    if (boxed && element.scrollWidth > element.clientWidth + 1 && element.clientWidth > 0 && !element.matches("table, thead, tbody, tr")) {
      found.push(`wider than its box: ${name(element)}`);
    }
  }
  return found;
}

/** The pixels of a part of the page that is in view, in the page's coordinates. Playwright's own pictures take far longer. */
async function pixels(page, clip) {
  page.debugged ??= await page.context().newCDPSession(page);
  const asked = { format: "png", captureBeyondViewport: false, clip: { ...clip, scale: 1 } };
  return (await page.debugged.send("Page.captureScreenshot", asked)).data;
}

/** Tables in which numbers are seen, cut, right beside the names that stay while it scrolls: pixels there that change when the
 * numbers vanish. */
async function cut(page) {
  const found = [];
  const shown = (index) => page.evaluate((index) => {
    const table = document.querySelectorAll(".scroll:has(tbody th)")[index];
    table.scrollLeft = (table.scrollWidth - table.clientWidth) / 2;
    table.querySelector("tbody").scrollIntoView({ behavior: "instant" });
    const names = [...table.querySelector("tbody tr:has(th)").querySelectorAll("th")].filter((name) => getComputedStyle(name).position === "sticky");
    const body = table.querySelector("tbody").getBoundingClientRect();
    const x = names.at(-1).getBoundingClientRect().right + 1.5 + window.scrollX;
    return { x, y: body.top + window.scrollY, width: 4, height: Math.min(body.height, 600), scrolls: table.scrollWidth > table.clientWidth + 1 };
  }, index);
  const count = await page.locator(".scroll:has(tbody th)").count();
  for (let index = 0; index < count; index++) {
    const { scrolls, ...clip } = await shown(index);
    if (!scrolls) continue;
    // What scrolling moves follows it a frame later.
    const picture = () => frames(page).then(() => pixels(page, clip));
    const before = await picture();
    const hide = (hidden) => page.evaluate(([index, hidden]) => {
      for (const cell of document.querySelectorAll(".scroll:has(tbody th)")[index].querySelectorAll("td")) {
        cell.style.color = hidden ? "transparent" : "";
        for (const part of cell.querySelectorAll("*")) part.style.visibility = hidden ? "hidden" : "";
      }
    }, [index, hidden]);
    await hide(true);
    if (before !== (await picture())) found.push(`table ${index + 1}`);
    await hide(false);
    await page.evaluate((index) => { document.querySelectorAll(".scroll:has(tbody th)")[index].scrollLeft = 0; }, index);
  }
  return found;
}

/** Words of a picture that lie one on the other, and names that lie on the base of the stand. */
function crowded() {
  const found = [];
  for (const picture of document.querySelectorAll("svg.picture")) {
    const boxes = [...picture.querySelectorAll("text")].map((element) => [element.textContent, element.getBoundingClientRect()]);
    if (picture.closest("#figure-stand")) {
      const base = [...picture.querySelectorAll("polygon.base")];
      for (const element of picture.querySelectorAll("text:not(.letter)")) {
        const { x, y, width, height } = element.getBBox();
        const places = [0, 0.25, 0.5, 0.75, 1].flatMap((across) => [0.3, 0.6, 0.8].map((down) => new DOMPoint(x + across * width, y + down * height)));
        if (places.some((place) => base.some((face) => face.isPointInFill(place)))) found.push(`${element.textContent} lies on the base`);
      }
    }
    const boxed = boxes.filter(([, box]) => box.width > 0);
    boxed.forEach(([words, box], index) => {
      for (const [others, other] of boxed.slice(index + 1)) {
        const wide = Math.min(box.right, other.right) - Math.max(box.left, other.left);
        const high = Math.min(box.bottom, other.bottom) - Math.max(box.top, other.top);
        if (wide > 0 && high > 0) found.push(`${picture.querySelector("title").textContent}: ${words} and ${others}: ${wide.toFixed(1)} by ${high.toFixed(1)}`);
      }
    });
  }
  return found;
}

/** Colours of a picture at points, in shares of its size. The browser's empty first tab reads it. */
function colours_at(page, png, shares) {
  return page.context().pages()[0].evaluate(async ([png, shares]) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height).getContext("2d");
    canvas.drawImage(image, 0, 0);
    return shares.map(([x, y]) => String(canvas.getImageData(Math.floor(x * image.width), Math.floor(y * image.height), 1, 1).data));
  }, [png, shares]);
}

/** Parts of pictures that `use` repeats in other colours than where they are drawn: style sheets may not reach them. */
async function recoloured(page) {
  const found = [];
  const hrefs = await page.evaluate(() => [...new Set([...document.querySelectorAll("svg.picture use")].map((use) => use.getAttribute("href")))]);
  for (const href of hrefs) {
    const places = [page.locator(href), page.locator(`svg.picture use[href="${href}"]`).last()];
    const seen = [];
    for (const drawn of places) {
      // Where the part is not hidden by another, in shares of its box.
      seen.push(await drawn.evaluate((element) => {
        element.scrollIntoView({ block: "center", behavior: "instant" });
        const box = element.getBoundingClientRect();
        const shares = [...Array(24).keys()].flatMap((down) => [...Array(24).keys()].map((across) => [(across + 0.5) / 24, (down + 0.5) / 24]));
        const is_there = ([across, down]) => document.elementFromPoint(box.left + across * box.width, box.top + down * box.height)?.closest("use, g[id]") === element;
        return shares.filter(is_there).map(String);
      }));
    }
    const both = seen[0].filter((share) => seen[1].includes(share)).map((share) => share.split(",").map(Number));
    if (both.length === 0) found.push(`${href} is seen in no place`);
    // Points on an edge are mixed with what is behind, and pixels lie differently: a colour may be that of another point.
    const colours = [];
    for (const drawn of places) {
      const clip = await drawn.evaluate((element) => {
        element.scrollIntoView({ block: "center", behavior: "instant" });
        const { left, top, width, height } = element.getBoundingClientRect();
        return { x: left + scrollX, y: top + scrollY, width, height };
      });
      colours.push(await colours_at(page, await pixels(page, clip), both));
    }
    const [first, repeated] = colours;
    const same = repeated.filter((colour) => first.includes(colour)).length;
    if (same < repeated.length / 4) found.push(`${href} has other colours where it is repeated: ${same} of ${first.length} points are the same`);
  }
  return found;
}

/** Type that is too small in print: 8 pt, in pictures and in the annex 6.5 pt, indices 5 pt. */
function small() {
  const found = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const parent = node.parentElement;
    if (!node.data.trim() || parent.closest("title, desc, .unseen") || parent.getClientRects().length === 0) continue;
    const text = parent.closest("text");
    const scale = text ? text.getScreenCTM().a : 1;
    const points = 0.75 * scale * parseFloat(getComputedStyle(parent).fontSize);
    const least = parent.closest("sub, sup, .index") ? 5 : text || parent.closest("pre") ? 6.5 : 8;
    if (points < least - 0.01) found.add(`${points.toFixed(2)} pt, not ${least}: ${node.data.trim().slice(0, 30)}`);
  }
  return [...found];
}

/** Symbols of quantities that are not italic: Greek letters, and u and U, alone or before an index. */
function upright() {
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const parent = node.parentElement;
    const [symbol] = node.data.match(/(?<![\p{L}°])(?:\p{Script=Greek}|[uU])(?![\p{L}\p{N}])/u) ?? [];
    if (!symbol || parent.closest("title, desc, pre, code, .given, sub, .index")) continue;
    if (getComputedStyle(parent).fontStyle !== "italic") found.push(`${symbol} of ${node.data.trim().slice(0, 40)}`);
  }
  return found;
}

/** Decimal marks of a column that are not one below the other: x of the end of the whole part of each number. */
function misaligned() {
  const found = [];
  for (const table of document.querySelectorAll("table.numbers")) {
    const columns = new Map();
    for (const cell of table.querySelectorAll("tbody td")) {
      const data = cell.querySelectorAll(":scope > data");
      const own = [...cell.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
      if (data.length !== 1 || own.length > 0) continue;
      const text = data[0].firstChild;
      const whole = text.data.search(/[.,]|\u202f[·×]/);
      const range = document.createRange();
      range.setStart(text, 0);
      range.setEnd(text, whole < 0 ? text.data.length : whole);
      const column = columns.get(cell.cellIndex) ?? [];
      column.push([range.getBoundingClientRect().right, text.data]);
      columns.set(cell.cellIndex, column);
    }
    for (const [index, column] of columns) {
      const [first, named] = column[0];
      const off = column.find(([x]) => Math.abs(x - first) > 0.6);
      if (off) found.push(`column ${index} of ${table.className}: ${off[1]} is off ${named} by ${(off[0] - first).toFixed(1)}`);
    }
  }
  return found;
}

/** Quantities in cells whose unit does not follow directly after the number: within the width of a digit and a space. */
function torn() {
  const found = [];
  for (const unit of document.querySelectorAll(".numbers td > .unit")) {
    const number = unit.parentElement.querySelector(":scope > data").getBoundingClientRect();
    const gap = unit.getBoundingClientRect().left - number.right;
    if (gap > parseFloat(getComputedStyle(unit).fontSize) * 0.5) found.push(`${gap.toFixed(1)} px between number and unit of ${unit.parentElement.textContent}`);
  }
  return found;
}

/** Rows of forms in which no pen has room: lower than 8 mm. */
function low() {
  const millimetres = (row) => (row.getBoundingClientRect().height / 96) * 25.4;
  return [...document.querySelectorAll(".form tbody tr, .lines, .proof .fields > div, #signatures .fields > div, .fields > div:has(> dd > .blank)")].map(millimetres).filter((height) => height < 7.99).map((height) => `${height.toFixed(1)} mm`);
}

/** Marks the beginning of every heading and of every row below one, and says what was marked, in the order of the page. */
function marked() {
  const heads = { H2: 2, H3: 3, CAPTION: 4, THEAD: 5 };
  const tables = [...document.querySelectorAll("table")];
  const found = [];
  const places = [];
  for (const element of document.querySelectorAll("h2, h3, caption, thead, tbody tr, .fields > div, li, p, figure, pre > span:nth-child(-n + 3)")) {
    const level = heads[element.tagName] ?? 0;
    if (element.closest(".unseen, .screen, .band, .checked, header") || element.getClientRects().length === 0) continue;
    if (element.matches("p, li") && element.parentElement.closest("table, figure, li, .fields")) continue;
    const style = getComputedStyle(element);
    const lines = Math.round(element.getBoundingClientRect().height / (parseFloat(style.lineHeight) || 12));
    const rows = element.tagName === "FIGURE" ? 3 : element.tagName === "P" ? Math.max(1, lines) : 1;
    found.push({ level, rows, table: tables.indexOf(element.closest("table")), name: element.textContent.trim().slice(0, 40) });
    places.push(element.matches("tr, thead") ? element.querySelector("th, td") : element.matches(".fields > div") ? element.firstElementChild : element);
  }
  // Words out of the flow, which no browser leaves out in print and no eye sees; after all measurements, because each change
  // has the page laid out again.
  places.forEach((place, index) => {
    const mark = document.createElement("span");
    mark.textContent = `qz${index}zq`;
    mark.style.cssText = "position:absolute;font:1px sans-serif;color:#fefefe;pointer-events:none";
    place.prepend(mark);
  });
  return found;
}

/** The sheets of a print, as text. */
function sheets(pdf) {
  return execFileSync("pdftotext", ["-raw", pdf, "-"], { encoding: "utf8", maxBuffer: 1 << 26 }).replace(/\f$/, "").split("\f");
}

/** Headings, captions and table heads at the foot of a sheet, with fewer than three rows below them that could be there. */
function orphaned(marks, pdf, printed) {
  const LEAST = 3;
  const first = new Map();
  const text = sheets(pdf);
  text.forEach((sheet, page) => {
    for (const [, mark] of sheet.matchAll(/qz(\d+)zq/g)) if (!first.has(Number(mark))) first.set(Number(mark), page);
  });
  const plain = (sheet) => sheet.replace(/qz\d+zq|\s/g, "").length;
  const found = [];
  const same = text.length === printed.length && text.every((sheet, page) => plain(sheet) === plain(printed[page]));
  if (!same) found.push("the marks have moved what is on the sheets");
  // A heading that stands again at the head of a sheet, where its rows go on, has no mark there.
  const spaced = (words) => words.replace(/\s+/g, " ").trim().slice(0, 40).trim();
  const headings = new Map(marks.flatMap(({ level, name }, place) => (level === 3 ? [[spaced(name), first.get(place)]] : [])));
  printed.forEach((sheet, page) => {
    const lines = sheet.split("\n").map(spaced);
    const bare = lines.find((line, index) => headings.get(line) < page && headings.has(lines[index + 1]));
    if (bare) found.push(`sheet ${page + 1}: nothing below ${bare}`);
  });
  marks.forEach((head, place) => {
    if (!first.has(place)) found.push(`${head.name} is marked and not printed`);
    if (head.level === 0) return;
    const after = marks.slice(place + 1);
    const within = ({ level, table }) => (head.level >= 4 ? table === head.table && level !== 4 : level === 0 || level > head.level);
    const end = after.findIndex((mark) => !within(mark));
    const below_head = (end < 0 ? after : after.slice(0, end)).map((mark, index) => ({ ...mark, page: first.get(place + 1 + index) }));
    const all = below_head.filter(({ level }) => level === 0 || (level >= 4 && head.level < 4));
    // What comes after a table that is whole may stand on the next sheet.
    const rows = all.filter(({ table }) => all[0].table < 0 || table === all[0].table);
    const sum = (some) => some.reduce((all, { rows }) => all + rows, 0);
    const due = Math.min(LEAST, sum(rows));
    const there = sum(rows.filter(({ page }) => page === first.get(place)));
    if (there < due) found.push(`sheet ${first.get(place) + 1}: ${there} of ${due} rows below ${head.name}`);
  });
  return found;
}

async function look(browser, folder, name) {
  const file = path.join(folder, `${name}.html`);
  const address = `file://${file}`;
  const html = fs.readFileSync(file, "utf8");
  const result = { bytes: Buffer.byteLength(html), asked: [], complaints: [], unfit: {}, crowded: {}, recoloured: [], cut: [], axe: {}, html: [] };
  const page = await browser.newPage();
  page.on("request", (request) => { if (request.url() !== address) result.asked.push(request.url()); });
  page.on("console", (message) => result.complaints.push(message.text()));
  page.on("pageerror", (error) => result.complaints.push(String(error)));
  page.on("dialog", (dialog) => { result.complaints.push(`a dialog: ${dialog.message()}`); dialog.dismiss(); });
  await page.goto(address);
  result.said = await page.evaluate(said);
  for (const colours of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme: colours });
    for (const [device, width] of Object.entries(WIDTHS)) {
      // Dark changes colours alone: it is looked at once.
      if (colours === "dark" && device !== "screen") continue;
      await page.setViewportSize({ width, height: 1000 });
      // What moves with scrolling follows a new size in a later frame.
      await frames(page);
      result.unfit[`${device} ${colours}`] = await page.evaluate(unfit);
      result.crowded[`${device} ${colours}`] = await page.evaluate(crowded);
      if (device === "phone") result.cut = await cut(page);
      if (process.env.SCREENS === "write") await page.screenshot({ path: path.join(folder, `${name}-${device}-${colours}.png`), fullPage: true });
    }
    if (colours === "light") result.recoloured = await recoloured(page);
    // The page's policy forbids scripts, so axe comes in through the debugger, as the measurements do.
    const rules = colours === "dark" ? { runOnly: ["color-contrast"] } : {};
    const violations = await page.evaluate(`${axe}; axe.run(${JSON.stringify(rules)}).then((found) => found.violations)`);
    result.axe[colours] = violations.map((violation) => `${violation.id}: ${violation.help}: ${violation.nodes.map((node) => node.html).join(" | ").slice(0, 500)}`);
    const code = page.locator("svg.code");
    if (await code.count()) await code.screenshot({ path: path.join(folder, `${name}-code-${colours}.png`) });
  }
  // The area of a page is 182 mm wide.
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  await page.setViewportSize({ width: Math.round((182 / 25.4) * 96), height: 1000 });
  result.unfit.print = await page.evaluate(unfit);
  result.crowded.print = await page.evaluate(crowded);
  result.print = { small: await page.evaluate(small), misaligned: await page.evaluate(misaligned), upright: await page.evaluate(upright), torn: await page.evaluate(torn), low: await page.evaluate(low) };
  const printed = path.join(folder, `${name}.pdf`);
  await page.pdf({ path: printed, preferCSSPageSize: true });
  const marks = await page.evaluate(marked);
  const marked_pdf = path.join(folder, `${name}.marked`);
  await page.pdf({ path: marked_pdf, preferCSSPageSize: true });
  result.print.orphaned = orphaned(marks, marked_pdf, sheets(printed));
  await page.close();
  const report = await new HtmlValidate(RULES).validateString(html);
  result.html = report.results.flatMap((one) => one.messages.map((message) => `${message.line}:${message.column} ${message.ruleId}: ${message.message}`));
  return result;
}

/** Looks at some pages, one after the other, in a browser of their own: a tab in the background would draw nothing. */
async function looked(executablePath, folder, names) {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), "chromium-"));
  const quiet = ["--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  const context = await chromium.launchPersistentContext(profile, { executablePath, chromiumSandbox: false, args: quiet });
  const results = {};
  while (names.length > 0) {
    const name = names.shift();
    results[name] = await look(context, folder, name);
  }
  await context.close();
  fs.rmSync(profile, { recursive: true, force: true });
  return results;
}

async function main() {
  const [executablePath, folder, ...names] = process.argv.slice(2);
  const both = await Promise.all([0, 1].map(() => looked(executablePath, folder, names)));
  process.stdout.write(JSON.stringify(Object.assign(...both)));
}

main().catch((error) => { console.error(error); process.exit(1); });
