import { describe, expect, it, vi } from 'vitest';

import { nextColoring, whyNot } from '../src/colorings';
import { waitBefore } from '../src/connection';
import { Meter } from '../src/meter';
import { hintFor, progressOf, wordOf } from '../src/panels/dock';
import { phrasesOf } from '../src/panels/findings';
import { selectionWords } from '../src/panels/loads';
import { levelWords } from '../src/panels/readout';
import { gravitySize, presetOf } from '../src/panels/steering';
import { levelRuns } from '../src/panels/timeline';
import { lackOf } from '../src/panels/toolbar';
import { ofLength } from '../src/panels/vector_field';
import { plotHeight, plotRange, thinned } from '../src/plot';
import type { Scale } from '../src/scale';
import { fromFraction, toFraction, words } from '../src/scale';
import { initialState } from '../src/store';
import { Throttle } from '../src/throttle';
import { destination, savedScenes } from '../src/uploads';

describe('sliders', () => {
    it.each<[Scale, number]>([
        [{ kind: 'linear', low: 0, high: 20 }, 9.81], [{ kind: 'log', low: 1e3, high: 1e12 }, 8e5],
        [{ kind: 'signed', high: 1e5, unit: 10 }, -340], [{ kind: 'signed', high: 1e5, unit: 10 }, 0],
    ])('lead from a value to a place and back: %j', (scale, value) => {
        expect(fromFraction(scale, toFraction(scale, value))).toBeCloseTo(value, 5);
    });

    it('stop at their ends', () => {
        expect(toFraction({ kind: 'log', low: 1, high: 10 }, 0)).toBe(0);
        expect(toFraction({ kind: 'linear', low: 0, high: 1 }, 7)).toBe(1);
    });
});

describe('numbers in words', () => {
    it.each([[0.0003, '0.0003'], [1e-7, '1e-7'], [800000, '800000'], [12345.678, '12346'], [2.1e11, '2.1e11'], [0, '0'], [-0.3582, '-0.358']])(
        '%d is %s', (value, text) => expect(words(value)).toBe(text));
    it('none is a dash', () => expect([words(null), words(NaN)]).toEqual(['–', '–']));
});

describe('plots', () => {
    it('range over whole decades, without what a log cannot show', () => {
        expect(plotRange([null, 0, -1, 0.02, 3], true)).toEqual({ low: 0.01, high: 10 });
        expect(plotRange([null, NaN], true)).toBeNull();
        expect(plotRange([5], false)!.low).toBeLessThan(5);
        expect(plotHeight(0.1, { low: 0.01, high: 1 }, true)).toBeCloseTo(0.5);
    });

    it('thin out a long run and keep its ends', () => {
        expect(thinned(3, 10)).toEqual([0, 1, 2]);
        const places = thinned(100000, 500);
        expect([places.length, places[0], places[499]]).toEqual([500, 0, 99999]);
    });
});

describe('steering', () => {
    it('keeps the way gravity points', () => {
        expect(ofLength([0, -9.81, 0], 2)).toEqual([0, -2, 0]);
        expect(ofLength([3, 0, 4], 10)).toEqual([6, 0, 8]);
        expect(ofLength([0, 0, 0], 5)).toEqual([0, -5, 0]);
        expect(gravitySize([3, 0, 4])).toBe(5);
        expect(gravitySize([[0, 1]])).toBeNull();
    });

    it('knows a preset by its values', () => {
        const cotton = { density: 1, youngs_modulus: 2, poisson_ratio: 0.3, thickness: 4 };
        expect(presetOf({ cotton }, { ...cotton, bending: 'hinge' })).toBe('cotton');
        expect(presetOf({ cotton }, { ...cotton, thickness: 5 })).toBe('custom');
    });
});

it('findings are told in words', () => {
    const phrases = phrasesOf({ degenerate_faces: 1, intersecting_face_pairs: 3, duplicate_faces: 0, vertices: 9 });
    expect(phrases.map(({ text }) => text)).toEqual(['3 pairs of faces that meet', '1 face without area']);
});

it('frames are grouped by level', () => {
    const frames = [0, 0, 0, 1].map((level, index) => ({ index, level, t: 0, phase: '' }));
    expect(levelRuns(frames)).toEqual([{ level: 0, share: 0.75 }, { level: 1, share: 0.25 }]);
});

const status = {
    type: 'status', state: 'idle', level: 0, levels: 4, vertices: 1, phase: '', t: 0, duration: 1, step: 0,
    equilibrium: false, steps_per_second: null, edit_to_step_ms: null, message: '',
} as const;

it('why a state could not be refined is said, until it is shown no more', () => {
    const refused = { ...status, message: 'no safe direction was found' };
    expect(wordOf({ ...initialState, status: refused })).toBe('No safe direction was found');
    expect(wordOf({ ...initialState, status: { ...refused, state: 'refining' } })).toBe('');
    expect(wordOf({ ...initialState, status: refused, frame: 3 })).toBe('');
    expect(wordOf({ ...initialState, status })).toBe('');
});

it('progress is by batches where they are counted', () => {
    const progress = { fraction: 0.4, text: 'level 2: step 3' };
    const refining = { ...status, state: 'refining', level: 1 } as const;
    expect(progressOf({ ...initialState, status: refining, progress })).toEqual(progress);
    expect(progressOf({ ...initialState, status: refining, progress: { ...progress, batch: 3, batches: 12 } }))
        .toEqual({ fraction: 0.25, text: 'To level 2: batch 3 of 12' });
    expect(progressOf({ ...initialState, status: refining })).toEqual({ fraction: 0, text: '' });
});

