// Cards of the report: figures of merit with their intervals, the window, the jams, warnings.

import { make } from "./dom";
import { grouped, percent, tidy, type Units } from "./format";
import { AXES, OUTCOMES, listed, type Jam, type Page, type Pose } from "./page";
import { reason } from "./outcome_text";

/** Meanings of the glossary, by term; build.mjs reads them from docs/glossary.md. */
declare const GLOSSARY: Record<string, string>;

/** A term, with its meaning as a tooltip. */
const term = (name: string, of = name) => (GLOSSARY[of] ? make("abbr", { title: GLOSSARY[of] }, name) : name);

const row = (name: Node | string, value: string, more = "") =>
    make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, value, ...(more ? [make("small", {}, more)] : [])));

/** A table whose first column names the rows. */
const table = (head: (Node | string)[], rows: string[][], caption: string) =>
    make("table", { class: "grid" }, make("caption", {}, caption),
        make("thead", {}, make("tr", {}, ...head.map((name) => make("th", { scope: "col" }, name)))),
        make("tbody", {}, ...rows.map(([name, ...cells]) => make("tr", {}, make("th", { scope: "row" }, name), ...cells.map((text) => make("td", {}, text))))));

const card = (id: string, title: string, ...children: (Node | string)[]) =>
    make("section", { class: "card", id, "aria-labelledby": `${id}-title` }, make("h2", { id: `${id}-title` }, title), ...children);

/** Digits enough for an interval. */
const interval = ([lo, hi]: [number, number]) => {
    const digits = Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(Math.max(1e-12, hi - lo)))));
    return `${lo.toFixed(digits)} … ${hi.toFixed(digits)}`;
};

export function merits({ report }: Page, units: Units): HTMLElement {
    const { acceptance, onaa, centered, tolerances, success } = report;
    const total = OUTCOMES.reduce((sum, outcome) => sum + acceptance.outcomes[outcome], 0) || 1;
    const bar = make("div", { class: "bar", role: "img", "aria-label": OUTCOMES.map((o) => `${o} ${percent(acceptance.outcomes[o] / total)}`).join(", ") },
        ...OUTCOMES.map((outcome) => make("i", { style: `flex-grow:${acceptance.outcomes[outcome]};background:var(--${outcome})` })));
    const legend = make("p", { class: "legend" }, ...OUTCOMES.filter((outcome) => acceptance.outcomes[outcome] > 0).map((outcome) =>
        make("span", {}, make("i", { style: `background:var(--${outcome})` }), `${outcome} ${percent(acceptance.outcomes[outcome] / total)}`)));
    const rows = [
        row(term("AA (Sum)", "Sum"), `${tidy4(acceptance.sum)} ${acceptance.unit}`, acceptance.sum_ci95 ? `95 % CI ${interval(acceptance.sum_ci95)}` : ""),
        row("share of the error box", percent(acceptance.fraction, 2)),
    ];
    if (acceptance.sum_bracket) rows.push(row("Sum by grid", tidy4(acceptance.sum_grid), `${acceptance.sum_bracket.map(tidy4).join(" … ")} if its border moves by one cell`));
    if (onaa) rows.push(row(term("ONAA edge", "ONAA"), onaa.edge.toFixed(4), "of every range: the largest box that docks, anywhere"));
    if (centered) rows.push(row(term("centred edge", "centred cube"), `${centered.reaches_border ? "≥ " : ""}${centered.edge.toFixed(4)}`, "the same, centred on zero"));
    if (success) rows.push(row("success", percent(success.probability, 2), success.ci95 ? `95 % CI ${success.ci95.map((share) => percent(share, 2)).join(" … ")}` : ""));
    const alone = table([term("single-axis limit"), "below", "above", "±"],
        tolerances.map((t) => [
            t.axis,
            `${t.minus_reaches_border ? "≥ " : ""}${units.error(t.axis, t.minus)}`,
            `${t.plus_reaches_border ? "≥ " : ""}${units.error(t.axis, t.plus)}`,
            units.error(t.axis, t.half_cell),
        ]), "This error, all others zero");
    return card("merits", "Figures of merit", bar, legend, make("table", { class: "facts" }, make("tbody", {}, ...rows)), ...(tolerances.length ? [alone] : []));
}

const tidy4 = (value: number) => (value === 0 ? "0" : Math.abs(value) < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4))));

