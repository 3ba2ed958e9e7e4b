// SPDX-License-Identifier: Apache-2.0
// Reads what src/view/view_data.cpp has written. docs/dev/viewer.md describes the bytes.
import { curveVertices, sheetVertices } from './geometry';

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** A triangle mesh; positions relative to the model's origin. */
export interface Mesh {
    positions: Float32Array; // #V × 3
    corners: Uint32Array; // #F × 3
}

/** When the elements of a filtration vanish: at s is left what vanishes at a larger scale. Infinity: never. */
export interface Scales {
    vertices: Float64Array; // #V
    faces: Float64Array; // #F
    curves: Float64Array; // #C
    levels: { scale: number; sheets: number; balls: number; area: number; curveLength: number; volume: number }[]; // by ascending scale
    plateau: { begin: number; middle: number; end: number }; // the longest range over which hardly any area vanishes
}

/** A medial axis for one scale, or for all of them. */
export interface Axis {
    scale: number;
    scales: Scales | null; // of a filtration
    positions: Float32Array; // #V × 3, relative to the model's origin
    radii: Float32Array; // #V
    sizes: Uint32Array; // #F: corners of each face
    corners: Uint32Array; // of one face after the other
    sheets: Uint32Array; // #F
    angles: Float32Array; // #F: object angle in degrees, 0 where it is not known
    colors: Uint32Array; // #sheets: numbers of their colours; a sheet has the same one at all scales
    // Erosion thickness, Infinity where no fire comes: of the `sheetVertices`, then of the `curveVertices`.
    thicknesses: Float32Array;
    curves: Uint32Array; // #C × 2: edges without a face, and of a filtration those that outlive their faces
    surface: Mesh | null; // of the simplified shape
    statistics: Json;
}

/** Thickness of the solid at the vertices of its surface. */
export interface Thickness {
    local: Float32Array; // #V: diameter of the largest ball in the solid around the vertex
    foot: Float32Array; // #V: of the ball that touches there
    regions: Int32Array | null; // #V: the thin region of a vertex, -1 for none
    limit: number | null; // below which regions are thin
}

export type Vector = [number, number, number];

export interface Model {
    name: string;
    min: Vector; // the box around everything, in the units of the input
    max: Vector;
    origin: Vector; // its middle
    lengthUnit: string; // of the input, as "mm"; empty where it is not known
    statistics: Json;
    shape: Mesh | null;
    thickness: Thickness | null; // of the shape
    axes: Axis[]; // by ascending scale
}

export interface Page {
    title: string;
    layout: 'side-by-side' | 'contact-sheet';
}

/** The data of the page are not what they should be. */
export class DataError extends Error {}

const COARSE = 0xffff; // steps of numbers that are quantised: of meshes, angles and thicknesses
const FINE = 0xfffff; // of balls

interface ArrayEntry {
    type: 'u8' | 'u16' | 'u32' | 'f64';
    offset: number;
    count: number;
}

const WIDTH = { u8: 1, u16: 2, u32: 4, f64: 8 };

/** The bytes of one array, in order again: they are stored byte plane by byte plane. */
function gathered(bytes: Uint8Array, entry: ArrayEntry): Uint8Array<ArrayBuffer> {
    const width = WIDTH[entry.type];
    if (width === undefined) throw new DataError(`an array is of the unknown type ${entry.type}`);
    const isCount = (n: unknown) => Number.isSafeInteger(n) && (n as number) >= 0;
    if (!isCount(entry.offset) || !isCount(entry.count) || entry.offset + width * entry.count > bytes.length) {
        throw new DataError('an array does not lie within the data');
    }
    const result = new Uint8Array(width * entry.count);
    for (let plane = 0; plane < width; ++plane) {
        const start = entry.offset + plane * entry.count;
        for (let i = 0, at = plane; i < entry.count; ++i, at += width) result[at] = bytes[start + i]!;
    }
    return result;
}

/** Numbers as they are. */
function doubles(bytes: Uint8Array, entry: ArrayEntry): Float64Array {
    if (entry.type !== 'f64') throw new DataError(`scales are of the type ${entry.type}`);
    return new Float64Array(gathered(bytes, entry).buffer);
}

