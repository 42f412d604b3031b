// Whatever strings a design or a stored result holds, none of them becomes a part of its page, and no script but the page's own runs.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { catchment, home, launch, open, program, root } from "./browser.mjs";

let browser;
before(async () => void (browser = await launch()));
after(() => browser?.close());

/** Short enough to stand whole in a message. */
const TAG = `<img src=x onerror="window.ran = 1">`;

/** Closes every context in which it may stand; sets `window.ran` if any of it runs. */
const HOSTILE = `</script></style></title></textarea>--><script>window.ran = "script"</script><img src=x onerror="window.ran = 'handler'">` +
    `<svg onload="window.ran = 'svg'"></svg>" onfocus="window.ran = 'attribute'" autofocus x='<!--<script>\u2028\${window.ran = 1}{{1}}&lt;`;

/** The whole page, watched from its first byte. */
async function watched(path) {
    const watch = () => {
        window.refused = [];
        document.addEventListener("securitypolicyviolation", (event) => window.refused.push(event.violatedDirective));
    };
    const { page, log } = await open(browser, path, {}, (page) => page.addInitScript(watch));
    const state = () => page.evaluate(() => ({ ran: window.ran ?? null, refused: window.refused, strangers: document.querySelectorAll("img, svg, iframe, object, [onerror], [onfocus], [onload]").length }));
    return { page, log, state };
}

/** Every string in a value, as the path to it. */
const strings = (value, path = []) =>
    typeof value === "string" ? [path] : value !== null && typeof value === "object" ? Object.entries(value).flatMap(([key, inner]) => strings(inner, [...path, key])) : [];
const put = (value, path, text) => path.slice(0, -1).reduce((inner, key) => inner[key], value)[path.at(-1)] = text;

/** Makes a page of a stored result. Returns null, or stderr if the program refuses. */
function made(result, page) {
    try {
        execFileSync(program, ["report", result, "-o", page, "--force", "--leave-out", "slices,jams,window"], { cwd: root, encoding: "utf8", stdio: ["ignore", "ignore", "pipe"] });
        return null;
    } catch (error) {
        return error.stderr;
    }
}

test("a stored result with every string hostile: nothing of it runs, and its version is refused", async () => {
    const [result, path] = [join(home, "stored"), join(home, "stored.html")];
    catchment("run", "designs/pyramid-stl.toml", "--free", "x,yaw", "--resolution", "12", "--samples", "100", "--jams", "--window", "-o", result);
    const file = join(result, "result.zarr/zarr.json");
    const whole = JSON.parse(readFileSync(file, "utf8"));
    const { report } = whole.attributes;
    assert.equal(made(result, path), null);
    // Settings are of any form: a name in them is a string, too.
    report.settings[HOSTILE] = HOSTILE;
    report.warnings.push({ warning: { kind: "note", text: HOSTILE }, message: HOSTILE });
    const all = strings(report);
    const [taken, refused] = [[], []];
    for (const place of all) {
        const spoilt = structuredClone(whole);
        put(spoilt.attributes.report, place, HOSTILE);
        writeFileSync(file, JSON.stringify(spoilt));
        const why = made(result, path);
        if (why === null) taken.push(place);
        else refused.push([place.join("."), why]);
    }
    for (const place of taken) put(report, place, HOSTILE);
    writeFileSync(file, JSON.stringify(whole));
    assert.equal(made(result, path), null);
    const names = taken.map((place) => place.join("."));
    for (const expected of ["design.name", `settings.${HOSTILE}`, "warnings.0.message"]) assert.ok(names.includes(expected), `${expected}: ${names.join("\n")}`);
    const version = refused.find(([place]) => place === "catchment");
    assert.match(version?.[1] ?? names.join(), /is not a version of catchment/);

    const { page, log, state } = await watched(path);
    assert.equal(await page.locator("h1").textContent(), HOSTILE);
    // Whatever can be pressed is pressed.
    for (const button of await page.locator("button.jam, #window button").all()) await button.click();
    await page.locator("canvas.slice").first().hover();
    assert.deepEqual(await state(), { ran: null, refused: [], strangers: 0 });
    assert.deepEqual(log.errors, []);
});

