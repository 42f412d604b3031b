// The module of motions that pages carry, run without a browser: its outcomes must be those of the program.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { inflateSync } from "node:zlib";
import { catchment, home } from "./browser.mjs";

const AXES = ["x", "y", "roll", "pitch", "yaw"];
/** Of 60 outcomes a module of another core that differs in one of 20 shows none with 0.95⁶⁰, a twentieth; of all five designs together never. */
const POSES = 60;

/** Numbers in [0, 1), the same every time (Park and Miller). */
function* numbers(seed) {
    for (let state = seed; ; ) yield (state = (state * 48271) % 2147483647) / 2147483647;
}

/** The page's own module, with the halves of its design in it. */
async function module(path) {
    const text = readFileSync(path, "utf8");
    const inside = (id) => {
        const from = text.indexOf(`id="${id}">`) + `id="${id}">`.length;
        return text.slice(from, text.indexOf("</script>", from)).trim();
    };
    const unpacked = (id) => inflateSync(Buffer.from(inside(id), "base64"));
    const { design } = JSON.parse(inside("data")).report;
    const compiled = await WebAssembly.compile(unpacked("motions"));
    // What it names and never calls.
    const named = {};
    for (const { module, name } of WebAssembly.Module.imports(compiled)) (named[module] ??= {})[name] = () => assert.fail(name);
    const { exports } = await WebAssembly.instantiate(compiled, named);
    const parts = [new TextEncoder().encode(JSON.stringify(design)), unpacked("fixed"), unpacked("moving")];
    let at = exports.input(parts.reduce((sum, part) => sum + part.length, 0)) >>> 0;
    for (const part of parts) {
        new Uint8Array(exports.memory.buffer, at, part.length).set(part);
        at += part.length;
    }
    const outputText = () => new TextDecoder().decode(new Uint8Array(exports.memory.buffer, exports.output() >>> 0, exports.output_length()));
    assert.equal(exports.load(parts[0].length, parts[1].length), 0, outputText());
    return { design, trace: (pose, friction) => (exports.trace(...pose, friction), JSON.parse(outputText())) };
}

// Planar ones that hook under each other, grooves of a lip, play, and friction.
for (const [design, friction, ...given] of [
    ["s-face", 0, "--cor", "-1"],
    ["v-face", 0.2],
    ["x-face-3d-locking", 0],
    ["pyramid", 0.1],
    ["gallery/peg-in-hole", 0],
]) {
    test(`${design}, friction ${friction}: the module's outcomes are those of the program`, async () => {
        const name = join(home, `${design.replace(/\W/g, "-")}-module`);
        // The page is wanted for its module: a result without sampled poses is enough.
        catchment("run", `designs/${design}.toml`, ...given, "--resolution", "4", "--samples", "0", "-o", `${name}.zarr`);
        catchment("report", `${name}.zarr`, "--leave-out", "slices,jams,window", "-o", `${name}.html`);
        const { design: read, trace } = await module(`${name}.html`);
        const random = numbers(2026);
        const half = (axis) => (read.alignment.free.includes(axis) ? read.alignment.half_ranges[AXES.indexOf(axis)] : 0);
        const poses = Array.from({ length: POSES }, () => AXES.map((axis) => half(axis) * (2 * random.next().value - 1)));
        const table = join(home, `${design.replace(/\W/g, "-")}-poses.csv`);
        writeFileSync(table, [AXES.join(), ...poses.map((pose) => pose.join())].join("\n"));
        const rows = catchment("outcome", `designs/${design}.toml`, "--poses", table, "--friction", String(friction), ...given).trim().split("\n");
        const column = rows[0].split(",").indexOf("outcome");
        const differing = poses.filter((pose, k) => trace(pose, friction).outcome !== rows[k + 1].split(",")[column]);
        // On a border the last bits of a sine decide.
        assert.ok(differing.length <= 1, `${differing.length} of ${POSES} differ, the first at ${differing[0]}: run viewer/wasm.sh`);
    });
}
