// SPDX-License-Identifier: Apache-2.0
// From an axis as polygons to what is drawn: triangles with smooth normals, and lines. Plain arrays in, plain arrays out.
import type { Axis, Mesh, Thickness } from './data';

/** The faces of an axis as triangles, sheet after sheet. Every sheet has vertices of its own: its `sheetVertices`. */
export interface SheetMesh {
    vertices: Uint32Array; // the vertex of the axis that each vertex of the mesh is
    vertexSheets: Uint32Array;
    vertexAngles: Float32Array; // the mean over the faces around it
    vertexThicknesses: Float32Array;
    normals: Float32Array;
    triangles: Uint32Array; // #T × 3
    triangleFaces: Uint32Array; // #T: the face that it is a part of
    sheetStarts: Uint32Array; // #sheets + 1: the first triangle of each
}

/** From which scale on, and up to which one, something is there. */
export interface Spans {
    from: Float64Array;
    to: Float64Array;
}

/** Lines between vertices of the axis. Of a filtration an edge may be several of these, one after the other. */
export interface AxisLines {
    curves: Uint32Array; // edges without a face
    seams: Uint32Array; // edges of three faces or more, or of two sheets
    boundaries: Uint32Array; // edges of one face
    boundarySheets: Uint32Array; // #boundaries
    points: Uint32Array; // vertices without an edge
    spans: { curves: Spans; seams: Spans; boundaries: Spans; points: Spans };
}

export interface AxisGeometry {
    sheets: SheetMesh;
    lines: AxisLines;
    thicknesses: Float32Array; // #V: erosion thickness, the largest of the sheets and curves there
    faceAreas: Float64Array; // #F
    edgeStarts: Uint32Array; // #edges with faces + 1, in
    edgeFaces: Uint32Array; // the faces around each edge, those that vanish last first
}

/** Where each of `count` groups begins if items, each with its group, are sorted by group; and the sorted items. */
function grouped(groups: Uint32Array, count: number): { starts: Uint32Array; items: Uint32Array } {
    const starts = new Uint32Array(count + 1);
    for (const g of groups) ++starts[g + 1]!;
    for (let g = 0; g < count; ++g) starts[g + 1]! += starts[g]!;
    const next = starts.slice(0, count);
    const items = new Uint32Array(groups.length);
    for (let i = 0; i < groups.length; ++i) items[next[groups[i]!]!++] = i;
    return { starts, items };
}

/** Where the corners of each face begin. */
function faceStarts(axis: Axis): Uint32Array {
    const starts = new Uint32Array(axis.sizes.length + 1);
    axis.sizes.forEach((size, f) => (starts[f + 1] = starts[f]! + size));
    return starts;
}

const sheetCountOf = (axis: Axis) => axis.sheets.reduce((most, s) => Math.max(most, s + 1), 0);

/** The vertices of each sheet in ascending order, one sheet after the other. */
export function sheetVertices(axis: Axis): { starts: Uint32Array; vertices: Uint32Array } {
    const count = sheetCountOf(axis);
    const corners = faceStarts(axis);
    const bySheet = grouped(axis.sheets, count);
    const starts = new Uint32Array(count + 1);
    const vertices = new Uint32Array(axis.corners.length); // as many as there can be
    const lastSheet = new Int32Array(axis.radii.length).fill(-1);
    let end = 0;
    for (let s = 0; s < count; ++s) {
        for (const f of bySheet.items.subarray(bySheet.starts[s]!, bySheet.starts[s + 1]!)) {
            for (const v of axis.corners.subarray(corners[f]!, corners[f + 1]!)) {
                if (lastSheet[v] === s) continue;
                lastSheet[v] = s;
                vertices[end++] = v;
            }
        }
        vertices.subarray(starts[s]!, end).sort();
        starts[s + 1] = end;
    }
    return { starts, vertices: vertices.slice(0, end) };
}

/** The vertices of curves, and those without a face, in ascending order. */
export function curveVertices(axis: Axis): Uint32Array {
    const counts = new Uint8Array(axis.radii.length).fill(1);
    for (const v of axis.corners) counts[v] = 0;
    for (const v of axis.curves) counts[v] = 1;
    return Uint32Array.from(counts.keys()).filter((v) => counts[v]);
}

/** The sides of all faces: side `i` goes from corner `i` to the next one of its face. */
function sidesOf(axis: Axis): { face: Uint32Array; from: Uint32Array; to: Uint32Array } {
    const count = axis.corners.length;
    const face = new Uint32Array(count);
    const to = new Uint32Array(count);
    let start = 0;
    axis.sizes.forEach((size, f) => {
        for (let k = 0; k < size; ++k) {
            face[start + k] = f;
            to[start + k] = axis.corners[start + ((k + 1) % size)]!;
        }
        start += size;
    });
    return { face, from: axis.corners, to };
}

