// SPDX-License-Identifier: Apache-2.0
// The view of one model, or of several beside each other.
import { listen, panned, rotated, zoomed } from './camera';
import type { Model } from './data';
import { download, h, problemBox } from './dom';
import { glb, picture } from './export';
import { drawLegend, updateLegend } from './legend';
import { ModelView, rangesOf, type Ranges } from './modelview';
import { panel, shortScale, type Panel, type Scales } from './panel';
import { followed, onSheet, verified } from './picked';
import { cells, Stage, viewNormal } from './stage';
import type { Place } from './statistics';
import { lastScale, middleScale } from './level';
import { closestOf, coloringsOf, fragmentOf, initialState, openingOf, openingScale, type Link, type Opening, type Picked, type State } from './state';

/** All scales of a filtration, which end where nothing changes any more; or those that were computed. */
export function scalesOf(models: readonly Model[]): Scales {
    const axes = models.flatMap((m) => m.axes);
    const nested = axes.filter((a) => a.scales);
    const computed = [...new Set(axes.map((a) => a.scale))].sort((a, b) => a - b);
    if (nested.length === 0) return { computed, range: null, opening: openingScale(computed) };
    return { computed, range: [1, Math.max(...nested.map(lastScale))], opening: middleScale(nested[0]!) };
}

/** The scale that can be shown and is nearest to another. */
function nearestScale({ computed, range }: Scales, scale: number | null): number | null {
    return range && scale !== null ? Math.min(range[1], Math.max(range[0], scale)) : closestOf(computed, scale);
}

const prefersDark = window.matchMedia('(prefers-color-scheme: dark)');

export class App {
    readonly element: HTMLElement;
    private state = initialState(); // its scale is one that can be shown, if there are any
    private readonly views: ModelView[];
    private readonly scales: Scales;
    private readonly ranges: Ranges;
    readonly opening: Opening;
    private readonly stage: Stage;
    private readonly canvas = h('canvas', { tabindex: 0, role: 'application', 'aria-label': 'The model. Arrow keys turn it, plus and minus zoom, Enter picks what is in the middle.' });
    private readonly area: HTMLElement;
    private readonly labels = h('div', { class: 'labels' });
    private readonly legend = h('div', { class: 'legend', hidden: true });
    private readonly notice = h('div', { class: 'notice', role: 'status', hidden: true });
    private problems: HTMLElement | null = null;
    private readonly controls: Panel;
    private isDrawPlanned = false;
    private isMoving = false;
    private detail = 1; // of the pixels each way while the camera moves
    private wasMoving = false;
    private lastFrame = 0;
    private urlTimer = 0;
    private noticeTimer = 0;
    private readonly observer: ResizeObserver;
    private readonly listeners = new AbortController();

    /** \param indices the numbers of the models on the page. \throws Error where there is no WebGL 2 */
    constructor(models: Model[], private readonly indices: number[], private readonly title: string, link: Link, back: (() => void) | null) {
        this.stage = new Stage(this.canvas);
        this.views = models.map((model) => new ModelView(model));
        this.scales = scalesOf(models);
        this.ranges = rangesOf(this.views);
        this.opening = openingOf(models);
        const toggle = h('button', { type: 'button', class: 'toggle', 'aria-expanded': 'true', onclick: () => this.togglePanel(toggle) }, 'Controls');
        this.area = h('main', { class: 'stage' }, this.canvas, this.labels, this.legend, this.notice, toggle);
        this.controls = panel(this.views, indices, this.scales, title, {
            state: () => this.state,
            change: (change) => this.set(change),
            setCut: (change) => this.setCut(change),
            reset: () => this.set({ ...initialState(this.opening), theme: this.state.theme, model: this.state.model }),
            savePicture: () => void this.savePicture(),
            saveGlb: () => void this.saveGlb(),
            copyLink: () => void this.copyLink(),
            goTo: (view, place) => this.goTo(view, place),
            back,
        });
        this.element = h('div', { class: 'viewer' }, this.area, this.controls.element);
        if (models.length > 1) this.labels.append(...models.map((m) => h('span', {}, m.name)));

        listen(this.canvas, () => Math.min(...cells(this.views.length, this.canvas.clientWidth, this.canvas.clientHeight).map((c) => Math.min(c.width, c.height))), {
            get: () => this.state.camera,
            set: (camera) => {
                this.isMoving = true;
                this.set({ camera });
            },
            click: (x, y) => this.pickAt(x, y),
            settle: () => this.settle(),
        });
        this.observer = new ResizeObserver(() => this.plan());
        this.observer.observe(this.area);
        const { signal } = this.listeners;
        prefersDark.addEventListener('change', () => this.set({}), { signal });
        window.addEventListener('keydown', (event) => this.key(event), { signal });
        this.canvas.addEventListener('webglcontextlost', () => this.say('The graphics were reset; reload the page.'), { signal });
        this.follow(link);
    }

