// SPDX-License-Identifier: Apache-2.0
// The thread that computes, in browsers and in Node. Receives the module first, then calls.
import { Instance, ScaleAxisError } from './core.js';

const isNode = typeof process !== 'undefined' && process.versions?.node !== undefined;

let instance = null;

function buffersOf(value, found = []) {
    if (ArrayBuffer.isView(value)) found.push(value.buffer);
    else if (value !== null && typeof value === 'object') Object.values(value).forEach((member) => buffersOf(member, found));
    return found;
}

async function receive(post, { module, id, name, fileName, bytes, options }) {
    try {
        if (module) {
            instance = await Instance.of(module, (stage, fraction) => post({ stage, fraction }));
            post({ version: instance.version });
            return;
        }
        const result = instance.run(name, fileName, bytes, options);
        post({ id, result }, buffersOf(result));
    } catch (error) {
        const { code, message, element, index, place, hints } = error;
        // Anything else is a trap, which leaves the memory in a state that nobody knows.
        const isTrap = !(error instanceof ScaleAxisError);
        post({ id, isTrap, error: isTrap ? { code: 'crash', message: `the computation has crashed: ${message}` } : { code, message, element, index, place, hints } });
    }
}

if (isNode) {
    void import('node:worker_threads').then(({ parentPort }) =>
        parentPort.on('message', (message) => receive((...all) => parentPort.postMessage(...all), message)));
} else {
    self.onmessage = ({ data }) => receive((...all) => self.postMessage(...all), data);
}
