// Slices, the surface and the sentence below the halves must agree with the pictures and the numbers of the same result.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { build } from "esbuild";
import { catchment, home, launch, motion, open, root, written } from "./browser.mjs";

let browser;
before(async () => void (browser = await launch()));
after(() => browser?.close());

/** A result, its page, and its pictures. Eight cells per axis: none is centred on 0. */
function stored(design, ...given) {
    const folder = join(home, `${design}-${given.join("").replace(/\W/g, "")}`);
    catchment("run", `designs/${design}.toml`, ...given, "--samples", "0", "-o", folder);
    const path = `${folder}.html`;
    catchment("report", folder, "--leave-out", "jams,window", "-o", path);
    return { path, svg: readFileSync(join(folder, "slices.svg"), "utf8") };
}

const OUTCOMES = ["aligned", "jammed", "missed", "undecided"];

/** The outcome of every cell of every map of a picture, from its pixels: one per cell, the first row on top. */
async function ofPicture(page, svg) {
    const images = [...svg.matchAll(/<image[^>]*href="(data:image\/png;base64,[^"]*)"/g)].map(([, data]) => data);
    return page.evaluate(async ([images, names]) => {
        const shown = [];
        for (const data of images) {
            const image = await createImageBitmap(new Blob([Uint8Array.from(atob(data.split(",")[1]), (c) => c.charCodeAt(0))], { type: "image/png" }));
            const pen = new OffscreenCanvas(image.width, image.height).getContext("2d", { willReadFrequently: true });
            pen.drawImage(image, 0, 0);
            const pixels = pen.getImageData(0, 0, image.width, image.height).data;
            const hex = (k) => `#${[0, 1, 2].map((c) => pixels[4 * k + c].toString(16).padStart(2, "0")).join("")}`;
            // The colours of the pictures, which those of the page in light are, too.
            const named = Object.fromEntries(names.map((name) => [getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim(), name]));
            shown.push({ size: [image.width, image.height], cells: Array.from({ length: image.width * image.height }, (_, k) => named[hex(k)] ?? hex(k)) });
        }
        return shown;
    }, [images, OUTCOMES]);
}

/** The outcomes that a slice of the page shows over so many cells; null where a mark covers the cell. */
const ofSlice = (page, number, [columns, rows]) =>
    page.evaluate(([number, columns, rows, names]) => {
        const canvas = document.querySelectorAll("canvas.slice")[number];
        const pen = canvas.getContext("2d", { willReadFrequently: true });
        const ratio = canvas.width / canvas.clientWidth;
        const [w, h] = [canvas.clientWidth - 56, canvas.clientHeight - 42];
        const style = getComputedStyle(document.documentElement);
        const named = Object.fromEntries(names.map((name) => [style.getPropertyValue(`--${name}`).trim(), name]));
        return Array.from({ length: columns * rows }, (_, k) => {
            const [i, j] = [k % columns, Math.floor(k / columns)];
            const [r, g, b] = pen.getImageData((46 + ((i + 0.5) * w) / columns) * ratio, (8 + ((j + 0.5) * h) / rows) * ratio, 1, 1).data;
            return named[`#${[r, g, b].map((v) => v.toString(16).padStart(2, "0")).join("")}`] ?? null;
        });
    }, [number, columns, rows, OUTCOMES]);

for (const [design, ...given] of [
    ["x-face-3d", "--free", "x,y,yaw", "--resolution", "8"],
    // It shows its own cells, also in pictures: those beside 0.
    ["pyramid", "--free", "x,y,yaw", "--resolution", "8", "--method", "flood"],
    ["v-face", "--resolution", "8"],
]) {
    test(`${design} ${given.join(" ")}: slices at zero show what its picture shows`, async () => {
        const { path, svg } = stored(design, ...given);
        const { page, log } = await open(browser, path, { colorScheme: "light" });
        // Before the test reads pixels, of which the browser warns.
        assert.deepEqual(log.errors, []);
        const maps = await ofPicture(page, svg);
        assert.equal(maps.length, await page.locator("canvas.slice").count());
        for (const [number, { size, cells }] of maps.entries()) {
            const shown = await ofSlice(page, number, size);
            const differing = shown.filter((outcome, k) => outcome !== null && outcome !== cells[k]).length;
            const covered = shown.filter((outcome) => outcome === null).length;
            assert.equal(differing, 0, `slice ${number + 1}, ${size.join(" × ")}`);
            assert.ok(covered < 0.2 * cells.length, `${covered} of ${cells.length} covered`);
            assert.ok(new Set(cells).size > 1);
        }
    });
}

