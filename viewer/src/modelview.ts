// SPDX-License-Identifier: Apache-2.0
// One model as a three.js scene, kept in step with the state.
import {
    BufferAttribute, BufferGeometry, Group, IcosahedronGeometry, InstancedBufferAttribute,
    InstancedBufferGeometry, Mesh as SceneMesh, Scene, type ShaderMaterial,
} from 'three';
import { mergeVertices } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import { colorTable, sheetColor, type Rgb } from './colors';
import type { Axis, Mesh, Model } from './data';
import { axisGeometry, gather, meshNormals, regionBorders, type AxisGeometry } from './geometry';
import { levelAt, middleScale, type Level } from './level';
import { ballMaterial, HAS_CUT, lineMaterial, surfaceMaterial } from './materials';
import { closestOf, LINES, openingScale, type LineName, type State } from './state';

export interface Palette {
    shape: Rgb;
    surface: Rgb;
    plain: Rgb; // the axis in one colour
    line: Rgb; // seams and boundaries
    curve: Rgb;
    marked: Rgb; // the boundary of the picked sheet
    ball: Rgb; // of what is picked
    thin: Rgb; // the border of thin regions
    faded: Rgb; // what is not marked tends towards it
}

export const PALETTES: Record<'light' | 'dark', Palette> = {
    light: { shape: [126, 146, 172], surface: [196, 178, 150], plain: [196, 200, 206], line: [52, 60, 72], curve: [30, 36, 46], marked: [10, 16, 24], ball: [232, 120, 30], thin: [222, 45, 38], faded: [226, 229, 233] },
    dark: { shape: [186, 208, 240], surface: [190, 172, 146], plain: [176, 182, 192], line: [16, 19, 24], curve: [232, 236, 242], marked: [255, 255, 255], ball: [255, 170, 80], thin: [255, 96, 84], faded: [58, 64, 73] },
};

/** Ends of the colour scales, of all models of a view. */
export interface Ranges {
    radius: number;
    thickness: number; // erosion thickness, the largest that is finite
    local: number; // local thickness of surfaces
    limit: number; // of their thin regions; 0 where there are none, or several
    hasInfinity: boolean; // among the erosion thicknesses
    unit: string; // of lengths; empty where it is not known, or not the same
}

/** Where values are on the colour scale, 0…1. */
export const radiusAt = (radius: number, ranges: Ranges) => (ranges.radius > 0 ? radius / ranges.radius : 0);
export const localAt = (thickness: number, ranges: Ranges) => (ranges.local > 0 ? thickness / ranges.local : 0);
/** By its root: that of sheets is small beside that of limbs. */
export const thicknessAt = (thickness: number, ranges: Ranges) => (ranges.thickness > 0 ? Math.sqrt(thickness / ranges.thickness) : 0);

export function rangesOf(views: readonly ModelView[]): Ranges {
    const largest = (values: (axis: Axis) => Float32Array) =>
        views.reduce((most, v) => v.model.axes.reduce((m, a) => values(a).reduce((x, y) => (y < Infinity ? Math.max(x, y) : x), m), most), 0);
    const limits = [...new Set(views.flatMap(({ model: { thickness: t } }) => (t?.limit && t.regions?.some((r) => r >= 0) ? [t.limit] : [])))];
    const [unit = '', ...others] = new Set(views.map((v) => v.model.lengthUnit));
    return {
        radius: largest((a) => a.radii),
        thickness: largest((a) => a.thicknesses),
        local: views.reduce((most, v) => v.model.thickness?.local.reduce((a, b) => Math.max(a, b), most) ?? most, 0),
        hasInfinity: views.some((v) => v.model.axes.some((a) => a.thicknesses.includes(Infinity))),
        limit: limits.length === 1 ? limits[0]! : 0,
        unit: others.length > 0 ? '' : unit,
    };
}

/** What suits the machine. Where a processor draws, triangles are dear, and an instance costs as much as a drawing. */
export const drawing = { ballTriangles: 8e6, mostBalls: Infinity, hasInstances: true };

