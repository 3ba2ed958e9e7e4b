// SPDX-License-Identifier: Apache-2.0
// What of an axis is there at a scale: of a filtration a part, of any other axis all.
import type { Axis } from './data';
import type { AxisGeometry, Spans } from './geometry';
import type { LineName } from './state';

export interface Level {
    triangles: Uint32Array; // numbers of those of the sheets
    lines: Record<LineName | 'points', Uint32Array>; // numbers of lines and points
    vertices: Uint32Array;
    faces: number;
    sheets: number; // parts that are connected across edges of two faces; 0 where it is no filtration
    sheetAreas: Float64Array; // of the sheets at s = 1, what is left of them
    area: number;
    curveLength: number;
}

/** The numbers below `count` for which something is true. */
function numbersWhere(count: number, isTrue: (i: number) => boolean): Uint32Array {
    const numbers = new Uint32Array(count);
    let end = 0;
    for (let i = 0; i < count; ++i) if (isTrue(i)) numbers[end++] = i;
    return numbers.slice(0, end);
}

const within = ({ from, to }: Spans, s: number) => numbersWhere(from.length, (i) => from[i]! <= s && s < to[i]!);

/** Parts of the faces that are connected across edges with exactly two faces, as the program counts sheets. */
function connectedParts(faceCount: number, isLeft: (f: number) => boolean, { edgeStarts, edgeFaces }: AxisGeometry): number {
    const parents = Uint32Array.from({ length: faceCount }, (_, f) => f);
    const rootOf = (f: number) => {
        while (parents[f] !== f) f = parents[f] = parents[parents[f]!]!;
        return f;
    };
    let parts = numbersWhere(faceCount, isLeft).length;
    for (let e = 0; e + 1 < edgeStarts.length; ++e) {
        const start = edgeStarts[e]!;
        const end = edgeStarts[e + 1]!;
        // Those that vanish last come first.
        if (end - start < 2 || !isLeft(edgeFaces[start + 1]!) || (end - start > 2 && isLeft(edgeFaces[start + 2]!))) continue;
        const [a, b] = [rootOf(edgeFaces[start]!), rootOf(edgeFaces[start + 1]!)];
        if (a === b) continue;
        parents[a] = b;
        --parts;
    }
    return parts;
}

/** What is left at `s`: all that vanishes later. */
export function levelAt(axis: Axis, geometry: AxisGeometry, s: number): Level {
    const { scales } = axis;
    const { sheets, lines, faceAreas } = geometry;
    const isLeft = (f: number) => !scales || scales.faces[f]! > s;
    const faces = numbersWhere(axis.sizes.length, isLeft);
    const sheetAreas = new Float64Array(sheets.sheetStarts.length - 1);
    for (const f of faces) sheetAreas[axis.sheets[f]!]! += faceAreas[f]!;
    const curves = within(lines.spans.curves, s);
    const p = axis.positions;
    const lengthOf = (c: number) => {
        const [a, b] = [3 * axis.curves[2 * c]!, 3 * axis.curves[2 * c + 1]!];
        return Math.hypot(p[a]! - p[b]!, p[a + 1]! - p[b + 1]!, p[a + 2]! - p[b + 2]!);
    };
    return {
        triangles: numbersWhere(sheets.triangleFaces.length, (t) => isLeft(sheets.triangleFaces[t]!)),
        lines: { curves, seams: within(lines.spans.seams, s), boundaries: within(lines.spans.boundaries, s), points: within(lines.spans.points, s) },
        vertices: numbersWhere(axis.radii.length, (v) => !scales || scales.vertices[v]! > s),
        faces: faces.length,
        sheets: scales ? connectedParts(axis.sizes.length, isLeft, geometry) : 0,
        sheetAreas,
        area: sheetAreas.reduce((sum, area) => sum + area, 0),
        curveLength: curves.reduce((sum, c) => sum + lengthOf(c), 0),
    };
}

/** The scale that a filtration is opened at: the middle of its plateau, in few digits. */
export const middleScale = (axis: Axis): number | null => axis.scales && Number(axis.scales.plateau.middle.toPrecision(4));

/** Up to which scale something changes in a filtration. */
export function lastScale(axis: Axis): number {
    const levels = axis.scales!.levels;
    const last = levels[levels.length - 1]!;
    const isLast = (level: typeof last) => level.balls === last.balls && level.area === last.area && level.curveLength === last.curveLength;
    return Math.max(levels.find(isLast)!.scale, Math.min(2, last.scale));
}
