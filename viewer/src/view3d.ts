// A canvas with a camera that orbits: what both pictures in space stand in. Draws when something changed, never idly.

import { AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer, type Box3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { colour } from "./dom";

/** Draws for all pictures in space, each of which copies what is drawn: a context of its own would compile every shader again. */
let painter: WebGLRenderer | null = null;

function painting(width: number, height: number): WebGLRenderer {
    if (!painter) {
        painter = new WebGLRenderer({ antialias: true });
        painter.localClippingEnabled = true;
    }
    const { width: wide, height: high } = painter.domElement;
    if (width > wide || height > high) painter.setSize(Math.max(width, wide), Math.max(height, high), false);
    return painter;
}

export class View3d {
    readonly scene = new Scene();
    readonly camera = new PerspectiveCamera(32, 1, 0.01, 200);
    readonly controls: OrbitControls;
    private readonly pen: CanvasRenderingContext2D;
    private asked = false;
    /** Called before each picture. */
    before: () => void = () => {};

    constructor(readonly canvas: HTMLCanvasElement, from: Vector3) {
        painting(canvas.clientWidth, canvas.clientHeight);
        this.pen = canvas.getContext("2d")!;
        this.camera.up.set(0, 0, 1);
        this.camera.position.copy(from);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.enableDamping = false;
        this.controls.addEventListener("change", () => this.draw());
        const sun = new DirectionalLight(0xffffff, 2.2);
        sun.position.set(2, -3, 4);
        const fill = new DirectionalLight(0xffffff, 0.7);
        fill.position.set(-3, 2, -1);
        this.scene.add(new AmbientLight(0xffffff, 1.1), sun, fill);
        new ResizeObserver(() => this.draw()).observe(canvas);
        canvas.addEventListener("keydown", (event) => this.key(event));
    }

    /** Looks at a box from where the camera stands. */
    look(box: Box3) {
        const centre = box.getCenter(new Vector3());
        const radius = box.getSize(new Vector3()).length() / 2 || 1;
        this.camera.aspect = this.canvas.clientWidth / this.canvas.clientHeight || 1;
        const away = this.camera.position.clone().sub(this.controls.target).normalize();
        const distance = (radius / Math.sin((this.camera.fov * Math.PI) / 360)) * Math.max(1, 1 / this.camera.aspect) * 0.92;
        this.controls.target.copy(centre);
        this.camera.position.copy(centre).addScaledVector(away, distance);
        this.camera.near = distance / 100;
        this.camera.far = distance * 10;
        this.camera.updateProjectionMatrix();
        this.controls.update();
        this.draw();
    }

    /** Draws with the next picture of the screen. */
    draw() {
        if (this.asked) return;
        this.asked = true;
        requestAnimationFrame(() => {
            this.asked = false;
            this.now();
        });
    }

    now() {
        const { clientWidth: width, clientHeight: height } = this.canvas;
        if (width === 0 || height === 0) return;
        const ratio = Math.min(devicePixelRatio, 2);
        const [wide, high] = [Math.floor(width * ratio), Math.floor(height * ratio)];
        if (this.canvas.width !== wide || this.canvas.height !== high) {
            Object.assign(this.canvas, { width: wide, height: high });
            this.camera.aspect = width / height;
            this.camera.updateProjectionMatrix();
        }
        this.scene.background = new Color(colour("--stage"));
        this.before();
        const renderer = painting(wide, high);
        renderer.setViewport(0, 0, wide, high);
        renderer.render(this.scene, this.camera);
        // The viewport begins below, the picture above.
        this.pen.drawImage(renderer.domElement, 0, renderer.domElement.height - high, wide, high, 0, 0, wide, high);
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
        this.draw();
    }
}