/** A unit ball: as round as the budget allows. */
function ballGeometry(count: number): BufferGeometry {
    const detail = [9, 5, 3, 1].find((d) => 20 * (d + 1) ** 2 * count <= drawing.ballTriangles) ?? 0;
    const ball = new IcosahedronGeometry(1, detail);
    ball.deleteAttribute('normal');
    ball.deleteAttribute('uv');
    return mergeVertices(ball, 1e-6);
}

/** A surface that hides what is behind it as soon as it is drawn, so that a transparent one shows its nearest side only. */
function surfaceLayer(geometry: BufferGeometry, material: ShaderMaterial, paint: BufferAttribute, order: number): Layer {
    const depth = material.clone();
    depth.uniforms = material.uniforms;
    depth.colorWrite = false;
    const object = (of: ShaderMaterial, at: number) => {
        const mesh = new SceneMesh(geometry, of);
        mesh.renderOrder = at;
        mesh.frustumCulled = false;
        return mesh;
    };
    const first = object(depth, 3 * order);
    return { group: new Group().add(first, object(material, 3 * order + 1)), material, paints: [paint], depth: first, painted: '' };
}

/** A layer of the scene. */
interface Layer {
    group: Group;
    material: ShaderMaterial; // has its opacity
    paints: BufferAttribute[];
    depth: SceneMesh | null; // what is drawn first where it is transparent
    painted: string; // what the colours depend on
}

function setOpacity(layer: Layer, opacity: number): void {
    layer.material.uniforms.opacity!.value = opacity;
    if (layer.depth) layer.depth.visible = opacity < 1;
}

function paintAll(layer: Layer, color: Rgb): void {
    if (layer.painted === color.join()) return;
    layer.painted = color.join();
    for (const paint of layer.paints) fill(paint, () => color);
}

/** Each of `count` items of `size` numbers, `times` times. */
function repeated<T extends Float32Array | Uint8Array>(values: T, size: number, times: number): T {
    const result = new (values.constructor as new (length: number) => T)(values.length * times);
    for (let i = 0, to = 0; i < values.length; i += size) {
        for (let n = 0; n < times; ++n, to += size) for (let k = 0; k < size; ++k) result[to + k] = values[i + k]!;
    }
    return result;
}

/** `count` copies of a small mesh, as one. */
function copies(positions: ArrayLike<number>, triangles: ArrayLike<number>, count: number): BufferGeometry {
    const vertices = positions.length / 3;
    const all = new Float32Array(positions.length * count);
    const corners = new Uint32Array(triangles.length * count);
    for (let c = 0; c < count; ++c) {
        all.set(positions, positions.length * c);
        for (let i = 0; i < triangles.length; ++i) corners[triangles.length * c + i] = triangles[i]! + vertices * c;
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(all, 3));
    geometry.setIndex(new BufferAttribute(corners, 1));
    return geometry;
}

/** A quadrilateral for each line, which the shader brings to its place. */
function lineGeometry(positions: Float32Array, ends: Uint32Array): BufferGeometry {
    const count = ends.length / 2;
    const geometry = copies([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0], [0, 1, 2, 0, 2, 3], count);
    for (const [k, name] of ['start', 'end'].entries()) {
        const points = gather(positions, ends.filter((_, i) => i % 2 === k), 3);
        geometry.setAttribute(name, new BufferAttribute(repeated(points, 3, 4), 3));
    }
    for (const name of ['startPaint', 'endPaint']) geometry.setAttribute(name, new BufferAttribute(new Uint8Array(12 * count), 3, true));
    return geometry;
}

function linesLayer(positions: Float32Array, ends: Uint32Array, width: number) {
    const geometry = lineGeometry(positions, ends);
    const material = lineMaterial(width);
    const mesh = new SceneMesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = 2;
    const paints = ['startPaint', 'endPaint'].map((name) => geometry.getAttribute(name) as BufferAttribute);
    return { group: new Group().add(mesh), material, paints, geometry, ends, depth: null, painted: '' };
}

