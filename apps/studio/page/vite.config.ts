import { defineConfig } from 'vitest/config';

// The server that the page talks to while it is developed: `npm run fake`, or `plisse studio --port 8765`.
const server = 'http://127.0.0.1:8765';

export default defineConfig({
    build: {
        // The server's content security policy allows the page's own files only, so nothing is inlined.
        assetsInlineLimit: 0,
        modulePreload: { polyfill: false },
        target: 'es2022',
        chunkSizeWarningLimit: 1000,
    },
    // three.js's licence asks for its notice in every copy.
    esbuild: { legalComments: 'inline' },
    server: { proxy: { '/api': { target: server, ws: true, changeOrigin: true } } },
    test: { include: ['tests/**/*.test.ts'] },
});
