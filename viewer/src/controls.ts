// The five errors: a slider and a number each, in the design's unit and degrees.

import { make } from "./dom";
import { tidy, type Units } from "./format";
import { AXES, type Axis, type Design, type Pose } from "./page";

export class Sliders {
    readonly element: HTMLElement;
    private readonly rows: { range: HTMLInputElement; number: HTMLInputElement }[];

    constructor(private readonly units: Units, design: Design, axes: Axis[], changed: (pose: Pose) => void) {
        const { free, half_ranges } = design.alignment;
        const value = (k: number) => units.meant(AXES[k], Number(this.rows[k].range.value));
        const tell = () => changed(AXES.map((_, k) => (this.rows[k].range.disabled ? 0 : value(k))) as Pose);
        this.rows = AXES.map((axis, k) => {
            const over = axes.find((a) => a.axis === axis);
            const [lo, hi] = [over?.lo ?? -half_ranges[k], over?.hi ?? half_ranges[k]].map((end) => units.shown(axis, end));
            const locked = !free.includes(axis);
            const given = { min: lo, max: hi, value: 0, ...(locked ? { disabled: true } : {}) };
            const range: HTMLInputElement = make("input", { type: "range", step: (hi - lo) / 1000, "aria-label": `${axis} error, ${units.unit(axis)}`, id: `slider-${axis}`, ...given,
                oninput: () => { number.value = plain(Number(range.value)); tell(); } });
            const number: HTMLInputElement = make("input", { type: "number", step: "any", "aria-label": `${axis} error as a number, ${units.unit(axis)}`, id: `number-${axis}`, ...given,
                onchange: () => { range.step = "any"; range.value = number.value; tell(); } });
            return { range, number };
        });
        this.element = make("div", { class: "sliders" }, ...AXES.map((axis, k) => {
            const { range, number } = this.rows[k];
            return make("label", { class: range.disabled ? "locked" : "", title: range.disabled ? "locked by the design" : "" },
                make("span", {}, axis), range, number, make("span", {}, units.unit(axis)));
        }));
    }

    show(pose: Pose) {
        this.rows.forEach(({ range, number }, k) => {
            const value = this.units.shown(AXES[k], pose[k]);
            // What is shown is what was chosen, not the nearest step.
            range.step = "any";
            range.value = String(value);
            number.value = plain(value);
        });
    }

    focus(k: number) {
        this.rows[k]?.range.focus();
    }
}

/** The friction coefficient of the motions: that of the result, until the user enters another one. */
export class Friction {
    readonly element: HTMLElement;
    private readonly number: HTMLInputElement;

    constructor(private readonly decided: number, changed: () => void) {
        this.number = make("input", { type: "number", id: "friction", min: 0, max: 10, step: "any", value: decided, "aria-label": "coefficient of friction of the motions",
            onchange: () => {
                if (!this.number.checkValidity() || this.number.value === "") this.number.value = String(decided);
                changed();
            } });
        this.element = make("label", { class: "friction", title: "coefficient of friction of the motions that are played" }, "μ ", this.number);
    }

    get value(): number {
        return Number(this.number.value);
    }

    /** A sentence that names both coefficients if the motion has another one than the set beside it; else empty. */
    get remark(): string {
        const of = (coefficient: number) => (coefficient === 0 ? "without friction" : `with friction ${tidy(coefficient)}`);
        return this.value === this.decided ? "" : ` This motion is ${of(this.value)}, the set ${of(this.decided)}.`;
    }
}

const plain = (value: number) => tidy(value).replace("−", "-");
