// The two halves in space, their contacts, and a section through them.

import {
    ArrowHelper, BackSide, Box3, Color, FrontSide, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Plane,
    SphereGeometry, Vector3,
} from "three";
import { colour } from "./dom";
import type { Pose, Touch } from "./page";
import { solid } from "./solid";
import { View3d } from "./view3d";

export type Section = "none" | "x" | "y";

/** A half: faces, the inside of what is cut, lines. */
class Body {
    readonly group = new Group();
    private readonly outside = new MeshLambertMaterial({ side: FrontSide });
    private readonly inside = new MeshBasicMaterial({ side: BackSide });
    private readonly line = new LineBasicMaterial();

    constructor(bytes: Uint8Array, private readonly name: "fixed" | "moving") {
        const { faces, lines } = solid(bytes);
        this.outside.polygonOffset = true;
        this.outside.polygonOffsetFactor = 1;
        this.outside.polygonOffsetUnits = 1;
        this.group.add(new Mesh(faces, this.outside), new Mesh(faces, this.inside), new LineSegments(lines, this.line));
        this.group.matrixAutoUpdate = false;
    }

    paint(planes: Plane[]) {
        this.outside.color = new Color(colour(`--${this.name}`));
        this.inside.color = new Color(colour(`--${this.name}-cut`));
        this.line.color = new Color(colour(`--${this.name}-edge`));
        for (const material of [this.outside, this.inside, this.line]) {
            if ((material.clippingPlanes?.length ?? 0) !== planes.length) material.needsUpdate = true;
            material.clippingPlanes = planes;
        }
    }
}

export class Stage {
    readonly view: View3d;
    private readonly fixed: Body;
    private readonly moving: Body;
    private readonly marks = new Group();
    private readonly size: number;
    private readonly plane = new Plane(new Vector3(0, -1, 0), 0);
    private section: Section = "none";
    private through = new Vector3();

    constructor(canvas: HTMLCanvasElement, halves: [Uint8Array, Uint8Array], private readonly cor: number) {
        this.view = new View3d(canvas, new Vector3(1.5, -2.6, 1.5));
        this.fixed = new Body(halves[0], "fixed");
        this.moving = new Body(halves[1], "moving");
        this.view.scene.add(this.fixed.group, this.moving.group, this.marks);
        const box = new Box3().setFromObject(this.fixed.group);
        this.size = box.getSize(new Vector3()).length();
        this.view.before = () => {
            const planes = this.section === "none" ? [] : [this.plane];
            this.fixed.paint(planes);
            this.moving.paint(planes);
        };
    }

    /** Both halves into the picture. */
    frame() {
        this.view.scene.updateMatrixWorld(true);
        const box = new Box3().setFromObject(this.fixed.group).union(new Box3().setFromObject(this.moving.group));
        // Room for the moving half on its way.
        this.view.look(box.expandByScalar(this.size / 6));
    }

    /** Puts the moving half at an error, the centre of rotation at a height; marks contacts. */
    place(pose: Pose, height: number, touches: Touch[], locked: { x: boolean; y: boolean }) {
        const [x, y, roll, pitch, yaw] = pose;
        const turn = new Matrix4().makeRotationZ(yaw).multiply(new Matrix4().makeRotationY(pitch)).multiply(new Matrix4().makeRotationX(roll));
        // The face centre from the centre of rotation, turned; an error that is locked is locked at the centre of rotation.
        const face = new Vector3(0, 0, this.cor).applyMatrix4(turn);
        const from = new Vector3(locked.x ? 0 : x - face.x, locked.y ? 0 : y - face.y, height);
        this.moving.group.matrix.makeTranslation(from.x, from.y, from.z).multiply(turn).multiply(new Matrix4().makeTranslation(0, 0, this.cor));
        this.moving.group.matrixWorldNeedsUpdate = true;
        this.mark(touches);
        this.through = touches.length
            ? touches.reduce((sum, t) => sum.add(new Vector3(...t.point_d)), new Vector3()).divideScalar(touches.length)
            : new Vector3(0, 0, 0);
        this.cut();
    }

    private mark(touches: Touch[]) {
        this.marks.clear();
        const paint = new Color(colour("--contact"));
        // Many contacts of one face say no more than a few hundred.
        for (const { point_d, normal } of touches.slice(0, 200)) {
            const ball = new Mesh(new SphereGeometry(this.size / 90, 16, 12), new MeshBasicMaterial({ color: paint, depthTest: false, transparent: true }));
            ball.position.set(...point_d);
            ball.renderOrder = 2;
            const arrow = new ArrowHelper(new Vector3(...normal), new Vector3(...point_d), this.size / 7, paint, this.size / 28, this.size / 45);
            arrow.renderOrder = 2;
            for (const part of [arrow.line, arrow.cone]) (part.material as MeshBasicMaterial).depthTest = false;
            this.marks.add(ball, arrow);
        }
        this.view.draw();
    }

    cutBy(section: Section) {
        this.section = section;
        this.cut();
    }

    private cut() {
        const normal = this.section === "x" ? new Vector3(-1, 0, 0) : new Vector3(0, 1, 0);
        this.plane.setFromNormalAndCoplanarPoint(normal, this.through);
        this.view.draw();
    }
}