    get current(): State {
        return this.state;
    }

    /** What is in the scene, for tests and scripts. */
    describe() {
        return this.views.map((view) => {
            const shown = view.shown(this.state);
            return {
                name: view.model.name,
                scale: view.model.axes[view.current]?.scale ?? null,
                surfaces: shown.surfaces.map(([name, s]) => ({ name, triangles: s.triangles.length / 3, opacity: s.opacity })),
                lines: shown.lines.map(([name, l]) => ({ name, count: l.starts.length / 3 })),
                balls: shown.balls ? shown.balls.balls.length / 4 : 0,
            };
        });
    }

    /** Draws, and waits until that is done. \returns milliseconds */
    frame(): number {
        const start = performance.now();
        this.draw(1);
        const gl = this.stage.renderer.getContext();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        return performance.now() - start;
    }

    /** Shows what a link asks for as far as that is there, and tells what is not. */
    follow({ state, problems }: Link): void {
        const coloring = coloringsOf(this.opening).includes(state.coloring) ? state.coloring : initialState(this.opening).coloring;
        const scale = nearestScale(this.scales, state.scale ?? this.scales.opening);
        const isComputed = state.scale === null || state.scale === scale;
        for (const view of this.views) view.choose(scale);
        const view = state.picked && this.views[this.indices.indexOf(state.picked.model)];
        const picked = state.picked && view ? verified(view, state.picked) : null;
        this.state = { ...state, coloring, scale, picked };
        this.set({});
        this.problems?.remove();
        const all = [
            ...problems,
            ...(isComputed ? [] : [`There is no scale s = ${state.scale}${scale === null ? '' : `: s = ${scale} is shown`}.`]),
            ...(coloring === state.coloring ? [] : ['There is no thickness of a surface.']),
            ...(state.picked && !picked ? ['What was picked is not there.'] : []),
        ];
        if (all.length > 0) this.area.append((this.problems = problemBox(all)));
    }

    set(change: Partial<State>): void {
        const before = this.state;
        this.state = { ...before, ...change };
        this.state.scale ??= this.scales.opening;
        const { scale, picked } = this.state;
        const view = picked && this.views[this.indices.indexOf(picked.model)]!;
        const axis = view?.model.axes[view.current];
        for (const each of this.views) each.choose(scale);
        if (view && axis && picked === before.picked && scale !== before.scale) this.state.picked = followed(view, picked, axis);
        const theme = this.theme;
        document.documentElement.dataset.theme = theme;
        updateLegend(this.legend, this.state, this.ranges, theme);
        this.plan();
        clearTimeout(this.urlTimer);
        this.urlTimer = window.setTimeout(() => history.replaceState(history.state, '', `#${fragmentOf(this.state, this.opening)}`), 150);
    }

    private get theme(): 'light' | 'dark' {
        const { theme } = this.state;
        return theme === 'auto' ? (prefersDark.matches ? 'dark' : 'light') : theme;
    }

