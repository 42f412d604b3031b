// A half from its bytes (Half::to_bytes of the library): triangles to draw, and the lines where its surface bends.

import { BufferAttribute, BufferGeometry } from "three";

export interface Drawn { faces: BufferGeometry; lines: BufferGeometry }

/** Facets whose normals differ by less are one face to the eye. */
const FLAT = Math.cos((12 * Math.PI) / 180);

export function solid(bytes: Uint8Array): Drawn {
    const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    let at = 0;
    const count = () => ((at += 4), data.getUint32(at - 4, true));
    const point = () => ((at += 24), [0, 8, 16].map((k) => data.getFloat64(at - 24 + k, true)));
    const positions: number[] = [], normals: number[] = [], lines: number[] = [];
    for (let surfaces = count(); surfaces > 0; surfaces--) {
        const [vertexCount, facetCount, , edgeCount] = [count(), count(), count(), count(), count()];
        const vertices = Array.from({ length: vertexCount }, point);
        const facing = Array.from({ length: facetCount }, point);
        const counts = Array.from({ length: facetCount }, count);
        const sides = new Map<string, number>();
        counts.forEach((corners, facet) => {
            const ring = Array.from({ length: corners }, count);
            ring.forEach((a, k) => {
                const b = ring[(k + 1) % corners];
                const key = a < b ? `${a} ${b}` : `${b} ${a}`;
                const other = sides.get(key);
                if (other === undefined) sides.set(key, facet);
                else if (facing[facet][0] * facing[other][0] + facing[facet][1] * facing[other][1] + facing[facet][2] * facing[other][2] < FLAT)
                    lines.push(...vertices[a], ...vertices[b]);
            });
            for (let k = 1; k + 1 < corners; k++)
                for (const corner of [ring[0], ring[k], ring[k + 1]]) {
                    positions.push(...vertices[corner]);
                    normals.push(...facing[facet]);
                }
        });
        at += 16 * edgeCount;
    }
    const faces = new BufferGeometry();
    faces.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
    faces.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
    const edges = new BufferGeometry();
    edges.setAttribute("position", new BufferAttribute(new Float32Array(lines), 3));
    return { faces, lines: edges };
}
