// The page verify.html: reads files, calls the functions above, and shows their answers as text.

const byId = (id) => document.getElementById(id);

/** Creates an element of texts and elements. Text of others is only ever text, never markup. */
function element(name, ...children) {
    const created = document.createElement(name);
    created.append(...children);
    return created;
}

function table(head, rows) {
    const line = (cells, name) => element("tr", ...cells.map((cell) => element(name, String(cell))));
    return element("table", element("thead", line(head, "th")), element("tbody", ...rows.map((row) => line(row, "td"))));
}

const file = (id) => byId(id).files[0];
const read = async (blob) => (blob ? new Uint8Array(await blob.arrayBuffer()) : undefined);

async function asked() {
    const value = (id) => byId(id).value.trim() || undefined;
    const place = [value("latitude"), value("longitude")];
    if ((place[0] === undefined) !== (place[1] === undefined)) throw new Error("give latitude and longitude, or neither");
    const at = place[0] === undefined ? undefined : place.map(Number);
    if (at?.some(Number.isNaN)) throw new Error("latitude and longitude are numbers with a decimal point");
    const revoked = await Promise.all([...byId("revoked").files].map(read));
    const register = await read(file("register"));
    const question = { serial: value("serial"), issuer: value("issuer"), time: value("time"), at, revoked, register };
    return Object.fromEntries(Object.entries(question).filter(([, given]) => given !== undefined));
}

function numbers({ matrices, vectors, positions }) {
    const parts = [element("h2", "Numbers")];
    if (matrices) {
        const shown = (rows) => rows.map((row) => row.join("  ")).join("\n");
        parts.push(table(["matrix", "rows"], Object.entries(matrices).map(([key, rows]) => [key, shown(rows)])));
    }
    const rows = vectors.map((at, index) => {
        const { alpha_arcsec, beta_arcsec, gamma_arcsec } = positions[index];
        return [at.i, at.j, alpha_arcsec, beta_arcsec, gamma_arcsec, ...at.specific_force_g, ...at.omega_deg_per_h];
    });
    parts.push(table(["i", "j", "α, ″", "β, ″", "γ, ″", "n_x, g", "n_y, g", "ω_x, °/h", "ω_y, °/h"], rows));
    return parts;
}

function parameters({ verdict, remarks = [], assumed_meter, results: [found] }) {
    const rows = [];
    const u = found.standard_uncertainty;
    for (const [key, unit] of [["k_deg_per_h_per_ma", "°/(h·mA)"], ["omega0_deg_per_h", "°/h"],
        ["omega_g_deg_per_h_per_g", "°/(h·g)"], ["omega_k_deg_per_h_per_g", "°/(h·g)"],
        ["g_matrix_deg_per_h_per_g", "°/(h·g)"], ["drift_deg_per_h_per_h", "°/h²"]]) {
        if (found[key] !== undefined) rows.push([key, [found[key]].flat(2).join("  "), [u[key]].flat(2).join("  "), unit]);
    }
    const { value, degrees_of_freedom, probability } = found.chi_square;
    const said = [...remarks, ...(assumed_meter ? [`Meter: ${assumed_meter}`] : [])].map((words) => element("p", words));
    if (verdict) said.push(element("p", `Decision for the gyro type: ${verdict.overall}`));
    return [element("h2", `Calibration by ${found.method}`), ...said,
        table(["parameter", "value", "u (k = 1)", "unit"], rows),
        element("p", `χ² ${value} with ${degrees_of_freedom} degrees of freedom, probability ${probability ?? "-"}`)];
}

function printed(html, id) {
    const frame = element("iframe");
    frame.title = "Printed passport";
    frame.setAttribute("sandbox", "");
    frame.srcdoc = html;
    const link = element("a", "Save the printed passport");
    link.href = URL.createObjectURL(new Blob([html], { type: "text/html" }));
    link.download = `${id.replaceAll("/", "-")}.html`;
    return [element("h2", "Printed passport"), element("p", link), frame];
}

const failed = (title) => (error) => [element("h2", title), element("pre", error.message)];

