// Messages between the page and its two workers: the name of each request, its data and its reply.

import type { Point, Pose, Touch, Trace } from "./page";
import type { Mesh } from "./border";

/** For every question what is given and what is found. */
export type Protocol<P> = { [A in keyof P]: [unknown, unknown] };

export interface Start {
    shape: number[];
    chunkCells: number;
    chunks: string[];
    /** Planes through 0 by exact motions: cells along both axes, codes packed as a chunk. */
    planes: { cells: number[]; packed: string }[];
    /** JSON of the design, the halves and the module, packed; null where no motion can be followed. */
    motions: { design: string; halves: [string, string]; module: string } | null;
}
/** Outcomes and motions. */
export interface Computing {
    start: [Start, null];
    /** The grid at the cells `at` of the other axes, or the plane of that number; the first of `axes` fastest. */
    plane: [{ axes: number[]; at: number[]; exact: number | null }, Uint8Array];
    /** The border of the cells with a code, and how many cells have each code. */
    border: [{ axes: number[]; at: number[]; code: number }, { mesh: Mesh; counts: number[] }];
    follow: [{ pose: Pose; friction: number }, { trace: Trace; json: string }];
}

/** From where a picture is seen, and its size in pixels. */
export interface View { width: number; height: number; position: number[]; quaternion: number[]; fov: number; near: number; far: number }
/** Colours of the style by name. */
export type Colours = Record<string, string>;
export type Corners = [Point, Point];
export interface Label { text: string; colour: string; height: number; at: Point }
/** Pictures in space. */
export interface Painting {
    /** Takes the halves, packed; their lowest and highest corners. */
    halves: [[string, string], [Corners, Corners]];
    /** The moving half by a matrix; a section through a point, along x or y. */
    stage: [{ seen: View; colours: Colours; moving: number[]; touches: Touch[]; section: { normal: Point; through: Point } | null }, ImageBitmap];
    /** Takes the surface of a set. */
    surface: [Mesh, null];
    volume: [{ seen: View; colours: Colours; surface: string; point: Point; labels: Label[] }, ImageBitmap];
    /** Where on the surface a look from −1 to 1 across and up ends. */
    hit: [{ seen: View; at: [number, number] }, Point | null];
}
