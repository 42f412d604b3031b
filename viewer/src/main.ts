// The page: what it shows, and what happens when a pose is chosen. It draws results; motions come from the library itself (worker), pictures in space
// from a worker of their own (painter): whatever they take, a click is answered.

import { Helper, latest } from "./request";
import { Friction, Sliders } from "./controls";
import { Cuts } from "./cuts";
import { make } from "./dom";
import { Units } from "./format";
import { help, keys } from "./keys";
import type { Computing, Painting } from "./messages";
import { AXES, listed, page as read, text, type Jam, type Outcome, type Pose, type Trace } from "./page";
import { doubts, jamsCard, merits, summary, windowCard } from "./panels";
import { Player } from "./player";
import { again } from "./served";
import { Slice, type Marks } from "./slices";
import { Stage, type Section } from "./stage";
import { ending } from "./outcome_text";
import { theme } from "./theme";
import { Volume } from "./volume";

const page = read();
const { report } = page;
const { design, axes } = report;
const units = new Units(design);
const { free, center_of_rotation: cor } = design.alignment;
const locked = { x: !free.includes("x"), y: !free.includes("y") };
const packed = [text("fixed"), text("moving"), text("motions")];
const helper = new Helper<Computing>("worker");
const painter = new Helper<Painting>("painter");

let pose: Pose = [0, 0, 0, 0, 0];
/** The motion that is shown: the JSON text of the library. */
let json = "";

const verdict = make("p", { class: "verdict", id: "verdict", role: "status", "aria-live": "polite" });
let stage: Stage | null = null;
let mated = 0;
const player = new Player((error, height, touches) => stage?.place(error, height, touches, locked));
const friction = new Friction(page.friction, () => void follow());
const sliders = new Sliders(units, design, axes, (chosen) => choose(chosen, false));

const marks = (): Marks => ({
    boxes: [
        ...(page.window ? [{ bounds: page.window.sides.map((side) => ({ axis: side.axis, lo: -side.half_width, hi: side.half_width })), colour: "--window", dashed: false }] : []),
        ...(report.onaa?.bounds.length ? [{ bounds: report.onaa.bounds, colour: "--onaa", dashed: true }] : []),
    ],
    jams: (page.jams?.jams ?? []).slice(0, 12).map((jam) => listed(jam.pose)),
});
const cuts = new Cuts(page, units, helper);
const host = {
    axes, units, marks,
    pose: () => pose,
    cut: (chosen: [number, number]) => cuts.cut(chosen, pose),
    border: async (chosen: number[], code: number) => {
        const at = cuts.at(pose);
        return { ...(await helper.ask("border", { axes: chosen, at, code })), fixed: cuts.fixed(chosen, at) };
    },
    has: (outcome: Outcome) => report.acceptance.outcomes[outcome] > 0,
    choose: (chosen: Pose) => choose(chosen, true),
};
const pairs: [number, number][] = axes.length < 3 ? [[0, 1]] : axes.length === 3 ? [[0, 1], [0, 2], [1, 2]] : [[0, 1], [2, 3], [0, axes.length - 1]];
const slices = axes.length < 2 ? [] : pairs.map((pair, k) => new Slice(host, pair, k + 1));
const volume = axes.length > 2 ? new Volume(host, painter, [0, 1, 2]) : null;

const cut = latest(async () => void (await Promise.all([...slices.map((slice) => slice.update()), volume?.update()])));
let play = false;
const follow = latest(async () => {
    if (!packed[2]) return;
    const requested = pose;
    try {
        const found = await helper.ask("follow", { pose: requested, friction: friction.value });
        if (requested === pose) show(found.trace, found.json);
    } catch (error) {
        tell("undecided", String(error instanceof Error ? error.message : error));
    }
});

function tell(outcome: string, message: string) {
    verdict.dataset.outcome = outcome;
    verdict.textContent = message;
}

function show(trace: Trace, traceJson: string) {
    json = traceJson;
    if (trace.waypoints.length === 0) stage?.place(listed(trace.start), mated, [], locked);
    player.take(trace);
    tell(trace.outcome, ending(trace, mated, units, design) + friction.remark);
    if (play) player.play();
}

function choose(chosen: Pose, playing: boolean) {
    pose = chosen.map((value, k) => (free.includes(AXES[k]) ? value : 0)) as Pose;
    play = playing;
    sliders.show(pose);
    void cut();
    void follow();
}

const examine = (at: Pose, _jam?: Jam) => {
    choose(at, true);
    stage?.view.canvas.scrollIntoView({ block: "nearest" });
};

function sectionPicker(): HTMLElement {
    const picker = make("select", { id: "section", "aria-label": "section through the contacts", onchange: () => stage?.cutBy(picker.value as Section) },
        make("option", { value: "none" }, "whole"), make("option", { value: "y" }, "cut along x"), make("option", { value: "x" }, "cut along y"));
    return picker;
}

