// Beside the page: unpacks outcomes, cuts them, follows motions. The page stays free meanwhile.

import { answer } from "./response";
import { Grid, unpacked } from "./grid";
import type { Computing, Start } from "./messages";
import { Motions, read } from "./motions";
import { border } from "./border";

let grid: Grid;
let planes: Grid[] = [];
let motions: Promise<Motions> | null = null;

async function opened({ design, halves, module }: NonNullable<Start["motions"]>): Promise<Motions> {
    const [fixed, moving, code] = await Promise.all([...halves, module].map(unpacked));
    return new Motions(await WebAssembly.compile(code as BufferSource), design, [fixed, moving]);
}

answer<Computing>({
    start(start) {
        grid = new Grid(start.shape, start.chunkCells, start.chunks);
        planes = start.planes.map(({ cells, packed }) => new Grid(cells, cells[0] * cells[1], [packed]));
        motions = start.motions && opened(start.motions);
        // Each `follow` awaits this promise and reports its error.
        motions?.catch(() => {});
        return { found: null };
    },
    async plane({ axes, at, exact }) {
        const found = await (exact === null ? grid.cut(axes, at) : planes[exact].cut(axes[0] < axes[1] ? [0, 1] : [1, 0], [0, 0]));
        return { found, moved: [found.buffer] };
    },
    async border({ axes, at, code }) {
        const codes = await grid.cut(axes, at);
        const mesh = border(codes, axes.map((k) => grid.shape[k]), code);
        const counts = [0, 0, 0, 0, 0];
        for (const code of codes) counts[code]++;
        return { found: { mesh, counts }, moved: [mesh.positions.buffer, mesh.indices.buffer] };
    },
    async follow({ pose, friction }) {
        if (!motions) throw new Error("this page holds no halves, so that no pose can be followed");
        const json = await (await motions).follow(pose, friction);
        return { found: { trace: read(json), json } };
    },
});
