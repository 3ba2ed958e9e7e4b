// SPDX-License-Identifier: Apache-2.0
// What is picked on the axis that is shown, with the values that it has there; and the same on another axis.
import type { Axis, Vector } from './data';
import { branchLength } from './geometry';
import type { ModelView } from './modelview';
import type { Picked } from './state';

/** Of the three corners of a triangle; a line has two. */
export type Weights = Vector;

const along = (a: Vector, b: Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const vertexOf = (positions: Float32Array, v: number): Vector => [positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!];

/** Between the values of corners, some of which may be infinite. */
const weighted = (weights: Weights, value: (corner: number) => number) =>
    weights.reduce((sum, w, k) => sum + (w === 0 ? 0 : w * value(k)), 0);

/** Of vertices of an axis: their mean with these weights, in the units of the model. */
const placeOf = (view: ModelView, axis: Axis, vertices: readonly number[], weights: Weights) =>
    view.model.origin.map((o, k) => o + weighted(weights, (i) => axis.positions[3 * vertices[i]! + k]!)) as Vector;

/** \param triangle of the sheets */
export function onSheet(view: ModelView, model: number, triangle: number, weights: Weights): Picked {
    const { axis, geometry: { sheets } } = view.axisView!;
    const copies = [0, 1, 2].map((k) => sheets.triangles[3 * triangle + k]!);
    const vertices = copies.map((c) => sheets.vertices[c]!);
    const face = sheets.triangleFaces[triangle]!;
    const angle = axis.angles[face]!;
    return {
        model, kind: 'sheet', sheet: axis.sheets[face]!, ball: -1, angle: angle > 0 ? angle : null,
        point: placeOf(view, axis, vertices, weights),
        radius: weighted(weights, (k) => axis.radii[vertices[k]!]!),
        thickness: weighted(weights, (k) => sheets.vertexThicknesses[copies[k]!]!),
    };
}

/** \param triangle of the input shape */
export function onShape(view: ModelView, model: number, triangle: number, weights: Weights): Picked {
    const { shape, thickness, origin } = view.model;
    const vertices = [0, 1, 2].map((k) => shape!.corners[3 * triangle + k]!);
    const at = (values: Float32Array) => weighted(weights, (k) => values[vertices[k]!]!);
    const nearest = vertices[weights.indexOf(Math.max(...weights))]!;
    const surface = thickness && { local: at(thickness.local), foot: at(thickness.foot), region: thickness.regions?.[nearest] ?? -1 };
    return {
        model, kind: 'shape', sheet: -1, ball: -1, radius: null, angle: null, thickness: null,
        point: origin.map((o, k) => o + weighted(weights, (i) => shape!.positions[3 * vertices[i]! + k]!)) as Vector,
        ...(surface ? { surface } : {}),
    };
}

export function onCurve(view: ModelView, model: number, edge: number, weights: Weights): Picked {
    const { axis, geometry, level } = view.axisView!;
    const { triangles, vertices } = geometry.sheets;
    const isOnSheet = new Uint8Array(axis.radii.length);
    for (const t of level.triangles) for (let k = 0; k < 3; ++k) isOnSheet[vertices[triangles[3 * t + k]!]!] = 1;
    const ends = [axis.curves[2 * edge]!, axis.curves[2 * edge + 1]!];
    return {
        model, kind: 'curve', sheet: -1, ball: ends[weights[1] > 0.5 ? 1 : 0]!, angle: null,
        point: placeOf(view, axis, ends, weights),
        radius: weighted(weights, (k) => axis.radii[ends[k]!]!),
        thickness: weighted(weights, (k) => geometry.thicknesses[ends[k]!]!),
        branch: branchLength(axis, level.lines.curves, (v) => isOnSheet[v] === 1, edge),
    };
}

export function onBall(view: ModelView, model: number, vertex: number): Picked {
    const { axis, geometry } = view.axisView!;
    const copy = geometry.sheets.vertices.indexOf(vertex);
    return {
        model, kind: 'ball', sheet: copy < 0 ? -1 : geometry.sheets.vertexSheets[copy]!, ball: vertex, angle: null,
        point: placeOf(view, axis, [vertex], [1, 0, 0]), radius: axis.radii[vertex]!, thickness: geometry.thicknesses[vertex]!,
    };
}

interface Near {
    item: number; // triangle or edge
    weights: Weights;
    distance: number;
}

/** The point of the line `ab` nearest to `p`. */
function nearOnLine(p: Vector, a: Vector, b: Vector): Omit<Near, 'item'> {
    const e = minus(b, a);
    const square = along(e, e);
    const t = square > 0 ? Math.min(1, Math.max(0, along(minus(p, a), e) / square)) : 0;
    return { weights: [1 - t, t, 0], distance: Math.hypot(...minus(p, [a[0] + t * e[0], a[1] + t * e[1], a[2] + t * e[2]])) };
}

/** The point of the triangle nearest to `p`: in its inside, or else on one of its sides. */
function nearOnTriangle(p: Vector, corners: readonly [Vector, Vector, Vector]): Omit<Near, 'item'> {
    const [a, b, c] = corners;
    const [u, v, w] = [minus(b, a), minus(c, a), minus(p, a)];
    const [uu, uv, vv, wu, wv] = [along(u, u), along(u, v), along(v, v), along(w, u), along(w, v)];
    const determinant = uu * vv - uv * uv;
    const s = (vv * wu - uv * wv) / determinant;
    const t = (uu * wv - uv * wu) / determinant;
    if (determinant > 0 && s >= 0 && t >= 0 && s + t <= 1) {
        return { weights: [1 - s - t, s, t], distance: Math.hypot(...minus(w, [s * u[0] + t * v[0], s * u[1] + t * v[1], s * u[2] + t * v[2]])) };
    }
    const sides = [0, 1, 2].map((k) => {
        const { weights, distance } = nearOnLine(p, corners[k]!, corners[(k + 1) % 3]!);
        const turned: Weights = [0, 0, 0];
        turned[k] = weights[0];
        turned[(k + 1) % 3] = weights[1];
        return { weights: turned, distance };
    });
    return sides.reduce((best, side) => (side.distance < best.distance ? side : best));
}

function nearest(items: Iterable<number>, near: (item: number) => Omit<Near, 'item'>): Near | null {
    let best: Near | null = null;
    for (const item of items) {
        const found = near(item);
        if (!best || found.distance < best.distance) best = { item, ...found };
    }
    return best;
}

/** The place on some of the sheets that is nearest to a point, and how far it is. */
function nearOnSheets(view: ModelView, point: Vector, counts: (sheet: number) => boolean): Near | null {
    const { axis, geometry: { sheets }, level } = view.axisView!;
    const p = minus(point, view.model.origin);
    const triangles = level.triangles.filter((t) => counts(axis.sheets[sheets.triangleFaces[t]!]!));
    const corner = (i: number) => vertexOf(axis.positions, sheets.vertices[sheets.triangles[i]!]!);
    return nearest(triangles, (t) => nearOnTriangle(p, [corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)]));
}