test("a design whose names and files are hostile: nothing of them runs", async () => {
    // No file name holds a slash.
    const mesh = HOSTILE.replaceAll("/", "\u2215").replaceAll("\u2028", "");
    const named = (half) => `${half}${mesh}`.slice(0, 120) + ".stl";
    for (const half of ["socket", "plug"]) copyFileSync(join(root, `designs/meshes/${half}.stl`), join(home, named(half)));
    // A name has at most 200 characters, none of which ends a line.
    const name = HOSTILE.replaceAll("\u2028", "");
    for (const [k, part] of [name.slice(0, 150), name.slice(-150)].entries()) {
        const text = readFileSync(join(root, "designs/pyramid-stl.toml"), "utf8")
            .replace(/^name = .*$/m, () => `name = ${JSON.stringify(part)}`)
            .replace(/"meshes\/(socket|plug)\.stl"/g, (_, half) => JSON.stringify(named(half)));
        const [design, path] = [join(home, `hostile-${k}.toml`), join(home, `hostile-${k}.html`)];
        writeFileSync(design, text);
        catchment("report", design, "--free", "x,yaw", "--resolution", "12", "--leave-out", "window", "-o", path);
        const { page, log, state } = await watched(path);
        assert.equal(await page.locator("h1").textContent(), part);
        for (const button of await page.locator("button.jam").all()) await button.click();
        assert.deepEqual(await state(), { ran: null, refused: [], strangers: 0 });
        assert.deepEqual(log.errors, []);
    }
});

/** The second barrier: were there a hole in the first, the browser would still refuse. */
test("a script that gets into a page does not run, from a disk and served", async () => {
    const path = join(home, "broken-into.html");
    catchment("report", "designs/v-face.toml", "--resolution", "8", "--leave-out", "jams,window", "-o", path);
    writeFileSync(path, readFileSync(path, "utf8").replace("<noscript>", () => `${HOSTILE.replace("<!--<script>", "")}<a id="link" href="javascript:window.ran='link'">a</a><noscript>`));
    const { page, state } = await watched(path);
    await page.locator("#link").click();
    const { ran, refused } = await state();
    assert.equal(ran, null);
    assert.ok(refused.filter((directive) => /^script-src/.test(directive)).length >= 3, refused.join());

    const server = spawn(program, ["view", join(root, "designs/v-face.toml"), "--resolution", "8", "--leave-out", "window,jams"], { stdio: ["ignore", "pipe", "ignore"] });
    try {
        const address = await new Promise((done) => server.stdout.once("data", (output) => done(String(output).trim())));
        const { page, state } = await watched(address);
        await page.evaluate((html) => document.body.insertAdjacentHTML("beforeend", html), HOSTILE);
        await page.evaluate(() => document.body.append(Object.assign(document.createElement("script"), { textContent: "window.ran = 'inserted'" })));
        assert.equal((await state()).ran, null);
    } finally {
        server.kill();
    }
});

test("messages of a served page are text", async () => {
    const design = join(home, "served.toml");
    copyFileSync(join(root, "designs/v-face.toml"), design);
    const server = spawn(program, ["view", design, "--resolution", "8", "--leave-out", "window,jams"], { stdio: ["ignore", "pipe", "ignore"] });
    try {
        const address = await new Promise((done) => server.stdout.once("data", (output) => done(String(output).trim())));
        const { page, state } = await watched(address);
        writeFileSync(design, `[connector]\nfamily = ${JSON.stringify(TAG)}\n`);
        await page.locator("#again").click();
        await page.waitForFunction((tag) => document.querySelector(".again output").textContent.includes(tag), TAG);
        await page.locator(".again input").fill(TAG);
        await page.locator("#again").click();
        await page.waitForFunction(() => /there is no axis `<img src`/.test(document.querySelector(".again output").textContent));
        assert.deepEqual(await state(), { ran: null, refused: [], strangers: 0 });
    } finally {
        server.kill();
    }
});
