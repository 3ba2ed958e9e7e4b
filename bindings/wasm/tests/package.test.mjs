// SPDX-License-Identifier: Apache-2.0
// The package in Node: results, errors, progress, cancellation, and its size.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { axis, convert, filtration, ScaleAxis, ScaleAxisError, skeleton, thickness, version } from '../index.js';
import { bytesOf, model, package_, root } from './tools.mjs';

const cat = model('data/cat.obj');
const coarse = { name: 'cat.obj', delta: 0.03 };
const box = model('data/thin/box.off');
const isError = (code, more = {}) => (error) => {
    assert.ok(error instanceof ScaleAxisError, String(error));
    assert.equal(error.code, code);
    assert.deepEqual(Object.fromEntries(Object.keys(more).map((key) => [key, error[key]])), more);
    return true;
};

test('an axis: arrays that belong together, and statistics', async () => {
    const stages = [];
    let last = 0;
    const { axes, balls, statistics } = await axis(cat, { ...coarse, scale: [1, 2], progress: (stage, part) => {
        assert.ok(part >= last && part <= 1, `${stage} ${part}`);
        last = part;
        stages.push(stage);
    } });
    assert.deepEqual(axes.map((a) => a.scale), [1, 2]);
    const [{ vertices, radii, edges, faces, faceSheets, faceAngles, triangles, triangleSheets, sheets }] = axes;
    assert.ok(vertices instanceof Float64Array && radii.length > 50 && vertices.length === 3 * radii.length);
    assert.ok(radii.every((r) => r >= 0) && balls.length === 4 * statistics.balls);
    assert.ok(edges instanceof Int32Array && edges.length > 0 && edges.every((v) => v >= 0 && v < radii.length));
    assert.equal(faces.offsets.length, faceSheets.length + 1);
    assert.equal(faces.offsets.at(-1), faces.items.length);
    assert.equal(faceAngles.length, faceSheets.length);
    assert.equal(triangles.length, 3 * triangleSheets.length);
    assert.equal(triangleSheets.length, faces.items.length - 2 * faceSheets.length);
    assert.ok(faceSheets.every((s) => s >= 0 && s < sheets));
    assert.equal(statistics.mesh.triangles, 15894);
    assert.equal(axes[0].statistics.result.balls, radii.length);
    assert.ok(axes[1].radii.length < radii.length && last === 1 && stages.includes('sampling'));
});

