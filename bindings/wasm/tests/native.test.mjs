// SPDX-License-Identifier: Apache-2.0
// The same bytes as the program, and the program without threads the same as the one with.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ScaleAxis } from '../index.js';
import { model, MODELS, nameOf, program, sequentialProgram, wordsOf, written } from './tools.mjs';

const engine = new ScaleAxis();

/** What of two axes as PLY is not the same: coordinates and radii must be, angles may differ in the last bit. */
function difference(a, b) {
    const words = (bytes) => bytes.toString('latin1').split(/\s+/);
    const [all, others] = [words(a), words(b)];
    if (all.length !== others.length) return Infinity;
    return all.reduce((most, word, i) => {
        if (word === others[i]) return most;
        const gap = Math.abs(Number(word) - Number(others[i])) / Math.max(1, Math.abs(Number(word)));
        return Number.isNaN(gap) ? Infinity : Math.max(most, gap);
    }, 0);
}

for (const [path, options] of MODELS) {
    test(`${path} ${wordsOf(options).join(' ')}: as in the program`, async (t) => {
        const result = await engine.axis(model(path), { name: nameOf(path), ...options, formats: 'ply' });
        const own = Buffer.from(result.axes[0].files.ply);
        const native = written('axis', path, 'ply', wordsOf(options));
        const isSame = own.equals(native);
        t.diagnostic(isSame ? 'the same bytes' : `differ by ${difference(own, native)}`);
        // The sine and cosine of two C libraries differ in the last bit.
        assert.ok(isSame || difference(own, native) < 1e-12);
    });
}

test('skeleton and thickness: as in the program', async () => {
    const cat = 'data/cat.obj';
    const skeleton = await engine.skeleton(model(cat), { name: 'cat.obj', delta: 0.02, formats: 'swc' });
    assert.ok(difference(Buffer.from(skeleton.files.swc), written('skeleton', cat, 'swc', ['--delta', '0.02'])) < 1e-12);
    const thickness = await engine.thickness(model(cat), { name: 'cat.obj', delta: 0.02, formats: 'ply' });
    assert.ok(Buffer.from(thickness.files.ply).equals(written('thickness', cat, 'ply', ['--delta', '0.02'])));
});

for (const [path, options] of MODELS) {
    test(`${path} ${wordsOf(options).join(' ')}: one thread and oneTBB give the same bytes`, () => {
        const words = wordsOf(options);
        const parallel = written('axis', path, 'ply', words, { executable: program, threads: 2 });
        assert.ok(written('axis', path, 'ply', words, { executable: sequentialProgram }).equals(parallel));
    });
}