async function answer() {
    const passport = await read(file("passport"));
    if (!passport) throw new Error("choose a passport");
    const signersFile = await read(file("signers-file"));
    const typed = byId("signers").value;
    if (signersFile && typed.trim()) throw new Error("give the trusted keys as a file or as text, not both");
    const signers = signersFile ?? typed;
    const question = await asked();
    const verdict = await verify(passport, signers, question);
    const soFar = ["stand", "place", "register"].some((name) => verdict.not_asked.includes(name));
    const large = element("p", verdict.valid ? (soFar ? "VALID SO FAR" : "VALID") : "REFUSED");
    large.className = `answer ${verdict.valid ? "valid" : "refused"}`;
    const { register } = verdict;
    const used = register && `register ${register.sequence} of ${register.issued_at}, SHA-256 ${register.sha256}`;
    const fresh = register?.fresh_until ? `, fresh until ${register.fresh_until}` : "";
    const mark = ({ passed, code }) => (passed === null ? code.replace("_", " ") : passed ? "ok" : "FAILED");
    const rows = verdict.checks.map((check) => [mark(check), check.name, check.code, check.detail]);
    const parts = [element("h2", "Answer"), large, element("p", verdict.id ?? "(id not verified)"),
        ...(used ? [element("p", used + fresh)] : []),
        ...verdict.remarks.map((words) => element("strong", words)),
        table(["result", "check", "code", "detail"], rows)];
    if (!verdict.valid) return parts;
    parts.push(...numbers(await content(passport, signers, question)));
    const currents = await read(file("currents"));
    const order = await file("order")?.text();
    const found = () => calibrate(passport, signers, currents, question, order).then(parameters, failed("No calibration"));
    if (currents) parts.push(...(await found()));
    parts.push(...printed(await print(passport, signers, question), verdict.id));
    return parts;
}

// Every request has a number: a late answer must not stand beside other files or another question.
let latest = 0;

function clear() {
    byId("result").replaceChildren();
    return ++latest;
}

async function show(parts) {
    const number = clear();
    const found = await parts;
    if (number === latest) byId("result").replaceChildren(...found);
}

byId("question").addEventListener("submit", (event) => {
    event.preventDefault();
    show(answer().catch(failed("No answer")));
});
byId("question").addEventListener("input", clear);

// The content of a dropped file tells what it is, never its name.
const kinds = [
    ["passport", "a passport", /^format: *"?dtg-passport\//m],
    ["register", "a register", /^format: *"?dtg-register\//m],
    ["revoked", "a list of revoked keys", /^\s*(SSHKRL|(#.*\r?\n\s*)*(sk-)?(ssh|ecdsa)-\S+\s+AAAA)/],
    ["signers-file", "a list of trusted keys", /^(?!#).*\s(sk-)?ssh-ed25519(@openssh\.com)?\s+AAAA/m],
    ["currents", "a table of currents", /^(?!#).*\bjx_ma\b/im],
    ["order", "an order", /^\s*\{/],
];

async function accept(files) {
    const given = new Map();
    for (const one of files) {
        const text = await one.text();
        const [id, what] = kinds.find(([, , form]) => form.test(text)) ?? [];
        const refuse = (why) => { throw new Error(`${one.name}: ${why}; none of the dropped files was taken`); };
        if (id === undefined) refuse("neither a passport nor a register, trusted keys, currents or an order");
        if (id === "revoked") refuse(`${what}, which must be chosen under Lists of revoked keys`);
        if (given.has(id)) refuse(`${what}, as is ${given.get(id).name}; drop only one`);
        const chosen = id === "signers-file" && (file(id) || byId("signers").value.trim());
        if (chosen) refuse("trusted keys, which are already chosen above; to use others, choose them there");
        given.set(id, one);
    }
    for (const [id, one] of given) {
        // The inputs show the name of what they hold.
        const held = new DataTransfer();
        held.items.add(one);
        byId(id).files = held.files;
    }
    if (byId("serial").value.trim()) return answer();
    byId("serial").focus();
    return [element("h2", "Serial number"), element("p", "Enter the serial number that you read from the stand, then press " +
        "Verify. Without it, a passport of another stand is not detected.")];
}

let dropped = Promise.resolve();
document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
    event.preventDefault();
    const files = [...event.dataTransfer.files];
    // One drop after the other, because reading a file takes time.
    const parts = dropped.then(() => accept(files)).catch(failed("No answer"));
    dropped = parts.then(() => undefined);
    show(parts);
});
