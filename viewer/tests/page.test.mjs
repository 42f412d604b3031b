// The page of `catchment report`, driven as a person drives it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import { catchment, home, launch, motion, open, program, root, written } from "./browser.mjs";

let browser;
before(async () => void (browser = await launch()));
after(() => browser?.close());

const AXES = ["x", "y", "roll", "pitch", "yaw"];
/** The last bits of sines may differ between this machine's library and the page's own. */
const CLOSE = 1e-9;

function alike(a, b, place = "") {
    if (typeof a === "number" && typeof b === "number") assert.ok(Math.abs(a - b) <= CLOSE * Math.max(1, Math.abs(b)), `${place}: ${a} and ${b}`);
    else if (a !== null && typeof a === "object") {
        assert.deepEqual(Object.keys(a), Object.keys(b), place);
        for (const key of Object.keys(a)) alike(a[key], b[key], `${place}.${key}`);
    } else assert.equal(a, b, place);
}

/** The motion that the program computes from the same start. */
function traced(design, { start }, ...given) {
    const pose = AXES.filter((axis) => start[axis] !== 0).map((axis) => `${axis}=${start[axis]}`).join(",") || "x=0";
    return JSON.parse(catchment("trace", `designs/${design}.toml`, "--pose", pose, "--json", ...given));
}

// Planar and spatial, with play, and of meshes.
for (const [design, ...given] of [
    ["v-face", "--resolution", "30", "--leave-out", "window"],
    ["x-face-3d", "--resolution", "8", "--leave-out", "window"],
    ["gallery/peg-in-hole", "--resolution", "20", "--leave-out", "window,jams"],
    ["pyramid-stl", "--resolution", "4", "--leave-out", "window,jams"],
]) {
    test(`${design}: clicks play the motions of trace; no other request leaves the page`, async () => {
        const { page, log } = await open(browser, written(design, ...given));
        let shown = await page.evaluate(() => window.catchment.motion());
        const outcomes = new Set();
        for (const [u, v] of [[0.6, 0.45], [0.85, 0.3], [0.16, 0.88], [0.4, 0.6]]) {
            const canvas = page.locator("canvas.slice").first();
            const { width, height } = await canvas.boundingBox();
            await canvas.click({ position: { x: 46 + u * (width - 56), y: 8 + v * (height - 42) } });
            const found = await motion(page, shown);
            shown = await page.evaluate(() => window.catchment.motion());
            alike(found, traced(design, found), design);
            outcomes.add(found.outcome);
            assert.equal(await page.locator("#verdict").getAttribute("data-outcome"), found.outcome);
        }
        assert.ok(outcomes.size > 1, [...outcomes].join());
        // The motion plays to its end by itself.
        await page.locator(".play").click();
        await page.waitForFunction(() => Number(document.querySelector(".time").value) > 0);
        assert.deepEqual(log.errors, []);
        assert.equal(log.requests.length, 1, log.requests.join());
    });
}

test("sliders, pickers and keys act as labelled", async () => {
    const { page, log } = await open(browser, written("x-face-3d", "--resolution", "8", "--leave-out", "window"));
    let shown = await page.evaluate(() => window.catchment.motion());
    await page.locator("#number-x").fill("0.2");
    await page.locator("#number-x").press("Enter");
    let found = await motion(page, shown);
    assert.ok(Math.abs(found.start.x - 0.2) < 1e-12);
    shown = await page.evaluate(() => window.catchment.motion());
    await page.locator("h1").click();
    await page.keyboard.press("5");
    assert.equal(await page.evaluate(() => document.activeElement.id), "slider-yaw");
    await page.keyboard.press("ArrowRight");
    found = await motion(page, shown);
    assert.ok(found.start.yaw > 0);

    const picture = (name) => page.locator(name).first().evaluate((canvas) => canvas.toDataURL());
    let old = await picture("canvas.slice");
    await page.locator("select[data-slice='1']").first().selectOption({ label: "yaw" });
    await page.waitForFunction((before) => document.querySelector("canvas.slice").toDataURL() !== before, old);
    old = await picture("canvas.volume");
    await page.locator("figure.volume select").nth(3).selectOption({ label: "yaw" });
    await page.waitForFunction((before) => document.querySelector("canvas.volume").toDataURL() !== before, old);

    old = await picture("canvas.stage");
    await page.locator("h1").click();
    await page.keyboard.press("s");
    await page.waitForFunction((before) => document.querySelector("canvas.stage").toDataURL() !== before, old);
    assert.equal(await page.locator("#section").inputValue(), "y");
    const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const light = await paper();
    await page.keyboard.press("t");
    assert.notEqual(await paper(), light);
    await page.keyboard.press("?");
    assert.ok(await page.locator("#help").isVisible());
    await page.keyboard.press("Escape");
    await page.keyboard.press("0");
    await page.waitForFunction(() => window.catchment.pose().every((value) => value === 0));

    // A cell to the right in a slice, by the keyboard alone.
    await page.locator("canvas.slice").first().focus();
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction(() => window.catchment.pose().some((value) => value !== 0));
    assert.deepEqual(log.errors, []);
});

