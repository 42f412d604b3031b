// Elements, written short.

type Given = Record<string, string | number | boolean | ((event: never) => void)>;

/** An element with attributes, listeners (`onclick`) and children. The page's policy forbids styles in attributes: they are set by script. */
export function make<T extends keyof HTMLElementTagNameMap>(tag: T, given: Given = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[T] {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(given)) {
        if (typeof value === "function") element.addEventListener(name.slice(2), value as EventListener);
        else if (name === "style") element.style.cssText = String(value);
        else if (typeof value === "boolean") element.toggleAttribute(name, value);
        else element.setAttribute(name, String(value));
    }
    element.append(...children);
    return element;
}

/** The colour of a variable of the style. */
export const colour = (name: string) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export const colours = (...names: string[]) => Object.fromEntries(names.map((name) => [name, colour(`--${name}`)]));
