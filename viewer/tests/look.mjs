// Pictures of a page, to look at: node tests/look.mjs page.html folder
import { join } from "node:path";
import { launch, open } from "./browser.mjs";

const [path, folder] = process.argv.slice(2);
const running = await launch();
for (const [name, options] of [
    ["light", { colorScheme: "light" }],
    ["dark", { colorScheme: "dark" }],
    ["narrow", { colorScheme: "light", viewport: { width: 420, height: 900 } }],
]) {
    const { page, said } = await open(running, path, options);
    const canvas = page.locator("canvas.slice").first();
    const { width, height } = await canvas.boundingBox();
    await canvas.click({ position: { x: 46 + 0.22 * (width - 56), y: 8 + 0.33 * (height - 42) } });
    await page.waitForTimeout(2600);
    await page.screenshot({ path: join(folder, `${name}.png`), fullPage: true });
    console.log(name, said.errors, said.asked.length, await page.locator("#verdict").textContent());
}
await running.close();
