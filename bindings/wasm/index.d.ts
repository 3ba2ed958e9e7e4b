// SPDX-License-Identifier: Apache-2.0
// Medial axes in browsers and in Node. All lengths are in units of the input, but where options say otherwise.

/** The bytes of a file. Without a `name` a `File` has its own. */
export type FileContent = Uint8Array | ArrayBuffer | File | Blob;

/** How a call runs. */
export interface Execution {
    /** Name of the file in messages; its extension tells the format where the bytes do not. */
    name?: string;
    /** Cancels the call, which then throws the reason of the signal. */
    signal?: AbortSignal;
    /** Called now and then; `fraction` runs from 0 to 1. */
    progress?: (stage: string, fraction: number) => void;
}

/** How a file becomes a solid. An option of another kind of input than the file's is refused. */
export interface InputOptions {
    /** What the file holds, where its content does not tell. */
    kind?: 'mesh' | 'image' | 'points' | 'balls';
    /** Of meshes: what the triangles make solid. */
    triangles?: 'auto' | 'winding' | 'wrap' | 'thicken';
    /** Of `wrap`: the diameter of the ball. */
    opening?: number;
    /** Of `thicken`: twice the distance from the triangles. */
    thickness?: number;
    /** Of files with several objects: which, from 1. */
    objects?: number | number[];
    /** Of images: the solid is above this value. */
    iso?: number;
    /** With `iso`: it is below. */
    below?: boolean;
    /** Of label images: the labels that are solid, by number or by name. */
    labels?: number | string | (number | string)[];
    /** Of images: all voxels other than 0 are solid. */
    nonzero?: boolean;
    /** Of masks and labels: standard deviation of the Gaussian, in voxels; 0: none. */
    maskSmoothing?: number;
    /** Of masks and labels: whether voids, spaces enclosed by the solid, become solid. */
    fillVoids?: boolean;
    /** Of points: how they become a solid; default: what suits them. */
    points?: 'mls' | 'crust';
    /** Of `mls`: radius of the weights' support, in spacings of the points. */
    kernel?: number;
}

/** How the axis is computed. */
export interface PipelineOptions extends InputOptions {
    /** Tolerance δ of the sampling, relative to the diagonal of the bounding box. Default: 0.01. */
    delta?: number;
    /** The same as a length. */
    deltaAbs?: number;
    /** Scales s, 1 and above: 1 keeps every feature. Default: 1.1. */
    scale?: number | number[];
    union?: 'fitted' | 'polar';
    sampling?: 'adaptive' | 'uniform';
    /** Object angle below which sheets are spurious, in degrees; 0 keeps all. */
    angle?: number;
    /** Whether sheets go on into convex sharp edges of the solid. Default: true. */
    sharp?: boolean;
    /** Least angle between the normals at such an edge, in degrees. */
    sharpAngle?: number;
    /** Erosion thickness below which parts of sheets are spurious, relative to the diagonal. Default: half of δ. */
    clean?: number;
    cleanAbs?: number;
    /** Whether the axis is simplified to few vertices; asked for by `error` and `vertices`, too. */
    compact?: boolean;
    /** Largest error of the compact axis, relative to the diagonal. Default: a quarter of δ. */
    error?: number;
    errorAbs?: number;
    /** Number of vertices of the compact axis. */
    vertices?: number;
    dense?: boolean;
    /** Rounds of smoothing. */
    smooth?: number;
    /** Whether the balls are made to touch the solid. Default: true. */
    center?: boolean;
    seed?: number;
}

/** What is made of the results. */
export interface OutputOptions<Format extends string> {
    /** Files that the result holds in `files`, the same bytes as the program writes. */
    formats?: Format | Format[];
    /** Whether the result holds the data that the interactive page shows in `view`: docs/dev/viewer.md. */
    view?: boolean;
}

export type AxisFormat = 'ply' | 'ma' | 'vtp' | 'obj' | 'glb';
export type FiltrationFormat = 'ply' | 'vtp';
export type SurfaceFormat = 'ply' | 'vtp' | 'glb';
export type SkeletonFormat = 'swc' | 'csv' | 'graphml' | 'json' | 'vtp' | 'ply';

export type AxisOptions = Execution & PipelineOptions & OutputOptions<AxisFormat>;
export type FiltrationOptions = Execution & Omit<PipelineOptions, 'scale'> & OutputOptions<FiltrationFormat>;
export interface ThicknessOptions extends Execution, PipelineOptions, OutputOptions<SurfaceFormat> {
    /** Least angle between two contacts of a ball for which it counts, in degrees; 0: all balls. Default: 120. */
    contactAngle?: number;
    /** Longest edge of the surface, relative to its diagonal; 0: leave it as it is. Default: 0.01. */
    edge?: number;
}
export interface SkeletonOptions extends Execution, Omit<PipelineOptions, 'sharp' | 'sharpAngle'>, OutputOptions<SkeletonFormat> {
    /** Distance of the nodes along branches, at most, relative to the diagonal. Default: 0.01. */
    nodeSpacing?: number;
    /** How far a branch sticks out of the others to stay, relative to its own radius. Default: 1. */
    significance?: number;
    /** Of a node: of the largest ball in the solid, or the mean distance to its surface. */
    radius?: 'inscribed' | 'mean';
}

