// Exact motions: the library's own code, compiled to WebAssembly. The module's doors are described in crates/catchment-wasm.

import type { Pose, Trace } from "./page";

interface Doors {
    memory: WebAssembly.Memory;
    input(length: number): number;
    load(design: number, fixed: number): number;
    trace(x: number, y: number, roll: number, pitch: number, yaw: number, friction: number): number;
    output(): number;
    output_length(): number;
}

export class Motions {
    private doors: Doors | null = null;

    constructor(private readonly module: WebAssembly.Module, private readonly design: string, private readonly halves: [Uint8Array, Uint8Array]) {}

    private async open(): Promise<Doors> {
        const doors = (await WebAssembly.instantiate(this.module, strangers(this.module))).exports as unknown as Doors;
        const parts = [new TextEncoder().encode(this.design), ...this.halves];
        const place = doors.input(parts.reduce((sum, part) => sum + part.length, 0)) >>> 0;
        let offset = place;
        for (const part of parts) {
            new Uint8Array(doors.memory.buffer, offset, part.length).set(part);
            offset += part.length;
        }
        if (doors.load(parts[0].length, parts[1].length) !== 0) throw new Error(outputText(doors));
        return doors;
    }

    /** The way of a pose error, as `catchment trace` has it: the JSON text. */
    async follow(pose: Pose, friction: number): Promise<string> {
        this.doors ??= await this.open();
        try {
            const status = this.doors.trace(...pose, friction);
            const text = outputText(this.doors);
            if (status !== 0) throw new Error(text);
            return text;
        } catch (error) {
            // A panic leaves the module as it was in the middle of its work.
            if (error instanceof WebAssembly.RuntimeError) {
                this.doors = null;
                throw new Error(`the motion could not be computed (${error.message})`);
            }
            throw error;
        }
    }
}

/** Functions that a dependency of the library imports from a browser (random numbers of archives). No motion calls them; a call throws an error. */
function strangers(module: WebAssembly.Module): WebAssembly.Imports {
    const imports: Record<string, Record<string, () => never>> = {};
    for (const { module: from, name } of WebAssembly.Module.imports(module))
        (imports[from] ??= {})[name] = () => {
            throw new WebAssembly.RuntimeError(`${name} is not here`);
        };
    return imports;
}

const outputText = (doors: Doors) =>
    new TextDecoder().decode(new Uint8Array(doors.memory.buffer, doors.output() >>> 0, doors.output_length()));

export const read = (text: string): Trace => JSON.parse(text);
