// What the surface can be coloured by, and when it cannot.

import type { ColorBy } from './protocol';
import { colorings } from './protocol';
import type { State, Store } from './store';

/** Why there are no such colours of what is shown; null where there are. */
export function whyNot(color: ColorBy, { detail, status }: Pick<State, 'detail' | 'status'>): string | null {
    const isProlonged = detail && status !== null && status.level + 1 < status.levels;
    return color === 'gap' && isProlonged
        ? 'Gaps are kept open on the level’s own mesh: the finest detail has none of its own'
        : null;
}

/** The colouring after this one that there is. */
export function nextColoring(state: Pick<State, 'color' | 'detail' | 'status'>): ColorBy {
    const there = colorings.filter((color) => color === state.color || whyNot(color, state) === null);
    return there[(there.indexOf(state.color) + 1) % there.length]!;
}

/** Takes back a colouring that has ceased to be there, and says why. */
export function dropLostColoring(store: Store, choose: (color: ColorBy) => void): void {
    store.watch((state) => [state.color, state.detail, state.status], (state) => {
        const reason = whyNot(state.color, state);
        if (reason === null) return;
        choose('none');
        store.toast('info', `${reason}.`);
    });
}