function save() {
    const link = make("a", { href: URL.createObjectURL(new Blob([json], { type: "application/json" })), download: "trace.json" });
    link.click();
    URL.revokeObjectURL(link.href);
}

function build() {
    const repaint = () => {
        slices.forEach((slice) => slice.draw());
        volume?.repaint();
        void stage?.view.draw();
    };
    const canvas = make("canvas", { tabindex: 0, class: "stage", "aria-label": "the two halves; arrows turn them, + and − zoom" });
    const section = sectionPicker();
    const halves = make("section", { class: "card", id: "halves" },
        make("div", { class: "bar-of-tools" }, make("h2", {}, "The halves"), section, friction.element,
            make("button", { type: "button", onclick: () => examine([0, 0, 0, 0, 0]) }, "mated"),
            make("button", { type: "button", onclick: save, title: "the motion as `catchment trace --json` has it" }, "save motion")),
        canvas, player.element, verdict, sliders.element);
    const set = make("section", { class: "card", id: "set" }, make("h2", {}, "Accepted set"),
        make("p", { class: "legend" }, ...["aligned", "jammed", "missed"].map((name) => make("span", {}, make("i", { style: `background:var(--${name})` }), name)),
            ...(page.window ? [make("span", {}, make("i", { class: "frame", style: "border-color:var(--window)" }), "window")] : []),
            ...(report.onaa?.bounds.length ? [make("span", {}, make("i", { class: "frame dashed", style: "border-color:var(--onaa)" }), "ONAA")] : []),
            ...(page.jams?.jams.length ? [make("span", {}, make("i", { class: "dot" }), "jam")] : [])),
        make("div", { class: "slices" }, ...slices.map((slice) => slice.element), ...(volume ? [volume.element] : [])));
    const cards = [merits(page, units), windowCard(page, units, examine), jamsCard(page, units, examine), doubts(page)].filter((card) => card !== null);
    document.body.append(
        make("header", {}, make("div", {}, make("h1", {}, design.name), make("p", {}, summary(page, units))), make("div", { class: "tools" }, ...(page.served ? [again()] : []), help(), theme(repaint))),
        make("main", {}, make("div", { class: "top" }, halves, ...(slices.length ? [set] : [])), make("div", { class: "cards" }, ...cards)),
        make("footer", {}, `catchment ${report.catchment}; works offline.`));
    keys({ player, sliders, section: section as HTMLSelectElement, mated: () => examine([0, 0, 0, 0, 0]) });
    // On paper everything is dark on white.
    const root = document.documentElement;
    let chosen = root.dataset.theme;
    window.addEventListener("beforeprint", () => {
        [chosen, root.dataset.theme] = [root.dataset.theme, "light"];
        repaint();
    });
    window.addEventListener("afterprint", () => {
        root.dataset.theme = chosen ?? "";
        repaint();
    });
    return { canvas, halves };
}

/** Resolves after the browser has painted the next frame. */
const drawn = () => new Promise<void>((done) => requestAnimationFrame(() => setTimeout(done)));

async function begin() {
    const { canvas, halves } = build();
    const chunks = Array.from({ length: page.chunks }, (_, k) => text(`outcomes-${k}`) ?? "");
    const [fixed, moving, module] = packed;
    await helper.ask("start", {
        shape: axes.map((axis) => axis.cells), chunkCells: page.chunk_cells, chunks,
        planes: page.planes.map((plane, k) => ({ cells: plane.map((axis) => axis.cells), packed: text(`plane-${k}`) ?? "" })),
        motions: fixed && moving && module ? { design: JSON.stringify(design), halves: [fixed, moving], module } : null,
    });
    const first = Promise.all(slices.map((slice) => slice.update()));
    let pictures: Promise<void>[] = [];
    if (fixed && moving) {
        stage = new Stage(canvas, painter, cor);
        const home = await helper.ask("follow", { pose, friction: friction.value });
        mated = home.trace.waypoints.at(-1)?.height_d ?? 0;
        show(home.trace, home.json);
        pictures = [stage.open([fixed, moving]).catch((error) =>
            canvas.replaceWith(make("p", { class: "hint" }, `This browser draws nothing in space (${error instanceof Error ? error.message : error}).`)))];
    } else {
        canvas.remove();
        player.element.remove();
        halves.querySelectorAll("select, button, .friction").forEach((tool) => tool.remove());
        tell("undecided", page.notes[0] ?? "This page holds no halves.");
    }
    await first;
    await drawn();
    // From here on a click is answered; pictures in space may still be on their way.
    performance.mark("answers");
    if (volume) pictures.push(volume.open().catch(() => volume.element.remove()));
    await Promise.all(pictures);
    document.documentElement.dataset.ready = "true";
}

/** For scripts that drive the page. */
Object.assign(window, { catchment: { motion: () => json, pose: () => [...pose], choose: (chosen: Pose) => choose(chosen, false) } });
begin().catch((error) => tell("undecided", `The page could not be drawn: ${error instanceof Error ? error.message : error}`));