test("a click onto the surface chooses a pose on the border of the set", async () => {
    const { page, log } = await open(browser, written("x-face-3d", "--resolution", "8", "--leave-out", "window"));
    const canvas = page.locator("canvas.volume");
    const { width, height } = await canvas.boundingBox();
    await canvas.click({ position: { x: width / 2, y: height / 2 } });
    await page.waitForFunction(() => window.catchment.pose().some((value) => value !== 0));
    const pose = await page.evaluate(() => window.catchment.pose());
    // The surface lies in the box, over the first three errors; the others stay where they were.
    assert.ok(pose.slice(0, 3).every((value) => Math.abs(value) < 2) && pose[3] === 0 && pose[4] === 0, pose.join());
    // Beside the set nothing is chosen.
    await canvas.click({ position: { x: 3, y: 3 } });
    assert.deepEqual(await page.evaluate(() => window.catchment.pose()), pose);
    assert.deepEqual(log.errors, []);
});

test("a browser that draws nothing in space answers all the same", async () => {
    const flat = await launch("--disable-software-rasterizer");
    try {
        const { page, log } = await open(flat, written("x-face-3d", "--resolution", "8", "--leave-out", "window"));
        assert.match(await page.locator("#halves .hint").textContent(), /draws nothing in space/);
        assert.equal(await page.locator("canvas.volume").count(), 0);
        const shown = await page.evaluate(() => window.catchment.motion());
        const canvas = page.locator("canvas.slice").first();
        const { width, height } = await canvas.boundingBox();
        await canvas.click({ position: { x: 46 + 0.6 * (width - 56), y: 8 + 0.45 * (height - 42) } });
        alike(await motion(page, shown), traced("x-face-3d", await motion(page, shown)));
        assert.deepEqual(log.errors.filter((error) => !/WebGL/.test(error)), []);
    } finally {
        await flat.close();
    }
});

test("the page reports the end of drawing, and prints dark on white", async () => {
    const { page } = await open(browser, written("x-face-3d", "--resolution", "8", "--leave-out", "window"), { colorScheme: "dark" });
    for (const name of ["canvas.stage", "canvas.volume"]) {
        const inked = await page.locator(name).evaluate((canvas) => {
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            return data.filter((value, k) => k % 4 === 3 && value > 0).length / (canvas.width * canvas.height);
        });
        assert.ok(inked > 0.05, `${name}: ${inked}`);
    }
    const ink = () => page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue("--ink"));
    const dark = await ink();
    await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    assert.notEqual(await ink(), dark);
    await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
    assert.equal(await ink(), dark);
});

test("slices show the cells of the result", async () => {
    const { page } = await open(browser, written("v-face", "--resolution", "30", "--leave-out", "window"));
    const data = JSON.parse(readFileSync(written("v-face", "--resolution", "30", "--leave-out", "window"), "utf8").match(/id="data">(.*?)<\/script>/s)[1]);
    const expected = data.report.acceptance.outcomes;
    const counted = await page.evaluate(() => {
        const canvas = document.querySelector("canvas.slice");
        const pen = canvas.getContext("2d");
        const ratio = canvas.width / canvas.clientWidth;
        const [w, h] = [canvas.clientWidth - 56, canvas.clientHeight - 42];
        const style = getComputedStyle(document.documentElement);
        const named = Object.fromEntries(["aligned", "jammed", "missed", "undecided"].map((name) => [style.getPropertyValue(`--${name}`).trim(), name]));
        const counts = { aligned: 0, jammed: 0, missed: 0, undecided: 0, other: 0 };
        for (let j = 0; j < 30; j++)
            for (let i = 0; i < 30; i++) {
                const [r, g, b] = pen.getImageData((46 + ((i + 0.27) * w) / 30) * ratio, (8 + ((j + 0.27) * h) / 30) * ratio, 1, 1).data;
                counts[named[`#${[r, g, b].map((v) => v.toString(16).padStart(2, "0")).join("")}`] ?? "other"]++;
            }
        return counts;
    });
    // Frames and numbers of jams cover some cells.
    assert.ok(counted.other < 60, JSON.stringify(counted));
    for (const name of ["aligned", "jammed", "missed"]) assert.ok(Math.abs(counted[name] - expected[name]) <= counted.other, `${name}: ${JSON.stringify(counted)} ${JSON.stringify(expected)}`);
});

