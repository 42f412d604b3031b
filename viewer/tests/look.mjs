// Pictures of a page, to look at: node tests/look.mjs folder [page.html]
//
// Without a page that of docs/viewer.md, at poses that stay the same: folder ../docs writes viewer-light.png, viewer-dark.png, viewer-jam.png
// and viewer-paper.png. They are looked at before they are committed.
import { join } from "node:path";
import { launch, motion, open, written } from "./browser.mjs";

const [folder, path] = process.argv.slice(2);
const saddle = () => path ?? written("x-face-3d", "--free", "x,y,yaw", "--resolution", "24");
/** It jams a quarter turn off. */
const pyramid = () => path ?? written("pyramid-stl", "--free", "x,y,yaw", "--resolution", "24", "--leave-out", "window");
/** x, y, roll, pitch, yaw in D and radians: one that docks. */
const DOCKS = [0.3, 0.2, 0, 0, 0.25];
const running = await launch();

/** Opens the page, shows a motion, and takes a picture. */
async function picture(name, made, options, shows, paper = false) {
    const { page, log, context } = await open(running, made(), options);
    const before = await page.evaluate(() => window.catchment.motion());
    await shows(page);
    await motion(page, before);
    // All is drawn, and a motion that plays has come to its end.
    await page.waitForTimeout(5000);
    if (paper) {
        await page.emulateMedia({ media: "print" });
        await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
        await page.waitForTimeout(1500);
    }
    await page.screenshot({ path: join(folder, `viewer-${name}.png`), fullPage: true });
    console.log(name, log.errors, log.requests.length, await page.locator("#verdict").textContent());
    await context.close();
}

const docks = (page) => page.evaluate((pose) => window.catchment.choose(pose), DOCKS);
/** Cut, because what touches is inside. */
const jams = async (page) => {
    await page.selectOption("#section", "y");
    await page.locator("button.jam").first().click();
};
await picture("light", saddle, { colorScheme: "light" }, docks);
await picture("dark", saddle, { colorScheme: "dark" }, docks);
await picture("jam", pyramid, { colorScheme: "light" }, jams);
await picture("paper", saddle, { colorScheme: "dark", viewport: { width: 1000, height: 1000 } }, docks, true);
await running.close();