describe('colours', () => {
    it('by gap are not to be had of the finest detail, but of the finest level', () => {
        const preview = { color: 'gap', detail: true, status } as const;
        expect(whyNot('gap', preview)).toContain('own mesh');
        expect(whyNot('stretch', preview)).toBeNull();
        expect(whyNot('gap', { ...preview, detail: false })).toBeNull();
        expect(whyNot('gap', { ...preview, status: { ...status, level: 3 } })).toBeNull();
    });
    it('follow each other, without those that are not there', () => {
        expect(nextColoring({ color: 'curvature', detail: false, status })).toBe('gap');
        expect(nextColoring({ color: 'curvature', detail: true, status })).toBe('level');
        expect(nextColoring({ color: 'level', detail: true, status })).toBe('none');
    });
    it('are missed with a reason', () => {
        expect(lackOf(new Float32Array([NaN, 1]), 'gap')).toBe('');
        expect(lackOf(new Float32Array([NaN, NaN]), 'gap')).toContain('near enough');
        expect(lackOf(null, 'stretch')).toContain('saved frame');
    });
});

it('levels are told by what they are to the user', () => {
    expect(levelWords({ level: 0, levels: 4, detail: false })).toBe('Level 0 of 3 · preview');
    expect(levelWords({ level: 2, levels: 4, detail: false })).toBe('Level 2 of 3');
    expect(levelWords({ level: 3, levels: 4, detail: false })).toBe('Level 3 of 3 · your mesh');
    expect(levelWords({ level: 1, levels: 4, detail: true })).toContain('finest mesh');
});

it('what a load pulls at is told in words', () => {
    expect(selectionWords(null)).toBe('all over');
    expect(selectionWords({ vertices: [3] })).toBe('vertex 3');
    expect(selectionWords({ vertices: [3, 4] })).toBe('2 vertices');
    expect(selectionWords({ boundary_loop: 0 })).toBe('boundary loop 0');
    expect(selectionWords({ sphere: [[0, 0, 0], 1] })).toBe('inside of a sphere');
    expect(selectionWords({ box: [[0, 0, 0], [1, 1, 1]] })).toBe('inside of a box');
});

it('the hint says what to press first', () => {
    expect(hintFor({ ...initialState, status })).toContain('Press Play');
    expect(hintFor({ ...initialState, status: { ...status, state: 'at_rest' } })).toContain('Press Refine');
    expect(hintFor({ ...initialState, status: { ...status, state: 'failed', message: 'why' } })).toBe('why');
});

it('files go where they belong, or are refused', () => {
    expect(destination('a b.OBJ', 10)).toEqual({ address: '/api/mesh?name=a%20b.OBJ' });
    expect(destination('s.json', 10)).toEqual({ address: '/api/scene' });
    expect(destination('x.blend', 10)).toHaveProperty('refusal');
    expect(destination('x.stl', 300 * 2 ** 20)).toHaveProperty('refusal');
});

it('a lost connection is tried again after longer and longer, but bounded, waits', () => {
    expect(waitBefore(0, 1)).toBe(300);
    expect(waitBefore(3, 0)).toBe(1200);
    expect(waitBefore(50, 1)).toBe(8000);
});

it('the meter counts a change as shown by a step after the server knew of it', () => {
    const meter = new Meter();
    meter.edited(1000, 4);
    meter.positions(1020, 5);
    expect(meter.editShown).toBeNull();
    meter.acknowledged(5);
    meter.positions(1040, 5);
    meter.positions(1090, 6);
    expect(meter.editShown).toBe(90);
    // Of a drag the first change counts, but not one of long ago.
    for (const now of [1200, 1300]) meter.edited(now, 6);
    meter.acknowledged(6);
    meter.positions(1350, 7);
    expect(meter.editShown).toBe(150);
    meter.edited(1400, 7);
    meter.edited(5000, 7);
    meter.acknowledged(7);
    meter.positions(5060, 8);
    expect(meter.editShown).toBe(60);
    for (let i = 0; i < 30; ++i) meter.step(2000 + i * 50);
    expect(meter.stepsPerSecond(3450)).toBeCloseTo(20);
    expect(meter.stepsPerSecond(9000)).toBeNull();
});

it('a throttle sends the first at once and the last in the end', () => {
    vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout', 'performance'] });
    const sent: number[] = [];
    const throttle = new Throttle<number>(30, (value) => sent.push(value));
    for (let i = 0; i < 10; ++i) throttle.push(i);
    expect(sent).toEqual([0]);
    vi.advanceTimersByTime(31);
    expect(sent).toEqual([0, 9]);
    throttle.push(10);
    throttle.flush();
    expect(sent).toEqual([0, 9, 10]);
    throttle.push(11);
    throttle.push(12);
    vi.advanceTimersByTime(10);
    throttle.flush();
    throttle.push(13);
    vi.advanceTimersByTime(29);
    expect(sent).toEqual([0, 9, 10, 12]);
    vi.advanceTimersByTime(1);
    expect(sent).toEqual([0, 9, 10, 12, 13]);
    vi.useRealTimers();
});

it('finds the scenes among what was saved, the last session first', () => {
    const files = ['a.json', 'a.edits.json', 'a.gltf', 'last-session.edits.json', 'last-session.json', 'z.json'];
    expect(savedScenes(files).map(({ file }) => file)).toEqual(['last-session.json', 'a.json', 'z.json']);
    expect(savedScenes(files)[1]!.words).toBe('a');
    expect(savedScenes(['b.usda'])).toEqual([]);
});
