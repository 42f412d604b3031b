// In a worker: replies to the requests of the page.

import type { Protocol } from "./messages";

/** What was computed, and what of it goes over to the page without a copy. */
export type Reply<T> = { found: T; moved?: Transferable[] };
export type Answers<P extends Protocol<P>> = { [A in keyof P]: (given: P[A][0]) => Reply<P[A][1]> | Promise<Reply<P[A][1]>> };

export function answer<P extends Protocol<P>>(answers: Answers<P>) {
    self.onmessage = async <A extends keyof P>({ data: { id, ask, given } }: MessageEvent<{ id: number; ask: A; given: P[A][0] }>) => {
        try {
            const { found, moved } = await answers[ask](given);
            self.postMessage({ id, found }, { transfer: moved ?? [] });
        } catch (error) {
            self.postMessage({ id, error: error instanceof Error ? error.message : String(error) });
        }
    };
}