/** Lists of different lengths: list `i` is `items.slice(offsets[i], offsets[i + 1])`. */
export interface Lists {
    offsets: Int32Array;
    items: Int32Array;
}

/** Balls, and the edges and polygons between them. */
export interface MedialComplex {
    /** Centres: 3 numbers each. */
    vertices: Float64Array;
    radii: Float64Array;
    /** All edges, those of faces too: 2 vertices each. */
    edges: Int32Array;
    /** Polygons: their vertices in cyclic order. */
    faces: Lists;
    faceSheets: Int32Array;
    /** Object angles in degrees. */
    faceAngles: Float64Array;
    /** How many sheets there are. */
    sheets: number;
    /** The same faces as triangles: 3 vertices each, and the sheet of each. */
    triangles: Int32Array;
    triangleSheets: Int32Array;
}

/** Keys as in docs/statistics.md. */
export type Statistics = { [key: string]: unknown };

interface Made {
    statistics: Statistics;
    files: { [format: string]: Uint8Array };
    view?: Uint8Array;
}

export interface AxisAtScale extends MedialComplex {
    scale: number;
    statistics: Statistics;
    files: { [format: string]: Uint8Array };
}

export interface AxisResult {
    /** One for each scale. */
    axes: AxisAtScale[];
    /** The union of balls that approximates the solid: centre and radius of each, 4 numbers. */
    balls: Float64Array;
    statistics: Statistics;
    view?: Uint8Array;
}

/** The axis at s = 1, and the scales at which its elements vanish. */
export interface FiltrationResult extends MedialComplex, Made {
    vertexScales: Float64Array;
    edgeScales: Float64Array;
    faceScales: Float64Array;
    levels: Statistics[];
    /** The range of scales over which the sheets change least. */
    plateau: { begin: number; end: number; middle: number };
}

/** A surface, and the thickness at each of its vertices. */
export interface ThicknessResult extends Made {
    vertices: Float64Array;
    triangles: Int32Array;
    /** Diameter of the largest ball in the solid that contains the vertex. */
    local: Float64Array;
    /** Diameter of the ball that touches the surface there. */
    foot: Float64Array;
}

/** Curves with radii, of the same homotopy type as the solid. */
export interface SkeletonResult extends Made {
    nodes: Float64Array;
    radii: Float64Array;
    edges: Int32Array;
    /** Nodes of each branch from one end or junction to the next. */
    branches: Lists;
    nodeBranches: Int32Array;
    /** Of sheets around voids. */
    faces: Lists;
}

/** An error of the library. `code` is one of docs/diagnostics.md, or `memory`, `crash`, `cancelled`. */
export class ScaleAxisError extends Error {
    readonly code: string;
    /** The kind of element that it is about: "line", "triangle", "ball". */
    readonly element: string | null;
    readonly index: number | null;
    /** Where it lies, in units of the input. */
    readonly place: [number, number, number] | null;
    /** Options that would help. */
    readonly hints: { option: string; value?: string }[];
}

/** Discrete scale axis of a mesh, a 3D image or a point cloud. */
export function axis(file: FileContent, options?: AxisOptions): Promise<AxisResult>;
/** The axis at all scales. */
export function filtration(file: FileContent, options?: FiltrationOptions): Promise<FiltrationResult>;
/** Thickness at the surface of a solid. */
export function thickness(file: FileContent, options?: ThicknessOptions): Promise<ThicknessResult>;
/** Curve skeleton of a solid. */
export function skeleton(file: FileContent, options?: SkeletonOptions): Promise<SkeletonResult>;
/** An axis, PLY or .ma, in another format. */
export function convert(file: FileContent, format: AxisFormat, options?: Execution): Promise<Uint8Array>;
/** Of the library. */
export function version(): Promise<string>;

/** The same functions in a worker of their own. Calls of one object run one after the other. */
export class ScaleAxis {
    /** Where `scaleaxis.wasm` and `worker.js` are; default: beside this module. In browsers a function may start the worker. */
    constructor(source?: { wasm?: URL | string | BufferSource | WebAssembly.Module; worker?: URL | string | (() => Worker) });
    axis: typeof axis;
    filtration: typeof filtration;
    thickness: typeof thickness;
    skeleton: typeof skeleton;
    convert: typeof convert;
    version: typeof version;
    /** Ends the worker, and rejects the call that it works on. Another call starts it again. */
    close(): void;
}
