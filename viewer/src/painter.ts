// Beside the page: draws the pictures in space, so that a slow graphics card (or none) holds up no click.

import { PerspectiveCamera, WebGLRenderer, type Scene } from "three";
import { answer } from "./response";
import { unpacked } from "./grid";
import { Halves } from "./halves";
import type { Painting, View } from "./messages";
import { Surface } from "./surface";

let halves: Halves;
let surface: Surface | null = null;
let renderer: WebGLRenderer | null = null;
const camera = new PerspectiveCamera();

/** One for all pictures, as large as the largest: another would compile every shader again. */
function painting(): WebGLRenderer {
    if (!renderer) {
        renderer = new WebGLRenderer({ canvas: new OffscreenCanvas(1, 1), antialias: true, alpha: true });
        renderer.localClippingEnabled = true;
    }
    return renderer;
}

function from(seen: View) {
    const { fov, near, far, width, height } = seen;
    Object.assign(camera, { fov, near, far, aspect: width / height });
    camera.position.fromArray(seen.position);
    camera.quaternion.fromArray(seen.quaternion);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
}

async function picture(scene: Scene, seen: View) {
    const { width, height } = seen;
    const renderer = painting();
    const canvas = renderer.domElement;
    if (width > canvas.width || height > canvas.height) renderer.setSize(Math.max(width, canvas.width), Math.max(height, canvas.height), false);
    renderer.setViewport(0, 0, width, height);
    renderer.render(scene, from(seen));
    // The viewport begins below, the picture above.
    const found = await createImageBitmap(canvas, 0, canvas.height - height, width, height);
    return { found, moved: [found] };
}

answer<Painting>({
    async halves(packed) {
        // Whether anything can be drawn at all is found first.
        painting();
        halves = new Halves(await unpacked(packed[0]), await unpacked(packed[1]));
        return { found: halves.corners };
    },
    stage(request) {
        halves.put(request);
        return picture(halves.scene, request.seen);
    },
    surface(mesh) {
        painting();
        (surface ??= new Surface()).take(mesh);
        return { found: null };
    },
    volume(request) {
        surface!.put(request);
        return picture(surface!.scene, request.seen);
    },
    hit({ seen, at }) {
        return { found: surface!.hit(at, from(seen)) };
    },
});
