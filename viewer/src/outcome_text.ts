// How a motion ends, in words.

import type { Units } from "./format";
import { AXES, listed, type Design, type Pose, type Trace } from "./page";

export function ending({ outcome, reason: named, waypoints, end }: Trace, mated: number, units: Units, design: Design): string {
    const last = waypoints.at(-1);
    if (outcome === "aligned") return `Docks: contact leads it to the mated pose along ${units.size(last?.travelled_d ?? 0)}.`;
    if (outcome === "undecided") return "Undecided: the budget of steps ran out.";
    if (outcome === "missed") return last ? `Misses: it slides off after ${units.size(last.travelled_d)}.` : "Misses: the halves pass each other by.";
    const crossed = named === "crossed" ? " crossed (a layer has met one that is not its partner)," : named ? ` ${named},` : "";
    const contacts = last?.touches.length ?? 0;
    const where = end ? ` with ${units.pose(listed(end))}` : "";
    const above = (last?.height_d ?? mated) - mated;
    const why = end && !named ? reason(listed(end), above, units, design) : "";
    return `Jams:${crossed} at rest on ${contacts} ${contacts === 1 ? "contact" : "contacts"}${where}, ${units.height(above)}.${why && ` ${why[0].toUpperCase()}${why.slice(1)}.`}`;
}

/** Heights nearer than this, in D, are one to the library (`CONTACT_TOLERANCE`). */
const ROUNDING = 1e-4;
/** A rest higher than so many times the depth of the seat is plainly not docked. */
const PLAIN = 5;
/** Errors below this, in D or radians, are none beside a turn. */
const NONE = 5e-3;

/** Why a rest so far above the mated height does not count as docked, by the rules of the design's seat; empty if the height alone explains it. */
export function reason(pose: Pose, above: number, units: Units, { alignment }: Design): string {
    const { docked: { depth, limits }, free, symmetry } = alignment;
    if (above > PLAIN * depth) return "";
    if (above > depth) return `docked is up to ${units.size(depth)} above it ([docked] depth)`;
    if (above < -Math.max(depth, ROUNDING)) return "it lies deeper than the mated pose: another place of rest";
    const turn = (2 * Math.PI) / symmetry;
    const off = [...pose] as Pose;
    off[4] -= turn * Math.round(off[4] / turn);
    const beyond = AXES.flatMap((axis, k) => {
        const limit = free.includes(axis) ? limits[k] : null;
        return limit !== null && Math.abs(off[k]) > limit ? [`${axis} is off by more than the ${units.error(axis, limit)} that count as docked ([docked] ${axis})`] : [];
    });
    if (beyond.length) return beyond.join("; ");
    const turned = Math.abs(off[4]);
    if (turned > NONE && AXES.every((_, k) => k === 4 || Math.abs(off[k]) <= NONE)) {
        const folds = Math.round((2 * Math.PI) / turned);
        const whole = folds > 1 && folds % symmetry === 0 && Math.abs(turned - (2 * Math.PI) / folds) <= NONE;
        const counts = whole ? `; symmetry = ${folds} in [alignment] would count it` : "";
        return `it lies as deep as docked, but turned by ${units.error("yaw", turned)}, which the design does not count as mated${counts}`;
    }
    return "it lies as deep as docked, but not connected with the mated pose: another place of rest";
}