/** Integers, which are stored as differences d modulo the size of their type, as 2d or -2d - 1. */
function integers(bytes: Uint8Array, entry: ArrayEntry): Uint32Array {
    if (entry.type === 'f64') throw new DataError('an array of integers has none');
    const buffer = gathered(bytes, entry).buffer;
    const steps =
        entry.type === 'u8' ? new Uint8Array(buffer) : entry.type === 'u16' ? new Uint16Array(buffer) : new Uint32Array(buffer);
    const mask = 2 ** (8 * WIDTH[entry.type]) - 1;
    const values = new Uint32Array(entry.count);
    let value = 0;
    for (let i = 0; i < values.length; ++i) {
        const step = steps[i]!;
        value = ((value + (step & 1 ? ~(step >>> 1) : step >>> 1)) & mask) >>> 0;
        values[i] = value;
    }
    return values;
}

function checkIndices(indices: Uint32Array, count: number, what: string): void {
    for (const i of indices) {
        if (i >= count) throw new DataError(`${what} names vertex ${i} of ${count}`);
    }
}

/* eslint-disable @typescript-eslint/no-explicit-any -- the header is JSON; what it says is checked where it is used */
interface Box {
    min: Vector;
    max: Vector;
}

/** Points relative to the middle of the box, whose sides the three arrays divide into steps. */
function points(bytes: Uint8Array, entries: any, { min, max }: Box, steps: number): Float32Array {
    const coordinates = [0, 1, 2].map((k) => integers(bytes, entries[k]));
    const count = coordinates[0]!.length;
    const result = new Float32Array(3 * count);
    coordinates.forEach((values, k) => {
        if (values.length !== count) throw new DataError('a point lacks a coordinate');
        const size = max[k]! - min[k]!;
        for (let v = 0; v < count; ++v) result[3 * v + k] = (values[v]! / steps - 0.5) * size;
    });
    return result;
}

function readMesh(bytes: Uint8Array, entry: any, box: Box): Mesh | null {
    if (!entry) return null;
    const positions = points(bytes, entry.points, box, COARSE);
    const count = positions.length / 3;
    const corners = integers(bytes, entry.corners);
    if (corners.length % 3 !== 0) throw new DataError('a triangle lacks a corner');
    checkIndices(corners, count, 'a triangle');
    return { positions, corners };
}

function readThickness(bytes: Uint8Array, entry: any, shape: Mesh | null): Thickness | null {
    if (!entry) return null;
    const values = (array: ArrayEntry) => Float32Array.from(integers(bytes, array), (steps) => (entry.largest * steps) / COARSE);
    const thickness: Thickness = {
        local: values(entry.local),
        foot: values(entry.foot),
        regions: entry.regions && Int32Array.from(integers(bytes, entry.regions), (region) => region - 1),
        limit: entry.limit ?? null,
    };
    const count = (shape?.positions.length ?? 0) / 3;
    const { local, foot, regions } = thickness;
    if ([local, foot, regions ?? local].some((array) => array.length !== count) || local.some(Number.isNaN)) {
        throw new DataError('a vertex of the shape lacks its thickness');
    }
    return thickness;
}

function readScales(bytes: Uint8Array, entry: any): Scales | null {
    if (!entry) return null;
    const scales: Scales = {
        vertices: doubles(bytes, entry.vertices),
        faces: doubles(bytes, entry.faces),
        curves: doubles(bytes, entry.curves),
        levels: entry.levels.map(([scale, sheets, balls, area, curveLength, volume]: number[]) => ({ scale, sheets, balls, area, curveLength, volume })),
        plateau: { begin: entry.plateau[0], middle: entry.plateau[1], end: entry.plateau[2] },
    };
    const numbers = [...scales.levels.flatMap((level) => Object.values(level)), ...Object.values(scales.plateau)];
    if (scales.levels.length === 0 || !numbers.every(Number.isFinite)) throw new DataError('a filtration has no levels');
    return scales;
}

