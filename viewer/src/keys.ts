// The keyboard.

import type { Sliders } from "./controls";
import { make } from "./dom";
import type { Player } from "./player";

const KEYS: [string, string][] = [
    ["1 … 5", "the slider of x, y, roll, pitch, yaw; arrows move it"],
    ["Space", "play or pause the motion"],
    ["Enter", "in a slice: play the motion of the pose"],
    ["arrows", "in a slice: a cell on; in a picture in space: turn it"],
    ["+ −", "in a picture in space: nearer, farther"],
    ["s", "section: whole, along x, along y"],
    ["0", "the mated pose"],
    ["t", "light or dark"],
    ["?", "this list"],
];

export function help(): HTMLElement {
    const list = make("dl", {}, ...KEYS.flatMap(([key, does]) => [make("dt", {}, key), make("dd", {}, does)]));
    const dialog = make("dialog", { id: "help", "aria-label": "keys" }, make("h2", {}, "Keys"), list,
        make("p", { class: "hint" }, "A click into a slice or onto the surface chooses a pose and plays its motion. Motions are computed in this page by the library itself."),
        make("button", { type: "button", onclick: () => dialog.close() }, "close"));
    return make("span", {}, make("button", { type: "button", title: "keys (?)", "aria-label": "keys", onclick: () => dialog.showModal() }, "?"), dialog);
}

export function keys({ player, sliders, section, mated }: { player: Player; sliders: Sliders; section: HTMLSelectElement; mated: () => void }) {
    window.addEventListener("keydown", (event) => {
        const inside = event.target as HTMLElement;
        if (event.ctrlKey || event.metaKey || event.altKey || inside.matches("input[type=number], select, input[type=text]")) return;
        if (document.querySelector("dialog[open]")) return;
        const k = "12345".indexOf(event.key);
        if (k >= 0) sliders.focus(k);
        else if (event.key === "0") mated();
        else if (event.key === " " && !inside.matches("button")) player.toggle();
        else if (event.key === "Enter" && inside.matches("canvas")) player.play();
        else if (event.key === "t") document.getElementById("theme")?.click();
        else if (event.key === "?") (document.getElementById("help") as HTMLDialogElement).showModal();
        else if (event.key === "s") {
            section.selectedIndex = (section.selectedIndex + 1) % section.options.length;
            section.dispatchEvent(new Event("change"));
        } else return;
        event.preventDefault();
    });
}
