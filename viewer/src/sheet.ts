// SPDX-License-Identifier: Apache-2.0
// The contact sheet: a small picture of each model, drawn from its data one after the other.
import { decodeModel } from './data';
import { h, problemBox } from './dom';
import { ModelView, rangesOf } from './modelview';
import { Stage } from './stage';
import { agreement } from './statistics';
import { initialState, openingOf } from './state';

const SIZE = 220; // CSS pixels

export interface Sheet {
    element: HTMLElement;
    stop(): void;
}

/** \param problems what is wrong with the link that led here */
export function contactSheet(title: string, texts: string[], problems: string[], open: (model: number) => void): Sheet {
    let isStopped = false;
    const pixels = Math.round(SIZE * Math.min(2, window.devicePixelRatio));
    const cards = texts.map((_, i) => {
        const picture = h('canvas', { width: pixels, height: pixels, 'aria-hidden': 'true' });
        const name = h('span', { class: 'name' }, `model ${i}`);
        const about = h('span', { class: 'about' }, '…');
        return { picture, name, about, element: h('a', { class: 'card', href: `#model=${i}`, onclick: (event) => {
            if ((event as MouseEvent).ctrlKey || (event as MouseEvent).metaKey) return;
            event.preventDefault();
            open(i);
        } }, picture, name, about) };
    });
    const element = h('main', { class: 'sheet' },
        h('header', {}, h('h1', {}, title), h('p', { class: 'quiet' }, `Choose one to look at it closely.`)),
        h('div', { class: 'cards' }, ...cards.map((card) => card.element)),
        problems.length > 0 ? problemBox(problems) : null);

    const run = async () => {
        const canvas = h('canvas');
        const stage = new Stage(canvas);
        stage.resize(SIZE, SIZE, 1);
        for (const [i, card] of cards.entries()) {
            await new Promise((resolve) => setTimeout(resolve)); // the page stays alive
            if (isStopped) break;
            try {
                const model = await decodeModel(texts[i]!);
                const view = new ModelView(model);
                const theme = document.documentElement.dataset.theme === 'dark' ? 'dark' : 'light';
                stage.draw([view], [i], initialState(openingOf([model])), theme, rangesOf([view]), SIZE, SIZE);
                card.picture.getContext('2d')!.drawImage(canvas, 0, 0, pixels, pixels);
                card.name.textContent = model.name;
                card.about.textContent = aboutModel(view);
                if (agreement(model.axes[view.current]) === false) {
                    card.about.append(' ', h('span', { class: 'bad', title: 'The topology differs somewhere: see its statistics' }, '✗'));
                }
                view.dispose();
            } catch (error) {
                card.about.textContent = `cannot be shown: ${error instanceof Error ? error.message : error}`;
                card.element.classList.add('failed');
            }
        }
        stage.renderer.dispose();
        stage.renderer.forceContextLoss();
        if (!isStopped) document.documentElement.dataset.ready = 'sheet';
    };
    void run().catch((error: unknown) => element.append(h('p', { class: 'message' }, String(error))));
    return { element, stop: () => (isStopped = true) };
}

function aboutModel(view: ModelView): string {
    const axis = view.model.axes[view.current];
    if (!axis) return 'no axis';
    const sheets = axis.sheets.reduce((most, s) => Math.max(most, s + 1), 0);
    return `${axis.scales ? 'all scales' : `s = ${axis.scale}`} · ${sheets} ${sheets === 1 ? 'sheet' : 'sheets'}`;
}
