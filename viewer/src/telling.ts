// How a motion ends, in words.

import type { Units } from "./format";
import { listed, type Trace } from "./page";

export function ending({ outcome, reason, waypoints, end }: Trace, mated: number, units: Units): string {
    const last = waypoints.at(-1);
    if (outcome === "aligned") return `Docks: contact leads it to the mated pose along ${units.size(last?.travelled_d ?? 0)}.`;
    if (outcome === "undecided") return "Undecided: the budget of steps ran out.";
    if (outcome === "missed") return last ? `Misses: it slides off after ${units.size(last.travelled_d)}.` : "Misses: the halves pass each other by.";
    const crossed = reason === "crossed" ? " crossed (a layer has met one that is not its partner)," : reason ? ` ${reason},` : "";
    const contacts = last?.touches.length ?? 0;
    const where = end ? ` at ${units.pose(listed(end))}` : "";
    return `Jams:${crossed} at rest on ${contacts} ${contacts === 1 ? "contact" : "contacts"}${where}, ${units.size((last?.height_d ?? mated) - mated)} above the mated height.`;
}
