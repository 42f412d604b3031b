// Numbers as people read them: the design's unit and degrees.

import { AXES, isTurn, type AxisName, type Design, type Pose } from "./page";

export class Units {
    readonly length: string;
    private readonly width: number;

    constructor(design: Design) {
        this.length = design.unit ?? "D";
        this.width = design.unit ? design.width : 1;
    }

    unit = (axis: AxisName) => (isTurn(axis) ? "°" : this.length);
    /** From D or radians. */
    shown = (axis: AxisName, value: number) => (isTurn(axis) ? (value * 180) / Math.PI : value * this.width);
    /** To D or radians. */
    meant = (axis: AxisName, shown: number) => (isTurn(axis) ? (shown * Math.PI) / 180 : shown / this.width);

    /** A length in D with its unit, to a thousandth of D. */
    length3 = (value: number) => `${plain(value * this.width, Math.max(3, 3 - Math.floor(Math.log10(this.width))))} ${this.length}`;
    /** A height in D beside that of the mated pose; what is nearer than drawings are rounded is the same. */
    height = (above: number) =>
        Math.abs(above) < SAME_HEIGHT ? "at the mated height" : `${this.length3(Math.abs(above))} ${above < 0 ? "below" : "above"} the mated height`;
    /** A length in D with its unit, to three digits. */
    size = (value: number) => `${tidy(value * this.width)} ${this.length}`;
    /** An error with its unit. */
    error = (axis: AxisName, value: number) => `${tidy(this.shown(axis, value))}${isTurn(axis) ? "°" : ` ${this.length}`}`;
    /** Errors that are not 0. */
    pose = (pose: Pose) =>
        AXES.flatMap((axis, k) => (Math.abs(pose[k]) > NOTHING ? [`${axis} ${this.error(axis, pose[k])}`] : [])).join(", ") || "no error";
}

/** Heights nearer than this, in D, are one. */
const SAME_HEIGHT = 1e-4;
/** Errors below this, in D or radians, are not worth a word. */
const NOTHING = 5e-4;

const plain = (value: number, digits: number) => Number(value.toFixed(digits)).toString();

/** Three digits, no more than needed. */
export function tidy(value: number): string {
    if (value === 0 || Math.abs(value) < 1e-6) return "0";
    const digits = Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(Math.abs(value)))));
    return Number(value.toFixed(digits)).toString().replace("-", "−");
}

export const percent = (share: number, digits = 1) => `${(100 * share).toFixed(digits)} %`;
export const grouped = (count: number) => count.toLocaleString("en").replaceAll(",", "\u202f");
