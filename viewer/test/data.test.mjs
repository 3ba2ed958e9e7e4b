// SPDX-License-Identifier: Apache-2.0
// The program writes, the page's own modules read.
import assert from 'node:assert/strict';
import { readFileSync, statSync, writeFileSync } from 'node:fs';
import { test } from 'node:test';
import { join } from 'node:path';
import { deflateSync, inflateSync } from 'node:zlib';
import { createRequire } from 'node:module';
import { box, dataOf, file, load, root, run, squares, writeAxis, writeMesh } from './tools.mjs';

const validator = createRequire(import.meta.url)('gltf-validator');
const { decodeModel, DataError } = await load('data');
const { axisGeometry } = await load('geometry');
const { closestOf, fragmentOf, initialState, openingScale, readLink } = await load('state');
const { optionRows } = await load('statistics');
const { rootTicks, shortNumber, withUnit } = await load('colors');

writeAxis('squares-axis-s1.2.ply', squares);
writeMesh('squares.off', ...box(3, 2, 1));
run('view', 'squares-axis-s1.2.ply', '--shape', 'squares.off', '-o', 'squares.html', '-q');

const close = (actual, expected, tolerance) =>
    assert.ok(actual.length === expected.length && actual.every((x, i) => Math.abs(x - expected[i]) <= tolerance), `${actual} is not ${expected}`);

test('an axis and its shape arrive as they were', async () => {
    const model = await decodeModel(dataOf('squares.html')[0]);
    assert.equal(model.name, 'squares');
    assert.equal(model.axes.length, 1);
    assert.deepEqual(model.origin, [0, 0, 0]);
    const [axis] = model.axes;
    assert.equal(axis.scale, 1.2);
    close([...axis.positions], squares.vertices.flatMap((v) => v.slice(0, 3)), 6 / 0xfffff);
    close([...axis.radii], squares.vertices.map((v) => v[3]), 8 / 0xfffff);
    assert.deepEqual([...axis.sizes], [4, 3, 3]);
    assert.deepEqual([...axis.corners], squares.faces.flatMap((f) => f.corners));
    assert.deepEqual([...axis.sheets], [0, 1, 1]);
    close([...axis.angles], [80, 40, 45], 90 / 65535);
    assert.deepEqual([...axis.curves], [6, 8]);
    assert.deepEqual([...axis.colors], [0, 1]);
    assert.equal(axis.thicknesses.length, 10); // four vertices of each sheet, two of the curve
    assert.equal(model.lengthUnit, '');
    assert.equal(axis.surface, null);
    assert.equal(axis.statistics.topology.components, 2);
    const [vertices, triangles] = box(3, 2, 1);
    close([...model.shape.positions], vertices.flat(), 6 / 65535);
    assert.deepEqual([...model.shape.corners], triangles.flat());
});

test('an axis becomes triangles and lines', async () => {
    const { sheets, lines } = axisGeometry((await decodeModel(dataOf('squares.html')[0])).axes[0]);
    assert.equal(sheets.triangles.length, 3 * 4);
    assert.deepEqual([...sheets.sheetStarts], [0, 2, 4]);
    close([...sheets.sheetAreas], [4, 3], 1e-4);
    assert.equal(sheets.vertices.length, 8); // none is in two sheets
    assert.deepEqual([...lines.curves], [6, 8]);
    assert.equal(lines.boundaries.length / 2, 8); // the diagonal of the second square is inside it
    assert.equal(lines.seams.length, 0);
    for (let c = 0; c < 8; ++c) close([...sheets.normals.subarray(3 * c, 3 * c + 3)].map(Math.abs), [0, 0, 1], 1e-4);
});

test('three faces around an edge meet in a seam, and faces that disagree are turned', () => {
    const at = Math.sqrt(3) / 2;
    const axis = (sheets, corners) => ({
        positions: Float32Array.of(0, 0, 0, 0, 0, 1, 1, 0, 0, -0.5, at, 0, -0.5, -at, 0), radii: new Float32Array(5).fill(1),
        sizes: new Uint32Array(corners.length / 3).fill(3), corners: Uint32Array.from(corners), sheets: Uint32Array.from(sheets),
        angles: new Float32Array(sheets.length), curves: new Uint32Array(), thicknesses: new Float32Array(9),
    });
    const seam = axisGeometry(axis([0, 1, 2], [0, 1, 2, 0, 1, 3, 0, 1, 4]));
    assert.deepEqual([...seam.lines.seams], [0, 1]);
    assert.equal(seam.lines.boundaries.length / 2, 6);
    const disagreeing = axisGeometry(axis([0, 0], [0, 1, 2, 0, 1, 3])); // both walk the edge from 0 to 1
    const [a, b] = [disagreeing.sheets.triangles.slice(0, 3), disagreeing.sheets.triangles.slice(3)];
    const walks = (t) => [0, 1, 2].some((k) => disagreeing.sheets.vertices[t[k]] === 0 && disagreeing.sheets.vertices[t[(k + 1) % 3]] === 1);
    assert.notEqual(walks(a), walks(b));
});

