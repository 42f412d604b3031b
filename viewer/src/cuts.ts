// What a slice shows: the plane of exact motions through 0 where the result has one and the other errors are 0, else the cells of the grid that hold
// the other errors. The pictures of `run -o` show the same.

import type { Helper } from "./request";
import { tidy, type Units } from "./format";
import type { Computing } from "./messages";
import { AXES, isTurn, type Axis, type Page, type Pose } from "./page";

export interface Fixed { axis: Axis["axis"]; value: number }
export interface Cut {
    codes: Uint8Array;
    /** Across and up. */
    cells: [number, number];
    /** The other errors as they are drawn: cell centres, or 0. */
    fixed: Fixed[];
    caption: string;
}

/** The cell of an axis that holds a value; on a border the upper one: as the library has it, to the last bit. */
export const cell = ({ lo, hi, cells }: { lo: number; hi: number; cells: number }, value: number) =>
    Math.min(cells - 1, Math.max(0, Math.floor((value - lo) / ((hi - lo) / cells))));

export const center = ({ lo, hi, cells }: Axis, k: number) => lo + (k + 0.5) * ((hi - lo) / cells);

/** `yaw = 4.5°, y = 2.5 mm` */
export const values = (units: Units, fixed: Fixed[]) =>
    fixed.map(({ axis, value }) => `${axis} = ${tidy(units.shown(axis, value))}${isTurn(axis) ? "°" : ` ${units.length}`}`).join(", ");

export class Cuts {
    constructor(private readonly page: Page, private readonly units: Units, private readonly helper: Helper<Computing>) {}

    /** The cell of each axis that holds a pose. */
    at(pose: Pose): number[] {
        return this.page.report.axes.map((axis) => cell(axis, pose[AXES.indexOf(axis.axis)]));
    }

    /** The errors that are not among `chosen`, at the centres of their cells. */
    fixed(chosen: number[], at: number[]): Fixed[] {
        return this.page.report.axes.flatMap((axis, k) => (chosen.includes(k) ? [] : [{ axis: axis.axis, value: center(axis, at[k]) }]));
    }

    async cut(chosen: [number, number], pose: Pose): Promise<Cut> {
        const { axes } = this.page.report;
        const names = chosen.map((k) => axes[k].axis);
        const others = axes.filter((axis) => !names.includes(axis.axis));
        const zero = others.every(({ axis }) => pose[AXES.indexOf(axis)] === 0);
        const exact = zero ? this.page.planes.findIndex((plane) => plane.every(({ axis }) => names.includes(axis))) : -1;
        const at = this.at(pose);
        const codes = await this.helper.ask("plane", { axes: chosen, at, exact: exact < 0 ? null : exact });
        if (exact >= 0) {
            const cells = names.map((name) => this.page.planes[exact].find(({ axis }) => axis === name)!.cells) as [number, number];
            const rest = others.length > 1 ? "other errors 0" : `${others[0].axis} = 0`;
            return { codes, cells, fixed: others.map(({ axis }) => ({ axis, value: 0 })), caption: `${rest}: exact motions, ${cells.join(" × ")}` };
        }
        const cells = chosen.map((k) => axes[k].cells) as [number, number];
        const fixed = this.fixed(chosen, at);
        return { codes, cells, fixed, caption: fixed.length ? `cells of the grid at ${values(this.units, fixed)}` : "" };
    }
}
