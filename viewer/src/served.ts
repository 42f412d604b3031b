// A page that is served: the design file is read and computed again on demand, and the page follows.

import { make } from "./dom";

interface Progress { state: "ready" | "running" | "failed"; share: number; stage: string; message: string }

/** A button, and how far it is. */
export function again(): HTMLElement {
    const said = make("output", { class: "progress", "aria-live": "polite" });
    const cells = make("input", { type: "text", size: 8, placeholder: "cells", "aria-label": "cells per axis, such as 30 or x=40,yaw=24", title: "cells per axis" });
    const button = make("button", { type: "button", id: "again", title: "reads the design file again and computes it", onclick: () => void run() }, "compute again");
    const run = async () => {
        button.disabled = true;
        const asked = await fetch("run", { method: "POST", body: cells.value.trim() });
        if (!asked.ok) said.textContent = await asked.text();
        else if (await follow(said)) location.reload();
        button.disabled = false;
    };
    return make("span", { class: "again" }, said, cells, button);
}

async function follow(said: HTMLElement): Promise<boolean> {
    for (;;) {
        const { state, share, stage, message }: Progress = await (await fetch("progress")).json();
        if (state !== "running") {
            said.textContent = state === "failed" ? message : "";
            return state === "ready";
        }
        said.textContent = `${stage} ${Math.round(100 * share)} %`;
        await new Promise((done) => setTimeout(done, 300));
    }
}