/**
 * What was picked on another axis of a model, on the one that is shown now: the nearest place of the same sheet, where
 * there is one; and of a filtration what is left of it. \param before the other axis
 */
export function followed(view: ModelView, picked: Picked, before: Axis): Picked | null {
    const after = view.model.axes[view.current];
    if (picked.kind === 'shape' || picked.kind === 'place') return picked;
    if (after === before) return after?.scales ? verified(view, picked) : picked;
    if (picked.kind !== 'sheet' || !after) return null;
    const near = nearOnSheets(view, picked.point, (sheet) => after.colors[sheet] === before.colors[picked.sheet]);
    return near && onSheet(view, picked.model, near.item, near.weights);
}

/** What a link says was picked, with the values that the model has there; null where there is nothing of the kind. */
export function verified(view: ModelView, picked: Picked): Picked | null {
    const { model, kind, point, ball, sheet } = picked;
    const isThere = (near: Near | null): near is Near => near !== null && near.distance <= 1e-3 * view.unit;
    const plain: Picked = { model, kind, point, sheet: -1, ball: -1, radius: null, angle: null, thickness: null };
    if (kind === 'place') return { ...plain, radius: picked.radius };
    const { shape, thickness } = view.model;
    if (kind === 'shape' && shape && thickness) {
        const p = minus(point, view.model.origin);
        const corner = (i: number) => vertexOf(shape.positions, shape.corners[i]!);
        const near = nearest(Array(shape.corners.length / 3).keys(), (t) => nearOnTriangle(p, [corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)]));
        return isThere(near) ? onShape(view, model, near.item, near.weights) : null;
    }
    if (kind === 'shape') return shape && plain;
    if (!view.axisView) return null;
    const { axis, level } = view.axisView;
    if (kind === 'surface') return axis.surface && plain;
    if (kind === 'sheet') {
        const near = nearOnSheets(view, point, (s) => s === sheet);
        return isThere(near) ? onSheet(view, model, near.item, near.weights) : null;
    }
    const p = minus(point, view.model.origin);
    if (kind === 'curve') {
        const near = nearest(level.lines.curves, (e) => nearOnLine(p, vertexOf(axis.positions, axis.curves[2 * e]!), vertexOf(axis.positions, axis.curves[2 * e + 1]!)));
        return isThere(near) ? onCurve(view, model, near.item, near.weights) : null;
    }
    const off = level.vertices.includes(ball) ? Math.hypot(...minus(p, vertexOf(axis.positions, ball))) : Infinity;
    return off <= 1e-3 * view.unit ? onBall(view, model, ball) : null;
}
