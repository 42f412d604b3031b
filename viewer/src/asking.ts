// Asks the worker, and gives what it found.

import type { Answers, Ask, Question } from "./messages";
import { text } from "./page";

export class Helper {
    private readonly worker: Worker;
    private readonly open = new Map<number, { done: (found: never) => void; failed: (error: Error) => void }>();
    private next = 0;

    constructor() {
        const url = URL.createObjectURL(new Blob([text("worker") ?? ""], { type: "text/javascript" }));
        this.worker = new Worker(url);
        this.worker.onmessage = ({ data: { id, found, error } }) => {
            const waiting = this.open.get(id);
            this.open.delete(id);
            if (error === undefined) waiting?.done(found as never);
            else waiting?.failed(new Error(error));
        };
    }

    ask<A extends Ask>(question: Extract<Question, { ask: A }>): Promise<Answers[A]> {
        return new Promise((done, failed) => {
            const id = this.next++;
            this.open.set(id, { done: done as (found: never) => void, failed });
            this.worker.postMessage({ id, question });
        });
    }
}

/** Runs one at a time, and of those asked meanwhile the last alone: what sliders want. */
export function latest(run: () => Promise<void>): () => Promise<void> {
    let running: Promise<void> | null = null;
    let again = false;
    const loop = async () => {
        do {
            again = false;
            await run();
        } while (again);
    };
    return () => {
        again = true;
        return (running ??= loop().finally(() => (running = null)));
    };
}
