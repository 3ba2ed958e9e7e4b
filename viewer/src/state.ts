// SPDX-License-Identifier: Apache-2.0
// All that a view is, apart from the data; and the same as the fragment of a URL.
import { COLOR_MAPS, type ColorMap } from './colors';
import type { Model } from './data';

export const LAYERS = ['axis', 'balls', 'surface', 'shape'] as const;
export type LayerName = (typeof LAYERS)[number];
export const LINES = ['seams', 'boundaries', 'curves'] as const;
export type LineName = (typeof LINES)[number];
export const COLORINGS = ['sheet', 'radius', 'angle', 'erosion', 'plain', 'thickness'] as const;
export type Coloring = (typeof COLORINGS)[number];
/** Does a colouring show values, by a colour map? */
export const isMapped = (coloring: Coloring) => coloring !== 'sheet' && coloring !== 'plain';
export const CUTS = ['off', 'x', 'y', 'z', 'view'] as const;
export type Cut = (typeof CUTS)[number];
export const UPS = ['x', 'y', 'z'] as const;
export type Up = (typeof UPS)[number];

/** Where the camera stands. Lengths are relative to half the diagonal of the model's box. */
export interface CameraState {
    azimuth: number; // degrees
    elevation: number;
    distance: number; // from the target; 1: the model just fits
    target: [number, number, number];
    up: Up;
}

export interface Picked {
    model: number;
    kind: 'sheet' | 'curve' | 'ball' | 'surface' | 'shape' | 'place'; // place: of the statistics
    sheet: number; // -1 where there is none
    point: [number, number, number]; // in the units of the model
    radius: number | null; // of the ball there
    angle: number | null; // object angle in degrees
    thickness: number | null; // erosion thickness
    ball: number; // vertex of the axis, -1 for a point between vertices
    branch?: number; // of a curve: length of the branch; not in a link
    surface?: { local: number; foot: number; region: number }; // thickness of the input shape; not in a link
}

export interface State {
    model: number; // the one that is shown; -1: all of them, or the contact sheet
    scale: number | null; // null: the one that a page opens at
    shown: Record<LayerName, boolean>;
    opacity: Record<LayerName, number>;
    lines: Record<LineName, boolean>;
    coloring: Coloring;
    map: ColorMap;
    balls: 'all' | 'picked';
    cut: { by: Cut; at: number; flipped: boolean; normal: [number, number, number] };
    theme: 'auto' | 'light' | 'dark';
    camera: CameraState;
    picked: Picked | null;
}

/** What a page shows at first: an axis, curves alone, or the thickness of a surface. */
export type Opening = 'axis' | 'curves' | 'thickness';

export function openingOf(models: readonly Model[]): Opening {
    if (models.some((m) => m.thickness)) return 'thickness';
    const axes = models.flatMap((m) => m.axes);
    return axes.length > 0 && axes.every((a) => a.sizes.length === 0 && a.curves.length > 0) ? 'curves' : 'axis';
}

/** Thickness is known of some surfaces only. */
export const coloringsOf = (opening: Opening): Coloring[] => COLORINGS.filter((c) => c !== 'thickness' || opening === 'thickness');

export function initialState(opening: Opening = 'axis'): State {
    const isThickness = opening === 'thickness';
    return {
        model: -1,
        scale: null,
        shown: { axis: !isThickness, balls: false, surface: false, shape: true },
        opacity: { axis: 1, balls: 1, surface: 0.6, shape: isThickness ? 1 : 0.3 },
        lines: { seams: true, boundaries: true, curves: true },
        coloring: isThickness ? 'thickness' : opening === 'curves' ? 'radius' : 'sheet',
        map: 'viridis',
        balls: 'all',
        cut: { by: 'off', at: 0, flipped: false, normal: [0, 0, 1] },
        theme: 'auto',
        camera: { azimuth: 30, elevation: 20, distance: 1, target: [0, 0, 0], up: 'y' },
        picked: null,
    };
}

