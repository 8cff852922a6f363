// Saved frames to scrub through, marked by level.

import type { Actions } from '../actions';
import { button, element } from '../dom';
import type { Frame } from '../protocol';
import { words } from '../scale';
import type { Store } from '../store';
import { Throttle } from '../throttle';

/** Runs of frames of the same level, as shares of the line. */
export function levelRuns(frames: readonly Frame[]): { level: number; share: number }[] {
    const runs: { level: number; count: number }[] = [];
    for (const frame of frames) {
        const last = runs[runs.length - 1];
        if (last?.level === frame.level) ++last.count;
        else runs.push({ level: frame.level, count: 1 });
    }
    return runs.map(({ level, count }) => ({ level, share: count / frames.length }));
}

export function timeline(store: Store, actions: Actions): HTMLElement {
    const show = new Throttle<number>(34, (index) => actions.showFrame(index));
    const slider = element('input', {
        type: 'range', min: 0, max: 0, step: 1, 'aria-label': 'Saved frames', id: 'scrub',
        oninput: () => {
            show.push(Number(slider.value));
        },
    });
    const runs = element('div', { class: 'runs', 'aria-hidden': 'true' });
    const label = element('span', { class: 'frame-label' });
    const live = button({ icon: 'live', text: 'Live', label: 'Back to the running state', key: 'L', kind: 'chip', press: () => actions.showLive() });
    store.watch((state) => [state.frames, state.frame], ({ frames, frame }) => {
        const count = frames.length;
        slider.max = String(Math.max(0, count - 1));
        slider.disabled = count < 2;
        if (frame === null) slider.value = slider.max;
        else if (document.activeElement !== slider) slider.value = String(frame);
        slider.style.setProperty('--fill', `${count > 1 ? (100 * Number(slider.value)) / (count - 1) : 0}%`);
        const shown = frames[frame ?? count - 1];
        const text = shown ? `frame ${shown.index + 1} of ${count} · t ${words(shown.t)} s · level ${shown.level}` : 'no frames yet';
        label.textContent = text;
        slider.setAttribute('aria-valuetext', text);
        live.disabled = frame === null;
        live.classList.toggle('on', frame === null);
    });
    store.watch((state) => [state.frames], ({ frames }) => {
        runs.replaceChildren(...levelRuns(frames).map(({ level, share }) =>
            element('span', { style: `flex-grow: ${share}; --level: ${level}`, title: `Level ${level}` })));
    });
    return element('div', { class: 'timeline', role: 'group', 'aria-label': 'Timeline' },
        element('div', { class: 'scrub' }, slider, runs), label, live);
}