    private setCut(change: Partial<State['cut']>): void {
        const cut = { ...this.state.cut, ...change };
        if (change.by === 'view') cut.normal = viewNormal(this.state);
        this.set({ cut });
    }

    private plan(): void {
        if (this.isDrawPlanned) return;
        this.isDrawPlanned = true;
        requestAnimationFrame((time) => {
            this.isDrawPlanned = false;
            // Where moving is slow, fewer pixels have to do until the camera rests.
            if (this.isMoving && this.wasMoving && time - this.lastFrame > 90) this.detail = Math.max(0.25, this.detail * 0.7);
            this.lastFrame = time;
            this.wasMoving = this.isMoving;
            this.draw(this.isMoving ? this.detail : 1);
        });
    }

    private settle(): void {
        this.isMoving = false;
        this.plan();
    }

    private draw(detail: number): void {
        const { clientWidth: width, clientHeight: height } = this.area;
        if (width === 0 || height === 0) return;
        this.stage.resize(width, height, detail);
        this.stage.draw(this.views, this.indices, this.state, this.theme, this.ranges, width, height);
        cells(this.views.length, width, height).forEach((cell, i) => {
            const label = this.labels.children[i] as HTMLElement | undefined;
            if (label) label.style.cssText = `left:${cell.x}px; top:${cell.y}px; max-width:${cell.width}px`;
        });
        this.controls.update(this.state);
    }

    private pickAt(x: number, y: number): void {
        const { clientWidth: width, clientHeight: height } = this.area;
        const before = this.state.picked;
        const picked = this.stage.pick(this.views, this.indices, this.state, x, y, width, height);
        if (picked || before) this.set({ picked });
    }

    /** Marks a place, and brings it to the middle of the view. */
    private goTo(view: ModelView, { point, radius }: Place): void {
        const { origin } = view.model;
        const picked: Picked = { model: this.indices[this.views.indexOf(view)]!, kind: 'place', sheet: -1, point, radius, angle: null, thickness: null, ball: -1 };
        const target = point.map((x, k) => (x - origin[k]!) / view.unit) as State['camera']['target'];
        const distance = Math.max(0.25, (2.5 * (radius ?? 0)) / view.unit);
        this.set({ picked, camera: { ...this.state.camera, target, distance } });
    }

    /** Picks the next sheet by size (or the one before), at one of its triangles. */
    private pickNext(step: 1 | -1): void {
        const index = Math.max(0, this.state.picked ? this.indices.indexOf(this.state.picked.model) : 0);
        const view = this.views[index]!;
        const axisView = view.axisView;
        if (!axisView) return;
        const { level, geometry: { sheets: { sheetStarts } } } = axisView;
        const { sheetAreas } = level;
        const order = [...sheetAreas.keys()].filter((s) => sheetAreas[s]! > 0).sort((a, b) => sheetAreas[b]! - sheetAreas[a]!);
        if (order.length === 0) return;
        const at = this.state.picked?.kind === 'sheet' ? order.indexOf(this.state.picked.sheet) : step > 0 ? -1 : 0;
        const sheet = order[(at + step + order.length) % order.length]!;
        const left = level.triangles.filter((t) => t >= sheetStarts[sheet]! && t < sheetStarts[sheet + 1]!);
        const middle = left[left.length >> 1]!;
        this.set({ picked: onSheet(view, this.indices[index]!, middle, [1 / 3, 1 / 3, 1 / 3]) });
    }

    private stepScale(step: number): void {
        const { computed, range } = this.scales;
        const next = range ? nearestScale(this.scales, shortScale(this.state.scale! * 1.01 ** step)) : computed[computed.indexOf(this.state.scale!) + step];
        if (next !== undefined) this.set({ scale: next });
    }

