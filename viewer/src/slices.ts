// Planes through the accepted set at the pose that is looked at: two errors vary, the others stay where the sliders are. The caption of each names what it draws.

import { cell, type Cut } from "./cuts";
import { colour, make } from "./dom";
import type { Units } from "./format";
import { tidy } from "./format";
import { AXES, OUTCOMES, type Axis, type AxisName, type Interval, type Pose } from "./page";

export interface Marks {
    /** Boxes to draw, each with the variable of its colour. */
    boxes: { bounds: Interval[]; colour: string; dashed: boolean }[];
    /** Places of rest that do not dock. */
    jams: Pose[];
}
export interface Host {
    axes: Axis[];
    units: Units;
    pose(): Pose;
    marks(): Marks;
    cut(chosen: [number, number]): Promise<Cut>;
    choose(pose: Pose): void;
}

const MARGIN = { left: 46, right: 10, top: 8, bottom: 34 };
const codeColours = ["--none", ...OUTCOMES.map((outcome) => `--${outcome}`)];

const rgb = (hex: string) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));

export class Slice {
    readonly element: HTMLElement;
    private readonly canvas = make("canvas", { tabindex: 0, class: "slice" });
    private readonly note = make("output", { class: "hover" });
    private pickers: HTMLSelectElement[];
    private readonly drawn = make("output", { class: "drawn" });
    private shown: Cut | null = null;

    constructor(private readonly host: Host, private chosen: [number, number], number: number) {
        this.pickers = [0, 1].map((side) => {
            const options = host.axes.map((axis, k) => make("option", { value: k, ...(k === chosen[side] ? { selected: true } : {}) }, axis.axis));
            const label = `slice ${number}, ${side === 0 ? "across" : "up"}`;
            const picker = make("select", { "aria-label": label, "data-slice": number, onchange: () => this.pick(side, Number(picker.value)) }, ...options);
            return picker;
        });
        this.element = make("figure", { class: "slice" },
            make("figcaption", {}, this.pickers[0], make("span", {}, "across, "), this.pickers[1], make("span", {}, "up"), this.note, this.drawn), this.canvas);
        this.canvas.addEventListener("click", (event) => this.at(event, (pose) => host.choose(pose)));
        this.canvas.addEventListener("pointermove", (event) => this.at(event, (pose) => this.tell(pose)));
        this.canvas.addEventListener("pointerleave", () => (this.note.textContent = ""));
        this.canvas.addEventListener("keydown", (event) => this.key(event));
        new ResizeObserver(() => this.draw()).observe(this.canvas);
    }

    private pick(side: number, axis: number) {
        // Both the same: they change places.
        if (this.chosen[1 - side] === axis) this.chosen[1 - side] = this.chosen[side];
        this.chosen[side] = axis;
        this.pickers.forEach((picker, k) => (picker.value = String(this.chosen[k])));
        void this.update();
    }

    /** Cuts and draws anew. */
    async update() {
        const requested: [number, number] = [...this.chosen];
        const cut = await this.host.cut(requested);
        // The pickers may have moved on meanwhile.
        if (requested[0] === this.chosen[0] && requested[1] === this.chosen[1]) {
            this.shown = cut;
            this.drawn.textContent = cut.caption;
        }
        this.draw();
    }

    private get pair(): [Axis, Axis] {
        return [this.host.axes[this.chosen[0]], this.host.axes[this.chosen[1]]];
    }