test("a page of 30³ cells is small, as is one of five errors", () => {
    const megabytes = (...given) => statSync(written(...given)).size / 1e6;
    const [cubed, five] = [megabytes("x-face-3d", "--free", "x,y,yaw", "--resolution", "30", "--leave-out", "window"), megabytes("x-face-3d", "--resolution", "8", "--leave-out", "window")];
    // The issue asks for less than 5 MB; viewer, motions and cells are 1.1 MB of it today.
    assert.ok(cubed < 2, `30³: ${cubed} MB`);
    assert.ok(five < 2, `8⁵: ${five} MB`);
});

test("speed of a page of 30³ cells, printed", async (t) => {
    const page = await (await browser.newContext({ viewport: { width: 1400, height: 1000 } })).newPage();
    await page.addInitScript(() => {
        window.frozen = [];
        new PerformanceObserver((list) => list.getEntries().forEach((entry) => window.frozen.push(Math.round(entry.duration)))).observe({ type: "longtask", buffered: true });
    });
    await page.goto(pathToFileURL(written("x-face-3d", "--free", "x,y,yaw", "--resolution", "30", "--leave-out", "window")).href);
    await page.waitForSelector("html[data-ready]", { timeout: 120000 });
    const longest = await page.evaluate(() => Math.max(0, ...window.frozen));
    const answers = await page.evaluate(() => Math.round(performance.getEntriesByName("answers")[0].startTime));
    t.diagnostic(`30³: answers after ${answers} ms (target 1 000), longest freeze ${longest} ms (target 200)`);
    assert.ok(Number.isFinite(longest) && answers > 0);
});

test("a jam that is clicked is shown where it rests", async () => {
    const { page } = await open(browser, written("v-face", "--resolution", "30", "--leave-out", "window"));
    const shown = await page.evaluate(() => window.catchment.motion());
    await page.locator("button.jam").first().click();
    const found = await motion(page, shown);
    assert.equal(found.outcome, "jammed");
    assert.match(await page.locator("#verdict").textContent(), /Jams: at rest on \d+ contact/);
});

test("motions use the chosen friction, and the page reports another friction of the set", async () => {
    const { page } = await open(browser, written("v-face", "--resolution", "30", "--friction", "0.2", "--leave-out", "window"));
    assert.match(await page.locator("header").textContent(), /friction 0.2/);
    let shown = await page.evaluate(() => window.catchment.motion());
    await page.evaluate(() => window.catchment.choose([0.3, 0, 0, 0.4, 0]));
    alike(await motion(page, shown), traced("v-face", { start: { x: 0.3, y: 0, roll: 0, pitch: 0.4, yaw: 0 } }, "--friction", "0.2"));
    assert.doesNotMatch(await page.locator("#verdict").textContent(), /This motion is/);
    shown = await page.evaluate(() => window.catchment.motion());
    await page.locator("#friction").fill("0");
    await page.locator("#friction").press("Enter");
    alike(await motion(page, shown), traced("v-face", { start: { x: 0.3, y: 0, roll: 0, pitch: 0.4, yaw: 0 } }));
    assert.match(await page.locator("#verdict").textContent(), /This motion is without friction, the set with friction 0.2/);
    // Any coefficient, not only round ones.
    await page.locator("#friction").fill("0.237");
    await page.locator("#friction").press("Enter");
    await page.waitForFunction(() => /with friction 0.237/.test(document.querySelector("#verdict").textContent));
});

test("a served page recomputes a changed design and reports its defects", async () => {
    const path = join(home, "changed.toml");
    const design = (name) => writeFileSync(path, readFileSync(join(root, "designs/v-face.toml"), "utf8").replace(/^name = .*$/m, `name = "${name}"`));
    design("before");
    const server = spawn(program, ["view", path, "--resolution", "20", "--leave-out", "window,jams"], { stdio: ["ignore", "pipe", "ignore"] });
    try {
        const address = await new Promise((done) => server.stdout.once("data", (output) => done(String(output).trim())));
        const { page, log } = await open(browser, address);
        assert.equal(await page.locator("h1").textContent(), "before");
        design("after");
        await page.locator(".again input").fill("26");
        await page.locator("#again").click();
        await page.waitForFunction(() => document.querySelector("h1")?.textContent === "after" && document.documentElement.dataset.ready);
        assert.match(await page.locator("header").textContent(), /26 × 26 cells/);
        writeFileSync(path, "schema = 1\n");
        await page.locator("#again").click();
        await page.waitForFunction(() => /connector/.test(document.querySelector(".again output").textContent));
        assert.equal(await page.locator("h1").textContent(), "after");
        assert.deepEqual(log.errors, []);
        assert.ok(log.requests.every((url) => url.startsWith(new URL(address).origin)), log.requests.join());
    } finally {
        server.kill();
    }
});