test('skeleton, thickness and filtration', async () => {
    const curves = await skeleton(cat, { ...coarse, formats: ['swc'] });
    assert.ok(curves.branches.offsets.length > 4 && curves.nodes.length === 3 * curves.radii.length);
    assert.match(new TextDecoder().decode(curves.files.swc), /^#/);
    const walls = await thickness(box, { name: 'box.off', delta: 0.02 });
    assert.equal(walls.local.length, walls.vertices.length / 3);
    const { minimum, maximum } = walls.statistics.thickness;
    assert.ok(minimum > 0 && minimum <= maximum);
    const nested = await filtration(cat, coarse);
    assert.equal(nested.faceScales.length, nested.faceSheets.length);
    assert.ok(nested.plateau.begin < nested.plateau.end && nested.levels.length > 2);
});

test('images and points', async () => {
    const ball = await axis(model('data/images/BallBinary30x30x30_gz.nrrd'), { name: 'ball.nrrd' });
    assert.ok(ball.axes[0].radii.length > 0 && ball.statistics.image.sizes[0] === 30);
    const lines = [];
    for (let i = 0; i < 1200; ++i) {
        const z = 1 - (2 * i + 1) / 1200;
        const [across, angle] = [Math.sqrt(1 - z * z), i * Math.PI * (3 - Math.sqrt(5))];
        lines.push(`${across * Math.cos(angle)} ${2 * across * Math.sin(angle)} ${3 * z}`);
    }
    const cloud = await axis(bytesOf(lines.join('\n')), { name: 'egg.xyz' });
    assert.ok(cloud.axes[0].triangleSheets.length > 0 && cloud.statistics.points);
});

test('voids of masks are filled where asked for', async () => {
    const mask = (isSolid) => {
        const inside = (v, least, most) => v.every((x) => x >= least && x <= most);
        const voxels = Uint8Array.from({ length: 12 ** 3 }, (_, i) => {
            const voxel = [i % 12, Math.floor(i / 12) % 12, Math.floor(i / 144)];
            return inside(voxel, 1, 10) && (isSolid || !inside(voxel, 4, 7)) ? 1 : 0;
        });
        const header = bytesOf('NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n');
        return Uint8Array.from([...header, ...voxels]);
    };
    const vertices = async (bytes, options) => (await axis(bytes, { name: 'box.nrrd', delta: 0.05, ...options })).axes[0].vertices;
    const [hollow, filled, solid] = [await vertices(mask(false)), await vertices(mask(false), { fillVoids: true }), await vertices(mask(true))];
    assert.deepEqual(filled, solid);
    assert.notDeepEqual(hollow, solid);
    await assert.rejects(axis(box, { name: 'box.off', fillVoids: true }), isError('option'));
});

test('files: the format of each, and of a stored axis another', async () => {
    const { axes: [{ files, radii }] } = await axis(box, { name: 'box.off', delta: 0.02, formats: ['ply', 'glb', 'ma', 'obj', 'vtp'] });
    const begins = (format, text) => assert.equal(new TextDecoder().decode(files[format].slice(0, text.length)), text);
    begins('ply', 'ply');
    begins('glb', 'glTF');
    begins('ma', `${radii.length} `);
    const ma = await convert(files.ply, 'ma', { name: 'axis.ply' });
    assert.deepEqual(ma, files.ma);
    await assert.rejects(axis(box, { name: 'box.off', formats: 'stl' }), isError('file.format'));
});

test('errors have code, element, index and place', async () => {
    await assert.rejects(axis(bytesOf('v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n'), { name: 'x.obj' }), isError('file.value', { element: 'face', index: 1 }));
    await assert.rejects(axis(bytesOf('v 0 0 x\n'), { name: 'x.obj' }), isError('file.syntax', { element: 'line', index: 1 }));
    await assert.rejects(axis(bytesOf('hello'), { name: 'x' }), isError('file.format', { element: null, index: null, place: null }));
    await assert.rejects(axis(bytesOf(''), { name: 'x.obj' }), isError('file.open'));
    await assert.rejects(axis(box, { name: 'box.off', delta: 7 }), isError('option'));
    await assert.rejects(axis(box, { name: 'box.off', delta: 'fine' }), isError('option'));
    await assert.rejects(axis(box, { name: 'box.off', deltas: 0.1 }), isError('option'));
    await assert.rejects(axis(box, { name: 'box.off', iso: 3 }), isError('option'));
    await assert.rejects(axis(7), TypeError);
    const flat = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n';
    await assert.rejects(axis(bytesOf(flat), { name: 'flat.obj' }), ScaleAxisError);
});

test('errors leave no memory behind', async () => {
    const engine = new ScaleAxis();
    for (let i = 0; i < 2000; ++i) await assert.rejects(engine.axis(bytesOf('v 0 0 x\n'), { name: 'x.obj' }), isError('file.syntax'));
    await engine.axis(box, { name: 'box.off', delta: 0.05 });
    engine.close();
});

test('a signal cancels at once, and the next call works', async () => {
    const engine = new ScaleAxis();
    const control = new AbortController();
    const start = performance.now();
    const long = engine.axis(cat, { name: 'cat.obj', delta: 0.001, signal: control.signal, progress: () => control.abort() });
    const waiting = engine.axis(cat, { ...coarse, signal: control.signal });
    await assert.rejects(long, { name: 'AbortError' });
    await assert.rejects(waiting, { name: 'AbortError' });
    assert.ok(performance.now() - start < 20000);
    assert.ok((await engine.axis(box, { name: 'box.off', delta: 0.05 })).axes[0].radii.length > 0);
    await assert.rejects(engine.axis(box, { signal: AbortSignal.abort() }), { name: 'AbortError' });
    engine.close();
});

test('calls run one after the other, and give what they give alone', async () => {
    const alone = await axis(cat, coarse);
    const [first, other, second] = await Promise.all([axis(cat, coarse), axis(box, { name: 'box.off', delta: 0.05 }), axis(cat, coarse)]);
    assert.deepEqual(first.axes[0].vertices, alone.axes[0].vertices);
    assert.deepEqual(second.axes[0].radii, alone.axes[0].radii);
    assert.notEqual(other.axes[0].radii.length, alone.axes[0].radii.length);
});

test('the version is that of the library and of the package', async () => {
    const header = readFileSync(join(root, 'include/scaleaxis/version.hpp'), 'utf8').match(/SCALEAXIS_VERSION "(.*)"/)[1];
    assert.equal(await version(), header);
    assert.equal(JSON.parse(readFileSync(join(package_, 'package.json'), 'utf8')).version, header);
});

test('the package is small', () => {
    const wasm = readFileSync(join(package_, 'scaleaxis.wasm'));
    const [{ size, files }] = JSON.parse(execFileSync('npm', ['pack', '--dry-run', '--json'], { cwd: package_, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }));
    const sizes = { wasm: wasm.length, gzip: gzipSync(wasm, { level: 9 }).length, package: size };
    assert.ok(sizes.wasm <= 1.8e6 && sizes.gzip <= 720e3 && sizes.package <= 1e6, JSON.stringify(sizes));
    assert.deepEqual(files.map((f) => f.path).sort(), ['LICENSE', 'NOTICE', 'README.md', 'core.js', 'index.d.ts', 'index.js', 'package.json', 'scaleaxis.wasm', 'worker.js']);
});

test('the types fit', () => {
    const folder = mkdtempSync(join(tmpdir(), 'scaleaxis-types-'));
    try {
        writeFileSync(join(folder, 'use.ts'), `
import { axis, convert, ScaleAxis, ScaleAxisError, skeleton, thickness } from ${JSON.stringify(join(package_, 'index.js'))};
const bytes = new Uint8Array(3);
export async function use(): Promise<number> {
    const { axes, balls } = await axis(bytes, { name: 'cat.obj', delta: 0.01, scale: [1, 1.1], formats: ['ply', 'glb'], progress: (stage, part) => void [stage.length, part] });
    const radii: Float64Array = axes[0]!.radii;
    const branches: Int32Array = (await skeleton(bytes, { significance: 2 })).branches.items;
    const local: Float64Array = (await thickness(bytes)).local;
    const ma: Uint8Array = await convert(bytes, 'ma');
    const engine = new ScaleAxis({ worker: () => new Worker('worker.js') });
    engine.close();
    // @ts-expect-error: there is no such option
    await axis(bytes, { deltas: 1 });
    return balls.length + radii.length + branches.length + local.length + ma.length;
}
export const codeOf = (error: unknown): string | null => (error instanceof ScaleAxisError ? error.code : null);
`);
        execFileSync(join(package_, 'node_modules/.bin/tsc'), ['--noEmit', '--strict', '--target', 'es2022', '--module', 'esnext', '--moduleResolution', 'bundler', '--lib', 'es2022,dom', join(folder, 'use.ts')], { encoding: 'utf8' });
    } finally {
        rmSync(folder, { recursive: true });
    }
});