/** Draws only some of the items of a geometry, of `size` indices each. \param indices of all; null: of lines */
function drawOnly(geometry: BufferGeometry, indices: Uint32Array | null, size: number, items: Uint32Array): void {
    const index = geometry.getIndex()!;
    const array = index.array as Uint32Array;
    items.forEach((item, i) => {
        for (let k = 0; k < size; ++k) array[size * i + k] = indices ? indices[size * item + k]! : 4 * item + [0, 1, 2, 0, 2, 3][k]!;
    });
    index.needsUpdate = true;
    geometry.setDrawRange(0, size * items.length);
}

/** Paints items that have `vertices` vertices each. */
function fill(attribute: BufferAttribute, color: (i: number) => Rgb, vertices = 1): void {
    const bytes = attribute.array as Uint8Array;
    for (let i = 0, at = 0; at < bytes.length; ++i) {
        const rgb = color(i);
        for (let n = 0; n < vertices; ++n) {
            bytes[at++] = rgb[0];
            bytes[at++] = rgb[1];
            bytes[at++] = rgb[2];
        }
    }
    attribute.needsUpdate = true;
}

const mixed = (a: Rgb, b: Rgb, t: number): Rgb => a.map((x, k) => Math.round(x + t * (b[k]! - x))) as unknown as Rgb;

/** An axis and its simplified shape, as drawn. */
class AxisView {
    readonly group = new Group();
    readonly geometry: AxisGeometry;
    private readonly faces: Layer;
    private readonly lines: Record<LineName, Layer & { geometry: BufferGeometry; ends: Uint32Array }>;
    private readonly surface: Layer | null;
    private balls: (BallLayer & { key: string }) | null = null;
    everyBall = 1; // every how many-th ball is drawn
    scale = 1; // of a filtration: the level that is shown
    level: Level;
    private painted = '';
    private sortedTowards: readonly [number, number, number] = [0, 0, 0];
    private sortedBalls: BallLayer | null = null;

    constructor(readonly axis: Axis) {
        this.geometry = axisGeometry(axis);
        const { sheets, lines } = this.geometry;

        const faces = new BufferGeometry();
        faces.setAttribute('position', new BufferAttribute(gather(axis.positions, sheets.vertices, 3), 3));
        faces.setAttribute('normal', new BufferAttribute(sheets.normals, 3));
        const paint = new BufferAttribute(new Uint8Array(3 * sheets.vertices.length), 3, true);
        faces.setAttribute('paint', paint);
        faces.setIndex(new BufferAttribute(axis.scales ? sheets.triangles.slice() : sheets.triangles, 1));
        this.faces = surfaceLayer(faces, surfaceMaterial(false), paint, 0);
        this.group.add(this.faces.group);

        const points = Uint32Array.from({ length: 2 * lines.points.length }, (_, i) => lines.points[i >> 1]!);
        const curves = new Uint32Array(lines.curves.length + points.length);
        curves.set(lines.curves);
        curves.set(points, lines.curves.length);
        this.lines = {
            curves: this.lineLayer(curves, axis.sizes.length > 0 ? 3.5 : 5), // alone they can be thick
            seams: this.lineLayer(lines.seams, 1.6),
            boundaries: this.lineLayer(lines.boundaries, 1.1),
        };
        this.surface = axis.surface && meshLayer(axis.surface, false, 3);
        if (this.surface) this.group.add(this.surface.group);
        this.level = levelAt(axis, this.geometry, this.scale);
        if (axis.scales) this.showLevel();
    }

    /** Shows the level of a filtration at a scale. */
    choose(scale: number): void {
        if (!this.axis.scales || scale === this.scale) return;
        this.scale = scale;
        this.level = levelAt(this.axis, this.geometry, scale);
        this.showLevel();
    }