test("slices are labelled", async () => {
    const given = ["--free", "x,y,yaw", "--resolution", "8", "--leave-out", "jams,window"];
    const { page } = await open(browser, written("x-face-3d", ...given));
    const captions = () => page.locator("figure.slice .drawn").allTextContents();
    for (const caption of await captions()) assert.match(caption, /^(yaw|y|x) = 0: exact motions, \d+ × \d+$/);
    // Off 0 they are cells of the grid: of eight over ±1 D, ±90°, centred at odd eighths.
    await page.evaluate(() => window.catchment.choose([0.3, 0, 0, 0, 0.5]));
    await page.waitForFunction(() => /grid/.test(document.querySelector("figure.slice .drawn").textContent));
    const { report } = JSON.parse(readFileSync(written("x-face-3d", ...given), "utf8").match(/id="data">(.*?)<\/script>/s)[1]);
    const drawn = (name, value, shown) => {
        const { lo, hi, cells } = report.axes.find(({ axis }) => axis === name);
        const step = (hi - lo) / cells;
        return `${name} = ${shown(lo + (Math.floor((value - lo) / step) + 0.5) * step)}`;
    };
    const [xy, xyaw] = await captions();
    assert.equal(xy, `cells of the grid at ${drawn("yaw", 0.5, (value) => `${Number(((value * 180) / Math.PI).toPrecision(3))}°`)}`);
    // x and yaw vary there, and y is 0.
    assert.match(xyaw, /^y = 0: exact motions/);
    // Without planes the cell beside 0 is drawn, and named.
    const { page: plain } = await open(browser, written("x-face-3d", "--free", "x,y,yaw", "--resolution", "8", "--leave-out", "jams,window,slices"));
    assert.match(await plain.locator("figure.slice .drawn").first().textContent(), /^cells of the grid at yaw = \d/);
});

test("an empty surface gives the reason", async () => {
    const { page } = await open(browser, written("pyramid", "--resolution", "8", "--leave-out", "jams,window,slices"));
    const caption = page.locator("figure.volume .drawn");
    assert.match(await caption.textContent(), /^cells of the grid at pitch = [\d.]+°, yaw = [\d.]+°$/);
    await page.evaluate(() => window.catchment.choose([0, 0, 0, 0.1, 1]));
    await page.waitForFunction(() => /^empty/.test(document.querySelector("figure.volume .drawn").textContent)).catch(async (error) => { throw Error(await caption.textContent(), { cause: error }); });
    assert.match(await caption.textContent(), /^empty: at pitch = [\d.]+°, yaw = [\d.]+° no cell is aligned \([\d\u202f]+ (jammed|missed).*\); move pitch or yaw$/);
    // The counts are those of the 8³ cells there.
    const counts = [...(await caption.textContent()).matchAll(/([\d\u202f]+) (?:jammed|missed|undecided)/g)].map(([, count]) => Number(count.replaceAll("\u202f", "")));
    assert.equal(counts.reduce((a, b) => a + b, 0), 512);
});

test("a surface of an absent outcome is reported", async () => {
    // A cone in its seat never jams.
    const { page } = await open(browser, written("cone", "--free", "x,y,pitch", "--resolution", "6", "--leave-out", "jams,window,slices"));
    const { report } = JSON.parse(readFileSync(written("cone", "--free", "x,y,pitch", "--resolution", "6", "--leave-out", "jams,window,slices"), "utf8").match(/id="data">(.*?)<\/script>/s)[1]);
    const none = OUTCOMES.slice(0, 2).findIndex((outcome) => report.acceptance.outcomes[outcome] === 0);
    assert.ok(none >= 0, JSON.stringify(report.acceptance.outcomes));
    await page.locator("figure.volume select").first().selectOption({ index: none });
    await page.waitForFunction(() => /^empty/.test(document.querySelector("figure.volume .drawn").textContent));
    assert.equal(await page.locator("figure.volume .drawn").textContent(), `empty: no cell of the result is ${OUTCOMES[none]}`);
});

