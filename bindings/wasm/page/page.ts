// SPDX-License-Identifier: Apache-2.0
// The page that computes: a file comes in, its axis is shown by the viewer.
import { App } from '../../../viewer/src/app';
import { readModel } from '../../../viewer/src/data';
import { download, h, svg } from '../../../viewer/src/dom';
import { openingOf, readLink } from '../../../viewer/src/state';
import '../../../viewer/src/style.css';
import { ScaleAxis, ScaleAxisError } from '../index.js';
import './page.css';

const FUNCTIONS = {
    axis: { label: 'Axis', formats: ['ply', 'glb', 'ma', 'obj', 'vtp'] },
    filtration: { label: 'All scales', formats: ['ply', 'vtp'] },
    skeleton: { label: 'Skeleton', formats: ['swc', 'csv', 'ply', 'graphml', 'json', 'vtp'] },
    thickness: { label: 'Thickness', formats: ['ply', 'glb', 'vtp'] },
} as const;
type FunctionName = keyof typeof FUNCTIONS;

interface Made {
    view: Uint8Array<ArrayBuffer>;
    files: Record<string, Uint8Array>;
}

const textOf = (id: string) => document.getElementById(id)!.textContent!.trim();

async function inflated(bytes: Uint8Array<ArrayBuffer>, format: CompressionFormat): Promise<Uint8Array<ArrayBuffer>> {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** What the page holds as base64 of gzip. */
const unpacked = (id: string) => inflated(Uint8Array.from(atob(textOf(id)), (c) => c.charCodeAt(0)), 'gzip');

/** Points on a torus. */
function cloud(): Uint8Array<ArrayBuffer> {
    const lines: string[] = [];
    for (let i = 0; i < 60; ++i) {
        for (let k = 0; k < 24; ++k) {
            const [u, v] = [(2 * Math.PI * (i + (k % 2) / 2)) / 60, (2 * Math.PI * k) / 24];
            const across = 1 + 0.35 * Math.cos(v);
            lines.push([across * Math.cos(u), 0.35 * Math.sin(v), across * Math.sin(u)].map((x) => x.toFixed(6)).join(' '));
        }
    }
    return new TextEncoder().encode(lines.join('\n'));
}

const SAMPLES: [string, string, () => Promise<Uint8Array<ArrayBuffer>> | Uint8Array<ArrayBuffer>][] = [
    ['Cat', 'cat.obj', () => unpacked('cat')],
    ['Gear', 'gear.off', () => unpacked('gear')],
    ['Ball (image)', 'ball.nrrd', () => unpacked('ball')],
    ['Torus (points)', 'torus.xyz', cloud],
];

let engine: Promise<ScaleAxis> | null = null;
function started(): Promise<ScaleAxis> {
    engine ??= (async () => {
        // Not a module: a page from the disk may start none.
        const url = URL.createObjectURL(new Blob([textOf('worker')], { type: 'text/javascript' }));
        return new ScaleAxis({ wasm: await unpacked('wasm'), worker: () => new Worker(url) });
    })();
    return engine;
}

class Studio {
    private file: { name: string; bytes: Uint8Array<ArrayBuffer> } | null = null;
    private running: AbortController | null = null;
    private app: App | null = null;
    private files: { name: string; content: Record<string, Uint8Array> } | null = null;

    private readonly input = h('input', { type: 'file', class: 'hidden', name: 'file', onchange: () => void this.take(this.input.files?.[0]) });
    private readonly fileName = h('strong', {}, 'Drop a file here');
    private readonly what = (Object.keys(FUNCTIONS) as FunctionName[]).map((value) =>
        h('input', { type: 'radio', name: 'what', value, checked: value === 'axis', onchange: () => this.follow() }));
    private readonly delta = h('input', { type: 'range', name: 'delta', min: 0, max: 100, step: 1, value: 40, oninput: () => this.follow() });
    private readonly scale = h('input', { type: 'range', name: 'scales', min: 1, max: 2, step: 0.01, value: 1.1, oninput: () => this.follow() });
    private readonly deltaText = h('output', { class: 'value' });
    private readonly scaleText = h('output', { class: 'value' });
    private readonly scaleField = h('label', { class: 'field' }, h('span', { title: 'Factor by which balls are grown: larger ones drop small features' }, 'Scale s'), this.scaleText, this.scale);
    private readonly sharp = h('input', { type: 'checkbox', name: 'sharp', checked: true });
    private readonly compact = h('input', { type: 'checkbox', name: 'compact' });
    private readonly clean = h('input', { name: 'clean', placeholder: 'δ / 2', inputmode: 'decimal' });
    private readonly iso = h('input', { name: 'iso', placeholder: 'none', inputmode: 'decimal' });
    private readonly labels = h('input', { name: 'labels', placeholder: 'all of a mask' });
    private readonly compute = h('button', { type: 'button', name: 'compute', class: 'main', disabled: true, onclick: () => void this.run() }, 'Compute');
    private readonly cancel = h('button', { type: 'button', name: 'cancel', hidden: true, onclick: () => this.running?.abort() }, 'Cancel');
    private readonly status = h('div', { class: 'status', role: 'status' });
    private readonly downloads = h('div', { class: 'downloads' });
    private readonly downloadSection = h('section', { hidden: true }, h('h2', {}, 'Download'), this.downloads);
    private readonly result = h('div', { class: 'result' }, emptyView());
    readonly element: HTMLElement;

    constructor() {
        const check = (input: HTMLInputElement, text: string) => h('label', { class: 'check' }, input, h('span', {}, text));
        const field = (text: string, input: HTMLInputElement, about: string) => h('label', { class: 'field' }, h('span', { title: about }, text), input);
        this.element = h('div', { class: 'studio' },
            h('aside', { class: 'setup', 'aria-label': 'Computation' },
                h('header', {}, h('h1', {}, 'scaleaxis'), h('p', { class: 'quiet' }, 'Stable medial axes of solids. All is computed here: nothing leaves this computer.')),
                h('label', { class: 'drop' }, this.input, this.fileName, h('span', { class: 'quiet' }, 'mesh, 3D image or points; or click')),
                h('section', {}, h('h2', {}, 'Samples'), h('div', { class: 'samples' }, ...SAMPLES.map(([label, name, bytes]) =>
                    h('button', { type: 'button', name: `sample-${name.replace(/\..*/, '')}`, onclick: () => void this.takeSample(name, bytes) }, label)))),
                h('fieldset', { class: 'choice' }, h('legend', { class: 'hidden' }, 'What to compute'),
                    ...this.what.map((input) => h('label', {}, input, h('span', {}, FUNCTIONS[input.value as FunctionName].label)))),
                h('section', { class: 'fields' },
                    h('label', { class: 'field' }, h('span', { title: 'Tolerance of the sampling, relative to the diagonal of the bounding box' }, 'Tolerance δ'), this.deltaText, this.delta),
                    this.scaleField),
                h('details', {}, h('summary', {}, 'More options'), h('div', { class: 'fields' },
                    check(this.sharp, 'sheets reach sharp edges'), check(this.compact, 'compact: few vertices'),
                    field('Cleaning', this.clean, 'Erosion thickness below which parts of sheets go, relative to the diagonal; 0: none'),
                    field('Image: iso value', this.iso, 'The solid is above this value'),
                    field('Image: labels', this.labels, 'Those that are solid, separated by commas'))),
                h('div', { class: 'go' }, this.compute, this.cancel), this.status, this.downloadSection),
            this.result);
        this.follow();
        window.addEventListener('dragover', (event) => {
            event.preventDefault();
            this.element.classList.add('dropping');
        });
        window.addEventListener('dragleave', () => this.element.classList.remove('dropping'));
        window.addEventListener('drop', (event) => {
            event.preventDefault();
            this.element.classList.remove('dropping');
            void this.take(event.dataTransfer?.files[0]);
        });
    }

    private get function(): FunctionName {
        return this.what.find((input) => input.checked)!.value as FunctionName;
    }

    /** From 0.05 on the left to 0.001 on the right, by the logarithm. */
    private get tolerance(): number {
        return Number((0.05 * (0.001 / 0.05) ** (Number(this.delta.value) / 100)).toPrecision(2));
    }

    private follow(): void {
        this.deltaText.textContent = String(this.tolerance);
        this.scaleText.textContent = Number(this.scale.value).toFixed(2);
        this.scaleField.hidden = this.function === 'filtration';
    }

    private async take(file: File | undefined): Promise<void> {
        if (file) await this.open(file.name, new Uint8Array(await file.arrayBuffer()));
    }

    private async takeSample(name: string, bytes: () => Promise<Uint8Array<ArrayBuffer>> | Uint8Array<ArrayBuffer>): Promise<void> {
        await this.open(name, await bytes());
    }

    private async open(name: string, bytes: Uint8Array<ArrayBuffer>): Promise<void> {
        this.file = { name, bytes };
        this.fileName.textContent = name;
        this.compute.disabled = false;
        this.running?.abort();
        await this.run();
    }

    private options(): Record<string, unknown> {
        const what = this.function;
        const optional = (input: HTMLInputElement) => (input.value.trim() === '' ? undefined : Number(input.value));
        const labels = this.labels.value.split(',').map((label) => label.trim()).filter((label) => label !== '');
        return {
            delta: this.tolerance,
            clean: optional(this.clean),
            iso: optional(this.iso),
            labels: labels.length > 0 ? labels.map((label) => (Number.isNaN(Number(label)) ? label : Number(label))) : undefined,
            ...(what === 'filtration' ? {} : { scale: Number(this.scale.value) }),
            ...(what === 'skeleton' ? {} : { sharp: this.sharp.checked }),
            ...(what === 'axis' && this.compact.checked ? { compact: true } : {}),
        };
    }

    private async run(): Promise<void> {
        if (!this.file) return;
        const { name, bytes } = this.file;
        const what = this.function;
        const running = new AbortController();
        this.running = running;
        this.compute.disabled = true;
        this.cancel.hidden = false;
        const bar = h('progress', { max: 1, value: 0 });
        const stage = h('span', { class: 'quiet' }, 'starting');
        this.status.replaceChildren(bar, stage);
        document.documentElement.dataset.ready = 'no';
        const start = performance.now();
        try {
            const { formats } = FUNCTIONS[what];
            const result: any = await (await started())[what](bytes, {
                ...this.options(), name, formats: [...formats], view: true, signal: running.signal,
                progress: (words: string, part: number) => {
                    bar.value = part;
                    stage.textContent = words;
                },
            } as any);
            const seconds = (performance.now() - start) / 1000;
            const made: Made = { view: result.view, files: what === 'axis' ? result.axes[0].files : result.files };
            await this.show(made, name, what);
            this.status.replaceChildren(h('span', { class: 'quiet' }, `${name}: ${FUNCTIONS[what].label.toLowerCase()} in ${seconds.toFixed(1)} s`));
            document.documentElement.dataset.ready = 'view';
        } catch (error) {
            if (this.running !== running) return;
            this.status.replaceChildren(running.signal.aborted ? h('span', { class: 'quiet' }, 'cancelled') : errorBox(error));
            document.documentElement.dataset.ready = running.signal.aborted ? 'cancelled' : 'failed';
        } finally {
            if (this.running === running) {
                this.running = null;
                this.compute.disabled = false;
                this.cancel.hidden = true;
            }
        }
    }

    private async show({ view, files }: Made, name: string, what: FunctionName): Promise<void> {
        const model = readModel(await inflated(view, 'deflate'));
        this.app?.dispose();
        this.app = new App([model], [0], model.name, readLink('', openingOf([model])), null);
        this.result.replaceChildren(this.app.element);
        this.files = { name: name.replace(/\..*/, ''), content: files };
        this.downloads.replaceChildren(...Object.keys(files).map((format) =>
            h('button', { type: 'button', name: `save-${format}`, onclick: () => this.save(format, what) }, format.toUpperCase())));
        this.downloadSection.hidden = false;
    }

    private save(format: string, what: FunctionName): void {
        const { name, content } = this.files!;
        download(new Blob([content[format] as BlobPart]), `${name}-${what}.${format}`);
    }

    get view(): App | null {
        return this.app;
    }
}

function errorBox(error: unknown): HTMLElement {
    const { message, code, place } = error as ScaleAxisError;
    return h('div', { class: 'error', role: 'alert' }, h('div', {}, message ?? String(error)),
        code ? h('div', { class: 'code' }, code + (place ? `, at ${place.map((x) => Number(x.toPrecision(5))).join(', ')}` : '')) : null);
}

/** A shape, its axis, and a ball that touches. */
function emptyView(): HTMLElement {
    const style = 'fill:none;stroke:currentColor;stroke-width:1.5';
    const drawing = svg('svg', { viewBox: '0 0 190 110', 'aria-hidden': 'true' },
        svg('rect', { x: 5, y: 5, width: 180, height: 100, rx: 3, style }),
        svg('path', { d: 'M5 5 L55 55 L135 55 L185 5 M5 105 L55 55 M185 105 L135 55', style: 'fill:none;stroke:var(--accent);stroke-width:2.5' }),
        svg('circle', { cx: 100, cy: 55, r: 50, style: `${style};stroke-dasharray:3 4` }));
    return h('div', { class: 'empty' }, h('div', {}, drawing, h('p', {}, 'Drop a mesh (OBJ, OFF, PLY, STL, glTF, 3MF), a 3D image (NRRD, NIfTI, MetaImage, VTK, NumPy)'),
        h('p', {}, 'or points (XYZ, PLY, LAS, PCD), or take a sample.')));
}

const dark = window.matchMedia('(prefers-color-scheme: dark)').matches;
document.documentElement.dataset.theme = dark ? 'dark' : 'light';
const studio = new Studio();
document.getElementById('app')!.replaceChildren(studio.element);
// For tests and for scripts.
Object.assign(window, { scaleaxis: { state: () => studio.view?.current, scene: () => studio.view?.describe(), frame: () => studio.view?.frame(), engine: started } });
started().then((engine) => engine.version()).then(() => (document.documentElement.dataset.ready ??= 'empty'), (error) => {
    document.body.replaceChildren(h('div', { class: 'message', role: 'alert' }, `This browser cannot run WebAssembly: ${error.message}`));
    document.documentElement.dataset.ready = 'failed';
});
