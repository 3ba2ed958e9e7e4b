// SPDX-License-Identifier: Apache-2.0
// Makes the page, one file that needs nothing else: node page/build.mjs OUT.html
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const package_ = join(here, '..');
const root = join(package_, '../..');

async function bundled(entry, format) {
    const { outputFiles } = await build({
        entryPoints: [entry], bundle: true, minify: true, write: false, format, target: 'es2022', outdir: 'out',
        external: ['node:*'], legalComments: 'inline', logLevel: 'warning',
    });
    return Object.fromEntries(outputFiles.map(({ path, text }) => [path.replace(/.*\./, ''), text.trim()]));
}

const packed = (file) => gzipSync(readFileSync(file), { level: 9 }).toString('base64');
const data = {
    wasm: packed(join(package_, 'scaleaxis.wasm')),
    cat: packed(join(root, 'data/cat.obj')),
    gear: packed(join(root, 'data/thin/gear.off')),
    ball: packed(join(root, 'data/images/BallBinary30x30x30_gz.nrrd')),
    worker: (await bundled(join(package_, 'worker.js'), 'iife')).js,
};
const { js, css } = await bundled(join(here, 'page.ts'), 'esm');
const parts = {
    STYLE: css,
    SCRIPT: js,
    DATA: Object.entries(data).map(([id, text]) => `<script type="text/plain" id="${id}">${text}</script>`).join('\n'),
};
const page = readFileSync(join(here, 'page.html'), 'utf8').replace(/@(STYLE|SCRIPT|DATA)@/g, (_, name) => parts[name]);
writeFileSync(process.argv[2], page);
console.log(`${process.argv[2]}: ${(page.length / 1e6).toFixed(2)} MB`);
