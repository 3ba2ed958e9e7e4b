// SPDX-License-Identifier: Apache-2.0
// The canvas: models beside each other, all seen by one camera.
import { PerspectiveCamera, Vector3, WebGLRenderer } from 'three';
import { direction, place } from './camera';
import { shared } from './materials';
import { drawing, type ModelView, type Ranges } from './modelview';
import { pick, type Ray } from './pick';
import type { Picked, State } from './state';

export const BACKGROUND = { light: 0xf6f7f9, dark: 0x14171c };

export interface Cell {
    x: number; // CSS pixels from the upper left corner
    y: number;
    width: number;
    height: number;
}

/** `count` cells that fill an area, as square as they can be. */
export function cells(count: number, width: number, height: number): Cell[] {
    let best = 1;
    let bestSide = 0;
    for (let columns = 1; columns <= count; ++columns) {
        const side = Math.min(width / columns, height / Math.ceil(count / columns));
        if (side > bestSide) [best, bestSide] = [columns, side];
    }
    const rows = Math.ceil(count / best);
    return Array.from({ length: count }, (_, i) => {
        const column = i % best;
        const row = Math.floor(i / best);
        const x = Math.round((column * width) / best);
        const y = Math.round((row * height) / rows);
        return { x, y, width: Math.round(((column + 1) * width) / best) - x, height: Math.round(((row + 1) * height) / rows) - y };
    });
}

/** The plane that cuts a model, in the space where half the diagonal of its box is 1. */
function cutPlane(view: ModelView, { cut }: State): [number, number, number, number] {
    if (cut.by === 'off') return [0, 0, 0, 1];
    const half = view.model.max.map((b, k) => (b - view.model.min[k]!) / 2 / view.unit);
    const normal = cut.by === 'view' ? cut.normal : (['x', 'y', 'z'].map((k) => (k === cut.by ? 1 : 0)) as [number, number, number]);
    const reach = normal.reduce((sum, n, k) => sum + Math.abs(n) * half[k]!, 0); // of the box along the normal
    const at = cut.at * reach * 1.001;
    return cut.flipped ? [-normal[0], -normal[1], -normal[2], -at] : [...normal, at];
}

export class Stage {
    readonly renderer: WebGLRenderer;
    readonly camera = new PerspectiveCamera();
    private ratio = 1;

    /** \throws Error where there is no WebGL 2 */
    constructor(readonly canvas: HTMLCanvasElement) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true });
        this.renderer.setScissorTest(true);
        const gl = this.renderer.getContext();
        const info = gl.getExtension('WEBGL_debug_renderer_info');
        const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
        if (/swiftshader|llvmpipe|software|basic render/i.test(name)) Object.assign(drawing, { ballTriangles: 5e5, mostBalls: 10000, hasInstances: false });
    }

    /** \param detail part of the pixels that the screen has each way, ≤ 1 */
    resize(width: number, height: number, detail: number): void {
        this.ratio = Math.min(2, window.devicePixelRatio) * detail;
        this.renderer.setPixelRatio(this.ratio);
        this.renderer.setSize(width, height, false);
    }

    draw(views: ModelView[], indices: number[], state: State, theme: 'light' | 'dark', ranges: Ranges, width: number, height: number): void {
        this.renderer.setClearColor(BACKGROUND[theme]);
        shared.pixel.value = this.ratio * Math.min(1, Math.max(0.5, Math.min(width, height) / 500)); // thin lines in small pictures
        cells(views.length, width, height).forEach((cell, i) => {
            const view = views[i]!;
            view.update(state, indices[i]!, theme, ranges);
            view.axisView?.sortBalls(viewNormal(state));
            shared.cut.value.set(...cutPlane(view, state));
            shared.size.value.set(cell.width * this.ratio, cell.height * this.ratio);
            const bottom = height - cell.y - cell.height;
            this.renderer.setViewport(cell.x, bottom, cell.width, cell.height);
            this.renderer.setScissor(cell.x, bottom, cell.width, cell.height);
            place(this.camera, state.camera, cell.width / cell.height);
            this.renderer.render(view.scene, this.camera);
        });
    }

    /** What is seen at a place of the canvas. */
    pick(views: ModelView[], indices: number[], state: State, x: number, y: number, width: number, height: number): Picked | null {
        const all = cells(views.length, width, height);
        const i = all.findIndex((c) => x >= c.x && x < c.x + c.width && y >= c.y && y < c.y + c.height);
        const cell = all[i];
        const view = views[i];
        if (!cell || !view) return null;
        place(this.camera, state.camera, cell.width / cell.height);
        const onScreen = new Vector3(((x - cell.x) / cell.width) * 2 - 1, 1 - ((y - cell.y) / cell.height) * 2, 0.5);
        const from = this.camera.position;
        const towards = onScreen.unproject(this.camera).sub(from).normalize();
        const [a, b, c, end] = cutPlane(view, state);
        const ray: Ray = {
            from: [from.x * view.unit, from.y * view.unit, from.z * view.unit],
            direction: [towards.x, towards.y, towards.z],
            spread: Math.tan((this.camera.fov * Math.PI) / 360) / (cell.height / 2),
            isShown: (px, py, pz) => a * px + b * py + c * pz <= end * view.unit,
        };
        return pick(view, indices[i]!, state, ray);
    }
}

/** The direction of view, for a cut across it. */
export function viewNormal(state: State): [number, number, number] {
    const d = direction(state.camera);
    return [d.x, d.y, d.z];
}
