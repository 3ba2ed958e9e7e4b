// SPDX-License-Identifier: Apache-2.0
// The colour scale: as an element of the page, and drawn into a picture.
import { colorTable, shortNumber, ticks } from './colors';
import { h } from './dom';
import type { Ranges } from './modelview';
import type { State } from './state';

interface Legend {
    title: string;
    end: number;
    marks: { at: number; text: string }[]; // `at`: 0…1
}

function legendOf(state: State, ranges: Ranges): Legend | null {
    if (!state.shown.axis && !state.shown.balls) return null;
    if (state.coloring === 'radius') {
        const marks = ticks(ranges.radius).map((value) => ({ at: ranges.radius > 0 ? value / ranges.radius : 0, text: shortNumber(value) }));
        return { title: 'Radius, in units of the model', end: ranges.radius, marks };
    }
    if (state.coloring === 'angle') {
        return { title: 'Object angle', end: 90, marks: [0, 30, 60, 90].map((value) => ({ at: value / 90, text: `${value}°` })) };
    }
    return null;
}

function gradient(state: State): string {
    const table = colorTable(state.map);
    const stops = Array.from({ length: 17 }, (_, i) => `rgb(${table.subarray(3 * Math.min(255, 16 * i), 3 * Math.min(255, 16 * i) + 3).join()})`);
    return `linear-gradient(to right, ${stops.join()})`;
}

export function updateLegend(element: HTMLElement, state: State, ranges: Ranges): void {
    const legend = legendOf(state, ranges);
    element.hidden = !legend;
    if (!legend) return;
    element.replaceChildren(
        h('div', { class: 'legend-title' }, legend.title),
        h('div', { class: 'legend-bar', style: `background: ${gradient(state)}` }),
        h('div', { class: 'legend-marks' }, ...legend.marks.map((m) => h('span', { style: `left: ${100 * m.at}%` }, m.text))));
}

/** The same in the lower left corner of a picture. */
export function drawLegend(context: CanvasRenderingContext2D, scale: number, state: State, ranges: Ranges, color: string): void {
    const legend = legendOf(state, ranges);
    if (!legend) return;
    const width = 220 * scale;
    const x = 24 * scale;
    const y = context.canvas.height - 48 * scale;
    const table = colorTable(state.map);
    for (let i = 0; i < 256; ++i) {
        context.fillStyle = `rgb(${table.subarray(3 * i, 3 * i + 3).join()})`;
        context.fillRect(x + (i / 256) * width, y, width / 256 + 1, 10 * scale);
    }
    context.fillStyle = color;
    context.font = `${12 * scale}px system-ui, sans-serif`;
    context.textAlign = 'left';
    context.fillText(legend.title, x, y - 7 * scale);
    context.textAlign = 'center';
    for (const mark of legend.marks) context.fillText(mark.text, x + mark.at * width, y + 25 * scale);
}
