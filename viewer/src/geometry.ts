// SPDX-License-Identifier: Apache-2.0
// From an axis as polygons to what is drawn: triangles with smooth normals, and lines. Plain arrays in, plain arrays out.
import type { Axis, Mesh } from './data';

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
    sheetAreas: Float64Array;
}

/** Lines between vertices of the axis. */
export interface AxisLines {
    curves: Uint32Array; // edges without a face
    seams: Uint32Array; // edges of three faces or more, or of two sheets
    boundaries: Uint32Array; // edges of one face
    boundarySheets: Uint32Array; // #boundaries
    points: Uint32Array; // vertices without an edge
}

export interface AxisGeometry {
    sheets: SheetMesh;
    lines: AxisLines;
    thicknesses: Float32Array; // #V: erosion thickness, the largest of the sheets and curves there
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
    const seams: number[] = [];
    const boundaries: number[] = [];
    const boundarySheets: number[] = [];
    for (let v = 0; v < vertexCount; ++v) {
        const sides = byLower.items.subarray(byLower.starts[v]!, byLower.starts[v + 1]!);
        sides.sort((a, b) => upper[a]! - upper[b]! || a - b);
        for (let i = 0; i < sides.length; ) {
            const first = sides[i]!;
            let end = i + 1;
            while (end < sides.length && upper[sides[end]!] === upper[first]) ++end;
            const second = sides[i + 1]!;
            if (end - i === 1) {
                boundaries.push(v, upper[first]!);
                boundarySheets.push(axis.sheets[face[first]!]!);
            } else if (end - i === 2 && axis.sheets[face[first]!] === axis.sheets[face[second]!]) {
                mate[first] = second;
                mate[second] = first;
            } else {
                seams.push(v, upper[first]!);
            }
            i = end;
        }
    }

    const hasEdge = new Uint8Array(vertexCount);
    for (const v of axis.corners) hasEdge[v] = 1;
    for (const v of axis.curves) hasEdge[v] = 1;
    const points: number[] = [];
    hasEdge.forEach((has, v) => has || points.push(v));

    const sheets = sheetMesh(axis, face, from, mate);
    const thicknesses = new Float32Array(vertexCount);
    sheets.vertices.forEach((v, c) => (thicknesses[v] = Math.max(thicknesses[v]!, sheets.vertexThicknesses[c]!)));
    curveVertices(axis).forEach((v, i) => (thicknesses[v] = axis.thicknesses[sheets.vertices.length + i]!));
    return {
        sheets,
        thicknesses,
        lines: {
            curves: axis.curves,
            seams: Uint32Array.from(seams),
            boundaries: Uint32Array.from(boundaries),
            boundarySheets: Uint32Array.from(boundarySheets),
            points: Uint32Array.from(points),
        },
    };
}

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

function sheetMesh(axis: Axis, face: Uint32Array, from: Uint32Array, mate: Int32Array): SheetMesh {
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
    const sheetAreas = new Float64Array(sheetCount);
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
            sheetAreas[s]! += Math.hypot(nx, ny, nz) / 2;
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
    return {
        vertices,
        vertexSheets,
        vertexAngles,
        vertexThicknesses: axis.thicknesses.slice(0, copies),
        normals,
        triangles,
        triangleFaces,
        sheetStarts,
        sheetAreas,
    };
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

/** Items at `indices`, `size` numbers each. */
export function gather(values: Float32Array, indices: Uint32Array, size: number): Float32Array {
    const result = new Float32Array(size * indices.length);
    for (let i = 0; i < indices.length; ++i) {
        for (let k = 0; k < size; ++k) result[size * i + k] = values[size * indices[i]! + k]!;
    }
    return result;
}
