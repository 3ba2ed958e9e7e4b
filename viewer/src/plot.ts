// SPDX-License-Identifier: Apache-2.0
// What is left of a filtration over the scale, as `scaleaxis filtration --plot` draws it: small, with a mark at the scale
// that is shown. A click sets the scale.
import { shortNumber, withUnit } from './colors';
import type { Scales } from './data';
import { h, svg } from './dom';
import type { Level } from './level';

const WIDTH = 264;
const HEIGHT = 104;
const SIDE = 8; // as far as the thumb of the slider stays from its ends
const TOP = 6;
const BOTTOM = 86;
const MARKS = [1, 1.05, 1.1, 1.2, 1.3, 1.5, 2, 3, 5, 10, 20, 50, 100];

export interface Plot {
    element: HTMLElement;
    update(scale: number, level: Level, unit: string): void;
}

function percentOf(part: number): string {
    return `${part < 0.1 ? (part * 100).toPrecision(2) : (part * 100).toFixed(0)} %`;
}

/** \param set what a click on a scale does */
export function persistencePlot({ levels, plateau }: Scales, [begin, end]: [number, number], set: (scale: number) => void): Plot {
    const shown = levels.filter((level) => level.scale <= end * (1 + 1e-9));
    const x = (scale: number) => SIDE + ((WIDTH - 2 * SIDE) * Math.log(Math.min(scale, end) / begin)) / Math.log(end / begin);
    const y = (part: number) => BOTTOM - (BOTTOM - TOP) * part;
    const most = (of: (level: (typeof levels)[number]) => number) => Math.max(...levels.map(of)) || 1;
    const curves = [
        { name: 'area', all: levels[0]!.area || 1, of: (l: (typeof levels)[number]) => l.area },
        { name: 'sheets', all: most((l) => l.sheets), of: (l: (typeof levels)[number]) => l.sheets },
        { name: 'curves', all: most((l) => l.curveLength), of: (l: (typeof levels)[number]) => l.curveLength },
        { name: 'volume', all: levels[0]!.volume || 1, of: (l: (typeof levels)[number]) => l.volume },
    ];
    let last = -Infinity;
    const marks = MARKS.filter((scale) => {
        const isShown = scale <= end * 1.001 && x(scale) - last >= 25;
        if (isShown) last = x(scale);
        return isShown;
    });
    const mark = svg('line', { class: 'mark', y1: TOP - 4, y2: BOTTOM });
    const drawing = svg('svg', { class: 'plot', viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img', 'aria-label': 'What is left over the scale' },
        svg('rect', { class: 'plateau', x: x(plateau.begin), y: TOP, width: Math.max(1, x(plateau.end) - x(plateau.begin)), height: BOTTOM - TOP }),
        ...[0, 0.5, 1].map((part) => svg('line', { class: 'grid', x1: SIDE, x2: WIDTH - SIDE, y1: y(part), y2: y(part) })),
        ...marks.flatMap((scale) => [
            svg('line', { class: 'grid', x1: x(scale), x2: x(scale), y1: BOTTOM, y2: BOTTOM + 3 }),
            svg('text', { x: x(scale), y: HEIGHT - 4, 'text-anchor': x(scale) < 12 ? 'start' : x(scale) > WIDTH - 12 ? 'end' : 'middle' }, String(scale)),
        ]),
        ...curves.map(({ name, all, of }) =>
            svg('polyline', { class: name, points: shown.map((level) => `${x(level.scale).toFixed(1)},${y(of(level) / all).toFixed(1)}`).join(' ') })),
        mark);
    const setAt = (event: Event) => {
        const { left, width } = drawing.getBoundingClientRect();
        const at = (((event as PointerEvent).clientX - left) / width) * WIDTH;
        set(begin * (end / begin) ** ((at - SIDE) / (WIDTH - 2 * SIDE)));
    };
    drawing.addEventListener('pointerdown', (event) => {
        drawing.setPointerCapture((event as PointerEvent).pointerId);
        setAt(event);
    });
    drawing.addEventListener('pointermove', (event) => (event as PointerEvent).buttons & 1 && setAt(event));

    const values = curves.map(() => h('span'));
    const key = h('div', { class: 'plot-key' }, ...curves.map(({ name }, i) => h('div', {}, h('i', { class: name }), h('span', { class: 'quiet' }, name), values[i]!)));
    const range = `${shortNumber(Number(plateau.begin.toPrecision(3)))} – ${shortNumber(Number(plateau.end.toPrecision(3)))}`;
    const auto = h('button', { type: 'button', name: 'plateau', title: 'The middle of the longest plateau, which --scale auto takes', onclick: () => set(Number(plateau.middle.toPrecision(4))) },
        h('i', { class: 'plateau' }), `Longest plateau, s = ${range}`);
    return {
        element: h('div', {}, drawing, key, auto),
        update(scale, level, unit) {
            for (const name of ['x1', 'x2']) mark.setAttribute(name, x(scale).toFixed(1));
            values[0]!.textContent = percentOf(level.area / curves[0]!.all);
            values[1]!.textContent = String(level.sheets);
            values[2]!.textContent = withUnit(Number(level.curveLength.toPrecision(3)), unit);
            // The union of the balls is not computed here: its volume is that of the level before.
            const before = levels.filter((l) => l.scale <= scale * (1 + 1e-9)).pop() ?? levels[0]!;
            values[3]!.textContent = percentOf(before.volume / curves[3]!.all);
        },
    };
}
