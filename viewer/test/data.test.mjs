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
const { axisGeometry, branchLength, regionBorders } = await load('geometry');
const { lastScale, levelAt, middleScale } = await load('level');
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
    const { sheets, lines, faceAreas } = axisGeometry((await decodeModel(dataOf('squares.html')[0])).axes[0]);
    assert.equal(sheets.triangles.length, 3 * 4);
    assert.deepEqual([...sheets.sheetStarts], [0, 2, 4]);
    close([...faceAreas], [4, 1.5, 1.5], 1e-4);
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

test('a level of a filtration is what the program cuts', async () => {
    run('filtration', join(root, 'data/cat.obj'), '--delta', '0.02', '-o', 'nested.ply', '--stats', 'nested.json', '-q');
    writeMesh('around.off', ...box(9, 9, 9)); // pages with one box, so that coordinates are rounded alike
    run('view', 'nested.ply', '--shape', 'around.off', '-o', 'nested.html', '-q');
    const { name, axes: [nested] } = await decodeModel(dataOf('nested.html')[0]);
    assert.equal(name, 'nested');
    const { levels, plateau } = JSON.parse(readFileSync(file('nested.json'), 'utf8'));
    assert.deepEqual(nested.scales.levels, levels.map((l) => ({ scale: l.scale, sheets: l.sheets, balls: l.balls, area: l.area, curveLength: l.curve_length, volume: l.volume })));
    assert.deepEqual(nested.scales.plateau, { begin: plateau.begin, middle: plateau.middle, end: plateau.end });
    assert.equal(middleScale(nested), Number(plateau.middle.toPrecision(4)));
    const geometry = axisGeometry(nested);
    const pointsOf = (axis, vertices) => Array.from(vertices, (v) => axis.positions.subarray(3 * v, 3 * v + 3).join());
    const facesOf = (axis) => {
        let start = 0;
        return Array.from(axis.sizes, (size) => pointsOf(axis, axis.corners.subarray(start, (start += size))).sort().join(' '));
    };
    const linesOf = (axis, ends, which) => Array.from(which, (i) => pointsOf(axis, ends.subarray(2 * i, 2 * i + 2)).sort().join(' '));
    const nestedFaces = facesOf(nested);
    const exact = nested.scales.faces.filter((s) => s > 1.2 && s < 1.5).sort()[40]; // one that vanishes there
    for (const s of [1, 1.06, 1.2, exact, 1.5, 2.345, 6, lastScale(nested), 10]) {
        run('filter', 'nested.ply', '--scale', String(s), '-o', 'cut.ply', '-q');
        run('view', 'cut.ply', '--shape', 'around.off', '-o', 'cut.html', '-q');
        const cut = (await decodeModel(dataOf('cut.html')[0])).axes[0];
        const cutGeometry = axisGeometry(cut);
        const level = levelAt(nested, geometry, s);
        const same = (ours, theirs, what) => assert.deepEqual(ours.sort(), theirs.sort(), `${what} at s = ${s}`);
        const left = nestedFaces.filter((_, f) => nested.scales.faces[f] > s);
        same(left, facesOf(cut), 'faces');
        assert.equal(level.faces, left.length);
        assert.equal(new Set(Array.from(level.triangles, (t) => geometry.sheets.triangleFaces[t])).size, left.length);
        same(pointsOf(nested, level.vertices), pointsOf(cut, cut.radii.keys()), 'vertices');
        for (const kind of ['curves', 'seams', 'boundaries']) {
            same(linesOf(nested, geometry.lines[kind], level.lines[kind]), linesOf(cut, cutGeometry.lines[kind], [...Array(cutGeometry.lines[kind].length / 2).keys()]), kind);
        }
        same(pointsOf(nested, level.lines.points.map((i) => geometry.lines.points[i])), pointsOf(cut, cutGeometry.lines.points), 'points');
        assert.equal(level.sheets, cut.sheets.reduce((most, n) => Math.max(most, n + 1), 0), `sheets at s = ${s}`);
        assert.ok(left.length > 0 || s > 2);
    }
    for (const { scale, area, curveLength, sheets, balls } of nested.scales.levels.filter((_, i) => i % 12 === 0)) {
        const level = levelAt(nested, geometry, scale);
        assert.deepEqual([level.sheets, level.vertices.length], [sheets, balls]);
        assert.ok(Math.abs(level.area - area) < 1e-3 * levels[0].area && Math.abs(level.curveLength - curveLength) < 1e-2, `${level.area} ${area} ${level.curveLength} ${curveLength}`);
    }
});

test('an axis of one scale is there at every level', async () => {
    const { axes: [axis] } = await decodeModel(dataOf('squares.html')[0]);
    assert.equal(axis.scales, null);
    const level = levelAt(axis, axisGeometry(axis), 5);
    assert.deepEqual([level.triangles.length, level.vertices.length, level.faces], [4, 9, 3]);
    assert.deepEqual([level.lines.curves.length, level.lines.boundaries.length, level.lines.seams.length, level.lines.points.length], [1, 8, 0, 0]);
    close([...level.sheetAreas], [4, 3], 1e-4);
});

