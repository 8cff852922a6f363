import { expect, it } from 'vitest';

import { isLive, valueAt } from '../src/pointer';

const scene = { bodies: [{ pressure: 3, 'a/b': { '~': 1 } }], gravity: null };

it('a pointer leads to a value or nowhere', () => {
    expect(valueAt(scene, '/bodies/0/pressure')).toBe(3);
    expect(valueAt(scene, '/bodies/0/a~1b/~0')).toBe(1);
    expect(valueAt(scene, '')).toBe(scene);
    expect(valueAt(scene, '/bodies/1/pressure')).toBeUndefined();
    expect(valueAt(scene, '/gravity/0')).toBeUndefined();
});

it('a change is live where a pattern names it, or what it is inside of', () => {
    const live = ['/bodies/*/pressure', '/gravity', '/bodies/*/material'];
    expect(isLive(live, '/bodies/3/pressure')).toBe(true);
    expect(isLive(live, '/gravity/1')).toBe(true);
    expect(isLive(live, '/bodies/0/material/thickness')).toBe(true);
    expect(isLive(live, '/bodies/0')).toBe(false);
    expect(isLive(live, '/bodies/0/rest')).toBe(false);
    expect(isLive([], '/gravity')).toBe(false);
});
