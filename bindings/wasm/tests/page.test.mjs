// SPDX-License-Identifier: Apache-2.0
// The page in Chromium, from the disk: what it computes, shows and saves.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { root } from './tools.mjs';

const url = pathToFileURL(join(root, 'build/wasm/scaleaxis.html')).href;
const said = [];
const asked = [];
let browser = null;
let page = null;

before(async () => {
    browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
        args: ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])],
    });
    page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
    page.setDefaultTimeout(120000);
    // The graphics driver remarks on the tests' own reading of pixels.
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !/GL Driver Message/.test(message.text()) && said.push(message.text()));
    page.on('pageerror', (error) => said.push(String(error)));
    page.on('request', (request) => request.url() !== url && !/^(blob|data):/.test(request.url()) && asked.push(request.url()));
    await page.goto(url);
    await state('empty');
});
after(() => browser?.close());

const element = (name) => page.locator(`[name="${name}"]`);
const state = (...states) => page.waitForFunction((all) => all.includes(document.documentElement.dataset.ready), states);
const choose = (what) => page.locator(`[name="what"][value="${what}"]`).check({ force: true });

/** Does what starts a computation, and waits for its end. */
async function done(action, end = 'view') {
    await page.evaluate(() => (document.documentElement.dataset.ready = 'no'));
    await action();
    await state('view', 'failed', 'cancelled');
    assert.equal(await page.evaluate(() => document.documentElement.dataset.ready), end, await page.locator('.status').innerText());
}

const scene = () => page.evaluate(() => {
    window.scaleaxis.frame();
    return window.scaleaxis.scene()[0];
});

async function saved(format) {
    const [download] = await Promise.all([page.waitForEvent('download'), element(`save-${format}`).click()]);
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

test('a sample: its axis, shown and saved', async () => {
    await done(() => element('sample-cat').click());
    const shown = await scene();
    assert.equal(shown.name, 'cat');
    assert.equal(shown.scale, 1.1);
    assert.ok(shown.surfaces.find((s) => s.name === 'medial axis').triangles > 500);
    assert.equal(shown.surfaces.find((s) => s.name === 'input shape').triangles, 15894);
    for (const [format, beginning] of [['ply', 'ply\n'], ['glb', 'glTF'], ['ma', '']]) {
        const { name, bytes } = await saved(format);
        assert.equal(name, `cat-axis.${format}`);
        assert.ok(bytes.length > 1000 && bytes.subarray(0, beginning.length).toString() === beginning);
    }
});

test('all scales: a slider moves over them', async () => {
    await choose('filtration');
    await done(() => element('compute').click());
    const trianglesAt = async (place) => {
        await element('scale').fill(place);
        return (await scene()).surfaces.find(({ name }) => name === 'medial axis')?.triangles ?? 0;
    };
    const [all, few] = [await trianglesAt('0'), await trianglesAt('900')];
    assert.ok(few < all / 2, `${few} of ${all}`);
});

test('skeleton and thickness', async () => {
    await choose('skeleton');
    await done(() => element('compute').click());
    assert.equal((await saved('swc')).name, 'cat-skeleton.swc');
    await choose('thickness');
    await done(() => element('sample-gear').click());
    assert.equal(await page.evaluate(() => window.scaleaxis.state().coloring), 'thickness');
    await choose('axis');
});

test('an image, points, and a file of the user', async () => {
    await done(() => element('sample-ball').click());
    assert.equal((await scene()).name, 'ball');
    await done(() => element('sample-torus').click());
    assert.ok((await scene()).lines.some((l) => l.name === 'curves' && l.count > 10)); // the axis of a torus is a circle
    await done(() => element('file').setInputFiles(join(root, 'data/thin/box.off')));
    assert.equal((await scene()).name, 'box');
});

test('an error is told, with its code', async () => {
    await done(() => element('file').setInputFiles({ name: 'bad.obj', mimeType: 'text/plain', buffer: Buffer.from('v 0 0 x\n') }), 'failed');
    const text = await page.getByRole('alert').innerText();
    assert.ok(text.includes('bad.obj') && text.includes('file.syntax'), text);
});

test('cancel, and go on', async () => {
    await page.locator('[name="delta"]').fill('100');
    await done(async () => {
        await element('sample-cat').click();
        await page.waitForFunction(() => document.querySelector('.status progress')?.value > 0);
        await element('cancel').click();
    }, 'cancelled');
    await page.locator('[name="delta"]').fill('10');
    await done(() => element('compute').click());
});

test('a warm run takes no longer than it should', async (t) => {
    const seconds = await page.evaluate(async () => {
        const cat = await (async () => {
            const bytes = Uint8Array.from(atob(document.getElementById('cat').textContent), (c) => c.charCodeAt(0));
            return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
        })();
        const engine = await window.scaleaxis.engine();
        const times = [];
        for (let i = 0; i < 3; ++i) {
            const start = performance.now();
            await engine.axis(cat, { name: 'cat.obj', delta: 0.01 });
            times.push((performance.now() - start) / 1000);
        }
        return times;
    });
    t.diagnostic(`cat at delta 0.01: ${seconds.map((s) => s.toFixed(2)).join(', ')} s`);
    assert.ok(Math.min(...seconds) < 30);
});

test('it says nothing, and asks for nothing', () => assert.deepEqual([said, asked], [[], []]));
