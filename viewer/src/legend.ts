// SPDX-License-Identifier: Apache-2.0
// The colour scale: as an element of the page, and drawn into a picture.
import { colorTable, rootTicks, shortNumber, ticks } from './colors';
import { h } from './dom';
import { localAt, PALETTES, radiusAt, thicknessAt, type Ranges } from './modelview';
import type { State } from './state';

interface Legend {
    title: string;
    marks: { at: number; text: string }[]; // `at`: 0…1
    hasInfinity: boolean; // values that have no place on the scale
    limit?: { at: number; text: string }; // of thin regions
}

const INFINITY_TEXT = '∞: no fire comes';
const infinityColor = (theme: 'light' | 'dark') => `rgb(${PALETTES[theme].plain.join()})`;

const thinColor = (theme: 'light' | 'dark') => `rgb(${PALETTES[theme].thin.join()})`;

function legendOf(state: State, ranges: Ranges): Legend | null {
    const unit = ranges.unit || 'units of the model';
    if (state.coloring === 'thickness' && (state.shown.shape || state.shown.axis || state.shown.balls)) {
        const marks = ticks(ranges.local).map((value) => ({ at: localAt(value, ranges), text: shortNumber(value) }));
        const thin = ranges.limit > 0 ? { limit: { at: localAt(ranges.limit, ranges), text: `thinner than ${shortNumber(ranges.limit)}` } } : {};
        return { title: `Local thickness, in ${unit}`, marks, hasInfinity: false, ...thin };
    }
    if (!state.shown.axis && !state.shown.balls) return null;
    if (state.coloring === 'radius') {
        const marks = ticks(ranges.radius).map((value) => ({ at: radiusAt(value, ranges), text: shortNumber(value) }));
        return { title: `Radius, in ${unit}`, marks, hasInfinity: false };
    }
    if (state.coloring === 'erosion') {
        const marks = rootTicks(ranges.thickness).map((value) => ({ at: thicknessAt(value, ranges), text: shortNumber(value) }));
        return { title: `Erosion thickness, in ${unit}`, marks, hasInfinity: ranges.hasInfinity };
    }
    if (state.coloring === 'angle') {
        const marks = [0, 30, 60, 90].map((value) => ({ at: value / 90, text: `${value}°` }));
        return { title: 'Object angle', marks, hasInfinity: false };
    }
    return null;
}

function gradient(state: State): string {
    const table = colorTable(state.map);
    const stops = Array.from({ length: 17 }, (_, i) => `rgb(${table.subarray(3 * Math.min(255, 16 * i), 3 * Math.min(255, 16 * i) + 3).join()})`);
    return `linear-gradient(to right, ${stops.join()})`;
}

export function updateLegend(element: HTMLElement, state: State, ranges: Ranges, theme: 'light' | 'dark'): void {
    const legend = legendOf(state, ranges);
    element.hidden = !legend;
    if (!legend) return;
    element.replaceChildren(
        h('div', { class: 'legend-title' }, legend.title),
        h('div', { class: 'legend-bar', style: `background: ${gradient(state)}` },
            ...(legend.limit ? [h('span', { style: `left: ${100 * legend.limit.at}%; background: ${thinColor(theme)}` })] : [])),
        h('div', { class: 'legend-marks' }, ...legend.marks.map((m) => h('span', { style: `left: ${100 * m.at}%` }, m.text))),
        ...(legend.hasInfinity ? [h('div', { class: 'legend-infinity' }, h('span', { style: `background: ${infinityColor(theme)}` }), INFINITY_TEXT)] : []),
        ...(legend.limit ? [h('div', { class: 'legend-thin' }, h('span', { style: `background: ${thinColor(theme)}` }), legend.limit.text)] : []));
}

/** The same in the lower left corner of a picture. */
export function drawLegend(context: CanvasRenderingContext2D, scale: number, state: State, ranges: Ranges, theme: 'light' | 'dark', color: string): void {
    const legend = legendOf(state, ranges);
    if (!legend) return;
    const width = 220 * scale;
    const x = 24 * scale;
    const y = context.canvas.height - (legend.hasInfinity || legend.limit ? 66 : 48) * scale;
    const table = colorTable(state.map);
    for (let i = 0; i < 256; ++i) {
        context.fillStyle = `rgb(${table.subarray(3 * i, 3 * i + 3).join()})`;
        context.fillRect(x + (i / 256) * width, y, width / 256 + 1, 10 * scale);
    }
    context.fillStyle = color;
    context.font = `${12 * scale}px system-ui, sans-serif`;
    context.textAlign = 'left';
    context.fillText(legend.title, x, y - 7 * scale);
    if (legend.hasInfinity) {
        context.fillText(INFINITY_TEXT, x + 18 * scale, y + 44 * scale);
        context.fillStyle = infinityColor(theme);
        context.fillRect(x, y + 34 * scale, 12 * scale, 12 * scale);
        context.fillStyle = color;
    }
    if (legend.limit) {
        context.fillText(legend.limit.text, x + 18 * scale, y + 44 * scale);
        context.fillStyle = thinColor(theme);
        context.fillRect(x, y + 38 * scale, 12 * scale, 3 * scale);
        context.fillRect(x + legend.limit.at * width - scale, y - 3 * scale, 2 * scale, 16 * scale);
        context.fillStyle = color;
    }
    context.textAlign = 'center';
    for (const mark of legend.marks) context.fillText(mark.text, x + mark.at * width, y + 25 * scale);
}
