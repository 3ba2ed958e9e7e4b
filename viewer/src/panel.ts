// SPDX-License-Identifier: Apache-2.0
// The controls. Each is made once and follows the state.
import { COLOR_MAPS, withUnit } from './colors';
import { h } from './dom';
import type { ModelView } from './modelview';
import { persistencePlot } from './plot';
import { statisticsOf, type Place } from './statistics';
import { coloringsOf, CUTS, isMapped, LAYERS, LINES, openingOf, UPS, type LayerName, type LineName, type Picked, type State } from './state';

export interface Actions {
    state(): State; // as it is now: what is drawn may be a frame behind
    change(change: Partial<State>): void;
    setCut(change: Partial<State['cut']>): void;
    reset(): void;
    savePicture(): void;
    saveGlb(): void;
    copyLink(): void;
    goTo(view: ModelView, place: Place): void;
    back: (() => void) | null; // to the contact sheet
}

/** The scales that can be shown. */
export interface Scales {
    computed: number[]; // of all models, ascending
    range: [number, number] | null; // where there is a filtration: any scale in it
    opening: number | null; // the one that the page opens at
}

/** A scale in as many digits as the slider tells apart. */
export const shortScale = (s: number) => Number(s.toPrecision(5));

export interface Panel {
    element: HTMLElement;
    update(state: State): void;
}

const LAYER_NAMES: Record<LayerName, string> = { axis: 'Medial axis', balls: 'Balls', surface: 'Simplified shape', shape: 'Input shape' };
const LINE_NAMES: Record<LineName, string> = { seams: 'seams', boundaries: 'boundaries', curves: 'curves' };
const PICKED_NAMES: Record<Picked['kind'], string> = {
    sheet: 'Sheet', curve: 'Curve of the axis', ball: 'Ball', surface: 'Simplified shape', shape: 'Input shape', place: 'Place',
};
const COLORING_NAMES = { sheet: 'Sheet', radius: 'Radius', angle: 'Angle', erosion: 'Erosion', plain: 'Plain', thickness: 'Thickness' };
const CUT_NAMES = { off: 'None', x: 'x', y: 'y', z: 'z', view: 'View' };

type Updates = ((state: State) => void)[];

/** A row of radio buttons that looks like one control. */
function choice<T extends string>(legend: string, name: string, values: readonly T[], names: Record<T, string>, get: (s: State) => T, set: (v: T) => void, updates: Updates) {
    const inputs = values.map((value) => h('input', { type: 'radio', name, value, onchange: () => set(value) }));
    updates.push((state) => inputs.forEach((input) => (input.checked = input.value === get(state))));
    return h('fieldset', { class: 'choice' }, h('legend', { class: 'hidden' }, legend),
        ...values.map((value, i) => h('label', {}, inputs[i]!, h('span', {}, names[value]))));
}

function check(label: string, name: string, get: (s: State) => boolean, set: (on: boolean) => void, updates: Updates) {
    const input = h('input', { type: 'checkbox', name, onchange: () => set(input.checked) });
    updates.push((state) => (input.checked = get(state)));
    return h('label', { class: 'check' }, input, h('span', {}, label));
}

function slider(label: string, name: string, [min, max, step]: [number, number, number], get: (s: State) => number, set: (value: number) => void, text: (s: State) => string, updates: Updates) {
    const input = h('input', { type: 'range', name, min, max, step, 'aria-label': label, oninput: () => set(Number(input.value)) });
    updates.push((state) => {
        input.value = String(get(state));
        input.setAttribute('aria-valuetext', text(state));
    });
    return input;
}

/** The slider over all scales of a filtration, by the logarithm of s, above the plot of what is left. */
function nestedScales(views: ModelView[], [begin, end]: [number, number], actions: Actions, updates: Updates): HTMLElement {
    const view = views.find((v) => v.model.axes.some((a) => a.scales))!;
    const { scales } = view.model.axes.find((a) => a.scales)!;
    const steps = 1000;
    const value = h('output', { class: 'value' });
    updates.push((s) => (value.textContent = `s = ${s.scale}`));
    const set = (scale: number) => actions.change({ scale: shortScale(Math.min(end, Math.max(begin, scale))) });
    const input = slider('Scale s', 'scale', [0, steps, 1], (s) => (steps * Math.log(s.scale! / begin)) / Math.log(end / begin),
        (i) => set(begin * (end / begin) ** (i / steps)), (s) => `s = ${s.scale}`, updates);
    const plot = persistencePlot(scales!, [begin, end], set);
    updates.push((s) => plot.update(s.scale!, view.axisView!.level, view.model.lengthUnit));
    return h('section', { class: 'nested' }, h('h2', {}, 'Scale', value), input, plot.element);
}

