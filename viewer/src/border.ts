// The border of a set of cells as a mesh: surface nets (Gibson 1998). A vertex per group of eight cells that are not all alike, at the mean of
// where the edges between unlike ones are cut, in halves; a square per pair of unlike neighbours. Nothing is smoothed.

export interface Mesh { positions: Float32Array; indices: Uint32Array }

/** The border of the cells with `code`, the first axis fastest; in cells, the centre of the first one at 0. What lies outside is not in the set. */
export function border(codes: Uint8Array, shape: number[], code: number): Mesh {
    const [nx, ny, nz] = shape;
    const inside = (x: number, y: number, z: number) =>
        x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz && codes[x + nx * (y + ny * z)] === code;
    const positions: number[] = [];
    const indices: number[] = [];
    // The vertex of the group whose lowest cell is (x, y, z), from −1 on.
    const wide = nx + 1, deep = ny + 1;
    const vertex = new Int32Array(wide * deep * (nz + 1)).fill(-1);
    const group = (x: number, y: number, z: number) => x + 1 + wide * (y + 1 + deep * (z + 1));
    for (let z = -1; z < nz; z++)
        for (let y = -1; y < ny; y++)
            for (let x = -1; x < nx; x++) {
                let mask = 0;
                for (let k = 0; k < 8; k++) if (inside(x + (k & 1), y + ((k >> 1) & 1), z + (k >> 2))) mask |= 1 << k;
                if (mask === 0 || mask === 255) continue;
                let [sx, sy, sz, count] = [0, 0, 0, 0];
                for (let a = 0; a < 8; a++)
                    for (const bit of [1, 2, 4]) {
                        const b = a | bit;
                        if (b === a || ((mask >> a) & 1) === ((mask >> b) & 1)) continue;
                        sx += ((a & 1) + (b & 1)) / 2;
                        sy += (((a >> 1) & 1) + ((b >> 1) & 1)) / 2;
                        sz += ((a >> 2) + (b >> 2)) / 2;
                        count++;
                    }
                vertex[group(x, y, z)] = positions.length / 3;
                positions.push(x + sx / count, y + sy / count, z + sz / count);
            }
    const square = (a: number, b: number, c: number, d: number, outward: boolean) =>
        outward ? indices.push(a, b, c, a, c, d) : indices.push(a, c, b, a, d, c);
    for (let z = -1; z < nz; z++)
        for (let y = -1; y < ny; y++)
            for (let x = -1; x < nx; x++) {
                const here = inside(x, y, z);
                const at = (dx: number, dy: number, dz: number) => vertex[group(x - dx, y - dy, z - dz)];
                if (y >= 0 && z >= 0 && here !== inside(x + 1, y, z)) square(at(0, 1, 1), at(0, 0, 1), at(0, 0, 0), at(0, 1, 0), here);
                if (x >= 0 && z >= 0 && here !== inside(x, y + 1, z)) square(at(1, 0, 1), at(1, 0, 0), at(0, 0, 0), at(0, 0, 1), here);
                if (x >= 0 && y >= 0 && here !== inside(x, y, z + 1)) square(at(1, 1, 0), at(0, 1, 0), at(0, 0, 0), at(1, 0, 0), here);
            }
    return { positions: new Float32Array(positions), indices: new Uint32Array(indices) };
}