/** Triangles, normals and lines of an axis. */
export function axisGeometry(axis: Axis): AxisGeometry {
    const { face, from, to } = sidesOf(axis);
    const sideCount = from.length;
    const vertexCount = axis.radii.length;

    // Sides that are one edge: those with the same lower end, and among these the same upper one.
    const lower = from.map((a, i) => Math.min(a, to[i]!));
    const upper = from.map((a, i) => Math.max(a, to[i]!));
    const byLower = grouped(lower, vertexCount);
    const mate = new Int32Array(sideCount).fill(-1); // the other side of an edge inside a sheet
    const boundarySheets: number[] = [];
    const lists = () => ({ ends: [] as number[], from: [] as number[], to: [] as number[] });
    const [seams, boundaries, curves] = [lists(), lists(), lists()];
    const add = (list: typeof seams, a: number, b: number, from: number, to: number) => {
        list.ends.push(a, b);
        list.from.push(from);
        list.to.push(to);
    };
    const { scales } = axis;
    const end = (f: number) => (scales ? scales.faces[f]! : Infinity);
    const edgeEnds = new Map<number, number>(); // of edges that outlive their faces: when the last face vanishes
    axis.curves.forEach((v, i) => i % 2 === 0 && edgeEnds.set(edgeKey(v, axis.curves[i + 1]!), 0));
    const vertexEnds = new Float64Array(vertexCount); // when the last edge vanishes
    const edgeStarts = [0];
    const edgeFaces = new Uint32Array(sideCount);
    let listed = 0;
    for (let v = 0; v < vertexCount; ++v) {
        const sides = byLower.items.subarray(byLower.starts[v]!, byLower.starts[v + 1]!);
        sides.sort((a, b) => upper[a]! - upper[b]! || a - b);
        for (let i = 0; i < sides.length; ) {
            const first = sides[i]!;
            let next = i + 1;
            while (next < sides.length && upper[sides[next]!] === upper[first]) ++next;
            const count = next - i;
            const w = upper[first]!;
            const faces = Array.from(sides.subarray(i, next), (side) => face[side]!);
            if (scales) faces.sort((f, g) => end(g) - end(f) || f - g);
            edgeFaces.set(faces, listed);
            edgeStarts.push((listed += count));
            const [last, second, third] = faces.slice(0, 3).map(end) as [number, number, number]; // when these vanish
            const isInSheet = count === 2 && axis.sheets[faces[0]!] === axis.sheets[faces[1]!];
            if (isInSheet) {
                mate[first] = sides[i + 1]!;
                mate[sides[i + 1]!] = first;
            } else if (count >= 2) {
                add(seams, v, w, 0, count === 2 ? second : third);
            }
            if (count === 1 || last > second) {
                add(boundaries, v, w, count === 1 ? 0 : second, last);
                boundarySheets.push(axis.sheets[faces[0]!]!);
            }
            if (edgeEnds.has(edgeKey(v, w))) edgeEnds.set(edgeKey(v, w), last);
            for (const x of [v, w]) vertexEnds[x] = Math.max(vertexEnds[x]!, last);
            i = next;
        }
    }

    for (let i = 0; i < axis.curves.length; i += 2) {
        const [a, b] = [axis.curves[i]!, axis.curves[i + 1]!];
        const to = scales ? scales.curves[i / 2]! : Infinity;
        add(curves, a, b, edgeEnds.get(edgeKey(a, b))!, to);
        for (const x of [a, b]) vertexEnds[x] = Math.max(vertexEnds[x]!, to);
    }
    const vertexEnd = (v: number) => (scales ? scales.vertices[v]! : Infinity);
    const points = Uint32Array.from([...vertexEnds.keys()].filter((v) => vertexEnd(v) > vertexEnds[v]!));

    const { sheets, faceAreas } = sheetMesh(axis, face, from, mate);
    const thicknesses = new Float32Array(vertexCount);
    sheets.vertices.forEach((v, c) => (thicknesses[v] = Math.max(thicknesses[v]!, sheets.vertexThicknesses[c]!)));
    curveVertices(axis).forEach((v, i) => (thicknesses[v] = axis.thicknesses[sheets.vertices.length + i]!));
    return {
        sheets,
        faceAreas,
        thicknesses,
        lines: {
            curves: axis.curves,
            seams: Uint32Array.from(seams.ends),
            boundaries: Uint32Array.from(boundaries.ends),
            boundarySheets: Uint32Array.from(boundarySheets),
            points,
            spans: {
                curves: spansOf(curves),
                seams: spansOf(seams),
                boundaries: spansOf(boundaries),
                points: { from: Float64Array.from(points, (v) => vertexEnds[v]!), to: Float64Array.from(points, vertexEnd) },
            },
        },
        edgeStarts: Uint32Array.from(edgeStarts),
        edgeFaces,
    };
}