test('damaged data are refused with a reason', async () => {
    const [text] = dataOf('squares.html');
    const bytes = inflateSync(Buffer.from(text, 'base64'));
    const refused = async (change, reason) => {
        const copy = Buffer.from(bytes);
        const changed = change(copy) ?? copy;
        await assert.rejects(decodeModel(deflateSync(changed).toString('base64')), (error) => error instanceof DataError && reason.test(error.message));
    };
    await assert.rejects(decodeModel('%'), DataError);
    await assert.rejects(decodeModel(text.slice(0, text.length / 2 & ~3)), /decompressed/);
    await assert.rejects(decodeModel(''), DataError);
    await refused((b) => b.subarray(0, 8), /do not begin/);
    await refused((b) => void (b[0] = 0), /do not begin/);
    await refused((b) => void b.writeUInt32LE(1, 4), /version 1/);
    await refused((b) => void b.writeUInt32LE(1e9, 8), /within their header/);
    await refused((b) => void (b[12] = 0), /not JSON/);
    await refused((b) => b.subarray(0, b.length - 20), /within the data/);
    const header = JSON.parse(bytes.subarray(12, 12 + bytes.readUInt32LE(8)).toString());
    const withHeader = (change) => () => {
        const copy = structuredClone(header);
        change(copy);
        const json = Buffer.from(JSON.stringify(copy));
        const start = Buffer.from(bytes.subarray(0, 12));
        start.writeUInt32LE(json.length, 8);
        return Buffer.concat([start, json, bytes.subarray(12 + bytes.readUInt32LE(8))]);
    };
    await refused(withHeader((h) => delete h.axes), /box or the axes/);
    await refused(withHeader((h) => (h.max[0] = 'wide')), /box or the axes/);
    await refused(withHeader((h) => delete h.axes[0].radii), /lacks an array/);
    await refused(withHeader((h) => (h.axes[0].radii.type = 'u64')), /unknown type/);
    await refused(withHeader((h) => (h.axes[0].radii.count = 3)), /without a radius/);
    await refused(withHeader((h) => (h.axes[0].radii.count = -1)), /within the data/);
    await refused(withHeader((h) => (h.axes[0].scale = null)), /no scale/);
    await refused(withHeader((h) => (h.axes[0].corners = h.axes[0].curves)), /lacks a corner/);
    await refused(withHeader((h) => (h.axes[0].curves = h.axes[0].angles)), /curve/);
    await refused(withHeader((h) => (h.axes[0].colors.count = 1)), /colour/);
    await refused(withHeader((h) => (h.axes[0].thicknesses.count = 9)), /erosion thickness/);
    await refused(withHeader((h) => delete h.axes[0].largest_thickness), /erosion thickness/);
});

test('a view survives as a link', () => {
    assert.equal(fragmentOf(initialState()), '');
    const state = { ...initialState(), model: 3, scale: 1.5, coloring: 'radius', map: 'magma', balls: 'picked', theme: 'dark',
        shown: { axis: true, balls: true, surface: false, shape: false }, lines: { seams: false, boundaries: true, curves: false },
        opacity: { axis: 0.5, balls: 0.75, surface: 0.25, shape: 0.1 }, cut: { by: 'view', at: -0.25, flipped: true, normal: [0.6, 0, 0.8] },
        camera: { azimuth: 12.5, elevation: -30, distance: 0.5, target: [0.1, 0, -0.2], up: 'z' },
        picked: { model: 3, kind: 'sheet', sheet: 7, point: [1.25, -2, 3e-7], radius: 0.125, angle: null, thickness: Infinity, ball: -1 } };
    assert.deepEqual(readLink(`#${fragmentOf(state)}`), { state, problems: [] });
    const far = { ...state, picked: { ...state.picked, point: [1e21, -3e300, 0], thickness: 0.5 } };
    assert.deepEqual(readLink(`#${fragmentOf(far)}`), { state: far, problems: [] });
    assert.deepEqual(readLink(''), { state: initialState(), problems: [] });
});