    private key(event: KeyboardEvent): void {
        const target = event.target as HTMLElement;
        if (event.ctrlKey || event.metaKey || event.altKey || target.closest('input[type=range], input[type=radio], select')) return;
        const { camera, shown, cut, coloring } = this.state;
        const step = 10;
        const turn = (right: number, up: number) =>
            this.set({ camera: event.shiftKey ? panned(camera, right / 200, up / 200) : rotated(camera, right, up) });
        const toggle = (layer: keyof State['shown']) => this.set({ shown: { ...shown, [layer]: !shown[layer] } });
        const cutBy = (by: 'x' | 'y' | 'z') => this.setCut({ by: cut.by === by ? 'off' : by });
        const actions: Record<string, () => void> = {
            ArrowLeft: () => turn(-step, 0), ArrowRight: () => turn(step, 0), ArrowUp: () => turn(0, step), ArrowDown: () => turn(0, -step),
            '+': () => this.set({ camera: zoomed(camera, 1 / 1.15) }), '=': () => this.set({ camera: zoomed(camera, 1 / 1.15) }),
            '-': () => this.set({ camera: zoomed(camera, 1.15) }), '0': () => this.set({ camera: { ...initialState().camera, up: camera.up } }),
            Escape: () => this.set({ picked: null }), n: () => this.pickNext(1), p: () => this.pickNext(-1),
            a: () => toggle('axis'), b: () => toggle('balls'), s: () => toggle('surface'), i: () => toggle('shape'),
            c: () => {
                const colorings = coloringsOf(this.opening);
                this.set({ coloring: colorings[(colorings.indexOf(coloring) + 1) % colorings.length]! });
            },
            '[': () => this.stepScale(-1), ']': () => this.stepScale(1), x: () => cutBy('x'), y: () => cutBy('y'), z: () => cutBy('z'),
        };
        if (target === this.canvas) {
            actions.Enter = () => {
                const cell = cells(this.views.length, this.area.clientWidth, this.area.clientHeight)[0]!;
                this.pickAt(cell.x + cell.width / 2, cell.y + cell.height / 2);
            };
        }
        const action = actions[event.key];
        if (!action) return;
        event.preventDefault();
        action();
    }

    private togglePanel(button: HTMLElement): void {
        const isHidden = this.element.classList.toggle('without-panel');
        button.setAttribute('aria-expanded', String(!isHidden));
    }

    private say(text: string): void {
        this.notice.textContent = text;
        this.notice.hidden = false;
        clearTimeout(this.noticeTimer);
        this.noticeTimer = window.setTimeout(() => (this.notice.hidden = true), 4000);
    }

    private get fileName(): string {
        return this.title.replace(/[^\w.-]+/g, '-').replace(/^-+|-+$/g, '') || 'scaleaxis';
    }

    private async savePicture(): Promise<void> {
        this.draw(1); // a canvas keeps its content only until the browser has shown it
        const color = getComputedStyle(this.element).color;
        const blob = await picture(this.canvas, (context, scale) => drawLegend(context, scale, this.state, this.ranges, this.theme, color));
        download(blob, `${this.fileName}.png`);
        this.say('The picture is saved.');
    }

    private async saveGlb(): Promise<void> {
        try {
            download(await glb(this.views, this.state), `${this.fileName}.glb`);
            this.say('What is shown is saved as GLB.');
        } catch (error) {
            this.say(`This cannot be saved as GLB: ${error instanceof Error ? error.message : error}`);
        }
    }

    private async copyLink(): Promise<void> {
        const url = `${location.href.replace(/#.*$/, '')}#${fragmentOf(this.state, this.opening)}`;
        try {
            await navigator.clipboard.writeText(url);
            this.say('The link is copied.');
        } catch {
            window.prompt('The link to this view:', url);
        }
    }

    dispose(): void {
        clearTimeout(this.urlTimer);
        this.listeners.abort();
        this.observer.disconnect();
        for (const view of this.views) view.dispose();
        this.stage.renderer.dispose();
        this.stage.renderer.forceContextLoss();
        this.element.remove();
    }
}
