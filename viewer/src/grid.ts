// The outcomes over the grid: chunks unpacked when they are first looked into, cut into planes and boxes.

/** Bytes of a base64 text. */
function decoded(base64: string): Uint8Array {
    const native = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array }).fromBase64;
    if (native) return native.call(Uint8Array, base64);
    const raw = atob(base64);
    const bytes = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
    return bytes;
}

/** What deflate (zlib) packed. */
async function inflated(packed: Uint8Array): Promise<Uint8Array> {
    const stream = new Blob([packed as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Bytes as a page holds them. */
export const unpacked = (base64: string): Promise<Uint8Array> => inflated(decoded(base64));

export class Grid {
    readonly strides: number[];
    private readonly cells: number;
    private readonly chunks: (Promise<Uint8Array> | undefined)[] = [];

    /** The first axis is fastest. */
    constructor(readonly shape: number[], private readonly chunkCells: number, private readonly packed: string[]) {
        let stride = 1;
        this.strides = shape.map((length) => {
            const own = stride;
            stride *= length;
            return own;
        });
        this.cells = stride;
    }

    /** Each cell is stored as its difference (exclusive or) from the one a row before. */
    private chunk(number: number): Promise<Uint8Array> {
        return (this.chunks[number] ??= unpacked(this.packed[number]).then((cells) => {
            const row = this.shape[0] ?? 1;
            for (let k = row; k < cells.length; k++) cells[k] ^= cells[k - row];
            return cells;
        }));
    }

    /** The codes over some axes, the first of them fastest, at the cell `at` of the others. */
    async cut(axes: number[], at: number[]): Promise<Uint8Array> {
        const base = this.strides.reduce((sum, stride, k) => sum + (axes.includes(k) ? 0 : stride * at[k]), 0);
        const shape = axes.map((k) => this.shape[k]);
        const strides = axes.map((k) => this.strides[k]);
        const total = shape.reduce((a, b) => a * b, 1);
        const places = new Float64Array(total);
        const wanted = new Set<number>();
        const place = axes.map(() => 0);
        for (let k = 0; k < total; k++) {
            let index = base;
            for (let a = 0; a < place.length; a++) index += place[a] * strides[a];
            places[k] = index;
            wanted.add(Math.floor(index / this.chunkCells));
            for (let a = 0; a < place.length && ++place[a] === shape[a]; a++) place[a] = 0;
        }
        const chunks = new Map<number, Uint8Array>();
        await Promise.all([...wanted].map(async (number) => chunks.set(number, await this.chunk(number))));
        const codes = new Uint8Array(total);
        for (let k = 0; k < total; k++) {
            const number = Math.floor(places[k] / this.chunkCells);
            codes[k] = chunks.get(number)![places[k] - number * this.chunkCells];
        }
        return codes;
    }

    get size(): number {
        return this.cells;
    }
}