export function panel(views: ModelView[], indices: number[], { computed: scales, range }: Scales, title: string, actions: Actions): Panel {
    const updates: Updates = [];
    const section = (name: string, ...children: (Node | null)[]) => h('section', {}, h('h2', {}, name), ...children);

    const scaleIndex = (s: State) => scales.indexOf(s.scale!);
    let scaleSection: HTMLElement | null = null;
    if (range) {
        scaleSection = nestedScales(views, range, actions, updates);
    } else if (scales.length > 1) {
        const value = h('output', { class: 'value' });
        updates.push((s) => (value.textContent = `s = ${scales[scaleIndex(s)]}`));
        const marks = h('div', { class: 'marks', 'aria-hidden': 'true' }, ...scales.map((s) => h('span', {}, String(s))));
        const input = slider('Scale s', 'scale', [0, scales.length - 1, 1], scaleIndex, (i) => actions.change({ scale: scales[i]! }),
            (s) => `s = ${scales[scaleIndex(s)]}`, updates);
        scaleSection = h('section', {}, h('h2', {}, 'Scale', value), input, scales.length <= 7 ? marks : null);
    }

    const has: Record<LayerName, boolean> = {
        axis: views.some((v) => v.model.axes.length > 0),
        balls: views.some((v) => v.model.axes.length > 0),
        surface: views.some((v) => v.model.axes.some((a) => a.surface)),
        shape: views.some((v) => v.model.shape),
    };
    const layers = LAYERS.filter((l) => has[l]).map((layer) => {
        const rows: Node[] = [h('div', { class: 'layer' },
            check(LAYER_NAMES[layer], layer, (s) => s.shown[layer], (on) => actions.change({ shown: { ...actions.state().shown, [layer]: on } }), updates),
            slider(`Opacity of ${LAYER_NAMES[layer]}`, `${layer}-opacity`, [0.05, 1, 0.05], (s) => s.opacity[layer],
                (v) => actions.change({ opacity: { ...actions.state().opacity, [layer]: v }, shown: { ...actions.state().shown, [layer]: true } }),
                (s) => `${Math.round(100 * s.opacity[layer])} %`, updates))];
        if (layer === 'axis') {
            rows.push(h('div', { class: 'sub' }, ...LINES.map((line) =>
                check(LINE_NAMES[line], line, (s) => s.lines[line], (on) => actions.change({ lines: { ...actions.state().lines, [line]: on } }), updates))));
        }
        if (layer === 'balls') {
            const which = h('div', { class: 'sub' },
                choice('Which balls', 'which-balls', ['all', 'picked'] as const, { all: 'All', picked: 'Of the picked' }, (s) => s.balls,
                    (balls) => actions.change({ balls, shown: { ...actions.state().shown, balls: true } }), updates));
            const thinned = h('p', { class: 'quiet sub' });
            updates.push((s) => {
                which.hidden = !s.shown.balls;
                const every = Math.max(...views.map((v) => v.axisView?.everyBall ?? 1));
                thinned.hidden = !s.shown.balls || every === 1;
                thinned.textContent = `There is no graphics card here: only one in ${every} balls is drawn.`;
            });
            rows.push(which, thinned);
        }
        return h('div', {}, ...rows);
    });

    const map = h('select', { name: 'map', 'aria-label': 'Colour map', onchange: () => actions.change({ map: map.value as State['map'] }) },
        ...COLOR_MAPS.map((m) => h('option', { value: m }, m)));
    updates.push((s) => {
        map.value = s.map;
        map.hidden = !isMapped(s.coloring);
    });

    const cutAt = slider('Place of the cut', 'cut-at', [-1, 1, 0.01], (s) => s.cut.at, (at) => actions.setCut({ at }), (s) => `${Math.round(50 + 50 * s.cut.at)} %`, updates);
    const cutRow = h('div', { class: 'row' }, cutAt,
        h('button', { type: 'button', name: 'flip', title: 'Show the other side', onclick: () => actions.setCut({ flipped: !actions.state().cut.flipped }) }, 'Flip'));
    updates.push((s) => (cutRow.hidden = s.cut.by === 'off'));

    const pickedText = h('div', { class: 'picked', 'aria-live': 'polite' });
    updates.push((s) => pickedText.replaceChildren(...pickedRows(s, views, indices, () => actions.change({ picked: null }))));

    const statistics = h('details', { open: true, class: 'statistics-box' }, h('summary', {}, h('h2', {}, 'Statistics')));
    let shownStatistics = '';
    updates.push(() => {
        const key = views.map((v) => [v.current, v.axisView?.scale]).join();
        if (key === shownStatistics) return;
        shownStatistics = key;
        statistics.replaceChildren(statistics.firstChild!, ...views.flatMap((v) => [
            ...(views.length > 1 ? [h('h3', {}, v.model.name)] : []),
            statisticsOf(v.model, v.model.axes[v.current], v.axisView?.level, (place) => actions.goTo(v, place)),
        ]));
    });

    const theme = h('select', { name: 'theme', 'aria-label': 'Light or dark', onchange: () => actions.change({ theme: theme.value as State['theme'] }) },
        h('option', { value: 'auto' }, 'System theme'), h('option', { value: 'light' }, 'Light'), h('option', { value: 'dark' }, 'Dark'));
    const up = h('select', { name: 'up', 'aria-label': 'Axis that points upwards', onchange: () => actions.change({ camera: { ...actions.state().camera, up: up.value as State['camera']['up'] } }) },
        ...UPS.map((u) => h('option', { value: u }, `${u} is up`)));
    updates.push((s) => {
        theme.value = s.theme;
        up.value = s.camera.up;
    });

    const button = (name: string, label: string, action: () => void, about = '') =>
        h('button', { type: 'button', name, title: about || label, onclick: action }, label);
    const element = h('aside', { class: 'panel', 'aria-label': 'Controls' },
        h('header', {},
            actions.back ? button('back', '← All models', actions.back) : null,
            h('h1', {}, title)),
        scaleSection,
        section('Show', ...layers),
        section('Colour', choice('Colour', 'color', coloringsOf(openingOf(views.map((v) => v.model))), COLORING_NAMES, (s) => s.coloring, (coloring) => actions.change({ coloring }), updates), map),
        section('Cut', choice('Cut across', 'cut', CUTS, CUT_NAMES, (s) => s.cut.by, (by) => actions.setCut({ by }), updates), cutRow),
        h('section', {}, h('h2', {}, 'Picked'), pickedText),
        section('View', h('div', { class: 'row' }, up, theme), h('div', { class: 'row' }, button('reset', 'Reset', actions.reset, 'Back to how the page opened'),
            button('link', 'Copy link', actions.copyLink, 'A link to this view'),
            button('png', 'PNG', actions.savePicture, 'Save the picture'), button('glb', 'GLB', actions.saveGlb, 'Save what is shown as a 3D file'))),
        h('section', {}, statistics),
        h('section', {}, h('details', { class: 'keys' }, h('summary', {}, h('h2', {}, 'Mouse, touch, keys')), h('table', {}, h('tbody', {}, ...KEYS.map(([key, what]) =>
            h('tr', {}, h('th', { scope: 'row' }, key), h('td', {}, what))))))));
    return {
        element,
        update(next) {
            for (const update of updates) update(next);
        },
    };
}

