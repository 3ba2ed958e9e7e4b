// SPDX-License-Identifier: Apache-2.0
// Where the camera stands for a state, and how pointers and keys move it.
import { PerspectiveCamera, Vector3 } from 'three';
import type { CameraState, Up } from './state';

const FIELD_OF_VIEW = 26; // degrees, the smaller way
const FIT = 0.94; // few models fill the sphere around their box

/** The axes of the viewer's world: right and towards the viewer at azimuth 0, and up. */
const AXES: Record<Up, { right: Vector3; front: Vector3; up: Vector3 }> = {
    y: { right: new Vector3(1, 0, 0), front: new Vector3(0, 0, 1), up: new Vector3(0, 1, 0) },
    z: { right: new Vector3(1, 0, 0), front: new Vector3(0, -1, 0), up: new Vector3(0, 0, 1) },
    x: { right: new Vector3(0, 1, 0), front: new Vector3(0, 0, 1), up: new Vector3(1, 0, 0) },
};

/** From the target to the viewer. */
export function direction(state: CameraState): Vector3 {
    const { right, front, up } = AXES[state.up];
    const azimuth = (state.azimuth * Math.PI) / 180;
    const elevation = (state.elevation * Math.PI) / 180;
    return new Vector3()
        .addScaledVector(right, Math.sin(azimuth) * Math.cos(elevation))
        .addScaledVector(front, Math.cos(azimuth) * Math.cos(elevation))
        .addScaledVector(up, Math.sin(elevation));
}

export function place(camera: PerspectiveCamera, state: CameraState, aspect: number): void {
    const half = (FIELD_OF_VIEW * Math.PI) / 360;
    camera.aspect = aspect;
    camera.fov = (360 / Math.PI) * Math.atan(Math.tan(half) / Math.min(1, aspect));
    const distance = (FIT * state.distance) / Math.sin(half);
    camera.up.copy(AXES[state.up].up);
    camera.position.set(...state.target).addScaledVector(direction(state), distance);
    camera.lookAt(...state.target);
    const reach = 1.5 + Math.hypot(...state.target); // of what there is to see, from the target
    camera.near = Math.max(distance - reach, distance / 500);
    camera.far = distance + reach;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
}

const clampElevation = (degrees: number) => Math.min(90, Math.max(-90, degrees));

export function rotated(state: CameraState, right: number, up: number): CameraState {
    const azimuth = (((state.azimuth + right) % 360) + 360) % 360;
    return { ...state, azimuth, elevation: clampElevation(state.elevation + up) };
}

export function zoomed(state: CameraState, factor: number): CameraState {
    return { ...state, distance: Math.min(20, Math.max(0.005, state.distance * factor)) };
}

/** Moves the target by parts of the viewport's smaller side. */
export function panned(state: CameraState, right: number, up: number): CameraState {
    const camera = new PerspectiveCamera();
    place(camera, state, 1);
    const extent = 2 * FIT * state.distance; // about what the smaller side shows at the target
    const x = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const y = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    const target = new Vector3(...state.target).addScaledVector(x, right * extent).addScaledVector(y, up * extent);
    target.clampLength(0, 3);
    return { ...state, target: [target.x, target.y, target.z] };
}

export interface Gestures {
    get(): CameraState;
    set(state: CameraState): void;
    click(x: number, y: number): void; // CSS pixels from the element's corner
    settle(): void; // no pointer is down any more
}

/** One pointer rotates, one with Shift or another button moves, two move and zoom, the wheel zooms. */
export function listen(element: HTMLElement, size: () => number, gestures: Gestures): void {
    const pointers = new Map<number, { x: number; y: number }>();
    let travelled = 0;
    let button = 0;
    const middle = () => {
        const all = [...pointers.values()];
        return { x: all.reduce((s, p) => s + p.x, 0) / all.length, y: all.reduce((s, p) => s + p.y, 0) / all.length };
    };
    const spread = () => {
        const [a, b] = [...pointers.values()];
        return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
    };
    element.addEventListener('pointerdown', (event) => {
        if (pointers.size === 0) {
            travelled = 0;
            button = event.button;
        }
        pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
        element.setPointerCapture(event.pointerId);
        if (pointers.size > 1) travelled = Infinity;
    });
    element.addEventListener('pointermove', (event) => {
        if (!pointers.has(event.pointerId)) return;
        const before = { ...middle(), spread: spread() };
        pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
        const after = { ...middle(), spread: spread() };
        const dx = (after.x - before.x) / size();
        const dy = (after.y - before.y) / size();
        travelled += Math.hypot(after.x - before.x, after.y - before.y);
        if (travelled < 4) return;
        let state = gestures.get();
        if (pointers.size > 1) {
            state = panned(state, -dx, dy);
            if (before.spread > 0 && after.spread > 0) state = zoomed(state, before.spread / after.spread);
        } else if (button !== 0 || event.shiftKey) {
            state = panned(state, -dx, dy);
        } else {
            state = rotated(state, -dx * 200, dy * 200);
        }
        gestures.set(state);
    });
    const end = (event: PointerEvent) => {
        if (!pointers.delete(event.pointerId)) return;
        if (event.type === 'pointerup' && travelled < 4 && button === 0) gestures.click(event.offsetX, event.offsetY);
        if (pointers.size === 0) gestures.settle();
    };
    element.addEventListener('pointerup', end);
    element.addEventListener('pointercancel', end);
    element.addEventListener('contextmenu', (event) => event.preventDefault());
    let wheelEnd = 0;
    element.addEventListener('wheel', (event) => {
        event.preventDefault();
        const lines = event.deltaMode === 1 ? 30 : 1;
        gestures.set(zoomed(gestures.get(), Math.exp(Math.max(-240, Math.min(240, event.deltaY * lines)) * 0.0015)));
        clearTimeout(wheelEnd);
        wheelEnd = window.setTimeout(() => pointers.size === 0 && gestures.settle(), 250);
    }, { passive: false });
}
