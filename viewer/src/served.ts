// A page that is served: the design file is read and computed again on demand, and the page follows.

import { make } from "./dom";

interface Progress { state: "ready" | "running" | "failed"; share: number; stage: string; message: string }

/** A button, and the progress of the computation. Pressed again it replaces the computation that runs. */
export function again(): HTMLElement {
    const output = make("output", { class: "progress", "aria-live": "polite" });
    const cells = make("input", { type: "text", size: 8, placeholder: "cells", "aria-label": "cells per axis, such as 30 or x=40,yaw=24", title: "cells per axis" });
    const button = make("button", { type: "button", id: "again", title: "reads the design file again and computes it, in place of a computation that still runs", onclick: () => void run() }, "compute again");
    let newest = 0;
    const run = async () => {
        const own = ++newest;
        try {
            const response = await fetch("run", { method: "POST", body: cells.value.trim() });
            if (!response.ok) output.textContent = await response.text();
            else if (await follow(output, () => own === newest)) location.reload();
        } catch {
            output.textContent = "The program does not answer: start `catchment view` again.";
        }
    };
    return make("span", { class: "again" }, output, cells, button);
}

/** Shows the progress until there is a page (true), it failed, or another request is followed. */
async function follow(output: HTMLElement, isNewest: () => boolean): Promise<boolean> {
    while (isNewest()) {
        const { state, share, stage, message }: Progress = await (await fetch("progress")).json();
        if (state !== "running") {
            output.textContent = state === "failed" ? message : "";
            return state === "ready";
        }
        output.textContent = `${stage} ${Math.round(100 * share)} %`;
        await new Promise((done) => setTimeout(done, 300));
    }
    return false;
}
