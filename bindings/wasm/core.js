// SPDX-License-Identifier: Apache-2.0
// The WebAssembly module: bytes and options in, typed arrays and statistics out. Runs in workers of browsers and of Node.

/** An error of the library: `code` is one of docs/diagnostics.md. */
export class ScaleAxisError extends Error {
    /** @param {{ code: string, message: string, element?: string, index?: number, place?: number[], hints?: object[] }} diagnostic */
    constructor(diagnostic) {
        super(diagnostic.message);
        this.name = 'ScaleAxisError';
        this.code = diagnostic.code;
        this.element = diagnostic.element ?? null;
        this.index = diagnostic.index ?? null;
        this.place = diagnostic.place ?? null;
        this.hints = diagnostic.hints ?? [];
    }
}

const arrays = { f64: Float64Array, i32: Int32Array, u8: Uint8Array };
const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** What a module without files may ask of a system: the time, and a place for last words. */
function systemOf(memory) {
    const view = () => new DataView(memory().buffer);
    const badFile = 8;
    return {
        clock_time_get(id, precision, out) {
            const milliseconds = id === 0 ? Date.now() : performance.now();
            view().setBigUint64(out, BigInt(Math.round(milliseconds * 1e6)), true);
            return 0;
        },
        fd_write(file, parts, count, written) {
            let size = 0;
            let text = '';
            for (let i = 0; i < count; ++i) {
                const [at, length] = [view().getUint32(parts + 8 * i, true), view().getUint32(parts + 8 * i + 4, true)];
                text += decoder.decode(new Uint8Array(memory().buffer, at, length).slice());
                size += length;
            }
            console.error(text);
            view().setUint32(written, size, true);
            return 0;
        },
        fd_prestat_get: () => badFile,
        environ_get: () => 0,
        environ_sizes_get(count, size) {
            view().setUint32(count, 0, true);
            view().setUint32(size, 0, true);
            return 0;
        },
        proc_exit(code) {
            throw new WebAssembly.RuntimeError(`it has ended with ${code}`);
        },
    };
}

export class Instance {
    #exports;

    /** @param {WebAssembly.Module} module @param {(stage: string, fraction: number) => void} progress */
    static async of(module, progress) {
        const instance = new Instance();
        const memory = () => instance.#exports.memory;
        const system = systemOf(memory);
        const notThere = () => 52; // a system without this function
        const asked = WebAssembly.Module.imports(module).filter((i) => i.module === 'wasi_snapshot_preview1');
        const tell = (at, length, fraction) => {
            progress(decoder.decode(new Uint8Array(memory().buffer, at, length).slice()), fraction);
            return 1;
        };
        const { exports } = await WebAssembly.instantiate(module, {
            wasi_snapshot_preview1: Object.fromEntries(asked.map(({ name }) => [name, system[name] ?? notThere])),
            scaleaxis: { progress: tell },
        });
        instance.#exports = exports;
        exports._initialize();
        return instance;
    }

    get version() {
        const at = this.#exports.version() >>> 0;
        const bytes = new Uint8Array(this.#exports.memory.buffer, at);
        return decoder.decode(bytes.slice(0, bytes.indexOf(0)));
    }

    /** @throws {ScaleAxisError} */
    run(name, fileName, bytes, options) {
        const { allocate, release, run, output, output_size: outputSize, clear, memory } = this.#exports;
        const given = [encoder.encode(`${name}\0`), encoder.encode(`${fileName}\0`), encoder.encode(`${JSON.stringify(options)}\0`), bytes];
        const places = given.map((part) => allocate(Math.max(part.length, 1)) >>> 0);
        try {
            if (places.includes(0)) throw new ScaleAxisError({ code: 'memory', message: 'there is not enough memory for the file' });
            given.forEach((part, i) => new Uint8Array(memory.buffer, places[i], part.length).set(part));
            const isDone = run(...places, bytes.length);
            const text = decoder.decode(new Uint8Array(memory.buffer, output() >>> 0, outputSize()).slice());
            if (!isDone) throw new ScaleAxisError(JSON.parse(text));
            // Copies: memory that grows leaves all views on it behind.
            const copied = (key, value) => {
                if (value === null || !Array.isArray(value.$array)) return value;
                const [type, at, size] = value.$array;
                return new arrays[type](memory.buffer.slice(at, at + size));
            };
            return JSON.parse(text, copied);
        } finally {
            clear();
            places.forEach(release);
        }
    }
}