    /** Numbers of those lines of a layer that are there. */
    private shownLines(name: LineName): Uint32Array {
        const { lines } = this.level;
        if (name !== 'curves') return lines[name];
        const shown = new Uint32Array(lines.curves.length + lines.points.length);
        shown.set(lines.curves);
        shown.set(lines.points.map((i) => i + this.geometry.lines.curves.length / 2), lines.curves.length);
        return shown;
    }

    private showLevel(): void {
        const { triangles } = this.geometry.sheets;
        drawOnly(this.faces.depth!.geometry, triangles, 3, this.level.triangles);
        for (const name of LINES) drawOnly(this.lines[name].geometry, null, 6, this.shownLines(name));
    }

    private lineLayer(ends: Uint32Array, width: number) {
        const layer = linesLayer(this.axis.positions, ends, width);
        this.group.add(layer.group);
        return layer;
    }

    /** Vertices whose balls are shown: all, or those of the picked element. */
    shownBalls(state: State, isPicked: boolean): Uint32Array {
        const { vertices: left } = this.level;
        if (state.balls === 'all') return left;
        if (!isPicked || !state.picked) return new Uint32Array();
        const { sheet, ball, kind } = state.picked;
        if (kind === 'sheet') {
            const { vertices, vertexSheets } = this.geometry.sheets;
            const isOfSheet = new Set(vertices.filter((_, c) => vertexSheets[c] === sheet));
            return left.filter((v) => isOfSheet.has(v));
        }
        return left.includes(ball) ? Uint32Array.of(ball) : new Uint32Array();
    }

    update(state: State, isPicked: boolean, palette: Palette, paletteName: string, ranges: Ranges): void {
        const marked = isPicked && state.picked && state.picked.kind === 'sheet' ? state.picked.sheet : -1;
        const paintKey = [state.coloring, state.map, paletteName, ranges.radius, ranges.thickness, ranges.local, marked].join();
        const colorOf = vertexColors(this.axis, state, palette, ranges);

        this.faces.group.visible = state.shown.axis;
        for (const name of LINES) {
            this.lines[name].group.visible = state.shown.axis && state.lines[name] && this.shownLines(name).length > 0;
            setOpacity(this.lines[name], state.opacity.axis);
        }
        setOpacity(this.faces, state.opacity.axis);
        if (this.painted !== paintKey) {
            this.painted = paintKey;
            const { sheets, lines } = this.geometry;
            const fade = (color: Rgb, sheet: number) => (marked < 0 || sheet === marked ? color : mixed(color, palette.faded, 0.72));
            fill(this.faces.paints[0]!, (c) =>
                fade(colorOf(sheets.vertices[c]!, sheets.vertexSheets[c]!, sheets.vertexAngles[c]!, sheets.vertexThicknesses[c]!), sheets.vertexSheets[c]!));
            const curves = this.lines.curves;
            const hasValues = state.coloring === 'radius' || state.coloring === 'erosion' || state.coloring === 'thickness';
            const curveColor = (v: number) => (hasValues ? colorOf(v, -1, 0, this.geometry.thicknesses[v]!) : palette.curve);
            curves.paints.forEach((paint, k) => fill(paint, (i) => fade(curveColor(curves.ends[2 * i + k]!), -1), 4));
            this.lines.seams.paints.forEach((paint) => fill(paint, () => fade(palette.line, -1), 4));
            this.lines.boundaries.paints.forEach((paint) =>
                fill(paint, (i) => (lines.boundarySheets[i] === marked ? palette.marked : fade(palette.line, -1)), 4));
        }

        if (this.surface) {
            this.surface.group.visible = state.shown.surface;
            setOpacity(this.surface, state.opacity.surface);
            paintAll(this.surface, palette.surface);
        }
        this.updateBalls(state, isPicked, paintKey, colorOf);
    }

