// The set over any three errors as a surface in a box; the others stay where the sliders are.

import { Box3, Vector3 } from "three";
import type { Helper } from "./request";
import { values, type Fixed } from "./cuts";
import { colour, colours, make } from "./dom";
import { grouped, tidy } from "./format";
import type { Computing, Label, Painting } from "./messages";
import { AXES, OUTCOMES, type Axis, type Outcome, type Point, type Pose } from "./page";
import { ticks, type Host } from "./slices";
import { View3d } from "./view3d";

export interface VolumeHost extends Host {
    /** The border of an outcome over three axes, the cells of each outcome there, and the other errors as they are drawn. */
    border(chosen: number[], code: number): Promise<Computing["border"][1] & { fixed: Fixed[] }>;
    /** Whether some cell of the whole result has an outcome. */
    has(outcome: Outcome): boolean;
}

export class Volume {
    readonly element: HTMLElement;
    private view: View3d | null = null;
    private readonly canvas = make("canvas", { tabindex: 0, class: "volume", "aria-label": "the set over three errors; arrows turn it, a click chooses a pose" });
    private readonly drawn = make("output", { class: "drawn" });
    private readonly pickers: HTMLSelectElement[];
    private readonly of: HTMLSelectElement;

    constructor(private readonly host: VolumeHost, private readonly painter: Helper<Painting>, private chosen: [number, number, number]) {
        this.pickers = chosen.map((axis, side) => {
            const options = host.axes.map((a, k) => make("option", { value: k, ...(k === axis ? { selected: true } : {}) }, a.axis));
            const picker = make("select", { "aria-label": `surface, axis ${side + 1}`, onchange: () => this.pick(side, Number(picker.value)) }, ...options);
            return picker;
        });
        this.of = make("select", { "aria-label": "which poses the surface holds", onchange: () => void this.update() },
            make("option", { value: 1 }, "aligned"), make("option", { value: 2 }, "jammed"));
        this.element = make("figure", { class: "volume" }, make("figcaption", {}, this.of, make("span", {}, "over"), ...this.pickers, this.drawn), this.canvas);
        let down = [0, 0];
        this.canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
        this.canvas.addEventListener("click", (event) => {
            // Turning the picture is no choice.
            if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) void this.choose(event);
        });
    }

    /** Starts drawing, the element being in the page; done when it is drawn. */
    async open(): Promise<void> {
        this.view = new View3d(this.canvas, new Vector3(1.7, -2.3, 1.4), (seen) => {
            const paint = colours("aligned", "jammed", "contact", "line");
            const surface = this.of.value === "1" ? "aligned" : "jammed";
            return this.painter.ask("volume", { seen, colours: paint, surface, point: this.point, labels: this.labels });
        });
        await this.update();
        await this.view.look(new Box3(new Vector3(-0.62, -0.62, -0.62), new Vector3(0.62, 0.62, 0.62)));
    }

    private pick(side: number, axis: number) {
        const other = this.chosen.indexOf(axis);
        if (other >= 0) this.chosen[other] = this.chosen[side];
        this.chosen[side] = axis;
        this.pickers.forEach((picker, k) => (picker.value = String(this.chosen[k])));
        void this.update();
    }

    private get triple(): Axis[] {
        return this.chosen.map((k) => this.host.axes[k]);
    }

    /** The chosen pose in the box. */
    private get point(): Point {
        const pose = this.host.pose();
        return this.triple.map(({ axis, lo, hi }) => (pose[AXES.indexOf(axis)] - lo) / (hi - lo) - 0.5) as Point;
    }

    async update() {
        if (!this.view) return;
        const requested = String(this.chosen);
        const code = Number(this.of.value);
        const { mesh: { positions, indices }, counts, fixed } = await this.host.border([...this.chosen], code);
        if (requested !== String(this.chosen) || code !== Number(this.of.value)) return;
        this.drawn.textContent = this.caption(OUTCOMES[code - 1], counts, fixed);
        const shape = this.triple.map((axis) => axis.cells);
        for (let k = 0; k < positions.length; k++) positions[k] = (positions[k] + 0.5) / shape[k % 3] - 0.5;
        await this.painter.ask("surface", { positions, indices }, [positions.buffer, indices.buffer]);
        void this.view.draw();
    }

    /** What is drawn, and why where that is nothing. */
    private caption(outcome: Outcome, counts: number[], fixed: Fixed[]): string {
        const at = values(this.host.units, fixed);
        if (counts[OUTCOMES.indexOf(outcome) + 1] > 0) return at && `cells of the grid at ${at}`;
        if (!this.host.has(outcome)) return `empty: no cell of the result is ${outcome}`;
        const others = OUTCOMES.flatMap((name, k) => (counts[k + 1] > 0 ? [`${grouped(counts[k + 1])} ${name}`] : []));
        return `empty: at ${at} no cell is ${outcome} (${others.join(", ")}); move ${fixed.map(({ axis }) => axis).join(" or ")}`;
    }

    /** Draws anew where colours changed. */
    repaint() {
        void this.view?.draw();
    }

    /** Names and ends of the axes, along three edges of the box. */
    private get labels(): Label[] {
        const { units } = this.host;
        return this.triple.flatMap((axis, k) => {
            const along = (share: number, out: number) => {
                const place: Point = [-0.5, -0.5, -0.5];
                if (k === 2) place[0] = -0.5 - out * 0.7, place[1] = -0.5 - out * 0.7;
                else place[1 - k] = -0.5 - out;
                place[k] = share - 0.5;
                return place;
            };
            const [first, last] = [ticks(units, axis, 4)[0], ticks(units, axis, 4).at(-1)!];
            const end = (value: number): Label =>
                ({ text: tidy(units.shown(axis.axis, value)), colour: colour("--soft"), height: 0.072, at: along((value - axis.lo) / (axis.hi - axis.lo), 0.09) });
            return [end(first), end(last), { text: `${axis.axis} [${units.unit(axis.axis)}]`, colour: colour("--ink"), height: 0.085, at: along(0.5, 0.16) }];
        });
    }

    private async choose(event: MouseEvent) {
        const seen = this.view?.seen();
        if (!seen) return;
        const box = this.canvas.getBoundingClientRect();
        const at: [number, number] = [((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2];
        const triple = this.triple;
        const hit = await this.painter.ask("hit", { seen, at });
        if (!hit) return;
        const pose = [...this.host.pose()] as Pose;
        triple.forEach(({ axis, lo, hi }, k) => (pose[AXES.indexOf(axis)] = lo + (hit[k] + 0.5) * (hi - lo)));
        this.host.choose(pose);
    }
}
