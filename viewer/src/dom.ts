// SPDX-License-Identifier: Apache-2.0

type Child = Node | string | null;

/** An element with attributes (`on…` are listeners) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
    tag: K,
    attributes: Record<string, string | number | boolean | ((event: Event) => void)> = {},
    ...children: Child[]
): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === 'function') element.addEventListener(name.slice(2), value);
        else if (typeof value === 'boolean') element.toggleAttribute(name, value);
        else element.setAttribute(name, String(value));
    }
    element.append(...children.filter((child) => child !== null));
    return element;
}

/** An element of a drawing. */
export function svg(tag: string, attributes: Record<string, string | number> = {}, ...children: (Node | string)[]): SVGElement {
    const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
    element.append(...children);
    return element;
}

/** What is wrong with a link, until it is closed. */
export function problemBox(problems: string[]): HTMLElement {
    const box = h('div', { class: 'problems', role: 'alert' },
        h('div', {}, 'Not all of this link can be followed:', h('ul', {}, ...problems.map((problem) => h('li', {}, problem)))),
        h('button', { type: 'button', name: 'close-problems', 'aria-label': 'Close', onclick: () => box.remove() }, '×'));
    return box;
}

/** Offers bytes as a file. */
export function download(blob: Blob, name: string): void {
    const link = h('a', { href: URL.createObjectURL(blob), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
