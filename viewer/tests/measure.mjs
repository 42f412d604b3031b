// How fast a page is: node tests/measure.mjs page.html … Prints the size, the time until it answers and until all is drawn, and its
// longest freezes until then and while it is used.
import { statSync } from "node:fs";
import { launch } from "./browser.mjs";
import { pathToFileURL } from "node:url";

const running = await launch();
for (const path of process.argv.slice(2)) {
    const page = await running.newPage({ viewport: { width: 1400, height: 1000 } });
    await page.addInitScript(() => {
        window.frozen = [];
        new PerformanceObserver((list) => list.getEntries().forEach((entry) => window.frozen.push([Math.round(entry.startTime), Math.round(entry.duration)]))).observe({ type: "longtask", buffered: true });
    });
    await page.goto(pathToFileURL(path).href);
    await page.waitForSelector("html[data-ready]", { timeout: 120000 });
    const ready = await page.evaluate(() => Math.round(performance.now()));
    const answers = await page.evaluate(() => Math.round(performance.getEntriesByName("answers")[0].startTime));
    const longest = () => page.evaluate(() => Math.max(0, ...window.frozen.map(([, long]) => long)));
    const loading = await longest();
    const timed = async (does) => {
        const before = await page.evaluate(() => window.catchment.motion());
        const started = Date.now();
        await does();
        await page.waitForFunction((old) => window.catchment.motion() !== old, before);
        return Date.now() - started;
    };
    const canvas = page.locator("canvas.slice").first();
    const { width, height } = await canvas.boundingBox();
    const click = await timed(() => canvas.click({ position: { x: 46 + 0.6 * (width - 56), y: 8 + 0.4 * (height - 42) } }));
    await page.evaluate(() => (window.frozen.length = 0));
    for (let k = 0; k < 30; k++) await page.evaluate((k) => window.catchment.choose([0.01 * k, 0, 0.01 * k, 0, 0.02 * k]), k);
    for (const picker of await page.locator("figcaption select").all()) {
        const options = await picker.locator("option").count();
        for (let k = 0; k < options; k++) await picker.selectOption({ index: k });
    }
    await page.waitForTimeout(2000);
    console.log(JSON.stringify({ path, megabytes: statSync(path).size / 1e6, answers_ms: answers, ready_ms: ready, click_ms: click, longest_task_loading_ms: loading, longest_task_ms: await longest() }));
    await page.close();
}
await running.close();