    private updateBalls(state: State, isPicked: boolean, paintKey: string, colorOf: VertexColor): void {
        const picked = isPicked ? state.picked : null;
        const key = [state.balls, state.balls === 'picked' && picked ? [picked.kind, picked.sheet, picked.ball] : '', paintKey, this.scale].join();
        if (!state.shown.balls) {
            if (this.balls) this.balls.group.visible = false;
            return;
        }
        if (this.balls?.key !== key) {
            if (this.balls) this.remove(this.balls);
            const all = this.shownBalls(state, isPicked);
            this.everyBall = Math.ceil(all.length / drawing.mostBalls) || 1;
            const vertices = all.filter((_, i) => i % this.everyBall === 0);
            const sheetOf = firstSheets(this.geometry, this.axis);
            this.balls = { ...ballLayer(this.axis, vertices, (v) => colorOf(v, sheetOf.sheet[v]!, sheetOf.angle[v]!, this.geometry.thicknesses[v]!)), key };
            this.group.add(this.balls.group);
        }
        this.balls.group.visible = true;
        setOpacity(this.balls, state.opacity.balls);
    }

    shown(): Shown {
        const result: Shown = { surfaces: [], lines: [], balls: null };
        if (this.faces.group.visible && this.level.triangles.length > 0) result.surfaces.push(['medial axis', shownSurface(this.faces)]);
        for (const name of LINES) {
            const { group, geometry, paints } = this.lines[name];
            if (!group.visible) continue;
            const isShown = new Uint8Array(this.lines[name].ends.length / 2);
            for (const i of this.shownLines(name)) isShown[i] = 1;
            const once = <T extends Float32Array | Uint8Array>(values: T) => values.filter((_, i) => i % 12 < 3 && isShown[Math.floor(i / 12)]) as T;
            const array = (key: string) => once(geometry.getAttribute(key).array as Float32Array);
            const [startColors, endColors] = paints.map((paint) => once(paint.array as Uint8Array)) as [Uint8Array, Uint8Array];
            result.lines.push([name, { starts: array('start'), ends: array('end'), startColors, endColors }]);
        }
        if (this.surface?.group.visible) result.surfaces.push(['simplified shape', shownSurface(this.surface)]);
        if (this.balls?.group.visible && this.balls.shown.balls.length > 0) {
            result.balls = { ...this.balls.shown, opacity: this.balls.material.uniforms.opacity!.value as number };
        }
        return result;
    }

    /** Puts the nearest balls first, so that most of what they hide is never painted. \param towards the viewer */
    sortBalls(towards: readonly [number, number, number]): void {
        if (!this.balls?.group.visible) return;
        if (towards.every((x, k) => x === this.sortedTowards[k]) && this.sortedBalls === this.balls) return;
        this.sortedBalls = this.balls;
        this.sortedTowards = towards;
        sortBalls(this.balls, towards);
    }

    private remove(layer: Layer): void {
        this.group.remove(layer.group);
        disposeGroup(layer.group);
    }
}

/** Positions of numbers from the largest to the smallest, up to a thousandth of their range: sorted by counting. */
function nearestFirst(depths: Float32Array): Uint32Array {
    const buckets = 1024;
    const low = depths.reduce((a, b) => Math.min(a, b), Infinity);
    const high = depths.reduce((a, b) => Math.max(a, b), -Infinity);
    const bucket = (depth: number) => (high > low ? Math.floor(((high - depth) / (high - low)) * (buckets - 1)) : 0);
    const next = new Uint32Array(buckets + 1);
    for (const depth of depths) ++next[bucket(depth) + 1]!;
    for (let b = 0; b < buckets; ++b) next[b + 1]! += next[b]!;
    const order = new Uint32Array(depths.length);
    for (let i = 0; i < depths.length; ++i) order[next[bucket(depths[i]!)]!++] = i;
    return order;
}

/** The colours of values from 0 to 1. */
function mapOf(state: State): (t: number) => Rgb {
    const table = colorTable(state.map);
    const colors = Array.from({ length: 256 }, (_, i): Rgb => [table[3 * i]!, table[3 * i + 1]!, table[3 * i + 2]!]);
    return (t) => colors[Math.round(255 * Math.min(1, Math.max(0, t)))]!;
}

type VertexColor = (vertex: number, sheet: number, angle: number, thickness: number) => Rgb;