    draw() {
        const { clientWidth: width, clientHeight: height } = this.canvas;
        if (width < 80 || height < 80) return;
        const ratio = Math.min(devicePixelRatio, 2);
        this.canvas.width = Math.round(width * ratio);
        this.canvas.height = Math.round(height * ratio);
        const pen = this.canvas.getContext("2d")!;
        pen.scale(ratio, ratio);
        const [across, up] = this.pair;
        const field = { x: MARGIN.left, y: MARGIN.top, w: width - MARGIN.left - MARGIN.right, h: height - MARGIN.top - MARGIN.bottom };
        if (this.shown) {
            const { codes, cells: [columns, rows] } = this.shown;
            const picture = new ImageData(columns, rows);
            const paint = codeColours.map((name) => rgb(colour(name)));
            for (let k = 0; k < codes.length; k++) {
                const row = rows - 1 - Math.floor(k / columns);
                picture.data.set([...paint[codes[k]], 255], 4 * (row * columns + (k % columns)));
            }
            const small = new OffscreenCanvas(columns, rows);
            small.getContext("2d")!.putImageData(picture, 0, 0);
            pen.imageSmoothingEnabled = false;
            pen.drawImage(small, field.x, field.y, field.w, field.h);
        }
        const px = (value: number) => field.x + ((value - across.lo) / (across.hi - across.lo)) * field.w;
        const py = (value: number) => field.y + field.h - ((value - up.lo) / (up.hi - up.lo)) * field.h;
        this.frame(pen, field, px, py);
        pen.save();
        pen.beginPath();
        pen.rect(field.x, field.y, field.w, field.h);
        pen.clip();
        const { boxes, jams } = this.host.marks();
        for (const { bounds, colour: name, dashed } of boxes) {
            const [a, b] = [across, up].map((axis) => bounds.find((bound) => bound.axis === axis.axis));
            if (!a || !b) continue;
            pen.strokeStyle = colour(name);
            pen.lineWidth = 1.8;
            // A box that the other errors have left is where it would be.
            const other = (axis: AxisName) => bounds.find((bound) => bound.axis === axis);
            const inside = this.shown?.fixed.every(({ axis, value }) => (other(axis)?.lo ?? value) <= value && value <= (other(axis)?.hi ?? value));
            pen.globalAlpha = inside ? 1 : 0.3;
            pen.setLineDash(dashed ? [5, 4] : []);
            pen.strokeRect(px(a.lo), py(b.hi), px(a.hi) - px(a.lo), py(b.lo) - py(b.hi));
        }
        pen.globalAlpha = 1;
        pen.setLineDash([]);
        jams.forEach((jam, k) => {
            const [x, y] = [px(jam[AXES.indexOf(across.axis)]), py(jam[AXES.indexOf(up.axis)])];
            pen.beginPath();
            pen.arc(x, y, 7, 0, 2 * Math.PI);
            pen.fillStyle = colour("--card");
            pen.strokeStyle = colour("--ink");
            pen.lineWidth = 1;
            pen.fill();
            pen.stroke();
            pen.fillStyle = colour("--ink");
            pen.font = "10px system-ui, sans-serif";
            pen.textAlign = "center";
            pen.textBaseline = "middle";
            pen.fillText(String(k + 1), x, y + 0.5);
        });
        const pose = this.host.pose();
        const [x, y] = [px(pose[AXES.indexOf(across.axis)]), py(pose[AXES.indexOf(up.axis)])];
        pen.lineWidth = 1;
        pen.strokeStyle = colour("--ink");
        pen.beginPath();
        pen.moveTo(x, field.y);
        pen.lineTo(x, field.y + field.h);
        pen.moveTo(field.x, y);
        pen.lineTo(field.x + field.w, y);
        pen.globalAlpha = 0.45;
        pen.stroke();
        pen.globalAlpha = 1;
        pen.beginPath();
        pen.arc(x, y, 4.5, 0, 2 * Math.PI);
        pen.fillStyle = colour("--contact");
        pen.fill();
        pen.stroke();
        pen.restore();
        this.canvas.setAttribute("aria-label",
            `outcomes over ${across.axis} across and ${up.axis} up; arrows move the pose by a cell, Enter plays its motion`);
    }

