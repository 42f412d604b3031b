// Builds the viewer into the folder of the library that ships it; with --compare says whether what lies there is what is built.
//
//     node build.mjs             src/*.ts ──▶ ../crates/catchment-report/src/page/bundle/{viewer.js, worker.js, painter.js, viewer.css}
//     node build.mjs --compare   exit code 1 unless the same bytes lie there
import { build } from "esbuild";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const bundle = here("../crates/catchment-report/src/page/bundle/");
const compare = process.argv.includes("--compare");
// Meanings of terms, for tooltips: the first sentence of each line of the glossary.
const glossary = Object.fromEntries(
    [...readFileSync(here("../docs/glossary.md"), "utf8").matchAll(/^- \*\*(.+?)\*\*: (.+)$/gm)].flatMap(([, names, text]) => {
        const meaning = text.replace(/ (Formerly|\*Source:).*/, "").replace(/\[([^\]]*)\]\([^)]*\)/g, "$1").replace(/[`*]/g, "");
        return names.split(/, | \(|\)/).filter((name) => name).map((name) => [name, meaning]);
    }),
);
const used = ["Sum", "ONAA", "centred cube", "tolerance window", "single-axis limit"];
const missing = used.filter((name) => !glossary[name]);
if (missing.length) throw new Error(`docs/glossary.md does not explain ${missing.join(", ")}`);
const define = { GLOSSARY: JSON.stringify(Object.fromEntries(used.map((name) => [name, glossary[name]]))) };
const shared = { define, bundle: true, minify: true, write: false, target: "es2022", legalComments: "none", charset: "ascii", logLevel: "warning" };
const banner = "/* catchment viewer; holds three.js, MIT, Copyright 2010-2026 three.js authors */";
// The page orbits, and leaves drawing to the painter: of three.js it takes vectors and cameras, without shaders.
const core = { name: "core", setup: (building) => building.onResolve({ filter: /^three$/ }, () => ({ path: here("node_modules/three/build/three.core.js") })) };
const built = await Promise.all([
    build({ ...shared, entryPoints: [here("src/main.ts")], outfile: "viewer.js", format: "iife", banner: { js: banner }, plugins: [core] }),
    build({ ...shared, entryPoints: [here("src/worker.ts")], outfile: "worker.js", format: "iife" }),
    build({ ...shared, entryPoints: [here("src/painter.ts")], outfile: "painter.js", format: "iife", banner: { js: banner } }),
    build({ ...shared, entryPoints: [here("src/style/viewer.css")], outfile: "viewer.css" }),
]);
let differs = false;
for (const file of built.flatMap((result) => result.outputFiles)) {
    const name = file.path.split("/").pop();
    const bytes = Buffer.from(file.contents);
    if (compare) {
        if (!existsSync(bundle + name) || !readFileSync(bundle + name).equals(bytes)) {
            console.error(`${name} is not what viewer/src builds: run \`npm run build\` in viewer/ and commit it`);
            differs = true;
        }
    } else {
        writeFileSync(bundle + name, bytes);
        console.log(`${name} ${bytes.length}`);
    }
}
process.exit(differs ? 1 : 0);