function vertexColors(axis: Axis, state: State, palette: Palette, ranges: Ranges): VertexColor {
    if (state.coloring === 'plain') return () => palette.plain;
    if (state.coloring === 'sheet') {
        const colors = new Map<number, Rgb>();
        return (_, sheet) => {
            if (sheet < 0) return palette.plain;
            let color = colors.get(sheet);
            if (!color) colors.set(sheet, (color = sheetColor(axis.colors[sheet]!)));
            return color;
        };
    }
    const mapped = mapOf(state);
    if (state.coloring === 'radius') return (vertex) => mapped(radiusAt(axis.radii[vertex]!, ranges));
    if (state.coloring === 'thickness') return (vertex) => mapped(localAt(2 * axis.radii[vertex]!, ranges));
    if (state.coloring === 'erosion') {
        return (_v, _sheet, _angle, thickness) =>
            thickness === Infinity ? palette.plain : mapped(thicknessAt(thickness, ranges));
    }
    return (_, sheet, angle) => (sheet < 0 ? palette.plain : mapped(angle / 90));
}

/** A sheet and the angle there for each vertex, for the colours of balls; -1 off the sheets. */
function firstSheets(geometry: AxisGeometry, axis: Axis): { sheet: Int32Array; angle: Float32Array } {
    const sheet = new Int32Array(axis.radii.length).fill(-1);
    const angle = new Float32Array(axis.radii.length);
    const { vertices, vertexSheets, vertexAngles } = geometry.sheets;
    for (let c = vertices.length - 1; c >= 0; --c) {
        sheet[vertices[c]!] = vertexSheets[c]!;
        angle[vertices[c]!] = vertexAngles[c]!;
    }
    return { sheet, angle };
}

/** Balls: as instances of one, or where these are slow as copies of it. */
interface BallLayer extends Layer {
    shown: ShownBalls;
    attribute: BufferAttribute;
    copies: number; // of the data of a ball: one for each vertex, or one for an instance
}

function ballLayer(axis: Pick<Axis, 'positions' | 'radii'>, vertices: Uint32Array, color: (vertex: number) => Rgb, order = 2, isGlass = false): BallLayer {
    const ball = ballGeometry(vertices.length);
    const sphere = ball.getAttribute('position').array as Float32Array;
    const indices = ball.getIndex()!.array;
    const balls = new Float32Array(4 * vertices.length);
    const colors = new Uint8Array(3 * vertices.length);
    vertices.forEach((v, i) => {
        balls.set(axis.positions.subarray(3 * v, 3 * v + 3), 4 * i);
        balls[4 * i + 3] = axis.radii[v]!;
        colors.set(color(v), 3 * i);
    });
    let geometry: BufferGeometry;
    let attribute: BufferAttribute;
    let paint: BufferAttribute;
    const times = drawing.hasInstances ? 1 : sphere.length / 3;
    if (drawing.hasInstances) {
        const instanced = new InstancedBufferGeometry();
        instanced.setAttribute('position', ball.getAttribute('position'));
        instanced.setIndex(ball.getIndex());
        instanced.instanceCount = vertices.length;
        geometry = instanced;
        attribute = new InstancedBufferAttribute(balls.slice(), 4);
        paint = new InstancedBufferAttribute(colors.slice(), 3, true);
    } else {
        geometry = copies(sphere, indices, vertices.length);
        attribute = new BufferAttribute(repeated(balls, 4, times), 4);
        paint = new BufferAttribute(repeated(colors, 3, times), 3, true);
    }
    geometry.setAttribute('ball', attribute);
    geometry.setAttribute('ballColor', paint);
    const shown = { balls, colors, template: { sphere, indices }, opacity: 1 };
    return { ...surfaceLayer(geometry, ballMaterial(isGlass), paint, order), shown, attribute, copies: times };
}

