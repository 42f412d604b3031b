// Beside the page: unpacks outcomes, cuts them, follows motions. The page stays free meanwhile.

import { answer } from "./answering";
import { Grid, unpacked } from "./grid";
import type { Computing, Start } from "./messages";
import { Motions, read } from "./motions";
import { border } from "./border";

let grid: Grid;
let motions: Promise<Motions> | null = null;

async function opened({ design, halves, module }: NonNullable<Start["motions"]>): Promise<Motions> {
    const [fixed, moving, code] = await Promise.all([...halves, module].map(unpacked));
    return new Motions(await WebAssembly.compile(code as BufferSource), design, [fixed, moving]);
}

answer<Computing>({
    start(start) {
        grid = new Grid(start.shape, start.chunkCells, start.chunks);
        motions = start.motions && opened(start.motions);
        // Whoever asks for a motion is told.
        motions?.catch(() => {});
        return { found: null };
    },
    async plane({ axes, at }) {
        const found = await grid.cut(axes, at);
        return { found, moved: [found.buffer] };
    },
    async border({ axes, at, code }) {
        const codes = await grid.cut(axes, at);
        const found = border(codes, axes.map((k) => grid.shape[k]), code);
        return { found, moved: [found.positions.buffer, found.indices.buffer] };
    },
    async follow({ pose, friction }) {
        if (!motions) throw new Error("this page holds no halves, so that no pose can be followed");
        const json = await (await motions).follow(pose, friction);
        return { found: { trace: read(json), json } };
    },
});