const short = (n: number) => String(Number(n.toPrecision(5)));
const PICKED_KINDS = ['sheet', 'curve', 'ball', 'surface', 'shape', 'place'] as const;

/** The state as a fragment without the #: what differs from the initial one. */
export function fragmentOf(state: State, opening: Opening = 'axis'): string {
    const initial = initialState(opening);
    const words: string[] = [];
    const add = (key: string, value: string, initialValue: string) => value !== initialValue && words.push(`${key}=${value}`);
    const layers = (s: State) => LAYERS.filter((l) => s.shown[l]).join(',') || 'none';
    const lines = (s: State) => LINES.filter((l) => s.lines[l]).join(',') || 'none';
    const opacities = (s: State) => LAYERS.map((l) => short(s.opacity[l])).join(',');
    const camera = ({ camera: c }: State) =>
        [c.azimuth, c.elevation, c.distance, ...c.target].map((n) => short(Math.abs(n) < 1e-6 ? 0 : n)).join(',');
    const cut = ({ cut: c }: State) =>
        [c.by, short(c.at), c.flipped ? 1 : 0, ...(c.by === 'view' ? c.normal.map(short) : [])].join(',');
    add('model', String(state.model), String(initial.model));
    if (state.scale !== null) words.push(`s=${state.scale}`);
    add('show', layers(state), layers(initial));
    add('lines', lines(state), lines(initial));
    add('opacity', opacities(state), opacities(initial));
    add('color', state.coloring, initial.coloring);
    add('map', state.map, initial.map);
    add('balls', state.balls, initial.balls);
    if (state.cut.by !== 'off') words.push(`cut=${cut(state)}`);
    add('theme', state.theme, initial.theme);
    add('up', state.camera.up, initial.camera.up);
    add('camera', camera(state), camera(initial));
    if (state.picked) {
        const { model, kind, sheet, point, radius, angle, thickness, ball } = state.picked;
        const optional = (n: number | null) => (n === null ? '' : String(n));
        words.push(`pick=${[model, kind, sheet, ...point, optional(radius), optional(angle), optional(thickness), ball].join(',')}`);
    }
    return words.join('&').replaceAll('e+', 'e'); // a plus would be read as a space
}

/** The scale that a page opens at: 1.1 or the one nearest to it, at which bumps have no branches of their own. */
export function openingScale(scales: readonly number[]): number | null {
    const simplified = scales.filter((s) => s > 1);
    return simplified.length > 0 ? closestOf(simplified, 1.1) : (scales[0] ?? null);
}

/** The one of some scales that is closest to `scale`, by their ratio. */
export function closestOf(scales: readonly number[], scale: number | null): number | null {
    if (scale === null) return null;
    const off = (s: number) => Math.abs(Math.log(s / scale));
    return scales.reduce((best: number | null, s) => (best === null || off(s) < off(best) ? s : best), null);
}

/** What a link asks for, and what is wrong with it: a sentence for each word that is not followed. */
export interface Link {
    state: State;
    problems: string[];
}

const numberOf = (text: string | undefined) => (text?.trim() ? Number(text) : NaN);
const choose = <T extends string>(text: string | undefined, choices: readonly T[]): T | undefined => choices.find((c) => c === text);

/** A set of names as `a,b` or `none`; nothing if a name is not one of them. */
function switches<T extends string>(text: string, names: readonly T[]): Record<T, boolean> | undefined {
    const words = text === 'none' || text === '' ? [] : text.split(',');
    if (!words.every((w) => choose(w, names))) return undefined;
    return Object.fromEntries(names.map((n) => [n, words.includes(n)])) as Record<T, boolean>;
}

