// SPDX-License-Identifier: Apache-2.0
// What the tests share: models, programs, and axes as both compute them.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

export const package_ = join(dirname(fileURLToPath(import.meta.url)), '..');
export const root = join(package_, '../..');
const folder = mkdtempSync(join(tmpdir(), 'scaleaxis-wasm-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

export const model = (path) => readFileSync(resolve(root, path));
export const bytesOf = (text) => new TextEncoder().encode(text);

export const program = process.env.SCALEAXIS ?? join(root, 'build/release/bin/scaleaxis');
export const sequentialProgram = join(root, 'build/sequential/bin/scaleaxis');

/** The file that a command of a program writes. */
export function written(command, path, format, words, { executable = program, threads = 1 } = {}) {
    const file = join(folder, `out.${format}`);
    rmSync(file, { force: true });
    execFileSync(executable, [command, resolve(root, path), '-o', file, '-q', '--threads', String(threads), ...words], { stdio: ['ignore', 'ignore', 'pipe'] });
    return readFileSync(file);
}

/** Bundled models, and options that fit: of the program, and the same in JavaScript. */
export const MODELS = [
    ['data/cat.obj', { delta: 0.01 }],
    ['data/cat.obj', { delta: 0.02, scale: 1.5 }],
    ['data/thin/L.off', { delta: 0.02 }],
    ['data/thin/box.off', { delta: 0.02 }],
    ['data/thin/gear.off', { delta: 0.02 }],
    ['data/thin/plate.off', { delta: 0.02 }],
    ['data/thin/plate20.off', { delta: 0.02 }],
    ['data/thin/tube.off', { delta: 0.02 }],
    ['data/dirty/joined_tetrahedra.obj', { delta: 0.02 }],
    ['data/dirty/multibody.stl', { delta: 0.02 }],
    ['data/dirty/platonic_shelf.obj', { delta: 0.02 }],
    ['data/dirty/wallhole.obj', { delta: 0.02 }],
    ['data/dirty/whitespace.off', { delta: 0.02 }],
    ['examples/robot/meshes/finger.obj', { delta: 0.02 }],
    ['data/images/BallBinary30x30x30_gz.nrrd', { delta: 0.02 }],
    ['data/images/BallBinary30x30x30.nii.gz', { delta: 0.02 }],
];

/** A file of points on an ellipsoid. */
export function cloud() {
    const file = join(folder, 'cloud.xyz');
    const points = Array.from({ length: 1500 }, (_, i) => {
        const [z, angle] = [(2 * i + 1) / 1500 - 1, i * 2.399963229728653];
        const across = Math.sqrt(1 - z * z);
        return [across * Math.cos(angle), 0.7 * across * Math.sin(angle), 1.3 * z].map((x) => x.toFixed(9)).join(' ');
    });
    writeFileSync(file, points.join('\n'));
    return file;
}

export const wordsOf = (options) => Object.entries(options).flatMap(([name, value]) => [`--${name}`, String(value)]);
export const nameOf = (path) => basename(path);
