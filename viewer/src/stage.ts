// The two halves in space: where the moving one is, what touches, and a section through the contacts.

import { Box3, Matrix4, Vector3 } from "three";
import type { Helper } from "./request";
import { colours } from "./dom";
import type { Painting } from "./messages";
import type { Pose, Touch } from "./page";
import { View3d } from "./view3d";

export type Section = "none" | "x" | "y";

export class Stage {
    readonly view: View3d;
    private readonly moving = new Matrix4();
    private touches: Touch[] = [];
    private section: Section = "none";

    constructor(canvas: HTMLCanvasElement, private readonly painter: Helper<Painting>, private readonly cor: number) {
        this.view = new View3d(canvas, new Vector3(1.5, -2.6, 1.5), (seen) => {
            const { touches, through } = this;
            const paint = colours("fixed", "fixed-cut", "fixed-edge", "moving", "moving-cut", "moving-edge", "contact");
            const section = this.section === "none" ? null : { normal: this.section === "x" ? [-1, 0, 0] : [0, 1, 0], through } as Painting["stage"][0]["section"];
            return painter.ask("stage", { seen, colours: paint, moving: this.moving.toArray(), touches, section });
        });
    }

    /** Takes the halves, packed, and brings both into the picture; done when they are drawn. */
    async open(halves: [string, string]): Promise<void> {
        const [fixed, moving] = (await this.painter.ask("halves", halves)).map(([lo, hi]) => new Box3(new Vector3(...lo), new Vector3(...hi)));
        // Room for the moving half on its way.
        const room = fixed.getSize(new Vector3()).length() / 6;
        return this.view.look(moving.applyMatrix4(this.moving).union(fixed).expandByScalar(room));
    }

    /** Puts the moving half at an error, the centre of rotation at a height; marks contacts. */
    place(pose: Pose, height: number, touches: Touch[], locked: { x: boolean; y: boolean }) {
        const [x, y, roll, pitch, yaw] = pose;
        const turn = new Matrix4().makeRotationZ(yaw).multiply(new Matrix4().makeRotationY(pitch)).multiply(new Matrix4().makeRotationX(roll));
        // The face centre from the centre of rotation, turned; an error that is locked is locked at the centre of rotation.
        const face = new Vector3(0, 0, this.cor).applyMatrix4(turn);
        this.moving.makeTranslation(locked.x ? 0 : x - face.x, locked.y ? 0 : y - face.y, height).multiply(turn).multiply(new Matrix4().makeTranslation(0, 0, this.cor));
        this.touches = touches;
        void this.view.draw();
    }

    cutBy(section: Section) {
        this.section = section;
        void this.view.draw();
    }

    /** The middle of the contacts. */
    private get through(): [number, number, number] {
        const sum = this.touches.reduce((sum, touch) => sum.add(new Vector3(...touch.point_d)), new Vector3());
        return sum.divideScalar(this.touches.length || 1).toArray();
    }
}
