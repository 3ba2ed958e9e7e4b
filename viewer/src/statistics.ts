// SPDX-License-Identifier: Apache-2.0
// The statistics of a run as tables. docs/statistics.md has their keys; what is absent is left out.
import type { Axis, Model } from './data';
import { shortNumber, withUnit } from './colors';
import { h } from './dom';
import type { Level } from './level';

/* eslint-disable @typescript-eslint/no-explicit-any -- JSON of any version of the program */
const count = (n: number) => n.toLocaleString('en').replaceAll(',', '\u202f');
const seconds = (s: number) => (s < 0.1 ? `${(1000 * s).toFixed(0)} ms` : `${s.toFixed(2)} s`);

function table(caption: string, rows: (Node | string)[][], head?: string[]): HTMLElement | null {
    if (rows.length === 0) return null;
    return h('table', {}, h('caption', {}, caption),
        head ? h('thead', {}, h('tr', {}, ...head.map((text) => h('th', { scope: 'col' }, text)))) : null,
        h('tbody', {}, ...rows.map(([first, ...rest]) =>
            h('tr', {}, h('th', { scope: 'row' }, first!), ...rest.map((cell) => h('td', {}, cell))))));
}

function verdict(agrees: boolean | null | undefined): HTMLElement {
    if (agrees === true) return h('span', { class: 'good' }, '✓ yes');
    if (agrees === false) return h('span', { class: 'bad' }, '✗ no');
    return h('span', { class: 'unknown' }, 'not known');
}

function topologyTable(s: any, a: any): HTMLElement | null {
    const known: [string, any][] = [
        ['input solid', s?.solid], ['union of balls', a?.dual_complex?.topology], ['medial axis', a?.medial_complex?.topology],
        ['filtered', a?.filter?.topology], ['cleaned', a?.cleaning?.topology], ['this axis', a?.topology],
    ];
    const number = (n: any) => (typeof n === 'number' ? String(n) : '–');
    return table('Topology', known.filter(([, t]) => t).map(([name, t]) =>
        [name, number(t.components), number(t.euler), number(t.tunnels), number(t.voids)]), ['', 'parts', 'Euler', 'tunnels', 'voids']);
}

/** A point of the statistics, and the radius of the ball there, if there is one. */
export interface Place {
    point: [number, number, number];
    radius: number | null;
}

/** A value that a click shows where it is. */
function placeButton(name: string, value: string, point: [number, number, number], radius: number | null, goTo: (place: Place) => void): HTMLElement {
    const at = point.map(shortNumber).join(', ');
    return h('button', { type: 'button', name, class: 'place', title: `Show (${at})`, onclick: () => goTo({ point, radius }) },
        h('span', {}, value), h('span', { class: 'quiet' }, ` at ${at}`));
}

/** Thickness of a surface, and its thin regions. */
function thicknessTables(s: any, unit: string, goTo: (place: Place) => void): (HTMLElement | null)[] {
    const { local, foot, regions } = s ?? {};
    if (!local?.minimum_place || !foot) return [];
    const length = (value: number) => withUnit(value, unit);
    const rows = [
        ['least', placeButton('least', length(local.minimum), local.minimum_place, null, goTo)],
        ['mean', length(local.mean)], ['deviation', length(local.deviation)],
        ['largest', placeButton('largest', length(local.maximum), local.maximum_place, null, goTo)],
        ['mean at the foot point', length(foot.mean)],
    ];
    const most = 10;
    const thin = (regions ?? []).slice(0, most).map((r: any, i: number) =>
        [String(i), placeButton(`region-${i}`, length(r.minimum), r.ball.center, r.ball.radius, goTo), withUnit(r.area, unit, 2)]);
    const more = (regions?.length ?? 0) > most ? `, the first ${most} of ${regions.length}` : '';
    return [table('Local thickness', rows), table(`Thinner than ${length(s.limit)}${more}`, thin, ['', 'least', 'area'])];
}

function skeletonTable(k: any, unit: string): HTMLElement | null {
    if (!k) return null;
    const lengths = ([['length of the branches', 'length'], ['least radius', 'least_radius'], ['mean radius', 'mean_radius'], ['largest radius', 'largest_radius']] as const)
        .map(([name, key]) => [name, withUnit(k[key], unit)]);
    return table('Skeleton', [...(['branches', 'ends', 'junctions'] as const).map((key) => [key, count(k[key])]), ...lengths, ['topology of the axis', verdict(k.is_homotopic)]]);
}

