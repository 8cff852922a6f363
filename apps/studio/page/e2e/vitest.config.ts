import { defineConfig } from 'vitest/config';

export default defineConfig({
    test: {
        include: ['e2e/**/*.spec.ts'],
        root: new URL('..', import.meta.url).pathname,
        // One server and one browser at a time: the solver wants the cores for itself.
        fileParallelism: false,
        testTimeout: Number(process.env.PLISSE_STUDIO_TIMEOUT ?? 60) * 1000,
        expect: { poll: { timeout: 20_000 } },
        hookTimeout: 60_000,
    },
});