/** Puts the nearest balls first, so that most of what they hide is never painted. */
function sortBalls(layer: BallLayer, towards: readonly [number, number, number]): void {
    const { balls, colors } = layer.shown;
    const depths = new Float32Array(balls.length / 4);
    for (let i = 0; i < depths.length; ++i) {
        depths[i] = balls[4 * i + 3]! + balls[4 * i]! * towards[0] + balls[4 * i + 1]! * towards[1] + balls[4 * i + 2]! * towards[2];
    }
    const places = layer.attribute.array as Float32Array;
    const paints = layer.paints[0]!.array as Uint8Array;
    let to = 0;
    for (const from of nearestFirst(depths)) {
        for (let n = 0; n < layer.copies; ++n, ++to) {
            for (let k = 0; k < 4; ++k) places[4 * to + k] = balls[4 * from + k]!;
            for (let k = 0; k < 3; ++k) paints[3 * to + k] = colors[3 * from + k]!;
        }
    }
    layer.attribute.needsUpdate = true;
    layer.paints[0]!.needsUpdate = true;
}

function meshLayer(mesh: Mesh, isGlass: boolean, order: number): Layer {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(mesh.positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(meshNormals(mesh), 3));
    const paint = new BufferAttribute(new Uint8Array(mesh.positions.length), 3, true);
    geometry.setAttribute('paint', paint);
    geometry.setIndex(new BufferAttribute(mesh.corners, 1));
    return surfaceLayer(geometry, surfaceMaterial(isGlass), paint, order);
}

function disposeGroup(group: Group): void {
    group.traverse((object) => {
        if (object instanceof SceneMesh) {
            object.geometry.dispose();
            object.material.dispose();
        }
    });
}

/** What is shown, as plain arrays: for export. Positions are relative to the model's origin. */
export interface ShownSurface {
    positions: Float32Array;
    normals: Float32Array;
    colors: Uint8Array;
    triangles: Uint32Array;
    opacity: number;
}
export interface ShownLines {
    starts: Float32Array;
    ends: Float32Array;
    startColors: Uint8Array;
    endColors: Uint8Array;
}
export interface ShownBalls {
    balls: Float32Array; // centre and radius
    colors: Uint8Array;
    template: { sphere: Float32Array; indices: ArrayLike<number> };
    opacity: number;
}
export interface Shown {
    surfaces: [string, ShownSurface][];
    lines: [string, ShownLines][];
    balls: ShownBalls | null;
}

function shownSurface(layer: Layer): ShownSurface {
    const geometry = layer.depth!.geometry;
    return {
        positions: geometry.getAttribute('position').array as Float32Array,
        normals: geometry.getAttribute('normal').array as Float32Array,
        colors: layer.paints[0]!.array as Uint8Array,
        triangles: (geometry.getIndex()!.array as Uint32Array).slice(0, Math.min(geometry.drawRange.count, geometry.getIndex()!.count)),
        opacity: layer.material.uniforms.opacity!.value as number,
    };
}

/** A model: its scene, in which half the diagonal of its box is 1 and the middle of the box is the origin. */
export class ModelView {
    readonly scene = new Scene();
    readonly unit: number; // half the diagonal of the box, in the units of the model
    private readonly root = new Group();
    private readonly shape: Layer | null;
    private readonly thin: Layer | null; // borders of thin regions on the shape
    private pickedBall: Layer | null = null;
    private readonly axes: (AxisView | null)[];
    current = 0; // of the axes: the one that is shown
    private scale = 1; // at which a filtration is shown

    constructor(readonly model: Model) {
        this.unit = Math.hypot(...model.max.map((b, k) => b - model.min[k]!)) / 2 || 1;
        this.root.scale.setScalar(1 / this.unit);
        this.scene.add(this.root);
        this.shape = model.shape && meshLayer(model.shape, true, 4);
        if (this.shape) this.root.add(this.shape.group);
        const borders = model.shape && model.thickness ? regionBorders(model.shape, model.thickness) : new Float32Array();
        this.thin = borders.length > 0 ? linesLayer(borders, Uint32Array.from({ length: borders.length / 3 }, (_, i) => i), 2) : null;
        if (this.thin) this.root.add(this.thin.group);
        this.axes = model.axes.map(() => null);
        this.choose(null);
    }