const edgeKey = (a: number, b: number) => Math.min(a, b) * 2 ** 26 + Math.max(a, b);
const spansOf = ({ from, to }: { from: number[]; to: number[] }): Spans => ({ from: Float64Array.from(from), to: Float64Array.from(to) });

/** Which faces have to be turned so that neighbours within a sheet agree (where the sheet has two sides). */
function turnedFaces(axis: Axis, starts: Uint32Array, face: Uint32Array, from: Uint32Array, mate: Int32Array): Uint8Array {
    const turned = new Uint8Array(axis.sizes.length);
    const isDone = new Uint8Array(axis.sizes.length);
    const queue: number[] = [];
    for (let seed = 0; seed < isDone.length; ++seed) {
        if (isDone[seed]) continue;
        isDone[seed] = 1;
        queue.push(seed);
        while (queue.length > 0) {
            const f = queue.pop()!;
            for (let side = starts[f]!; side < starts[f + 1]!; ++side) {
                const other = mate[side]!;
                if (other < 0 || isDone[face[other]!]) continue;
                // Neighbours that agree walk their common edge in opposite directions.
                const disagrees = from[side] === from[other];
                turned[face[other]!] = turned[f]! ^ (disagrees ? 1 : 0);
                isDone[face[other]!] = 1;
                queue.push(face[other]!);
            }
        }
    }
    return turned;
}

function sheetMesh(axis: Axis, face: Uint32Array, from: Uint32Array, mate: Int32Array): { sheets: SheetMesh; faceAreas: Float64Array } {
    const faceCount = axis.sizes.length;
    const sheetCount = sheetCountOf(axis);
    const starts = faceStarts(axis);
    const turned = turnedFaces(axis, starts, face, from, mate);
    const bySheet = grouped(axis.sheets, sheetCount);
    const { starts: copyStarts, vertices } = sheetVertices(axis);
    const copies = vertices.length;

    const triangleCount = axis.corners.length - 2 * faceCount;
    const triangles = new Uint32Array(3 * triangleCount);
    const triangleFaces = new Uint32Array(triangleCount);
    const sheetStarts = new Uint32Array(sheetCount + 1);
    const faceAreas = new Float64Array(faceCount);
    const vertexSheets = new Uint32Array(copies);
    const vertexAngles = new Float32Array(copies);
    const faceCounts = new Uint32Array(copies);
    const normals = new Float32Array(3 * copies);
    const copyOf = new Uint32Array(axis.radii.length); // of a vertex in the sheet at hand
    const p = axis.positions;
    let t = 0;
    for (let s = 0; s < sheetCount; ++s) {
        vertexSheets.fill(s, copyStarts[s]!, copyStarts[s + 1]!);
        for (let c = copyStarts[s]!; c < copyStarts[s + 1]!; ++c) copyOf[vertices[c]!] = c;
        for (let i = bySheet.starts[s]!; i < bySheet.starts[s + 1]!; ++i) {
            const f = bySheet.items[i]!;
            const corners = axis.corners.subarray(starts[f]!, starts[f + 1]!);
            let nx = 0, ny = 0, nz = 0; // twice the area vector
            const o = 3 * corners[0]!;
            for (let k = 1; k + 1 < corners.length; ++k) {
                const a = 3 * corners[k]!, b = 3 * corners[k + 1]!;
                const ax = p[a]! - p[o]!, ay = p[a + 1]! - p[o + 1]!, az = p[a + 2]! - p[o + 2]!;
                const bx = p[b]! - p[o]!, by = p[b + 1]! - p[o + 1]!, bz = p[b + 2]! - p[o + 2]!;
                nx += ay * bz - az * by;
                ny += az * bx - ax * bz;
                nz += ax * by - ay * bx;
            }
            faceAreas[f] = Math.hypot(nx, ny, nz) / 2;
            const sign = turned[f] ? -1 : 1;
            for (const v of corners) {
                const c = copyOf[v]!;
                normals[3 * c]! += sign * nx;
                normals[3 * c + 1]! += sign * ny;
                normals[3 * c + 2]! += sign * nz;
                vertexAngles[c]! += axis.angles[f]!;
                ++faceCounts[c]!;
            }
            for (let k = 1; k + 1 < corners.length; ++k) {
                const [b, c] = turned[f] ? [k + 1, k] : [k, k + 1];
                triangles[3 * t] = copyOf[corners[0]!]!;
                triangles[3 * t + 1] = copyOf[corners[b]!]!;
                triangles[3 * t + 2] = copyOf[corners[c]!]!;
                triangleFaces[t++] = f;
            }
        }
        sheetStarts[s + 1] = t;
    }
    for (let c = 0; c < copies; ++c) vertexAngles[c]! /= faceCounts[c]!;
    normalize(normals);
    const vertexThicknesses = axis.thicknesses.slice(0, copies);
    return { sheets: { vertices, vertexSheets, vertexAngles, vertexThicknesses, normals, triangles, triangleFaces, sheetStarts }, faceAreas };
}

