// A motion, played: from first contact to where it ends.

import { make } from "./dom";
import { AXES, listed, type Pose, type Touch, type Trace } from "./page";

/** How long a motion takes to watch, in ms. */
const LONG = 1800;

export class Player {
    readonly element: HTMLElement;
    private readonly time = make("input", { type: "range", min: 0, max: 1000, value: 0, "aria-label": "along the motion", class: "time", oninput: () => { this.stop(); this.show(Number(this.time.value) / 1000); } });
    private readonly button = make("button", { type: "button", class: "play", "aria-label": "play the motion", onclick: () => this.toggle() }, "▶");
    private trace: Trace | null = null;
    private running = 0;

    constructor(private readonly place: (pose: Pose, height: number, touches: Touch[]) => void) {
        this.element = make("div", { class: "player" }, this.button, this.time);
    }

    /** Takes a motion, at its start. */
    take(trace: Trace) {
        this.stop();
        this.trace = trace;
        this.button.disabled = this.time.disabled = trace.waypoints.length < 2;
        this.time.value = "0";
        this.show(0);
    }

    toggle() {
        if (this.running) this.stop();
        else this.play();
    }

    play() {
        if (!this.trace || this.trace.waypoints.length < 2) return;
        this.stop();
        const from = Number(this.time.value) >= 999 ? 0 : Number(this.time.value) / 1000;
        // Whoever wants no movement sees its end.
        if (matchMedia("(prefers-reduced-motion: reduce)").matches) return this.end();
        const started = performance.now() - from * LONG;
        const step = (now: number) => {
            const share = Math.min(1, (now - started) / LONG);
            this.time.value = String(1000 * share);
            this.show(share);
            if (share < 1) this.running = requestAnimationFrame(step);
            else this.stop();
        };
        this.running = requestAnimationFrame(step);
        this.button.textContent = "❚❚";
        this.button.setAttribute("aria-label", "pause");
    }

    /** At the end of the motion. */
    end() {
        this.stop();
        this.time.value = "1000";
        this.show(1);
    }

    stop() {
        cancelAnimationFrame(this.running);
        this.running = 0;
        this.button.textContent = "▶";
        this.button.setAttribute("aria-label", "play the motion");
    }

    /** At a share of the length of the path. */
    private show(share: number) {
        const way = this.trace?.waypoints;
        if (!way?.length) return;
        const travelled = share * way[way.length - 1].travelled_d;
        let next = way.findIndex((waypoint) => waypoint.travelled_d >= travelled);
        if (next < 0) next = way.length - 1;
        const [a, b] = [way[Math.max(0, next - 1)], way[next]];
        const length = b.travelled_d - a.travelled_d;
        const part = length > 0 ? (travelled - a.travelled_d) / length : 1;
        const [from, to] = [listed(a.error), listed(b.error)];
        const between = AXES.map((_, k) => from[k] + (near(to[k], from[k]) - from[k]) * part) as Pose;
        this.place(between, a.height_d + (b.height_d - a.height_d) * part, part < 0.5 ? a.touches : b.touches);
    }
}

/** The same angle within half a turn; offsets are never that far apart. */
const near = (angle: number, other: number) => angle - 2 * Math.PI * Math.round((angle - other) / (2 * Math.PI));
