import { describe, expect, it } from 'vitest';

import { parseServerMessage } from '../src/protocol';
import type { Frame, Sample, SessionMessage, StatusMessage } from '../src/protocol';
import { Store, hasScene, initialState, reduce } from '../src/store';
import type { State } from '../src/store';

const fresh = (change: Partial<State> = {}): State => ({ ...initialState, samples: [], ...change });
const status = (state: StatusMessage['state']): StatusMessage => ({
    type: 'status', state, level: 0, levels: 4, vertices: 500, phase: 'preview', t: 0, duration: 1, step: 0,
    equilibrium: false, steps_per_second: null, edit_to_step_ms: null, message: '',
});
const frame = (index: number): Frame => ({ index, level: 0, t: index, phase: 'preview' });
const sample = (step: number): Sample => ({
    level: 0, t: 0, step, energy: 1, residual: 1, gap: null, iterations: 1, seconds: 0,
});
const session = (name: string, handles = 0): SessionMessage => ({
    type: 'session', presets: {}, live: [], edited: false, can_undo: false, can_redo: false, file_name: name,
    scene: {
        name, bodies: [], loads: [], obstacles: [], gravity: [0, 0, 0], contact: { distance: 1, thickness: 0, friction: 0 },
        handles: Array.from({ length: handles }, (_, i) => ({ name: `h${i}`, body: 'b', axes: 'xyz', motion: [] })),
        hierarchy: { levels: 1, coarsest_vertices: 1, source: '', operator: 'shell', bending_on: 'level' },
        solve: { method: '', time_step: 1, duration: 1, tolerance: 1 },
    },
});

describe('the state', () => {
    it('has numbers before there is a run', () => {
        const bare = { type: 'status', state: 'building', message: '' } as StatusMessage;
        expect(reduce(fresh(), bare).status).toMatchObject({ state: 'building', level: 0, levels: 1, step: 0 });
    });

    it('takes samples one by one, and all of them after an undo', () => {
        let state = reduce(fresh(), { type: 'sample', ...sample(1) });
        state = reduce(state, { type: 'sample', ...sample(2) });
        expect(state.samples.map((s) => s.step)).toEqual([1, 2]);
        expect(reduce(state, { type: 'samples', samples: [sample(1)] }).samples).toEqual([sample(1)]);
    });

    it('drops saved frames from where the server tells them anew', () => {
        let state = fresh({ frames: [0, 1, 2, 3].map(frame), frame: 3 });
        state = reduce(state, { type: 'frames', count: 3, from: 2, list: [{ ...frame(2), level: 1 }] });
        expect(state.frames.map((f) => f.level)).toEqual([0, 0, 1]);
        expect(state.frame).toBeNull();
    });

    it('shows progress only while something is built or refined', () => {
        let state = reduce(fresh(), status('refining'));
        state = reduce(state, { type: 'progress', fraction: 0.5, text: 'batch 2 of 4' });
        expect(reduce(state, status('refining')).progress?.fraction).toBe(0.5);
        expect(reduce(state, status('at_rest')).progress).toBeNull();
    });

    it('leaves the gallery and the selection when another scene comes', () => {
        const before = fresh({ session: session('a', 2), gallery: true, selected: '/handles/1' });
        expect(reduce(before, session('b', 2))).toMatchObject({ gallery: false, selected: null });
        expect(reduce(before, session('a', 2))).toMatchObject({ gallery: true, selected: '/handles/1' });
        expect(reduce(before, session('a', 1)).selected).toBeNull();
    });

    it('offers saved files, and says an error once', () => {
        let state = reduce(fresh(), { type: 'saved', files: ['drape.json', 'drape.edits.json'] });
        expect(state.toasts.map((toast) => toast.file)).toEqual(['drape.json', 'drape.edits.json']);
        for (let i = 0; i < 2; ++i) state = reduce(state, { type: 'error', message: 'no' });
        expect(state.toasts.filter((toast) => toast.kind === 'error').length).toBe(1);
        for (let i = 0; i < 9; ++i) state = reduce(state, { type: 'error', message: `no ${i}` });
        expect(state.toasts.map((toast) => toast.text)).toEqual(['no 5', 'no 6', 'no 7', 'no 8']);
    });

    it('has a scene to show unless it is empty', () => {
        expect(hasScene(fresh())).toBe(false);
        expect(hasScene(fresh({ status: status('empty') }))).toBe(false);
        expect(hasScene(fresh({ status: status('idle') }))).toBe(true);
        expect(hasScene(fresh({ status: status('empty'), unusable: { message: '', findings: {} } }))).toBe(true);
    });
});

describe('the store', () => {
    it('tells a watcher only of what it watches, once for several changes', async () => {
        const store = new Store();
        const seen: boolean[] = [];
        store.watch((state) => [state.edges], (state) => seen.push(state.edges));
        store.update({ edges: true });
        store.update({ detail: true });
        await Promise.resolve();
        store.update({ color: 'gap' });
        await Promise.resolve();
        expect(seen).toEqual([false, true]);
    });
});

describe('messages', () => {
    it('that are none are passed over', () => {
        for (const text of ['', '{', 'null', '3', '{"type": 5}', '{"type": "later"}']) expect(parseServerMessage(text)).toBeNull();
        expect(parseServerMessage('{"type": "saved", "files": []}')).toEqual({ type: 'saved', files: [] });
    });
});