function normalize(vectors: Float32Array): void {
    for (let i = 0; i < vectors.length; i += 3) {
        const length = Math.hypot(vectors[i]!, vectors[i + 1]!, vectors[i + 2]!) || 1;
        for (let k = 0; k < 3; ++k) vectors[i + k]! /= length;
    }
}

/** Normals of the vertices of a mesh, weighted by area. */
export function meshNormals(mesh: Mesh): Float32Array {
    const p = mesh.positions;
    const normals = new Float32Array(p.length);
    for (let t = 0; t < mesh.corners.length; t += 3) {
        const a = 3 * mesh.corners[t]!, b = 3 * mesh.corners[t + 1]!, c = 3 * mesh.corners[t + 2]!;
        const ux = p[b]! - p[a]!, uy = p[b + 1]! - p[a + 1]!, uz = p[b + 2]! - p[a + 2]!;
        const vx = p[c]! - p[a]!, vy = p[c + 1]! - p[a + 1]!, vz = p[c + 2]! - p[a + 2]!;
        const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        for (const v of [a, b, c]) for (let k = 0; k < 3; ++k) normals[v + k]! += n[k]!;
    }
    normalize(normals);
    return normals;
}

/**
 * The length of the branch that an edge of a curve is on: up to the next end, junction or sheet on either side, or all
 * around a loop. \param edges numbers of the curves that are there \param isOnSheet of vertices
 */
export function branchLength(axis: Axis, edges: Uint32Array, isOnSheet: (vertex: number) => boolean, edge: number): number {
    const around = new Map<number, number[]>();
    const endsOf = (e: number) => [axis.curves[2 * e]!, axis.curves[2 * e + 1]!] as const;
    for (const e of edges) {
        for (const v of endsOf(e)) {
            const others = around.get(v);
            if (others) others.push(e);
            else around.set(v, [e]);
        }
    }
    const p = axis.positions;
    const lengthOf = (e: number) => {
        const [a, b] = endsOf(e).map((v) => 3 * v) as [number, number];
        return Math.hypot(p[a]! - p[b]!, p[a + 1]! - p[b + 1]!, p[a + 2]! - p[b + 2]!);
    };
    let length = lengthOf(edge);
    for (const start of endsOf(edge)) {
        for (let v = start, last = edge; ; ) {
            const next = around.get(v)!;
            if (next.length !== 2 || isOnSheet(v)) break;
            last = next[0] === last ? next[1]! : next[0]!;
            if (last === edge) return length; // a loop
            length += lengthOf(last);
            const [a, b] = endsOf(last);
            v = a === v ? b : a;
        }
    }
    return length;
}

/** The border of the thin regions of a surface, two points a line; between vertices where the limit is, or halfway. */
export function regionBorders(mesh: Mesh, { local, regions, limit }: Thickness): Float32Array {
    const points: number[] = [];
    const isThin = (v: number) => regions![v]! >= 0;
    for (let t = 0; regions && t < mesh.corners.length; t += 3) {
        for (let k = 0; k < 3; ++k) {
            // The corner that differs from both others.
            const [a, b, c] = [0, 1, 2].map((i) => mesh.corners[t + ((k + i) % 3)]!) as [number, number, number];
            if (isThin(b) !== isThin(c) || isThin(a) === isThin(b)) continue;
            for (const other of [b, c]) {
                const part = limit === null ? 0.5 : Math.min(1, Math.max(0, (limit - local[a]!) / (local[other]! - local[a]!)));
                for (let i = 0; i < 3; ++i) {
                    const from = mesh.positions[3 * a + i]!;
                    points.push(from + part * (mesh.positions[3 * other + i]! - from));
                }
            }
        }
    }
    return Float32Array.from(points);
}

/** Items at `indices`, `size` numbers each. */
export function gather(values: Float32Array, indices: Uint32Array, size: number): Float32Array {
    const result = new Float32Array(size * indices.length);
    for (let i = 0; i < indices.length; ++i) {
        for (let k = 0; k < size; ++k) result[size * i + k] = values[size * indices[i]! + k]!;
    }
    return result;
}