/** How the union of balls compares with the solid: known of fitted balls, which lie in it. */
function accuracyTable(fit: any, unit: string, goTo: (place: Place) => void): HTMLElement | null {
    const { accuracy, thin_part: thin } = fit ?? {};
    if (!accuracy) return null;
    const place = (name: string, value: number, point: any, radius: number | null) => placeButton(name, withUnit(value, unit), point, radius, goTo);
    const ball = (name: string, { center, radius }: any) => place(name, 2 * radius, center, radius);
    return table('Accuracy', [
        ['surface to union, largest', place('farthest', accuracy.largest_distance, accuracy.farthest_sample, null)],
        ['surface to union, mean', withUnit(accuracy.mean_distance, unit)],
        ['union beyond the surface', '0'],
        ['thinnest', ball('thinnest', accuracy.thinnest)],
        ['thickest', ball('thickest', accuracy.thickest)],
        ...(thin ? [['thin for δ', place('thin-part', thin.thickness, thin.place, thin.thickness / 2)]] : []),
    ]);
}

/** Options with their values, those of a group under its name. What was not given is left out. */
export function optionRows(options: object, group = ''): [string, string][] {
    return Object.entries(options).flatMap(([key, value]): [string, string][] => {
        const name = `${group}${key.replaceAll('_', ' ')}`;
        if (value === null || (Array.isArray(value) && value.length === 0)) return [];
        if (Array.isArray(value)) return [[name, value.map((v) => (typeof v === 'object' ? JSON.stringify(v) : String(v))).join(', ')]];
        return typeof value === 'object' ? optionRows(value, `${name}: `) : [[name, String(value)]];
    });
}

/** Does the topology of a model agree everywhere, as far as it is known? */
export function agreement(axis: Axis | undefined): boolean | null {
    const known = Object.values((axis?.statistics as any)?.agreement ?? {}).filter((v) => v !== null);
    return known.length === 0 ? null : known.every((v) => v === true);
}

/** \param level what of the axis is shown \param goTo shows a place of the model */
export function statisticsOf(model: Model, axis: Axis | undefined, level: Level | undefined, goTo: (place: Place) => void): HTMLElement {
    const s = model.statistics as any;
    const a = axis?.statistics as any;
    const rows = (entries: [string, any][]) =>
        entries.filter(([, value]) => typeof value === 'number').map(([name, value]) => [name, count(value)]);
    const counts = rows([
        [model.thickness ? 'triangles of the surface' : 'triangles of the input', s?.mesh?.triangles ?? (model.shape ? model.shape.corners.length / 3 : null)],
        ['samples', s?.samples], ['balls', a?.balls ?? s?.balls], ['of these hidden', a?.hidden_balls],
        ['sheets before the filter', a?.filter?.sheets_before],
        ['sheets', axis?.scales ? level?.sheets : axis ? axis.sheets.reduce((most, n) => Math.max(most, n + 1), 0) : null],
        ['faces', level?.faces], ['curve edges', level?.lines.curves.length], ['vertices of the axis', level?.vertices.length],
    ]);
    const facts: (Node | string)[][] = [];
    for (const [name, value] of [['input', s?.input], ['axis', a?.file]] as const) {
        if (value) facts.push([name, h('span', { title: value }, String(value).split('/').pop()!)]);
    }
    if (axis && a) facts.push(['scale s', axis.scales ? 'all' : String(axis.scale)]);
    if (s?.tolerance) facts.push(['tolerance δ', withUnit(s.tolerance, model.lengthUnit)]);
    if (s?.diagonal) facts.push(['diagonal', withUnit(s.diagonal, model.lengthUnit)]);

    const agrees = a?.agreement;
    const agreements = agrees && table('Same topology?', [
        ['solid = union', verdict(agrees.solid_and_dual)],
        ['union = medial axis', verdict(agrees.dual_and_medial)],
        ['medial axis = filtered', verdict(agrees.medial_and_filtered)],
        ...('filtered_and_cleaned' in agrees ? [['filtered = cleaned', verdict(agrees.filtered_and_cleaned)]] : []),
    ]);
    const costs = [...(s?.costs ?? []), ...(a?.costs ?? []), ...(a?.surface?.costs ?? [])];
    const times = costs.map((c: any) => [c.stage, seconds(c.seconds)]);
    if (times.length > 0) times.push(['together', seconds(costs.reduce((sum: number, c: any) => sum + c.seconds, 0))]);
    // Lines in documents of before version 2.
    const warnings: string[] = [...(s?.warnings ?? []), ...(a?.surface?.warnings ?? [])].map((w) => (typeof w === 'string' ? w : w.message));
    return h('div', { class: 'statistics' },
        table('Files', facts), table('Counts', counts), topologyTable(s, a), agreements ?? null, skeletonTable(s?.skeleton, model.lengthUnit), ...thicknessTables(s, model.lengthUnit, goTo), accuracyTable(s?.fit, model.lengthUnit, goTo),
        warnings.length > 0 ? h('ul', { class: 'warnings' }, ...warnings.map((w) => h('li', {}, w))) : null,
        table('Time', times), table('Options', optionRows(s?.options ?? {})));
}
/* eslint-enable */