test('the thickness of a surface arrives, from its file too', async () => {
    writeMesh('slab.off', ...box(4, 4, 0.5));
    run('thickness', 'slab.off', '--limit', '1.5', '--delta', '0.05', '--edge', '0.1', '-o', 'slab-thickness.ply', '--view', 'slab.html', '--stats', 'slab.json', '-q');
    const told = JSON.parse(readFileSync(file('slab.json'), 'utf8'));
    const model = await decodeModel(dataOf('slab.html')[0]);
    const { shape, thickness, axes, statistics } = model;
    assert.equal(shape.positions.length / 3, told.vertices);
    const largest = Math.max(told.local.maximum, told.foot.maximum);
    close([Math.min(...thickness.local), Math.max(...thickness.local), Math.max(...thickness.foot)], [told.local.minimum, told.local.maximum, told.foot.maximum], largest / 65535);
    assert.equal(thickness.limit, 1.5);
    assert.deepEqual(new Set(thickness.regions), new Set([0])); // all of it
    assert.deepEqual([axes.length, axes[0].scale, statistics.local.mean], [1, 1.1, told.local.mean]);
    assert.equal(regionBorders(shape, thickness).length, 0);
    run('view', 'slab-thickness.ply', '-o', 'again.html', '-q');
    const again = await decodeModel(dataOf('again.html')[0]);
    assert.deepEqual([again.thickness.local, again.thickness.regions, again.thickness.limit], [thickness.local, thickness.regions, null]);
    run('view', 'slab.off', '-o', 'plain.html', '-q');
    assert.equal((await decodeModel(dataOf('plain.html')[0])).thickness, null);
});

test('branches end at ends, junctions and sheets', () => {
    // A fork with a loop at its end, and one curve that comes to a sheet at vertex 2.
    const xs = [[0, 0], [1, 0], [3, 0], [3, 4], [6, 4], [6, 8], [3, 8]];
    const curves = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6], [6, 3]];
    const axis = { positions: Float32Array.from(xs.flatMap(([x, y]) => [x, y, 0])), radii: new Float32Array(7), curves: Uint32Array.from(curves.flat()) };
    const all = Uint32Array.from(curves.keys());
    const lengths = (isOnSheet, edges = all) => Array.from(edges, (e) => branchLength(axis, edges, isOnSheet, e));
    close(lengths(() => false), [7, 7, 7, 14, 14, 14, 14], 1e-5);
    close(lengths((v) => v === 2), [3, 3, 4, 14, 14, 14, 14], 1e-5);
    close(lengths(() => false, all.slice(0, 6)), Array(6).fill(17), 1e-5); // no loop any more
    close(lengths(() => false, all.slice(3)), [14, 14, 14, 14], 1e-5); // a loop alone
});

test('thin regions end where the limit is', () => {
    const mesh = { positions: Float32Array.of(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0), corners: Uint32Array.of(0, 1, 2, 0, 2, 3) };
    const thickness = { local: Float32Array.of(1, 3, 2, 4), regions: Int32Array.of(0, -1, -1, -1), limit: 1.5 };
    close([...regionBorders(mesh, thickness)], [0.25, 0, 0, 0.5, 0.5, 0, 0.5, 0.5, 0, 0, 1 / 6, 0], 1e-6);
    close([...regionBorders(mesh, { ...thickness, limit: null })].slice(0, 3), [0.5, 0, 0], 1e-6);
    assert.equal(regionBorders(mesh, { ...thickness, regions: null }).length, 0);
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
    await refused(withHeader((h) => (h.thickness = { largest: 1, local: h.axes[0].radii, foot: h.axes[0].radii, regions: null, limit: null })), /lacks its thickness/);
    const numbers = { type: 'f64', offset: 0, count: 3 };
    const scales = { vertices: { ...numbers, count: 9 }, faces: numbers, curves: { ...numbers, count: 1 }, levels: [[1, 2, 9, 7, 1, 3]], plateau: [1, 1, 1] };
    await refused(withHeader((h) => (h.axes[0].scales = { ...scales, faces: { ...numbers, count: 2 } })), /lacks its scale/);
    await refused(withHeader((h) => (h.axes[0].scales = { ...scales, levels: [] })), /no levels/);
    await refused(withHeader((h) => (h.axes[0].scales = { ...scales, plateau: [1, 1] })), /no levels/);
    await refused(withHeader((h) => (h.axes[0].scales = { ...scales, faces: h.axes[0].radii })), /scales are of the type/);
    await refused(withHeader((h) => (h.axes[0].radii.type = 'f64')), /integers/);
});

test('a view survives as a link', () => {
    assert.equal(fragmentOf(initialState()), '');
    assert.equal(fragmentOf(initialState('thickness'), 'thickness'), '');
    assert.deepEqual(readLink('color=sheet', 'thickness').state, { ...initialState('thickness'), coloring: 'sheet' });
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
    for (const name of ['cat.glb', 'cat.obj']) {
        run('axis', join(root, 'data/cat.obj'), '-o', name, '-q', '--delta', '0.03');
    }
    const faces = readFileSync(file('cat.obj'), 'latin1').match(/^f .*$/gm).map((line) => line.split(' ').length - 1);
    const { issues, info } = await validator.validateBytes(new Uint8Array(readFileSync(file('cat.glb'))));
    assert.equal(issues.numErrors + issues.numWarnings, 0, JSON.stringify(issues.messages));
    assert.equal(info.totalTriangleCount, faces.reduce((sum, corners) => sum + corners - 2, 0));
    writeFileSync(file('three.balls'), '0 0 0 1\n1 0 0 1\n10 0 0 1\n'); // a curve and a ball of its own
    run('medial', 'three.balls', '-o', 'three.glb', '-q');
    const three = await validator.validateBytes(new Uint8Array(readFileSync(file('three.glb'))));
    assert.equal(three.issues.numErrors + three.issues.numWarnings, 0, JSON.stringify(three.issues.messages));
    assert.equal(three.info.drawCallCount, 2);
});