    /** The axis that is shown, which is made when it is needed. */
    get axisView(): AxisView | null {
        if (this.axes.length === 0) return null;
        const view = (this.axes[this.current] ??= new AxisView(this.model.axes[this.current]!));
        view.choose(this.scale);
        return view;
    }

    /** Shows the axis of the computed scale closest to `scale`, from the next drawing on; null: the one a page opens at. */
    choose(scale: number | null): void {
        const nested = this.model.axes.findIndex((a) => a.scales);
        if (nested >= 0) {
            this.current = nested;
            this.scale = scale ?? middleScale(this.model.axes[nested]!)!;
            return;
        }
        const scales = this.model.axes.map((a) => a.scale);
        this.current = Math.max(0, scales.indexOf(closestOf(scales, scale ?? openingScale(scales)) ?? NaN));
    }

    update(state: State, index: number, themeName: 'light' | 'dark', ranges: Ranges): void {
        const palette = PALETTES[themeName];
        const axis = this.axisView;
        for (const other of this.axes) if (other && other !== axis) this.root.remove(other.group);
        if (axis) {
            this.root.add(axis.group);
            axis.update(state, state.picked?.model === index, palette, themeName, ranges);
        }
        this.setCut(state.cut.by !== 'off');
        if (this.shape) {
            this.shape.group.visible = state.shown.shape;
            setOpacity(this.shape, state.opacity.shape);
            this.paintShape(state, palette, ranges);
        }
        if (this.thin) {
            this.thin.group.visible = state.shown.shape && state.coloring === 'thickness';
            paintAll(this.thin, palette.thin);
        }
        this.updatePickedBall(state, state.picked?.model === index, palette);
    }

    private paintShape(state: State, palette: Palette, ranges: Ranges): void {
        const shape = this.shape!;
        const { thickness } = this.model;
        if (state.coloring !== 'thickness' || !thickness) return paintAll(shape, palette.shape);
        const key = ['thickness', state.map, ranges.local].join();
        if (shape.painted === key) return;
        shape.painted = key;
        const mapped = mapOf(state);
        fill(shape.paints[0]!, (v) => mapped(localAt(thickness.local[v]!, ranges)));
    }

    /** The ball of the picked point, always shown; a small one where a place has none. */
    private updatePickedBall(state: State, isPicked: boolean, palette: Palette): void {
        if (this.pickedBall) {
            this.root.remove(this.pickedBall.group);
            disposeGroup(this.pickedBall.group);
        }
        this.pickedBall = null;
        const picked = isPicked ? state.picked : null;
        const radius = picked?.radius ?? (picked?.kind === 'place' || picked?.surface ? 0.01 * this.unit : null);
        if (!picked || radius === null) return;
        const ball = { positions: Float32Array.from(picked.point, (x, k) => x - this.model.origin[k]!), radii: Float32Array.of(radius) };
        this.pickedBall = ballLayer(ball, Uint32Array.of(0), () => palette.ball, 3, true);
        setOpacity(this.pickedBall, picked.radius === null ? 1 : 0.6);
        this.root.add(this.pickedBall.group);
    }

    private setCut(hasCut: boolean): void {
        this.root.traverse((object) => {
            if (!(object instanceof SceneMesh)) return;
            const material = object.material as ShaderMaterial;
            if (HAS_CUT in material.defines === hasCut) return;
            if (hasCut) material.defines[HAS_CUT] = '';
            else delete material.defines[HAS_CUT];
            material.needsUpdate = true;
        });
    }

    /** What is shown after the last update. */
    shown(state: State): Shown {
        const axis = this.axisView?.shown() ?? { surfaces: [], lines: [], balls: null };
        if (this.shape && state.shown.shape) axis.surfaces.push(['input shape', shownSurface(this.shape)]);
        return axis;
    }

    dispose(): void {
        for (const axis of this.axes) if (axis) this.root.add(axis.group);
        disposeGroup(this.root);
    }
}
