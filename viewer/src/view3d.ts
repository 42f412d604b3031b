// A canvas with a camera that orbits: what both pictures in space stand in. Asks for a picture when something changed, never idly.

import { PerspectiveCamera, Vector3, type Box3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { latest } from "./request";
import type { View } from "./messages";

export class View3d {
    private readonly camera = new PerspectiveCamera(32, 1, 0.01, 200);
    private readonly controls: OrbitControls;
    private readonly pen: CanvasRenderingContext2D;
    private isOpen = false;

    constructor(readonly canvas: HTMLCanvasElement, from: Vector3, private readonly picture: (seen: View) => Promise<ImageBitmap>) {
        this.pen = canvas.getContext("2d")!;
        this.camera.up.set(0, 0, 1);
        this.camera.position.copy(from);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.enableDamping = false;
        this.controls.addEventListener("change", () => void this.draw());
        new ResizeObserver(() => void this.draw()).observe(canvas);
        canvas.addEventListener("keydown", (event) => this.key(event));
    }

    /** Looks at a box from where the camera stands; from now on there are pictures. */
    look(box: Box3): Promise<void> {
        const centre = box.getCenter(new Vector3());
        const radius = box.getSize(new Vector3()).length() / 2 || 1;
        this.camera.aspect = this.canvas.clientWidth / this.canvas.clientHeight || 1;
        const away = this.camera.position.clone().sub(this.controls.target).normalize();
        const distance = (radius / Math.sin((this.camera.fov * Math.PI) / 360)) * Math.max(1, 1 / this.camera.aspect) * 0.92;
        this.controls.target.copy(centre);
        this.camera.position.copy(centre).addScaledVector(away, distance);
        this.camera.near = distance / 100;
        this.camera.far = distance * 10;
        this.isOpen = true;
        this.controls.update();
        return this.draw();
    }

    /** Draws anew, with the next picture of the screen; done when it is there. */
    readonly draw = latest(async () => {
        if (!this.isOpen) return;
        await new Promise(requestAnimationFrame);
        const seen = this.seen();
        if (!seen) return;
        const picture = await this.picture(seen);
        // Which empties it, too: what is drawn is transparent where nothing is.
        Object.assign(this.canvas, { width: picture.width, height: picture.height });
        this.pen.drawImage(picture, 0, 0);
        picture.close();
    });

    /** Nothing where the canvas is not shown. */
    seen(): View | null {
        const ratio = Math.min(devicePixelRatio, 2);
        const [width, height] = [Math.floor(this.canvas.clientWidth * ratio), Math.floor(this.canvas.clientHeight * ratio)];
        const { position, quaternion, fov, near, far } = this.camera;
        return width * height === 0 ? null : { width, height, position: position.toArray(), quaternion: quaternion.toArray(), fov, near, far };
    }

    /** Arrows turn the camera, + and − bring it nearer and farther. */
    private key(event: KeyboardEvent) {
        const step = Math.PI / 24;
        const turn: Record<string, [number, number]> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
        const zoom: Record<string, number> = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 };
        const offset = this.camera.position.clone().sub(this.controls.target);
        if (turn[event.key]) {
            const [side, up] = turn[event.key];
            offset.applyAxisAngle(this.camera.up, side);
            const polar = Math.min(Math.PI - 0.05, Math.max(0.05, Math.acos(offset.z / offset.length()) + up));
            const flat = Math.atan2(offset.y, offset.x), length = offset.length();
            offset.set(Math.cos(flat) * Math.sin(polar), Math.sin(flat) * Math.sin(polar), Math.cos(polar)).multiplyScalar(length);
        } else if (zoom[event.key]) offset.multiplyScalar(zoom[event.key]);
        else return;
        event.preventDefault();
        this.camera.position.copy(this.controls.target).add(offset);
        this.controls.update();
        void this.draw();
    }
}