const KEYS: [string, string][] = [
    ['drag, arrows', 'turn'], ['Shift + drag, Shift + arrows, two fingers', 'move'], ['wheel, pinch, + and −', 'zoom'],
    ['click, Enter', 'pick what is there, or in the middle'], ['n, p', 'next and previous sheet, by size'], ['Esc', 'pick nothing'],
    ['a, b, s, i', 'axis, balls, simplified shape, input shape'], ['c', 'next colouring'], ['[ and ]', 'smaller and larger scale'],
    ['x, y, z', 'cut across an axis, or no more'], ['0', 'reset the camera'],
];

function pickedRows(state: State, views: ModelView[], indices: number[], clear: () => void): Node[] {
    const p = state.picked;
    const view = p && views[indices.indexOf(p.model)];
    if (!p || !view) return [h('p', { class: 'quiet' }, 'Click on the model to see what is there.')];
    const unit = view.model.lengthUnit;
    const rows: [string, string][] = [];
    if (views.length > 1) rows.push(['Model', view.model.name]);
    if (p.sheet >= 0) rows.push(['Sheet', String(p.sheet)]);
    if (p.radius !== null) rows.push(['Radius', withUnit(p.radius, unit)], ['Thickness', withUnit(2 * p.radius, unit)]);
    if (p.branch !== undefined) rows.push(['Length of the branch', withUnit(p.branch, unit)]);
    if (p.surface) {
        rows.push(['Local thickness', withUnit(p.surface.local, unit)], ['Thickness at the foot point', withUnit(p.surface.foot, unit)]);
        if (p.surface.region >= 0) rows.push(['Thin region', String(p.surface.region)]);
    }
    if (p.thickness !== null) rows.push(['Erosion thickness', withUnit(p.thickness, p.thickness < Infinity ? unit : '')]);
    if (p.angle !== null) rows.push(['Object angle', `${p.angle.toFixed(1)}°`]);
    if (p.kind === 'sheet') rows.push(['Area of the sheet', withUnit(view.axisView!.level.sheetAreas[p.sheet]!, unit, 2)]);
    if (p.ball >= 0) rows.push(['Ball', `vertex ${p.ball}`]);
    p.point.forEach((x, k) => rows.push(['xyz'[k]!, withUnit(x, unit)]));
    return [h('table', {}, h('caption', {}, PICKED_NAMES[p.kind], h('button', { type: 'button', name: 'unpick', 'aria-label': 'Pick nothing', onclick: clear }, '×')),
        h('tbody', {}, ...rows.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value)))))];
}
