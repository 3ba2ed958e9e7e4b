// SPDX-License-Identifier: Apache-2.0
// What a ray from the viewer meets first.
import type { Mesh } from './data';
import type { ModelView } from './modelview';
import { onBall, onCurve, onShape, onSheet } from './picked';
import type { Picked, State } from './state';

/** A ray in the units of the model, relative to its origin. */
export interface Ray {
    from: [number, number, number];
    direction: [number, number, number]; // of length 1
    spread: number; // radius of a pixel at distance 1
    isShown: (x: number, y: number, z: number) => boolean; // false beyond the cut
}

interface Hit {
    distance: number;
    weights: [number, number, number]; // of the corners
    item: number;
}

/** The first of some triangles on the ray, of either orientation. */
function firstTriangle(ray: Ray, position: (corner: number) => number, positions: Float32Array, triangles: Iterable<number>): Hit | null {
    const [ox, oy, oz] = ray.from;
    const [dx, dy, dz] = ray.direction;
    let best: Hit | null = null;
    for (const t of triangles) {
        const a = 3 * position(3 * t), b = 3 * position(3 * t + 1), c = 3 * position(3 * t + 2);
        const ax = positions[a]!, ay = positions[a + 1]!, az = positions[a + 2]!;
        const ux = positions[b]! - ax, uy = positions[b + 1]! - ay, uz = positions[b + 2]! - az;
        const vx = positions[c]! - ax, vy = positions[c + 1]! - ay, vz = positions[c + 2]! - az;
        const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
        const determinant = ux * px + uy * py + uz * pz;
        if (determinant === 0) continue;
        const sx = ox - ax, sy = oy - ay, sz = oz - az;
        const u = (sx * px + sy * py + sz * pz) / determinant;
        if (u < 0 || u > 1) continue;
        const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
        const v = (dx * qx + dy * qy + dz * qz) / determinant;
        if (v < 0 || u + v > 1) continue;
        const distance = (vx * qx + vy * qy + vz * qz) / determinant;
        if (distance <= 0 || (best && distance >= best.distance)) continue;
        if (!ray.isShown(ox + distance * dx, oy + distance * dy, oz + distance * dz)) continue;
        best = { distance, weights: [1 - u - v, u, v], item: t };
    }
    return best;
}

function firstBall(ray: Ray, positions: Float32Array, radii: Float32Array, vertices: Uint32Array): Hit | null {
    const [ox, oy, oz] = ray.from;
    const [dx, dy, dz] = ray.direction;
    let best: Hit | null = null;
    for (const v of vertices) {
        const x = positions[3 * v]! - ox, y = positions[3 * v + 1]! - oy, z = positions[3 * v + 2]! - oz;
        const along = x * dx + y * dy + z * dz;
        const rest = radii[v]! ** 2 - (x * x + y * y + z * z - along * along);
        if (rest < 0) continue;
        const distance = along - Math.sqrt(rest);
        if (distance <= 0 || (best && distance >= best.distance)) continue;
        if (!ray.isShown(ox + distance * dx, oy + distance * dy, oz + distance * dz)) continue;
        best = { distance, weights: [1, 0, 0], item: v };
    }
    return best;
}

/** The first of some lines within a few pixels of the ray. */
function firstLine(ray: Ray, positions: Float32Array, ends: Uint32Array, lines: Iterable<number>): Hit | null {
    const pixels = 5;
    const [dx, dy, dz] = ray.direction;
    let best: Hit | null = null;
    for (const line of lines) {
        const a = 3 * ends[2 * line]!, b = 3 * ends[2 * line + 1]!;
        const w = [0, 1, 2].map((k) => positions[a + k]! - ray.from[k]!) as [number, number, number];
        const e = [0, 1, 2].map((k) => positions[b + k]! - positions[a + k]!) as [number, number, number];
        // Both seen along the ray, in the plane across it.
        const wAlong = w[0] * dx + w[1] * dy + w[2] * dz;
        const eAlong = e[0] * dx + e[1] * dy + e[2] * dz;
        const wx = [w[0] - wAlong * dx, w[1] - wAlong * dy, w[2] - wAlong * dz] as const;
        const ex = [e[0] - eAlong * dx, e[1] - eAlong * dy, e[2] - eAlong * dz] as const;
        const square = ex[0] ** 2 + ex[1] ** 2 + ex[2] ** 2;
        const t = square > 0 ? Math.min(1, Math.max(0, -(wx[0] * ex[0] + wx[1] * ex[1] + wx[2] * ex[2]) / square)) : 0;
        const distance = wAlong + t * eAlong;
        const off = Math.hypot(wx[0] + t * ex[0], wx[1] + t * ex[1], wx[2] + t * ex[2]);
        if (distance <= 0 || off > pixels * ray.spread * distance || (best && distance >= best.distance)) continue;
        if (!ray.isShown(...([0, 1, 2].map((k) => positions[a + k]! + t * e[k]!) as [number, number, number]))) continue;
        best = { distance, weights: [1 - t, t, 0], item: line };
    }
    return best;
}

/** What is picked: the nearest of what is shown; what is more than half transparent only where nothing else is met. */
export function pick(view: ModelView, index: number, state: State, ray: Ray): Picked | null {
    const { origin, shape } = view.model;
    const candidates: { distance: number; isSolid: boolean; picked: Picked }[] = [];
    const add = (distance: number, opacity: number, picked: Picked) => candidates.push({ distance, isSolid: opacity > 0.5, picked });
    const addMesh = (mesh: Mesh, kind: 'surface' | 'shape', opacity: number) => {
        const hit = firstTriangle(ray, (i) => mesh.corners[i]!, mesh.positions, Array(mesh.corners.length / 3).keys());
        if (!hit) return;
        if (kind === 'shape') {
            add(hit.distance, opacity, onShape(view, index, hit.item, hit.weights));
            return;
        }
        const point = ray.from.map((x, k) => x + hit.distance * ray.direction[k]! + origin[k]!) as Picked['point'];
        add(hit.distance, opacity, { model: index, kind, point, sheet: -1, ball: -1, radius: null, angle: null, thickness: null });
    };

    const axisView = view.axisView;
    if (axisView) {
        const { axis, geometry, level } = axisView;
        if (state.shown.axis) {
            const { triangles, vertices } = geometry.sheets;
            const face = firstTriangle(ray, (i) => vertices[triangles[i]!]!, axis.positions, level.triangles);
            if (face) add(face.distance, state.opacity.axis, onSheet(view, index, face.item, face.weights));
            const curve = state.lines.curves ? firstLine(ray, axis.positions, axis.curves, level.lines.curves) : null;
            if (curve) add(curve.distance, state.opacity.axis, onCurve(view, index, curve.item, curve.weights));
        }
        if (state.shown.balls) {
            const ball = firstBall(ray, axis.positions, axis.radii, axisView.shownBalls(state, state.picked?.model === index));
            if (ball) add(ball.distance, state.opacity.balls, onBall(view, index, ball.item));
        }
        if (state.shown.surface && axis.surface) addMesh(axis.surface, 'surface', state.opacity.surface);
    }
    if (state.shown.shape && shape) addMesh(shape, 'shape', state.opacity.shape);
    candidates.sort((a, b) => a.distance - b.distance);
    return (candidates.find((c) => c.isSolid) ?? candidates[0])?.picked ?? null;
}
