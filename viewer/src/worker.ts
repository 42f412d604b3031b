// Beside the page: unpacks outcomes, cuts them, follows motions. The page stays free meanwhile.

import { Grid, decoded, inflated } from "./grid";
import type { Question, Start } from "./messages";
import { Motions, read } from "./motions";
import { border } from "./surface";

let grid: Grid;
let motions: Promise<Motions> | null = null;

async function opened({ design, halves, module }: NonNullable<Start["motions"]>): Promise<Motions> {
    const [fixed, moving, code] = await Promise.all([...halves, module].map((packed) => inflated(decoded(packed))));
    return new Motions(await WebAssembly.compile(code as BufferSource), design, [fixed, moving]);
}

async function answer(question: Question): Promise<[unknown, Transferable[]]> {
    switch (question.ask) {
        case "start": {
            const { shape, chunkCells, chunks } = question.start;
            grid = new Grid(shape, chunkCells, chunks);
            motions = question.start.motions && opened(question.start.motions);
            // Whoever asks for a motion is told.
            motions?.catch(() => {});
            return [null, []];
        }
        case "plane": {
            const codes = await grid.cut(question.axes, question.at);
            return [codes, [codes.buffer]];
        }
        case "border": {
            const codes = await grid.cut(question.axes, question.at);
            const mesh = border(codes, question.axes.map((k) => grid.shape[k]), question.code);
            return [mesh, [mesh.positions.buffer, mesh.indices.buffer]];
        }
        case "follow": {
            if (!motions) throw new Error("this page holds no halves, so that no pose can be followed");
            const json = await (await motions).follow(question.pose, question.friction);
            return [{ trace: read(json), json }, []];
        }
    }
}

self.onmessage = async ({ data: { id, question } }: MessageEvent<{ id: number; question: Question }>) => {
    try {
        const [found, moved] = await answer(question);
        self.postMessage({ id, found }, { transfer: moved });
    } catch (error) {
        self.postMessage({ id, error: error instanceof Error ? error.message : String(error) });
    }
};
