// SPDX-License-Identifier: Apache-2.0
// How surfaces, balls and lines are painted. Colours are sRGB bytes from the data to the screen: a value has the same
// colour in the scene and in the legend, up to its shading.
import { DoubleSide, FrontSide, ShaderMaterial, Vector2, Vector4, type IUniform } from 'three';

/** Uniforms that all materials share: set once, seen everywhere. */
export const shared = {
    cut: { value: new Vector4(0, 0, 0, 1) } as IUniform<Vector4>, // what lies beyond this plane is left out
    size: { value: new Vector2(1, 1) } as IUniform<Vector2>, // of the viewport in pixels
    pixel: { value: 1 } as IUniform<number>, // device pixels for a CSS pixel
};

/** Defined where there is a cut: a shader that may discard is slower. */
export const HAS_CUT = 'HAS_CUT';

const CUT = /* glsl */ `
uniform vec4 cut;
varying vec3 place;
void leaveOutBeyondCut() {
#ifdef HAS_CUT
    if (dot(cut.xyz, place) > cut.w) discard;
#endif
}
`;

const LIGHT = /* glsl */ `
float light(vec3 n) {
    // A key light from the upper left, a fill from the right, both fixed to the viewer.
    float key = max(dot(n, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
    float fill = max(dot(n, normalize(vec3(0.7, 0.05, 0.5))), 0.0);
    return 0.6 + 0.4 * key + 0.12 * fill;
}
`;

const SURFACE_VERTEX = /* glsl */ `
#ifdef BALLS
attribute vec4 ball; // centre and radius
attribute vec3 ballColor;
#else
attribute vec3 paint;
#endif
varying vec3 vNormal;
varying vec3 vPaint;
varying vec3 toViewer;
varying vec3 place;
void main() {
#ifdef BALLS
    vec3 p = ball.xyz + ball.w * position;
    vNormal = normalMatrix * position;
    vPaint = ballColor;
#else
    vec3 p = position;
    vNormal = normalMatrix * normal;
    vPaint = paint;
#endif
    vec4 world = modelMatrix * vec4(p, 1.0);
    place = world.xyz;
    vec4 seen = viewMatrix * world;
    toViewer = -seen.xyz;
    gl_Position = projectionMatrix * seen;
}
`;

const SURFACE_FRAGMENT = /* glsl */ `
uniform float opacity;
uniform float glass; // 1: the rim is more opaque than what is seen head-on
varying vec3 vNormal;
varying vec3 vPaint;
varying vec3 toViewer;
${CUT}
${LIGHT}
void main() {
    leaveOutBeyondCut();
    vec3 flatNormal = normalize(cross(dFdx(toViewer), dFdy(toViewer))); // towards the viewer
    vec3 n = normalize(vNormal);
#ifndef BALLS
    if (dot(n, flatNormal) < 0.0) n = -n; // both sides are lit
    if (!(dot(n, flatNormal) > 0.8)) n = flatNormal; // sharp edges stay sharp
#else
    if (!gl_FrontFacing) n = -n;
#endif
    float facing = clamp(dot(n, normalize(toViewer)), 0.0, 1.0);
    float rim = 1.0 - facing;
    float alpha = opacity * mix(1.0, 0.25 + 0.75 * rim * rim, glass * (1.0 - opacity * opacity));
    gl_FragColor = vec4(vPaint * light(n), alpha);
}
`;

function surface(defines: Record<string, string>, opacity: number, glass: number): ShaderMaterial {
    return new ShaderMaterial({
        defines,
        uniforms: { cut: shared.cut, opacity: { value: opacity }, glass: { value: glass } },
        vertexShader: SURFACE_VERTEX,
        fragmentShader: SURFACE_FRAGMENT,
        transparent: true,
        side: DoubleSide,
        polygonOffset: true, // lines on a surface are in front of it
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
    });
}

/** A surface with a colour for each vertex. `isGlass`: clear where one looks straight through. */
export const surfaceMaterial = (isGlass: boolean) => surface({}, 1, isGlass ? 1 : 0);

export function ballMaterial(isGlass: boolean): ShaderMaterial {
    const material = surface({ BALLS: '' }, 1, isGlass ? 1 : 0);
    material.side = FrontSide;
    return material;
}

const LINE_VERTEX = /* glsl */ `
attribute vec3 start;
attribute vec3 end;
attribute vec3 startPaint;
attribute vec3 endPaint;
uniform vec2 size;
uniform float pixel;
uniform float width;
varying vec3 place;
varying vec3 vPaint;
varying vec2 across; // in half widths, beyond the end points too
varying float stretch; // length in half widths
void main() {
    vec4 a = projectionMatrix * modelViewMatrix * vec4(start, 1.0);
    vec4 b = projectionMatrix * modelViewMatrix * vec4(end, 1.0);
    float halfWidth = 0.5 * width * pixel;
    vec2 onScreen = (b.xy / b.w - a.xy / a.w) * 0.5 * size;
    float length = length(onScreen);
    vec2 along = length > 1e-4 ? onScreen / length : vec2(1.0, 0.0);
    vec2 offset = (position.x * 2.0 - 1.0) * along + position.y * vec2(-along.y, along.x);
    vec4 p = position.x < 0.5 ? a : b;
    p.xy += offset * halfWidth / (0.5 * size) * p.w;
    p.z -= 2e-4 * p.w;
    if (a.w <= 0.0 || b.w <= 0.0) p = vec4(0.0, 0.0, 2.0, 1.0);
    gl_Position = p;
    stretch = length / halfWidth;
    across = vec2(position.x < 0.5 ? -1.0 : stretch + 1.0, position.y);
    vPaint = position.x < 0.5 ? startPaint : endPaint;
    place = (modelMatrix * vec4(position.x < 0.5 ? start : end, 1.0)).xyz;
}
`;

const LINE_FRAGMENT = /* glsl */ `
uniform float opacity;
varying vec3 vPaint;
varying vec2 across;
varying float stretch;
${CUT}
void main() {
    leaveOutBeyondCut();
    float beyond = across.x < 0.0 ? across.x : max(across.x - stretch, 0.0);
    if (beyond * beyond + across.y * across.y > 1.0) discard; // round ends
    gl_FragColor = vec4(vPaint, opacity);
}
`;

/** Lines `width` CSS pixels wide, as quadrilaterals. */
export function lineMaterial(width: number): ShaderMaterial {
    return new ShaderMaterial({
        uniforms: { ...shared, width: { value: width }, opacity: { value: 1 } },
        vertexShader: LINE_VERTEX,
        fragmentShader: LINE_FRAGMENT,
        transparent: true,
        side: DoubleSide,
    });
}
