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

/** Starts Chromium. It draws in space by software, because there may be no graphics card; `space` replaces the flag for this. */
export const launch = (space = "--enable-unsafe-swiftshader") =>
    chromium.launch({
        executablePath: browser,
        args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", space],
    });

/** Opens a page and waits until it is drawn. `log` collects errors and warnings, and the address of every request but blob: and data:. `prepare` gets the page before it loads. */
export async function open(running, path, options = {}, prepare = async () => {}) {
    const context = await running.newContext({ viewport: { width: 1400, height: 1000 }, ...options });
    const page = await context.newPage();
    await prepare(page);
    const log = { errors: [], requests: [] };
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver|swiftshader|WebGL-/i.test(message.text()) && log.errors.push(message.text()));
    page.on("pageerror", (error) => log.errors.push(String(error)));
    page.on("request", (request) => !/^(blob|data):/.test(request.url()) && log.requests.push(request.url()));
    await page.goto(path.startsWith("http") ? path : pathToFileURL(path).href);
    await page.waitForSelector("html[data-ready]", { timeout: 60000 });
    return { page, log, context };
}

/** The motion that is shown once it is that of another pose than `before`. */
export async function motion(page, before = "") {
    await page.waitForFunction((old) => window.catchment.motion() !== old, before);
    return JSON.parse(await page.evaluate(() => window.catchment.motion()));
}