function readAxis(bytes: Uint8Array, entry: any, box: Box): Axis {
    const diagonal = Math.hypot(...box.max.map((b, k) => b - box.min[k]!));
    const axis: Axis = {
        scale: entry.scale,
        scales: readScales(bytes, entry.scales),
        positions: points(bytes, entry.points, box, FINE),
        radii: Float32Array.from(integers(bytes, entry.radii), (steps) => (diagonal * steps) / FINE),
        sizes: integers(bytes, entry.sizes),
        corners: integers(bytes, entry.corners),
        sheets: integers(bytes, entry.sheets),
        angles: Float32Array.from(integers(bytes, entry.angles), (steps) => (90 * steps) / COARSE),
        colors: integers(bytes, entry.colors),
        thicknesses: Float32Array.from(integers(bytes, entry.thicknesses), (steps) =>
            steps === COARSE ? Infinity : (entry.largest_thickness * steps) / (COARSE - 1)),
        curves: integers(bytes, entry.curves),
        surface: readMesh(bytes, entry.surface, box),
        statistics: entry.statistics ?? null,
    };
    const faces = axis.sizes.length;
    if (typeof axis.scale !== 'number' || !(axis.scale > 0)) throw new DataError('an axis has no scale');
    if (axis.positions.length !== 3 * axis.radii.length) throw new DataError('an axis has vertices without a radius');
    if (axis.sheets.length !== faces || axis.angles.length !== faces) throw new DataError('a face lacks its sheet or angle');
    if (axis.sizes.reduce((sum, n) => sum + n, 0) !== axis.corners.length) throw new DataError('a face lacks a corner');
    if (axis.sizes.some((n) => n < 3)) throw new DataError('a face has fewer than three corners');
    if (axis.curves.length % 2 !== 0) throw new DataError('a curve lacks an end');
    const { scales } = axis;
    if (scales && (scales.vertices.length !== axis.radii.length || scales.faces.length !== faces || scales.curves.length !== axis.curves.length / 2)) {
        throw new DataError('an element of a filtration lacks its scale');
    }
    checkIndices(axis.corners, axis.radii.length, 'a face');
    checkIndices(axis.curves, axis.radii.length, 'a curve');
    const { starts, vertices } = sheetVertices(axis);
    if (axis.colors.length < starts.length - 1) throw new DataError('a sheet lacks its colour');
    const thicknesses = vertices.length + curveVertices(axis).length;
    if (axis.thicknesses.length !== thicknesses || axis.thicknesses.some(Number.isNaN)) {
        throw new DataError('a vertex lacks its erosion thickness');
    }
    return axis;
}

/** The model in bytes that are no longer compressed. \throws DataError */
export function readModel(bytes: Uint8Array): Model {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (bytes.length < 12 || String.fromCharCode(...bytes.subarray(0, 4)) !== 'SAXV') {
        throw new DataError('they do not begin as a model of scaleaxis does');
    }
    const version = view.getUint32(4, true);
    if (version !== 4) throw new DataError(`they are of version ${version}, this page reads version 4`);
    const end = 12 + view.getUint32(8, true);
    if (end > bytes.length) throw new DataError('they end within their header');
    let header: any;
    try {
        header = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes.subarray(12, end)));
    } catch {
        throw new DataError('their header is not JSON');
    }
    const isVector = (v: unknown) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
    if (!isVector(header?.min) || !isVector(header?.max) || !Array.isArray(header?.axes)) {
        throw new DataError('their header lacks the box or the axes');
    }
    const { min, max } = header as { min: Vector; max: Vector };
    const origin = min.map((a, k) => (a + max[k]!) / 2) as Vector;
    const arrays = bytes.subarray(end);
    try {
        const shape = readMesh(arrays, header.shape, { min, max });
        return {
            name: String(header.name),
            min,
            max,
            origin,
            lengthUnit: typeof header.statistics?.unit === 'string' ? header.statistics.unit : '',
            statistics: header.statistics ?? null,
            shape,
            thickness: readThickness(arrays, header.thickness, shape),
            axes: header.axes
                .map((entry: any) => readAxis(arrays, entry, { min, max }))
                .sort((a: Axis, b: Axis) => a.scale - b.scale),
        };
    } catch (error) {
        if (error instanceof TypeError) throw new DataError('their header lacks an array');
        throw error;
    }
}
/* eslint-enable */

function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
    let binary: string;
    try {
        binary = atob(text.trim());
    } catch {
        throw new DataError('they are not base64');
    }
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
    return bytes;
}

async function inflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
    try {
        const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
        return new Uint8Array(await new Response(stream).arrayBuffer());
    } catch {
        throw new DataError('they are damaged: they cannot be decompressed');
    }
}

/** The model in the text of a script element. \throws DataError */
export async function decodeModel(text: string): Promise<Model> {
    return readModel(await inflated(bytesOfBase64(text)));
}
