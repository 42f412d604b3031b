// The set over any three errors as a surface in a box; the others stay where the sliders are.

import {
    Box3, Box3Helper, BufferAttribute, BufferGeometry, CanvasTexture, Color, DoubleSide, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, Raycaster,
    SphereGeometry, Sprite, SpriteMaterial, Vector2, Vector3,
} from "three";
import { colour, make } from "./dom";
import { tidy } from "./format";
import { AXES, type Axis, type Pose } from "./page";
import { cell, ticks, type Host } from "./slices";
import type { Mesh as Border } from "./surface";
import { View3d } from "./view3d";

export interface VolumeHost extends Host {
    border(axes: number[], at: number[], code: number): Promise<Border>;
}

export class Volume {
    readonly element: HTMLElement;
    private view: View3d | null = null;
    private readonly canvas = make("canvas", { tabindex: 0, class: "volume", "aria-label": "the set over three errors; arrows turn it, a click chooses a pose" });
    private readonly surface = new Mesh(new BufferGeometry(), new MeshLambertMaterial({ side: DoubleSide, flatShading: true }));
    private readonly point = new Mesh(new SphereGeometry(0.022, 16, 12), new MeshBasicMaterial({ depthTest: false, transparent: true }));
    private readonly labels = new Group();
    private readonly box = new Box3Helper(new Box3(new Vector3(-0.5, -0.5, -0.5), new Vector3(0.5, 0.5, 0.5)));
    private readonly pickers: HTMLSelectElement[];
    private readonly of: HTMLSelectElement;

    constructor(private readonly host: VolumeHost, private chosen: [number, number, number]) {
        this.pickers = chosen.map((axis, side) => {
            const options = host.axes.map((a, k) => make("option", { value: k, ...(k === axis ? { selected: true } : {}) }, a.axis));
            const picker = make("select", { "aria-label": `surface, axis ${side + 1}`, onchange: () => this.pick(side, Number(picker.value)) }, ...options);
            return picker;
        });
        this.of = make("select", { "aria-label": "which poses the surface holds", onchange: () => void this.update() },
            make("option", { value: 1 }, "aligned"), make("option", { value: 2 }, "jammed"));
        this.element = make("figure", { class: "volume" }, make("figcaption", {}, this.of, make("span", {}, "over"), ...this.pickers), this.canvas);
        this.point.renderOrder = 3;
        let down = [0, 0];
        this.canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
        this.canvas.addEventListener("click", (event) => {
            // Turning the picture is no choice.
            if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) this.choose(event);
        });
    }

    /** Starts drawing; the element is in the page by now. */
    open() {
        this.view = new View3d(this.canvas, new Vector3(1.7, -2.3, 1.4));
        this.view.scene.add(this.surface, this.point, this.box, this.labels);
        this.view.before = () => {
            const name = this.of.value === "1" ? "--aligned" : "--jammed";
            (this.surface.material as MeshLambertMaterial).color = new Color(colour(name));
            (this.point.material as MeshBasicMaterial).color = new Color(colour("--contact"));
            (this.box.material as unknown as MeshBasicMaterial).color = new Color(colour("--line"));
        };
        this.view.look(new Box3(new Vector3(-0.62, -0.62, -0.62), new Vector3(0.62, 0.62, 0.62)));
        this.name();
    }

    private pick(side: number, axis: number) {
        const other = this.chosen.indexOf(axis);
        if (other >= 0) this.chosen[other] = this.chosen[side];
        this.chosen[side] = axis;
        this.pickers.forEach((picker, k) => (picker.value = String(this.chosen[k])));
        this.name();
        void this.update();
    }

    private get triple(): Axis[] {
        return this.chosen.map((k) => this.host.axes[k]);
    }

    async update() {
        if (!this.view) return;
        const pose = this.host.pose();
        const { axes } = this.host;
        const asked = String(this.chosen);
        const at = axes.map((axis) => cell(axis, pose[AXES.indexOf(axis.axis)]));
        const { positions, indices } = await this.host.border([...this.chosen], at, Number(this.of.value));
        if (asked !== String(this.chosen)) return;
        const shape = this.triple.map((axis) => axis.cells);
        for (let k = 0; k < positions.length; k++) positions[k] = (positions[k] + 0.5) / shape[k % 3] - 0.5;
        this.surface.geometry.dispose();
        this.surface.geometry = new BufferGeometry();
        this.surface.geometry.setAttribute("position", new BufferAttribute(positions, 3));
        this.surface.geometry.setIndex(new BufferAttribute(indices, 1));
        this.surface.geometry.computeVertexNormals();
        this.triple.forEach((axis, k) => {
            const value = pose[AXES.indexOf(axis.axis)];
            this.point.position.setComponent(k, (value - axis.lo) / (axis.hi - axis.lo) - 0.5);
        });
        this.view.draw();
    }

    /** Draws anew where colours changed. */
    repaint() {
        this.name();
        this.view?.draw();
    }

    /** Names and ends of the axes, along three edges of the box. */
    private name() {
        this.labels.clear();
        const { units } = this.host;
        this.triple.forEach((axis, k) => {
            const along = (share: number, out: number) => {
                const place = [-0.5, -0.5, -0.5];
                if (k === 2) place[0] = -0.5 - out * 0.7, place[1] = -0.5 - out * 0.7;
                else place[1 - k] = -0.5 - out;
                place[k] = share - 0.5;
                return new Vector3(...(place as [number, number, number]));
            };
            const [first, last] = [ticks(units, axis, 4)[0], ticks(units, axis, 4).at(-1)!];
            for (const value of [first, last]) {
                const text = label(tidy(units.shown(axis.axis, value)), "--soft", 0.072);
                text.position.copy(along((value - axis.lo) / (axis.hi - axis.lo), 0.09));
                this.labels.add(text);
            }
            const name = label(`${axis.axis} [${units.unit(axis.axis)}]`, "--ink", 0.085);
            name.position.copy(along(0.5, 0.16));
            this.labels.add(name);
        });
    }

    private choose(event: MouseEvent) {
        if (!this.view) return;
        const box = this.canvas.getBoundingClientRect();
        const at = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
        const ray = new Raycaster();
        ray.setFromCamera(at, this.view.camera);
        const hit = ray.intersectObject(this.surface)[0];
        if (!hit) return;
        const pose = [...this.host.pose()] as Pose;
        this.triple.forEach((axis, k) => {
            pose[AXES.indexOf(axis.axis)] = axis.lo + (hit.point.getComponent(k) + 0.5) * (axis.hi - axis.lo);
        });
        this.host.choose(pose);
    }
}

/** Text that faces the camera. */
function label(text: string, paint: string, height: number): Sprite {
    const canvas = make("canvas");
    const pen = canvas.getContext("2d")!;
    const font = "500 44px system-ui, sans-serif";
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(text).width) + 8;
    canvas.height = 56;
    pen.font = font;
    pen.fillStyle = colour(paint);
    pen.textBaseline = "middle";
    pen.fillText(text, 4, 28);
    const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false }));
    sprite.scale.set((height * canvas.width) / canvas.height, height, 1);
    return sprite;
}
