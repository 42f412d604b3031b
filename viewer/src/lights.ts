// What lights both pictures in space.

import { AmbientLight, DirectionalLight, Scene } from "three";

export function lit(): Scene {
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(2, -3, 4);
    const fill = new DirectionalLight(0xffffff, 0.7);
    fill.position.set(-3, 2, -1);
    return new Scene().add(new AmbientLight(0xffffff, 1.1), sun, fill);
}
