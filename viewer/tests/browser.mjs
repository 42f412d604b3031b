// A page in headless Chromium, and what went wrong in it.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const root = fileURLToPath(new URL("../..", import.meta.url));
export const program = process.env.CATCHMENT ?? join(root, "target/debug/catchment");
export const home = mkdtempSync(join(tmpdir(), "catchment-viewer-"));
const browser = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);

/** Runs the program; what it prints. */
export const catchment = (...given) => execFileSync(program, given, { cwd: root, encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"] });

/** The page of a design, as a file. */
export function written(design, ...given) {
    const path = join(home, `${design.replace(/\W/g, "-")}-${given.join("").replace(/\W/g, "")}.html`);
    if (!existsSync(path)) catchment("report", `designs/${design}.toml`, ...given, "-o", path);
    return path;
}

/** Draws in space by software, for want of a graphics card, or as `space` says. */
export const launch = (space = "--enable-unsafe-swiftshader") =>
    chromium.launch({
        executablePath: browser,
        args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", space],
    });

/** Opens a page and waits until it is drawn; `said` collects errors and everything that it asked for from elsewhere. `prepare` has the page before it loads. */
export async function open(running, path, options = {}, prepare = async () => {}) {
    const context = await running.newContext({ viewport: { width: 1400, height: 1000 }, ...options });
    const page = await context.newPage();
    await prepare(page);
    const said = { errors: [], asked: [] };
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver|swiftshader|WebGL-/i.test(message.text()) && said.errors.push(message.text()));
    page.on("pageerror", (error) => said.errors.push(String(error)));
    page.on("request", (request) => !/^(blob|data):/.test(request.url()) && said.asked.push(request.url()));
    await page.goto(path.startsWith("http") ? path : pathToFileURL(path).href);
    await page.waitForSelector("html[data-ready]", { timeout: 60000 });
    return { page, said, context };
}

/** The motion that is shown once it is that of another pose than `before`. */
export async function motion(page, before = "") {
    await page.waitForFunction((old) => window.catchment.motion() !== old, before);
    return JSON.parse(await page.evaluate(() => window.catchment.motion()));
}