    private frame(pen: CanvasRenderingContext2D, field: { x: number; y: number; w: number; h: number }, px: (v: number) => number, py: (v: number) => number) {
        const { units } = this.host;
        const [across, up] = this.pair;
        pen.strokeStyle = colour("--line");
        pen.strokeRect(field.x + 0.5, field.y + 0.5, field.w - 1, field.h - 1);
        pen.fillStyle = colour("--soft");
        pen.font = "11px system-ui, sans-serif";
        pen.textAlign = "center";
        pen.textBaseline = "top";
        for (const value of ticks(units, across, Math.max(2, Math.floor(field.w / 60)))) {
            const x = px(value);
            const label = tidy(units.shown(across.axis, value));
            // The last one stays inside of the picture.
            pen.fillText(label, Math.min(x, pen.canvas.clientWidth - pen.measureText(label).width / 2 - 1), field.y + field.h + 5);
            pen.fillRect(x - 0.5, field.y + field.h, 1, 4);
        }
        pen.fillText(`${across.axis} [${units.unit(across.axis)}]`, field.x + field.w / 2, field.y + field.h + 19);
        pen.textAlign = "right";
        pen.textBaseline = "middle";
        for (const value of ticks(units, up, Math.max(2, Math.floor(field.h / 40)))) {
            const y = py(value);
            pen.fillText(tidy(units.shown(up.axis, value)), field.x - 6, y);
            pen.fillRect(field.x - 4, y - 0.5, 4, 1);
        }
        pen.save();
        pen.translate(9, field.y + field.h / 2);
        pen.rotate(-Math.PI / 2);
        pen.textAlign = "center";
        pen.fillText(`${up.axis} [${units.unit(up.axis)}]`, 0, 0);
        pen.restore();
    }

    private at(event: PointerEvent | MouseEvent, use: (pose: Pose) => void) {
        const box = this.canvas.getBoundingClientRect();
        const [across, up] = this.pair;
        const share = (event.clientX - box.left - MARGIN.left) / (box.width - MARGIN.left - MARGIN.right);
        const rise = 1 - (event.clientY - box.top - MARGIN.top) / (box.height - MARGIN.top - MARGIN.bottom);
        if (share < 0 || share > 1 || rise < 0 || rise > 1) return void (this.note.textContent = "");
        const pose = [...this.host.pose()] as Pose;
        pose[AXES.indexOf(across.axis)] = across.lo + share * (across.hi - across.lo);
        pose[AXES.indexOf(up.axis)] = up.lo + rise * (up.hi - up.lo);
        use(pose);
    }

    private tell(pose: Pose) {
        const [across, up] = this.pair;
        const value = (axis: Axis) => pose[AXES.indexOf(axis.axis)];
        const place = ([columns, rows]: [number, number]) =>
            cell({ ...across, cells: columns }, value(across)) + columns * cell({ ...up, cells: rows }, value(up));
        const code = this.shown?.codes[place(this.shown.cells)];
        const label = [across, up].map((axis) => `${axis.axis} ${this.host.units.error(axis.axis, value(axis))}`).join(", ");
        this.note.textContent = code ? `${label}: ${OUTCOMES[code - 1]}` : label;
    }

    private key(event: KeyboardEvent) {
        const moves: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
        const move = moves[event.key];
        if (!move) return;
        event.preventDefault();
        const pose = [...this.host.pose()] as Pose;
        this.pair.forEach((axis, k) => {
            const index = AXES.indexOf(axis.axis);
            const moved = pose[index] + (move[k] * (axis.hi - axis.lo)) / axis.cells;
            pose[index] = Math.min(axis.hi, Math.max(axis.lo, moved));
        });
        this.host.choose(pose);
    }
}

/** Round values along an axis, about `most` of them. */
export function ticks(units: Units, { axis, lo, hi }: { axis: AxisName; lo: number; hi: number }, most: number): number[] {
    const [from, to] = [units.shown(axis, lo), units.shown(axis, hi)];
    const raw = (to - from) / most;
    const power = 10 ** Math.floor(Math.log10(raw));
    const turns = units.unit(axis) === "°" ? [5, 10, 15, 30, 45, 90].find((step) => step >= raw) : undefined;
    const step = turns ?? [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw * 0.999)!;
    const values: number[] = [];
    for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; k++) values.push(units.meant(axis, k * step));
    return values;
}
