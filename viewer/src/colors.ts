// SPDX-License-Identifier: Apache-2.0
// Colours of values and of sheets. A colour is three bytes of sRGB.
import { interpolateCividis, interpolateMagma, interpolateViridis } from 'd3-scale-chromatic';

export type Rgb = readonly [number, number, number];

export const COLOR_MAPS = ['viridis', 'cividis', 'magma'] as const;
export type ColorMap = (typeof COLOR_MAPS)[number];

const INTERPOLATORS: Record<ColorMap, (t: number) => string> = {
    viridis: interpolateViridis,
    cividis: interpolateCividis,
    magma: interpolateMagma,
};

function parsed(css: string): Rgb {
    const hex = /^#(..)(..)(..)$/.exec(css);
    if (hex) return [1, 2, 3].map((i) => parseInt(hex[i]!, 16)) as unknown as Rgb;
    return css.match(/\d+/g)!.slice(0, 3).map(Number) as unknown as Rgb;
}

const tables = new Map<ColorMap, Uint8Array>();

/** 256 colours of a perceptually uniform map, three bytes each. */
export function colorTable(map: ColorMap): Uint8Array {
    let table = tables.get(map);
    if (!table) {
        table = new Uint8Array(768);
        for (let i = 0; i < 256; ++i) table.set(parsed(INTERPOLATORS[map](i / 255)), 3 * i);
        tables.set(map, table);
    }
    return table;
}

/** A colour of OKLab (Ottosson 2020) by lightness, chroma and hue in turns. */
function oklch(lightness: number, chroma: number, turns: number): Rgb {
    const a = chroma * Math.cos(2 * Math.PI * turns);
    const b = chroma * Math.sin(2 * Math.PI * turns);
    const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
    const linear = [
        4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
        -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
    return linear.map((value) => {
        const v = Math.min(1, Math.max(0, value));
        return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
    }) as unknown as Rgb;
}

/** A hue for each number: all of one lightness and chroma, those of near numbers far apart, as in scaleaxis-render. */
export function sheetColor(number: number): Rgb {
    const turns = 0.72 + (number * (Math.sqrt(5) - 1)) / 2;
    return oklch(0.77, 0.115, turns - Math.floor(turns));
}

/** Round numbers from 0 to about `end`: 3 to 7 of them. */
export function ticks(end: number): number[] {
    if (!(end > 0)) return [0];
    const raw = end / 4;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 2.5, 5, 10].map((n) => n * power).find((n) => n >= raw * 0.999)!;
    const result = [];
    for (let i = 0; i * step <= end * 1.0001; ++i) result.push(i * step);
    return result;
}

/** Round numbers from 0 to `end` at such distances that their square roots can be told apart. */
export function rootTicks(end: number): number[] {
    const apart = 0.18;
    const result = [0];
    const top = end > 0 ? Math.floor(Math.log10(end)) : NaN;
    let last = 1 + apart;
    for (const power of [top, top - 1, top - 2]) {
        for (const digit of [5, 2, 1]) {
            const value = Number(`${digit}e${power}`);
            const at = Math.sqrt(value / end);
            if (!(at >= apart && at <= last - apart)) continue;
            result.splice(1, 0, value);
            last = at;
        }
    }
    return result;
}

/** A length in as many digits as a reader needs. */
export function shortNumber(value: number): string {
    if (value === 0) return '0';
    if (!Number.isFinite(value)) return '∞';
    const size = Math.abs(value);
    return size >= 1e6 || size < 1e-4 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}

/** The same with its unit, which may be empty. \param power 2 for an area */
export function withUnit(value: number, unit: string, power: 1 | 2 = 1): string {
    return `${shortNumber(value)}${unit && `\u202f${unit}`}${unit && power === 2 ? '²' : ''}`;
}