test("a rest that looks docked gives the reason why it is not", async () => {
    const { page } = await open(browser, written("pyramid", "--free", "x,yaw", "--resolution", "12", "--leave-out", "window"));
    const shown = await page.evaluate(() => window.catchment.motion());
    await page.evaluate(() => window.catchment.choose([0, 0, 0, 0, Math.PI / 2 - 0.2]));
    assert.equal((await motion(page, shown)).outcome, "jammed");
    const verdict = await page.locator("#verdict").textContent();
    assert.match(verdict, /at the mated height\. It lies as deep as docked, but turned by 90°, which the design does not count as mated; symmetry = 4 in \[alignment\] would count it\./);
    assert.doesNotMatch(verdict, /0\.000/);
    const card = await page.locator("#jams").textContent();
    assert.match(card, /rests at the mated height with .*yaw −?90°/);
    assert.match(card, /symmetry = 4/);
});

/** A module of the viewer by itself. */
async function module(name) {
    const { outputFiles } = await build({ entryPoints: [join(root, `viewer/src/${name}.ts`)], bundle: true, write: false, format: "esm", logLevel: "warning" });
    return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

test("the rule of the seat that a rest breaks is named", async () => {
    const [{ reason, ending }, { Units }] = await Promise.all([module("outcome_text"), module("format")]);
    const design = (limits = [null, null, null, null, null], symmetry = 1) => ({
        name: "", width: 50, unit: "mm",
        alignment: { free: ["x", "y", "yaw"], center_of_rotation: 0, rotation_length: 0.5, half_ranges: [1, 1, 0, 0, 1], symmetry, docked: { depth: 2e-3, limits } },
    });
    const units = new Units(design());
    const why = (pose, above, ...given) => reason(pose, above, units, design(...given));
    const [quarter, depth] = [Math.PI / 2, 2e-3];
    assert.equal(why([0.3, 0, 0, 0, 0], 0.2), "", "the height alone explains it");
    assert.equal(why([0.3, 0, 0, 0, 0], 2 * depth), "docked is up to 0.1 mm above it ([docked] depth)");
    assert.match(why([0, 0, 0, 0, 0], -0.01), /deeper than the mated pose/);
    assert.match(why([0.02, 0, 0, 0, 0], 0, [0.01, null, null, null, null]), /^x is off by more than the 0.5 mm that count as docked \(\[docked\] x\)$/);
    assert.match(why([0.3, 0, 0, 0, 0], 0), /not connected with the mated pose/);
    assert.match(why([0, 0, 0, 0, -quarter], 0), /turned by 90°.*; symmetry = 4 in \[alignment\]/);
    // A third of a turn is no half of one: nothing is proposed that would count neither.
    assert.match(why([0, 0, 0, 0, (2 * Math.PI) / 3], 0, undefined, 2), /turned by 60°.*does not count as mated; symmetry = 6/);
    assert.match(why([0, 0, 0, 0, 0.75], 0), /turned by 43°.*does not count as mated$/);

    const jammed = (height_d, yaw) => {
        const error = { x: 0, y: 0, roll: 0, pitch: 0, yaw };
        return { start: error, outcome: "jammed", reason: null, end: error, waypoints: [{ travelled_d: 0, error, height_d, touches: [{}, {}, {}, {}] }] };
    };
    assert.match(ending(jammed(8.06e-6, quarter), 0, units, design()), /^Jams: at rest on 4 contacts with yaw 90°, at the mated height\. It lies/);
    assert.equal(ending(jammed(0.123456, 0.2), 0, units, design()), "Jams: at rest on 4 contacts with yaw 11.5°, 6.173 mm above the mated height.");
    assert.match(ending(jammed(-0.1, 0.2), 0, units, design()), /, 5 mm below the mated height\./);
});
