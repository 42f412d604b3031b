// The two halves in space, their contacts, and a section through them, as they are drawn.

import {
    ArrowHelper, BackSide, Box3, Color, FrontSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, Plane, SphereGeometry,
    Vector3,
} from "three";
import { lit } from "./lights";
import type { Colours, Corners, Painting } from "./messages";
import type { Touch } from "./page";
import { solid } from "./solid";

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

    get box(): Box3 {
        return new Box3().setFromObject(this.group);
    }

    paint(colours: Colours, planes: Plane[]) {
        this.outside.color = new Color(colours[this.name]);
        this.inside.color = new Color(colours[`${this.name}-cut`]);
        this.line.color = new Color(colours[`${this.name}-edge`]);
        for (const material of [this.outside, this.inside, this.line]) {
            if ((material.clippingPlanes?.length ?? 0) !== planes.length) material.needsUpdate = true;
            material.clippingPlanes = planes;
        }
    }
}

export class Halves {
    readonly scene = lit();
    /** Before the moving half is put anywhere. */
    readonly corners: [Corners, Corners];
    private readonly fixed: Body;
    private readonly moving: Body;
    private readonly marks = new Group();
    private readonly size: number;
    private readonly ball: SphereGeometry;

    constructor(fixed: Uint8Array, moving: Uint8Array) {
        this.fixed = new Body(fixed, "fixed");
        this.moving = new Body(moving, "moving");
        this.scene.add(this.fixed.group, this.moving.group, this.marks);
        this.corners = [this.fixed.box, this.moving.box].map(({ min, max }) => [min.toArray(), max.toArray()]) as [Corners, Corners];
        this.size = this.fixed.box.getSize(new Vector3()).length();
        this.ball = new SphereGeometry(this.size / 90, 16, 12);
    }

    put({ colours, moving, touches, section }: Painting["stage"][0]) {
        this.moving.group.matrix.fromArray(moving);
        this.moving.group.matrixWorldNeedsUpdate = true;
        const planes = section ? [new Plane().setFromNormalAndCoplanarPoint(new Vector3(...section.normal), new Vector3(...section.through))] : [];
        this.fixed.paint(colours, planes);
        this.moving.paint(colours, planes);
        this.mark(touches, new Color(colours.contact));
    }

    private mark(touches: Touch[], paint: Color) {
        this.marks.children.forEach((part) => part instanceof ArrowHelper && part.dispose());
        this.marks.clear();
        const material = new MeshBasicMaterial({ color: paint, depthTest: false, transparent: true });
        // Many contacts of one face say no more than a few hundred.
        for (const { point_d, normal } of touches.slice(0, 200)) {
            const ball = new Mesh(this.ball, material);
            ball.position.set(...point_d);
            ball.renderOrder = 2;
            const arrow = new ArrowHelper(new Vector3(...normal), new Vector3(...point_d), this.size / 7, paint, this.size / 28, this.size / 45);
            arrow.renderOrder = 2;
            for (const part of [arrow.line, arrow.cone]) (part.material as MeshBasicMaterial).depthTest = false;
            this.marks.add(ball, arrow);
        }
    }
}
