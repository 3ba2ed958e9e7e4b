// SPDX-License-Identifier: Apache-2.0
// What the tests share: the program, files that it reads, the viewer's modules, and the browser.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { build } from 'esbuild';
import { chromium } from 'playwright-core';

const here = dirname(fileURLToPath(import.meta.url));
export const root = join(here, '../..');
const program = process.env.SCALEAXIS ?? join(root, 'build/release/bin/scaleaxis');
if (!existsSync(program)) throw new Error(`${program} is not there: build it (tools/build release), or name it in SCALEAXIS`);

export const folder = mkdtempSync(join(tmpdir(), 'scaleaxis-viewer-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

export const file = (name) => join(folder, name);
export const urlOf = (name, fragment = '') => pathToFileURL(file(name)).href + (fragment && `#${fragment}`);
export const run = (...words) => execFileSync(program, words, { cwd: folder, encoding: 'utf8' });

/** A module of the viewer, for Node. */
export async function load(name) {
    const outfile = file(`${name}.mjs`);
    await build({ entryPoints: [join(here, `../src/${name}.ts`)], bundle: true, format: 'esm', outfile, logLevel: 'warning' });
    return import(pathToFileURL(outfile).href);
}

/** The texts of the data in a page. */
export const dataOf = (name) =>
    [...readFileSync(file(name), 'utf8').matchAll(/<script type="application\/x-scaleaxis">([^<]*)<\/script>/g)].map((m) => m[1]);

/** Writes an axis as text PLY. `faces`: { corners, sheet, angle }. */
export function writeAxis(name, { vertices, faces = [], edges = [] }) {
    writeFileSync(file(name), [
        'ply', 'format ascii 1.0', `element vertex ${vertices.length}`, ...['x', 'y', 'z', 'radius'].map((p) => `property double ${p}`),
        `element face ${faces.length}`, 'property list uchar int vertex_indices', 'property int sheet', 'property double angle',
        `element edge ${edges.length}`, 'property int vertex1', 'property int vertex2', 'end_header',
        ...vertices.map((v) => v.join(' ')), ...faces.map((f) => [f.corners.length, ...f.corners, f.sheet, f.angle].join(' ')),
        ...edges.map((e) => e.join(' ')), ''].join('\n'));
}

/** Writes a mesh as OFF. */
export function writeMesh(name, vertices, triangles) {
    writeFileSync(file(name), ['OFF', `${vertices.length} ${triangles.length} 0`, ...vertices.map((v) => v.join(' ')),
        ...triangles.map((t) => `3 ${t.join(' ')}`), ''].join('\n'));
}

/** The corners and triangles of the box from (-x, -y, -z) to (x, y, z). */
export function box(x, y, z) {
    const vertices = Array.from({ length: 8 }, (_, i) => [i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z]);
    const triangles = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]];
    return [vertices, triangles];
}

/** A square sheet in the plane z = 0 and a second one above it to the right, which meet in no point, and a curve. */
export const squares = {
    vertices: [[-2, -1, 0, 0.5], [0, -1, 0, 0.5], [0, 1, 0, 0.5], [-2, 1, 0, 0.5],
        [0.5, -1, 0, 0.25], [2, -1, 0, 0.25], [2, 1, 0, 0.75], [0.5, 1, 0, 0.75], [2, 1.5, 0, 0.1]],
    faces: [{ corners: [0, 1, 2, 3], sheet: 0, angle: 80 }, { corners: [4, 5, 6], sheet: 1, angle: 40 }, { corners: [4, 6, 7], sheet: 1, angle: 45 }],
    edges: [[6, 8]],
};

let browser = null;

/** A page of its own, with what it said and asked for. */
export async function open(url, options = {}) {
    browser ??= await chromium.launch({
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
        args: ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])],
    });
    const context = await browser.newContext({ viewport: { width: 900, height: 600 }, ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(120000);
    const said = [];
    const asked = [];
    page.on('console', (message) => {
        // The graphics driver remarks on the tests' own reading of pixels; the page has no part in it.
        if (/GL Driver Message \(OpenGL, Performance/.test(message.text())) return;
        if (['error', 'warning'].includes(message.type())) said.push(message.text());
    });
    page.on('pageerror', (error) => said.push(String(error)));
    page.on('request', (request) => request.url() !== url.replace(/#.*/, '') && !request.url().startsWith('blob:') && !request.url().startsWith('data:') && asked.push(request.url()));
    await page.goto(url, { timeout: 120000 });
    await ready(page);
    return { page, said, asked, close: () => context.close() };
}

export const ready = (page) =>
    page.waitForFunction(() => ['view', 'sheet', 'failed'].includes(document.documentElement.dataset.ready), null, { timeout: 180000 });

export const closeBrowser = () => browser?.close();

export const stateOf = (page) => page.evaluate(() => window.scaleaxis.state());
/** The scene as it is drawn for the state that is now; otherwise it may be a frame behind. */
export const sceneOf = (page) => page.evaluate(() => {
    window.scaleaxis.frame();
    return window.scaleaxis.scene();
});

/** What the canvas shows: how much of each part of it is not background, and a number for all of it. */
export const pixels = (page) => page.evaluate(() => {
    window.scaleaxis.frame();
    const canvas = document.querySelector('.stage canvas');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const { data, width, height } = context.getImageData(0, 0, copy.width, copy.height);
    const parts = { left: 0, right: 0, upper: 0, lower: 0 };
    let all = 0;
    let hash = 0;
    for (let y = 0, i = 0; y < height; ++y) {
        for (let x = 0; x < width; ++x, i += 4) {
            hash = (Math.imul(hash, 31) + data[i] + 7 * data[i + 1] + 13 * data[i + 2]) | 0;
            if (data[i] === data[0] && data[i + 1] === data[1] && data[i + 2] === data[2]) continue;
            ++all;
            ++parts[x < width / 2 ? 'left' : 'right'];
            ++parts[y < height / 2 ? 'upper' : 'lower'];
        }
    }
    return { ...parts, all, hash };
});

/** Clicks on the canvas, at parts of its width and height. */
export async function clickAt(page, x, y) {
    const box = await page.locator('.stage canvas').boundingBox();
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
}
