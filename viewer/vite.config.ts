// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';

// One page with everything in it: dist/template.html, which the program fills with data.
export default defineConfig({
    plugins: [viteSingleFile()],
    build: { target: 'es2022', modulePreload: { polyfill: false }, rollupOptions: { input: 'template.html' } },
});
