// SPDX-License-Identifier: Apache-2.0
// The same bytes as the program, and the program without threads the same as the one with.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ScaleAxis } from '../index.js';
import { cloud, model, MODELS, nameOf, program, sequentialProgram, wordsOf, written } from './tools.mjs';

const engine = new ScaleAxis();

for (const [path, options] of [...MODELS, [cloud(), { points: 'mls', delta: 0.03 }], [cloud(), { points: 'crust' }]]) {
    test(`${nameOf(path)} ${wordsOf(options).join(' ')}: as in the program`, async () => {
        const result = await engine.axis(model(path), { name: nameOf(path), ...options, formats: 'ply' });
        assert.ok(Buffer.from(result.axes[0].files.ply).equals(written('axis', path, 'ply', wordsOf(options))));
    });
}

for (const [name, format] of [['filtration', 'ply'], ['skeleton', 'swc'], ['skeleton', 'csv'], ['thickness', 'ply']]) {
    test(`${name} as ${format}: as in the program`, async () => {
        const { files } = await engine[name](model('data/cat.obj'), { name: 'cat.obj', delta: 0.02, formats: format });
        assert.ok(Buffer.from(files[format]).equals(written(name, 'data/cat.obj', format, ['--delta', '0.02'])));
    });
}

for (const [path, options] of MODELS) {
    test(`${path} ${wordsOf(options).join(' ')}: one thread and oneTBB give the same bytes`, () => {
        const words = wordsOf(options);
        const parallel = written('axis', path, 'ply', words, { executable: program, threads: 2 });
        assert.ok(written('axis', path, 'ply', words, { executable: sequentialProgram }).equals(parallel));
    });
}