function cutOf(text: string): Partial<State['cut']> | undefined {
    const [name, place, side, ...rest] = text.split(',');
    const by = choose(name, CUTS);
    const at = numberOf(place);
    const normal = rest.map(numberOf);
    const hasNormal = normal.length === 3 && normal.every(Number.isFinite);
    if (!by || !(Math.abs(at) <= 1) || !choose(side, ['0', '1']) || hasNormal !== (by === 'view')) return undefined;
    return { by, at, flipped: side === '1', ...(hasNormal ? { normal: normal as [number, number, number] } : {}) };
}

function pickOf(text: string): Picked | undefined {
    const words = text.split(',');
    const kind = choose(words[1], PICKED_KINDS);
    const optional = (word: string | undefined) => (word === '' ? null : numberOf(word));
    const [model, , sheet, x, y, z] = words.map(numberOf) as [number, number, number, number, number, number];
    const [radius, angle, thickness] = words.slice(6, 9).map(optional) as [number | null, number | null, number | null];
    const ball = numberOf(words[9]);
    const values = [model, sheet, x, y, z, radius ?? 0, angle ?? 0, ball, thickness === Infinity ? 0 : (thickness ?? 0)];
    if (words.length !== 10 || !kind || !values.every(Number.isFinite)) return undefined;
    return { model, kind, sheet, point: [x, y, z], radius, angle, thickness, ball };
}

/** The state that a fragment describes; what it does not say, or not rightly, is as initially. */
export function readLink(fragment: string, opening: Opening = 'axis'): Link {
    let state = initialState(opening);
    // What a word changes, or nothing if it makes no sense.
    const readers: Record<string, (text: string) => Partial<State> | undefined> = {
        model: (text) => (Number.isInteger(numberOf(text)) && numberOf(text) >= 0 ? { model: numberOf(text) } : undefined),
        s: (text) => (numberOf(text) > 0 && numberOf(text) < Infinity ? { scale: numberOf(text) } : undefined),
        show: (text) => optionally('shown', switches(text, LAYERS)),
        lines: (text) => optionally('lines', switches(text, LINES)),
        opacity: (text) => {
            const values = text.split(',').map(numberOf);
            if (values.length !== LAYERS.length || !values.every((v) => v >= 0 && v <= 1)) return undefined;
            return { opacity: Object.fromEntries(LAYERS.map((l, i) => [l, values[i]!])) as State['opacity'] };
        },
        color: (text) => optionally('coloring', choose(text, COLORINGS)),
        map: (text) => optionally('map', choose(text, COLOR_MAPS)),
        balls: (text) => optionally('balls', choose(text, ['all', 'picked'])),
        theme: (text) => optionally('theme', choose(text, ['auto', 'light', 'dark'])),
        up: (text) => {
            const up = choose(text, UPS);
            return up && { camera: { ...state.camera, up } };
        },
        cut: (text) => {
            const cut = cutOf(text);
            return cut && { cut: { ...state.cut, ...cut } };
        },
        camera: (text) => {
            const values = text.split(',').map(numberOf);
            if (values.length !== 6 || !values.every(Number.isFinite) || !(values[2]! > 0)) return undefined;
            const [azimuth, elevation, distance, x, y, z] = values as [number, number, number, number, number, number];
            return { camera: { ...state.camera, azimuth, elevation, distance, target: [x, y, z] } };
        },
        pick: (text) => optionally('picked', pickOf(text)),
    };
    const problems: string[] = [];
    const quoted = (text: string) => `“${text.length > 60 ? `${text.slice(0, 60)}…` : text}”`;
    for (const [key, text] of new URLSearchParams(fragment.replace(/^#/, ''))) {
        const read = Object.hasOwn(readers, key) ? readers[key] : undefined;
        const change = read?.(text);
        if (change) state = { ...state, ...change };
        else problems.push(read ? `${quoted(`${key}=${text}`)} makes no sense.` : `${quoted(key)} is not known.`);
    }
    return { state, problems };
}

const optionally = <K extends keyof State>(key: K, value: State[K] | undefined): Partial<State> | undefined =>
    value === undefined ? undefined : ({ [key]: value } as unknown as Partial<State>);
