// SPDX-License-Identifier: Apache-2.0
// What is shown as a picture and as a GLB file.
import {
    BufferAttribute, BufferGeometry, Color, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshStandardMaterial,
    Object3D, SRGBColorSpace,
} from 'three';
import { GLTFExporter } from 'three/examples/jsm/exporters/GLTFExporter.js';
import type { ModelView, ShownBalls, ShownLines, ShownSurface } from './modelview';
import type { State } from './state';

/** The canvas as a PNG, with what `decorate` draws over it. `scale`: device pixels for a CSS pixel. */
export async function picture(canvas: HTMLCanvasElement, decorate: (context: CanvasRenderingContext2D, scale: number) => void): Promise<Blob> {
    const copy = document.createElement('canvas');
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext('2d')!;
    context.drawImage(canvas, 0, 0);
    decorate(context, canvas.width / canvas.clientWidth);
    return new Promise((resolve, reject) =>
        copy.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the picture is too large'))), 'image/png'));
}

/** sRGB bytes as the linear colours of glTF. */
function linearColors(bytes: Uint8Array): BufferAttribute {
    const table = Float32Array.from({ length: 256 }, (_, i) => new Color().setRGB(i / 255, 0, 0, SRGBColorSpace).r);
    return new BufferAttribute(Float32Array.from(bytes, (byte) => table[byte]!), 3);
}

const surfaceMaterial = (opacity: number) =>
    new MeshStandardMaterial({ vertexColors: true, roughness: 0.8, metalness: 0, side: DoubleSide, transparent: opacity < 1, opacity });

function surfaceObject(surface: ShownSurface): Object3D {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(surface.positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(surface.normals, 3));
    geometry.setAttribute('color', linearColors(surface.colors));
    geometry.setIndex(new BufferAttribute(surface.triangles, 1));
    return new Mesh(geometry, surfaceMaterial(surface.opacity));
}

function linesObject(lines: ShownLines): Object3D {
    const count = lines.starts.length / 3;
    const positions = new Float32Array(6 * count);
    const colors = new Uint8Array(6 * count);
    for (let i = 0; i < count; ++i) {
        positions.set(lines.starts.subarray(3 * i, 3 * i + 3), 6 * i);
        positions.set(lines.ends.subarray(3 * i, 3 * i + 3), 6 * i + 3);
        colors.set(lines.startColors.subarray(3 * i, 3 * i + 3), 6 * i);
        colors.set(lines.endColors.subarray(3 * i, 3 * i + 3), 6 * i + 3);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('color', linearColors(colors));
    return new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true }));
}

/** All balls as one mesh, since few programs know instances. */
function ballsObject(balls: ShownBalls): Object3D {
    const { sphere, indices } = balls.template;
    const vertices = sphere.length / 3;
    const count = balls.balls.length / 4;
    const positions = new Float32Array(3 * vertices * count);
    const normals = new Float32Array(3 * vertices * count);
    const colors = new Uint8Array(3 * vertices * count);
    const triangles = new Uint32Array(indices.length * count);
    for (let b = 0; b < count; ++b) {
        const radius = balls.balls[4 * b + 3]!;
        for (let i = 0; i < 3 * vertices; ++i) {
            positions[3 * vertices * b + i] = balls.balls[4 * b + (i % 3)]! + radius * sphere[i]!;
            colors[3 * vertices * b + i] = balls.colors[3 * b + (i % 3)]!;
        }
        normals.set(sphere, 3 * vertices * b);
        for (let i = 0; i < indices.length; ++i) triangles[indices.length * b + i] = indices[i]! + vertices * b;
    }
    return surfaceObject({ positions, normals, colors, triangles, opacity: balls.opacity });
}

/** Everything that is shown of the models, in their own units, as binary glTF. The cut is not applied. */
export async function glb(views: ModelView[], state: State): Promise<Blob> {
    const root = new Group();
    root.name = 'scaleaxis';
    let offset = 0; // models stand beside each other
    for (const view of views) {
        const model = new Group();
        model.name = view.model.name;
        const [x, y, z] = view.model.origin;
        model.position.set(x + offset, y, z);
        offset += 2.2 * view.unit;
        const shown = view.shown(state);
        for (const [name, surface] of shown.surfaces) model.add(named(surfaceObject(surface), name));
        for (const [name, lines] of shown.lines) model.add(named(linesObject(lines), name));
        if (shown.balls) model.add(named(ballsObject(shown.balls), 'balls'));
        root.add(model);
    }
    const bytes = (await new GLTFExporter().parseAsync(root, { binary: true })) as ArrayBuffer;
    return new Blob([bytes], { type: 'model/gltf-binary' });
}

function named<T extends Object3D>(object: T, name: string): T {
    object.name = name;
    return object;
}
