// SPDX-License-Identifier: Apache-2.0
// All that a view is, apart from the data; and the same as the fragment of a URL.
import { COLOR_MAPS, type ColorMap } from './colors';

export const LAYERS = ['axis', 'balls', 'surface', 'shape'] as const;
export type LayerName = (typeof LAYERS)[number];
export const LINES = ['seams', 'boundaries', 'curves'] as const;
export type LineName = (typeof LINES)[number];
export const COLORINGS = ['sheet', 'radius', 'angle', 'plain'] as const;
export type Coloring = (typeof COLORINGS)[number];
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
    ball: number; // vertex of the axis, -1 for a point between vertices
}

export interface State {
    model: number; // the one that is shown; -1: all of them, or the contact sheet
    scale: number | null; // null: the smallest
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

export function initialState(): State {
    return {
        model: -1,
        scale: null,
        shown: { axis: true, balls: false, surface: false, shape: true },
        opacity: { axis: 1, balls: 1, surface: 0.6, shape: 0.3 },
        lines: { seams: true, boundaries: true, curves: true },
        coloring: 'sheet',
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
export function fragmentOf(state: State): string {
    const initial = initialState();
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
        const { model, kind, sheet, point, radius, angle, ball } = state.picked;
        const optional = (n: number | null) => (n === null ? '' : String(n));
        words.push(`pick=${[model, kind, sheet, ...point, optional(radius), optional(angle), ball].join(',')}`);
    }
    return words.join('&');
}

/** The state that a fragment describes; what it does not say, or not rightly, is as initially. */
export function stateOf(fragment: string): State {
    const state = initialState();
    const words = new URLSearchParams(fragment.replace(/^#/, ''));
    const list = (key: string) => words.get(key)?.split(',');
    const numbers = (key: string) => list(key)?.map(Number);
    const choose = <T extends string>(key: string, choices: readonly T[], otherwise: T): T =>
        choices.find((c) => c === words.get(key)) ?? otherwise;

    const model = Number(words.get('model') ?? -1);
    if (Number.isInteger(model) && model >= 0) state.model = model;
    const scale = Number(words.get('s'));
    if (scale > 0) state.scale = scale;
    const shown = list('show');
    if (shown) for (const l of LAYERS) state.shown[l] = shown.includes(l);
    const lines = list('lines');
    if (lines) for (const l of LINES) state.lines[l] = lines.includes(l);
    numbers('opacity')?.forEach((value, i) => {
        if (value >= 0 && value <= 1 && LAYERS[i]) state.opacity[LAYERS[i]] = value;
    });
    state.coloring = choose('color', COLORINGS, state.coloring);
    state.map = choose('map', COLOR_MAPS, state.map);
    state.balls = choose('balls', ['all', 'picked'] as const, state.balls);
    state.theme = choose('theme', ['auto', 'light', 'dark'] as const, state.theme);
    state.camera.up = choose('up', UPS, state.camera.up);
    const cut = list('cut');
    const by = CUTS.find((c) => c === cut?.[0]);
    if (cut && by && Math.abs(Number(cut[1])) <= 1) {
        state.cut = { ...state.cut, by, at: Number(cut[1]), flipped: cut[2] === '1' };
        const normal = cut.slice(3).map(Number);
        if (normal.length === 3 && normal.every(Number.isFinite)) state.cut.normal = normal as [number, number, number];
    }
    const camera = numbers('camera');
    if (camera?.length === 6 && camera.every(Number.isFinite) && camera[2]! > 0) {
        const [azimuth, elevation, distance, x, y, z] = camera as [number, number, number, number, number, number];
        state.camera = { ...state.camera, azimuth, elevation, distance, target: [x, y, z] };
    }
    const pick = list('pick');
    const kind = PICKED_KINDS.find((k) => k === pick?.[1]);
    if (pick?.length === 9 && kind) {
        const [m, , sheet, x, y, z] = pick.map(Number) as [number, number, number, number, number, number];
        const optional = (text: string) => (text === '' ? null : Number(text));
        const picked: Picked = {
            model: m, kind, sheet, point: [x, y, z],
            radius: optional(pick[6]!), angle: optional(pick[7]!), ball: Number(pick[8]),
        };
        const values = [m, sheet, x, y, z, picked.radius ?? 0, picked.angle ?? 0, picked.ball];
        if (values.every(Number.isFinite)) state.picked = picked;
    }
    return state;
}
