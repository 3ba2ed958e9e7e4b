// SPDX-License-Identifier: Apache-2.0
// Medial axes in browsers and in Node. index.d.ts describes all of it.
import { ScaleAxisError } from './core.js';

export { ScaleAxisError };

const isNode = typeof process !== 'undefined' && process.versions?.node !== undefined;

async function compiled(wasm) {
    if (wasm instanceof WebAssembly.Module) return wasm;
    if (wasm instanceof URL || typeof wasm === 'string') {
        const url = new URL(wasm, import.meta.url);
        if (isNode && url.protocol === 'file:') {
            const { readFile } = await import('node:fs/promises');
            return WebAssembly.compile(await readFile(url));
        }
        const response = await fetch(url);
        if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
        return WebAssembly.compile(await response.arrayBuffer());
    }
    return WebAssembly.compile(wasm);
}

/** A worker of either kind, with the same members. */
async function startedWorker(source, receive, fail) {
    if (isNode) {
        const { Worker } = await import('node:worker_threads');
        const worker = new Worker(new URL(source));
        worker.on('message', receive);
        worker.on('error', fail);
        worker.unref(); // a program ends when it waits for nothing
        return { post: (message) => worker.postMessage(message), stop: () => void worker.terminate(), hold: (is) => (is ? worker.ref() : worker.unref()) };
    }
    const worker = typeof source === 'function' ? source() : new Worker(source, { type: 'module' });
    worker.onmessage = ({ data }) => receive(data);
    worker.onerror = (event) => fail(new Error(event.message || 'the worker cannot be started'));
    return { post: (message) => worker.postMessage(message), stop: () => worker.terminate(), hold: () => {} };
}

async function bytesOf(file) {
    if (typeof Blob !== 'undefined' && file instanceof Blob) return new Uint8Array(await file.arrayBuffer());
    if (file instanceof ArrayBuffer) return new Uint8Array(file);
    if (ArrayBuffer.isView(file)) return new Uint8Array(file.buffer, file.byteOffset, file.byteLength);
    throw new TypeError('a file is a Uint8Array, an ArrayBuffer, a File or a Blob');
}

export class ScaleAxis {
    #source;
    #module = null;
    #worker = null; // a promise
    #calls = Promise.resolve(); // of which one runs at a time
    #current = null; // the call that the worker works on
    #ids = 0;

    constructor({ wasm = new URL('scaleaxis.wasm', import.meta.url), worker = new URL('worker.js', import.meta.url) } = {}) {
        this.#source = { wasm, worker };
    }

    /** The version of the library. */
    async version() {
        return (await this.#started()).version;
    }

    axis(file, options) {
        return this.#call('axis', file, options);
    }
    filtration(file, options) {
        return this.#call('filtration', file, options);
    }
    thickness(file, options) {
        return this.#call('thickness', file, options);
    }
    skeleton(file, options) {
        return this.#call('skeleton', file, options);
    }
    async convert(file, format, options = {}) {
        const { files } = await this.#call('convert', file, { ...options, formats: [format] });
        return files[format];
    }

    /** Ends the worker; another call starts it again. */
    close() {
        this.#current?.reject(new ScaleAxisError({ code: 'cancelled', message: 'closed' }));
        this.#stop();
    }

    #stop() {
        void this.#worker?.then((worker) => worker.stop(), () => {});
        this.#worker = null;
        this.#current = null;
    }

    #started() {
        this.#worker ??= this.#start().catch((error) => {
            this.#worker = null;
            throw error;
        });
        return this.#worker;
    }

    async #start() {
        this.#module ??= await compiled(this.#source.wasm);
        const started = withResolvers();
        const fail = (error) => {
            started.reject(error);
            this.#current?.reject(error);
            this.#stop();
        };
        const worker = await startedWorker(this.#source.worker, (message) => {
            if (message.version) started.resolve(message.version);
            else if (message.stage !== undefined) this.#current?.progress?.(message.stage, message.fraction);
            else if (message.id === undefined) fail(new ScaleAxisError(message.error));
            else if (message.id === this.#current?.id) this.#finish(message);
        }, fail);
        worker.hold(true);
        worker.post({ module: this.#module });
        worker.version = await started.promise;
        worker.hold(false);
        return worker;
    }

    #finish({ result, error, isTrap }) {
        const { resolve, reject } = this.#current;
        this.#current = null;
        if (isTrap) this.#stop();
        if (error) reject(new ScaleAxisError(error));
        else resolve(result);
    }

    #call(name, file, options = {}) {
        const call = this.#calls.then(() => this.#run(name, file, options));
        this.#calls = call.catch(() => {});
        const { signal } = options;
        if (!signal) return call;
        // At once, even if other calls are before it.
        return new Promise((resolve, reject) => {
            signal.addEventListener('abort', () => reject(signal.reason), { once: true });
            call.then(resolve, reject);
        });
    }

    async #run(name, file, { signal, progress, name: fileName = file?.name ?? 'input', ...options }) {
        signal?.throwIfAborted();
        const bytes = await bytesOf(file);
        const worker = await this.#started();
        signal?.throwIfAborted();
        const { promise, resolve, reject } = withResolvers();
        const id = ++this.#ids;
        this.#current = { id, progress, resolve, reject };
        const abort = () => {
            this.#stop();
            reject(signal.reason);
        };
        signal?.addEventListener('abort', abort);
        worker.hold(true);
        worker.post({ id, name, fileName, bytes, options });
        try {
            return await promise;
        } finally {
            worker.hold(false);
            signal?.removeEventListener('abort', abort);
        }
    }
}

function withResolvers() {
    const result = {};
    result.promise = new Promise((resolve, reject) => Object.assign(result, { resolve, reject }));
    return result;
}

let own = null;
const shared = () => (own ??= new ScaleAxis());
export const axis = (file, options) => shared().axis(file, options);
export const filtration = (file, options) => shared().filtration(file, options);
export const thickness = (file, options) => shared().thickness(file, options);
export const skeleton = (file, options) => shared().skeleton(file, options);
export const convert = (file, format, options) => shared().convert(file, format, options);
export const version = () => shared().version();