test('a link that makes no sense says so', () => {
    const bad = ['model=-4', 'model=1.5', 'model=', 's=x', 's=0', 's=', 'show=axis,sheet', 'lines=curve', 'camera=1,2', 'camera=1,2,0,0,0,0',
        'camera=1,2,1,0,0,', 'color=loud', 'map=jet', 'balls=none', 'theme=black', 'up=w', 'opacity=2,nan', 'opacity=1,1,1', 'cut=x,7,1', 'cut=x,0',
        'cut=view,0,1', 'cut=x,0,1,1,0,0', 'pick=1,sheet', 'pick=0,sheet,1,0,0,x,1,1,1,-1', 'pick=0,leaf,1,0,0,0,1,1,1,-1'];
    for (const word of bad) {
        const { state, problems } = readLink(`#${word}`);
        assert.deepEqual(state, initialState(), word);
        assert.deepEqual(problems, [`“${word}” makes no sense.`]);
    }
    for (const name of ['colour', 'constructor']) assert.deepEqual(readLink(`#${name}=2`).problems, [`“${name}” is not known.`]);
    const { state, problems } = readLink('#show=&s=1.5&color=loud&up=z');
    assert.deepEqual([state.scale, state.camera.up, problems.length], [1.5, 'z', 1]);
    assert.deepEqual(state.shown, { axis: false, balls: false, surface: false, shape: false });
    assert.ok(readLink(`#${'x'.repeat(1000)}`).problems[0].length < 100);
});

test('a page opens at the most useful scale', () => {
    for (const [scales, opening] of [[[], null], [[1], 1], [[1, 1.05, 1.1, 1.2], 1.1], [[1, 1.3, 1.5], 1.3], [[1, 1.08, 1.3], 1.08], [[0.5, 0.9], 0.5], [[1.5, 2], 1.5]]) {
        assert.equal(openingScale(scales), opening, String(scales));
    }
    assert.equal(closestOf([1, 2, 8], 4.1), 8); // by their ratio
    assert.equal(closestOf([1, 2], null), null);
});

test('options are told with what is in them', () => {
    assert.deepEqual(optionRows({ delta: 0.01, absolute_delta: null, scales: [1, 1.1], input: { as: null, labels: [], is_below: false, bounds: { min: [0, 1] } }, parts: [{ a: 1 }] }), [
        ['delta', '0.01'], ['scales', '1, 1.1'], ['input: is below', 'false'], ['input: bounds: min', '0, 1'], ['parts', '{"a":1}']]);
});

test('a scale by roots has round numbers that do not run into each other', () => {
    assert.deepEqual(rootTicks(1), [0, 0.05, 0.2, 0.5, 1]);
    assert.deepEqual(rootTicks(0), [0]);
    for (let end = 1e-7; end < 1e7; end *= 1.17) {
        const ticks = rootTicks(end);
        const places = ticks.map((value) => Math.sqrt(value / end));
        assert.ok(ticks.length >= 4 && ticks.length <= 6 && places.every((p, i) => p <= 1 && (i === 0 || p - places[i - 1] > 0.179)), `${end}: ${ticks}`);
    }
});

test('lengths have the unit of the input', () => {
    assert.deepEqual([withUnit(1.25, ''), withUnit(1.25, 'mm'), withUnit(3, 'mm', 2), withUnit(3, '', 2), shortNumber(Infinity)], ['1.25', '1.25\u202fmm', '3\u202fmm²', '3', '∞']);
});

test('a page stays within its size', () => {
    run('axis', join(root, 'data/cat.obj'), '-o', 'cat-axis.ply', '--view', 'cat.html', '-q');
    const header = (n) => Number(new RegExp(`element ${n} (\\d+)`).exec(readFileSync(file('cat-axis.ply'), 'latin1').slice(0, 1000))[1]);
    const raw = inflateSync(Buffer.from(dataOf('cat.html')[0], 'base64')).length;
    // At least one triangle a face.
    assert.ok(raw < 24 * header('vertex') + 16 * (header('face') + 15894) + 1e6, `${raw}`);
    assert.ok(statSync(file('cat.html')).size < 1e6 + 24 * header('vertex') + 16 * (header('face') + 15894));
});

test('an axis as GLB is valid', async () => {
    run('axis', join(root, 'data/cat.obj'), '-o', 'cat.glb', '-q', '--delta', '0.03');
    const { issues, info } = await validator.validateBytes(new Uint8Array(readFileSync(file('cat.glb'))));
    assert.equal(issues.numErrors + issues.numWarnings, 0, JSON.stringify(issues.messages));
    assert.ok(info.totalTriangleCount > 1000);
    writeFileSync(file('three.balls'), '0 0 0 1\n1 0 0 1\n10 0 0 1\n'); // a curve and a ball of its own
    run('medial', 'three.balls', '-o', 'three.glb', '-q');
    const three = await validator.validateBytes(new Uint8Array(readFileSync(file('three.glb'))));
    assert.equal(three.issues.numErrors + three.issues.numWarnings, 0, JSON.stringify(three.issues.messages));
    assert.equal(three.info.drawCallCount, 2);
});
