// SPDX-License-Identifier: Apache-2.0
import './style.css';
import { App } from './app';
import { DataError, decodeModel, type Page } from './data';
import { h } from './dom';
import { contactSheet, type Sheet } from './sheet';
import { openingOf, readLink } from './state';

const root = document.getElementById('app')!;

function show(message: string): void {
    root.replaceChildren(h('div', { class: 'message', role: 'alert' }, h('h1', {}, 'This page cannot be shown'), h('p', {}, message)));
    document.documentElement.dataset.ready = 'failed';
}

function readPage(): Page {
    const text = document.getElementById('page')?.textContent;
    if (!text) throw new DataError('this is the template; `scaleaxis axis … --view OUT.html` makes a page with data from it');
    const page = JSON.parse(text) as Page;
    return { title: String(page.title), layout: page.layout };
}

let app: App | null = null;
let sheet: Sheet | null = null;

async function openView(page: Page, texts: string[]): Promise<void> {
    const { state, problems } = readLink(location.hash);
    sheet?.stop();
    sheet = null;
    app?.dispose();
    app = null;
    const isSheet = page.layout === 'contact-sheet' && texts.length > 1;
    if (state.model >= texts.length) {
        problems.push(`There is no model ${state.model}: the first of ${texts.length} has the number 0.`);
        state.model = -1;
    }
    const dark = state.theme === 'dark' || (state.theme === 'auto' && window.matchMedia('(prefers-color-scheme: dark)').matches);
    document.documentElement.dataset.theme = dark ? 'dark' : 'light';
    document.documentElement.dataset.ready = 'no';
    if (isSheet && state.model < 0) {
        sheet = contactSheet(page.title, texts, problems, (model) => {
            history.pushState(null, '', `#model=${model}`);
            void open(page, texts);
        });
        root.replaceChildren(sheet.element);
        return;
    }
    const indices = state.model >= 0 ? [state.model] : texts.map((_, i) => i);
    root.replaceChildren(h('p', { class: 'message quiet', role: 'status' }, 'Reading the data…'));
    const models = [];
    for (const i of indices) models.push(await decodeModel(texts[i]!));
    const title = models.length === 1 ? models[0]!.name : page.title;
    document.title = `${title} – scaleaxis`;
    const link = readLink(location.hash, openingOf(models));
    app = new App(models, indices, title, { state: { ...link.state, model: state.model }, problems }, isSheet ? () => {
        history.pushState(null, '', '#');
        void open(page, texts);
    } : null);
    root.replaceChildren(app.element);
    requestAnimationFrame(() => requestAnimationFrame(() => (document.documentElement.dataset.ready = 'view')));
}

async function open(page: Page, texts: string[]): Promise<void> {
    try {
        await openView(page, texts);
    } catch (error) {
        if (error instanceof DataError) show(`The data of this page cannot be read: ${error.message}.`);
        else show(`${error instanceof Error ? error.message : error}. A browser with WebGL 2 is needed.`);
    }
}

async function start(): Promise<void> {
    const page = readPage();
    document.title = `${page.title} – scaleaxis`;
    const texts = [...document.querySelectorAll('script[type="application/x-scaleaxis"]')].map((s) => s.textContent ?? '');
    if (texts.length === 0) throw new DataError('there is no model in it');
    window.addEventListener('popstate', () => void open(page, texts));
    window.addEventListener('hashchange', () => {
        const link = readLink(location.hash, app?.opening);
        if (app && app.current.model === link.state.model) app.follow(link);
    });
    await open(page, texts);
}

// For tests and for scripts.
Object.assign(window, { scaleaxis: { state: () => app?.current, scene: () => app?.describe(), frame: () => app?.frame() } });
start().catch((error: unknown) => show(`The data of this page cannot be read: ${error instanceof Error ? error.message : error}.`));
