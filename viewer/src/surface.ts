// The set over three errors as it is drawn: its surface in a box from −½ to ½, the chosen pose, names and ends of the axes.

import {
    Box3, Box3Helper, BufferAttribute, BufferGeometry, CanvasTexture, Color, DoubleSide, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, Raycaster,
    SphereGeometry, Sprite, SpriteMaterial, Vector2, Vector3, type PerspectiveCamera,
} from "three";
import type { Mesh as Border } from "./border";
import { lit } from "./lights";
import type { Label, Painting } from "./messages";
import type { Point } from "./page";

export class Surface {
    readonly scene = lit();
    private readonly surface = new Mesh(new BufferGeometry(), new MeshLambertMaterial({ side: DoubleSide, flatShading: true }));
    private readonly point = new Mesh(new SphereGeometry(0.022, 16, 12), new MeshBasicMaterial({ depthTest: false, transparent: true }));
    private readonly box = new Box3Helper(new Box3(new Vector3(-0.5, -0.5, -0.5), new Vector3(0.5, 0.5, 0.5)));
    private readonly labels = new Group();
    private written = "";

    constructor() {
        this.point.renderOrder = 3;
        this.scene.add(this.surface, this.point, this.box, this.labels);
    }

    take({ positions, indices }: Border) {
        const { geometry } = this.surface;
        this.surface.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3)).setIndex(new BufferAttribute(indices, 1));
        this.surface.geometry.computeVertexNormals();
        geometry.dispose();
    }

    put({ colours, surface, point, labels }: Painting["volume"][0]) {
        this.surface.material.color = new Color(colours[surface]);
        this.point.material.color = new Color(colours.contact);
        (this.box.material as unknown as MeshBasicMaterial).color = new Color(colours.line);
        this.point.position.set(...point);
        // Letters are drawn again where they say something else.
        const writing = JSON.stringify(labels);
        if (writing === this.written) return;
        this.written = writing;
        for (const old of this.labels.children as Sprite[]) {
            old.material.map?.dispose();
            old.material.dispose();
        }
        this.labels.clear().add(...labels.map(sprite));
    }

    hit(at: [number, number], camera: PerspectiveCamera): Point | null {
        const ray = new Raycaster();
        ray.setFromCamera(new Vector2(...at), camera);
        return ray.intersectObject(this.surface)[0]?.point.toArray() ?? null;
    }
}

/** Text that faces the camera. */
function sprite({ text, colour, height, at }: Label): Sprite {
    const canvas = new OffscreenCanvas(1, 56);
    const pen = canvas.getContext("2d")!;
    const font = "500 44px system-ui, sans-serif";
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(text).width) + 8;
    pen.font = font;
    pen.fillStyle = colour;
    pen.textBaseline = "middle";
    pen.fillText(text, 4, 28);
    const found = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false }));
    found.scale.set((height * canvas.width) / canvas.height, height, 1);
    found.position.set(...at);
    return found;
}
