// Light or dark: as the system has it, or as chosen here.

import { make } from "./dom";

const KEY = "catchment-theme";

/** A button that changes it; `changed` draws anew what has no style. */
export function theme(changed: () => void): HTMLElement {
    const root = document.documentElement;
    const dark = matchMedia("(prefers-color-scheme: dark)");
    try {
        root.dataset.theme = localStorage.getItem(KEY) ?? "";
    } catch {
        // A page of a file may have no storage.
    }
    const isDark = () => (root.dataset.theme ? root.dataset.theme === "dark" : dark.matches);
    dark.addEventListener("change", changed);
    return make("button", { type: "button", id: "theme", title: "light or dark (t)", "aria-label": "light or dark", onclick: () => {
        root.dataset.theme = isDark() ? "light" : "dark";
        try {
            localStorage.setItem(KEY, root.dataset.theme);
        } catch {
            // It is light or dark until the page is left.
        }
        changed();
    } }, "◐");
}
