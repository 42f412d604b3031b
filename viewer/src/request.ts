// Sends a request to a worker and gives its reply.

import type { Protocol } from "./messages";
import { text } from "./page";

export class Helper<P extends Protocol<P>> {
    private readonly worker: Worker;
    private readonly open = new Map<number, { done: (found: never) => void; failed: (error: Error) => void }>();
    private next = 0;

    /** `script`: the element that holds what the worker runs. */
    constructor(script: string) {
        const url = URL.createObjectURL(new Blob([text(script) ?? ""], { type: "text/javascript" }));
        this.worker = new Worker(url);
        this.worker.onmessage = ({ data: { id, found, error } }) => {
            const waiting = this.open.get(id);
            this.open.delete(id);
            if (error === undefined) waiting?.done(found as never);
            else waiting?.failed(new Error(error));
        };
    }

    ask<A extends keyof P>(ask: A, given: P[A][0], moved: Transferable[] = []): Promise<P[A][1]> {
        return new Promise((done, failed) => {
            const id = this.next++;
            this.open.set(id, { done: done as (found: never) => void, failed });
            this.worker.postMessage({ id, ask, given }, moved);
        });
    }
}

/** Runs one call at a time. Of the calls that arrive meanwhile, only the last one runs: sliders need no more. */
export function latest(run: () => Promise<void>): () => Promise<void> {
    let running: Promise<void> | null = null;
    let again = false;
    const loop = async () => {
        try {
            do {
                again = false;
                await run();
            } while (again);
        } finally {
            // At once: a request after this one begins anew.
            running = null;
        }
    };
    return () => {
        again = true;
        return (running ??= loop());
    };
}
