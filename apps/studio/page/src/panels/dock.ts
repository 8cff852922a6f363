// What to press: play and refine, with a line that says what comes next.

import type { Actions } from '../actions';
import { button, element, relabel } from '../dom';
import type { State, Store } from '../store';
import { isBusy } from '../store';

/** One sentence for whoever sees the page for the first time. */
export function hintFor(state: State): string {
    const { status } = state;
    if (!status) return '';
    const isFinest = status.level + 1 >= status.levels;
    if (state.frame !== null) return 'A saved frame. Play, or press Live, to come back to the running state.';
    switch (status.state) {
        case 'building':
            return 'Building the levels of detail …';
        case 'playing':
            return 'Change anything on the right while it moves. Press Refine when you like what you see.';
        case 'refining':
            return 'Sharpening without a single intersection. Stop at any time and keep what is there.';
        case 'failed':
            return status.message || 'It could not go on. Undo the last change, or start over.';
        case 'at_rest':
            return isFinest ? 'At rest, on your own mesh. Export it, or go back to the preview and steer on.' : 'At rest. Press Refine to sharpen it, or change something and press Play.';
        case 'idle':
            if (status.step === 0) return 'Press Play: the preview moves. Change anything on the right.';
            return isFinest ? 'Refined to your own mesh. Export it, or go back to the preview.' : 'Paused. Play on, or press Refine to sharpen what is there.';
        case 'empty':
            return '';
    }
}

/** What the server has to say of the state that is shown, such as why it could not be refined. */
export function wordOf({ status, frame }: State): string {
    if (!status || frame !== null || isBusy(status) || status.state === 'failed') return '';
    return status.message.charAt(0).toUpperCase() + status.message.slice(1);
}

/** How far the bar is, and what stands under it: by batches of the refinement where they are counted. */
export function progressOf(state: State): { fraction: number; text: string } {
    const { progress, status } = state;
    if (!progress) return { fraction: 0, text: '' };
    const { batch, batches } = progress;
    if (batch === undefined || !batches) return { fraction: progress.fraction, text: progress.text };
    return { fraction: batch / batches, text: `To level ${(status?.level ?? 0) + 1}: batch ${batch} of ${batches}` };
}

export function dock(store: Store, actions: Actions): HTMLElement {
    const play = button({ icon: 'play', text: 'Play', label: 'Play', kind: 'primary large', press: () => actions.playOrPause() });
    const step = button({ icon: 'step', label: 'One step', key: '.', kind: 'large', press: () => actions.step() });
    const restart = button({ icon: 'restart', label: 'Start over', kind: 'large', press: () => actions.restart() });
    const refine = button({
        icon: 'refine', text: 'Refine', label: 'Refine one level', key: 'R', kind: 'large accent', press: () => actions.refine('next'),
    });
    const finest = button({
        icon: 'finest', text: 'To the finest', label: 'Refine to the finest level', key: 'Shift+R', kind: 'large', press: () => actions.refine('finest'),
    });
    const back = button({
        icon: 'back', text: 'Back to preview', label: 'Back to the coarse state that was refined', key: 'B', kind: 'large', press: () => actions.backToPreview(),
    });
    const hint = element('p', { class: 'hint', role: 'status' });
    const word = element('p', { class: 'hint word', role: 'alert' });
    const bar = element('div', { class: 'progress-fill' });
    const text = element('span', { class: 'progress-text' });
    const progress = element('div', { class: 'progress', role: 'progressbar', 'aria-label': 'Progress', 'aria-valuemin': 0, 'aria-valuemax': 100 },
        element('div', { class: 'progress-track' }, bar), text);
    store.watch((state) => [state.status, state.frame, state.connection], (state) => {
        const { status } = state;
        const isRunning = status?.state === 'playing';
        const isRefining = status?.state === 'refining';
        if (isRefining) relabel(play, 'stop', 'Stop', 'Stop refining and keep what is there', 'Space');
        else if (isRunning) relabel(play, 'pause', 'Pause', 'Pause', 'Space');
        else relabel(play, 'play', 'Play', 'Play', 'Space');
        const isIdle = status !== null && !isBusy(status) && status.state !== 'empty' && state.connection === 'open';
        play.disabled = !isIdle && !isRefining;
        step.disabled = restart.disabled = !isIdle || isRunning;
        restart.disabled = !isIdle;
        refine.disabled = finest.disabled = !isIdle || !actions.canRefine();
        const isFinest = status !== null && status.level + 1 >= status.levels;
        refine.hidden = finest.hidden = isFinest && status.levels > 1;
        back.hidden = !status || status.level === 0 || isBusy(status);
        hint.textContent = hintFor(state);
        hint.classList.toggle('bad', status?.state === 'failed');
        // An alert is read out again by a screen reader whenever it is written.
        if (word.textContent !== wordOf(state)) word.textContent = wordOf(state);
    });
    store.watch((state) => [state.progress, isBusy(state.status)], (state) => {
        progress.hidden = !isBusy(state.status);
        const shown = progressOf(state);
        bar.style.transform = `scaleX(${shown.fraction})`;
        progress.setAttribute('aria-valuenow', String(Math.round(shown.fraction * 100)));
        progress.setAttribute('aria-valuetext', shown.text);
        text.textContent = shown.text;
    });
    const buttons = element('div', { class: 'dock-buttons' },
        element('div', { class: 'dock-group' }, play, step, restart),
        element('div', { class: 'dock-group' }, refine, finest, back));
    const root = element('div', { class: 'dock' }, word, hint, progress, buttons);
    store.watch((state) => [state.unusable], (state) => (root.hidden = state.unusable !== null));
    return root;
}
