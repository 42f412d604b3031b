// What the page and its worker say to each other.

import type { Pose, Trace } from "./page";
import type { Mesh } from "./surface";

export interface Start {
    shape: number[];
    chunkCells: number;
    chunks: string[];
    /** JSON of the design, the halves and the module, packed; null where no motion can be followed. */
    motions: { design: string; halves: [string, string]; module: string } | null;
}
export type Question =
    | { ask: "start"; start: Start }
    | { ask: "plane"; axes: number[]; at: number[] }
    | { ask: "border"; axes: number[]; at: number[]; code: number }
    | { ask: "follow"; pose: Pose; friction: number };
export interface Answers {
    start: null;
    plane: Uint8Array;
    border: Mesh;
    follow: { trace: Trace; json: string };
}
export type Ask = Question["ask"];