export function windowCard({ window: found }: Page, units: Units, show: (pose: Pose) => void): HTMLElement | null {
    if (!found) return null;
    const rows = found.sides.map((side) => [
        side.axis + (side.axis === found.tightest ? " (limits)" : ""),
        `± ${units.error(side.axis, side.half_width)}`,
        `± ${units.error(side.axis, side.alone)}${side.alone_reaches_border ? " *" : ""}`,
        `± ${units.error(side.axis, side.beside)}${side.beside_reaches_border ? " *" : ""}`,
    ]);
    const children: Node[] = [table(["error", term("tolerance window"), term("single-axis limit"), "others in window"], rows, "Tolerance window: all errors at once")];
    if (found.sides.some((side) => side.alone_reaches_border || side.beside_reaches_border)) children.push(make("p", { class: "hint" }, "* the error box ends here: the limit may be larger"));
    const { motions, failing_at_most } = found.certificate;
    if (motions > 0)
        children.push(make("p", {}, `0 failures in ${grouped(motions)} poses sampled in it: failure rate below ${percent(failing_at_most, 4)} (95 % confidence).`));
    if (found.worst) {
        const pose = listed(found.worst.error);
        children.push(make("p", {}, `Nearest failure: ${units.pose(pose)}, ${found.worst.outcome}. `,
            make("button", { type: "button", onclick: () => show(pose) }, "play it")));
    }
    return card("window", "Tolerance window", ...children);
}

const drawn = ({ kind, name }: { kind: string; name: string }) => (name.startsWith(kind) ? name : `${kind} ${name}`);

export function jamsCard({ jams, report }: Page, units: Units, show: (pose: Pose, jam: Jam) => void): HTMLElement | null {
    if (!jams) return null;
    const items = jams.jams.slice(0, 12).map((jam) => {
        const pose = listed(jam.pose);
        const contacts = [...new Set(jam.contacts.map((contact) => `${drawn(contact.moving)} on ${drawn(contact.fixed)}`))];
        const held = jam.examined?.escape_path
            ? `${jam.examined.stability}; escape height at most ${units.size(jam.examined.escape_path.climb_at_most_d)} (then ${jam.examined.escape_path.to})`
            : (jam.examined?.stability ?? "");
        return make("li", {}, make("button", { type: "button", class: "jam", onclick: () => show(pose, jam) },
            make("b", {}, `${percent(jam.of_box.share)} of the error box`),
            make("small", {}, `95 % CI ${jam.of_box.ci95.map((share) => percent(share)).join(" … ")}${jam.places > 1 ? `, at ${jam.places} mirrored places` : ""}`),
            make("span", {}, `rests ${units.height(jam.above_mated_d)} with ${units.pose(pose)}`),
            make("span", {}, contacts.slice(0, 3).join("; ") + (contacts.length > 3 ? `; and ${contacts.length - 3} more` : "")),
            ...[reason(pose, jam.above_mated_d, units, report.design), held].filter((line) => line).map((line) => make("span", {}, line))));
    });
    const hint = make("p", { class: "hint" }, `${grouped(jams.motions)} sampled poses, followed exactly. Click a jam to see it.`);
    const { outcomes, cells } = report.acceptance;
    const labelled = outcomes.jammed > 0 ? ` Jammed cells (${percent(outcomes.jammed / (cells || 1), 2)}) are centres on a ridge, or jams too thin for these poses.` : "";
    const none = make("p", {}, `0 of ${grouped(jams.motions)} sampled poses jammed.${labelled}`);
    return card("jams", "Jams", ...(items.length ? [hint, make("ol", { class: "jams" }, ...items)] : [none]));
}

export function doubts({ report, notes }: Page): HTMLElement | null {
    const lines = [...report.warnings.map(({ message }) => message), ...notes];
    return lines.length ? card("doubts", "Warnings and notes", make("ul", {}, ...lines.map((text) => make("li", {}, text)))) : null;
}

/** What it is a result of. */
export function summary(page: Page, units: Units): string {
    const { report } = page;
    const cells = report.axes.length ? `${report.axes.map((axis) => axis.cells).join(" × ")} cells` : `${report.acceptance.cells} poses`;
    const width = report.design.unit ? `, D = ${tidy(report.design.width)} ${report.design.unit}` : "";
    const free = AXES.filter((axis) => report.design.alignment.free.includes(axis)).join(", ");
    const friction = page.friction ? `, friction ${tidy(page.friction)}` : "";
    return `free: ${free} · ${report.method}, ${cells}${friction}${width} · centre of rotation ${units.size(report.design.alignment.center_of_rotation)} before the face`;
}
