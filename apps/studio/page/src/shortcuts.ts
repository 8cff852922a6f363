// Keys, and the page that names them.

import type { Actions } from './actions';
import { nextColoring } from './colorings';
import { button, element } from './dom';
import type { Store } from './store';

interface Shortcut {
    keys: string;
    words: string;
    matches: (event: KeyboardEvent) => boolean;
    press: () => void;
}

const plain = (key: string, shift = false) => (event: KeyboardEvent): boolean =>
    event.key.toLowerCase() === key && !event.ctrlKey && !event.metaKey && !event.altKey && event.shiftKey === shift;
const command = (key: string, shift = false) => (event: KeyboardEvent): boolean =>
    event.key.toLowerCase() === key && (event.ctrlKey || event.metaKey) && event.shiftKey === shift;

export interface ShortcutTargets {
    store: Store;
    actions: Actions;
    resetCamera: () => void;
    openSave: () => void;
}

function shortcuts({ store, actions, resetCamera, openSave }: ShortcutTargets, help: () => void): Shortcut[] {
    return [
        { keys: 'Space', words: 'Play, pause; stop refining', matches: plain(' '), press: () => actions.playOrPause() },
        { keys: '.', words: 'One step', matches: plain('.'), press: () => actions.step() },
        { keys: 'R', words: 'Refine one level', matches: plain('r'), press: () => actions.refine('next') },
        { keys: 'Shift R', words: 'Refine to the finest', matches: plain('r', true), press: () => actions.refine('finest') },
        { keys: 'B', words: 'Back to the preview', matches: plain('b'), press: () => actions.backToPreview() },
        { keys: 'Ctrl Z', words: 'Undo', matches: command('z'), press: () => actions.undo() },
        { keys: 'Ctrl Shift Z', words: 'Redo', matches: command('z', true), press: () => actions.redo() },
        { keys: 'Ctrl S', words: 'Save the scene', matches: command('s'), press: openSave },
        { keys: 'E', words: 'Edges', matches: plain('e'), press: () => actions.look({ edges: !store.state.edges }) },
        { keys: 'D', words: 'Finest detail', matches: plain('d'), press: () => actions.look({ detail: !store.state.detail }) },
        { keys: 'C', words: 'Next colouring', matches: plain('c'), press: () => actions.look({ color: nextColoring(store.state) }) },
        { keys: 'F', words: 'Whole scene in view', matches: plain('f'), press: resetCamera },
        { keys: 'L', words: 'Back to the running state', matches: plain('l'), press: () => actions.showLive() },
        { keys: '1', words: 'Look around', matches: plain('1'), press: () => actions.useTool('look') },
        { keys: '2', words: 'Grab', matches: plain('2'), press: () => actions.useTool('grab') },
        { keys: '3', words: 'Move', matches: plain('3'), press: () => actions.useTool('move') },
        { keys: '4', words: 'Turn', matches: plain('4'), press: () => actions.useTool('turn') },
        { keys: '?', words: 'This help', matches: (event) => event.key === '?', press: help },
    ];
}

/** Whether a key belongs to what has the focus: text is typed there, or Space presses it. No number has an R in it. */
export function isTaken(event: KeyboardEvent): boolean {
    const target = event.target as HTMLElement | null;
    if (!target?.matches) return false;
    const isCommand = event.ctrlKey || event.metaKey || event.altKey;
    if (target.matches('.number') && !isCommand) return event.key.length > 1 || /[\d.,e+-]/i.test(event.key);
    if (target.matches('input[type=text], textarea')) return !(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== 's';
    if (event.key === ' ') return target.matches('button, summary, select, label, input:not([type=range])');
    return target.matches('select') && event.key.length === 1;
}

/** Listens to keys; returns what opens the help. */
export function startShortcuts(targets: ShortcutTargets): () => void {
    const dialog = element('dialog', { class: 'dialog help', 'aria-labelledby': 'help-title' });
    const show = (): void => {
        if (!dialog.open) dialog.showModal();
    };
    const list = shortcuts(targets, show);
    dialog.append(
        element('h2', { id: 'help-title' }, 'How it works'),
        element('ol', {},
            element('li', {}, 'Press ', element('strong', {}, 'Play'), ': the coarse preview moves.'),
            element('li', {}, 'Steer it: change numbers on the right, pull it with the hand, move handles and obstacles. Everything can be undone.'),
            element('li', {}, 'Press ', element('strong', {}, 'Refine'), ': the same state gets sharper, level by level, up to your own mesh.')),
        element('p', { class: 'quiet' }, 'Drag to turn the view, right-drag to shift it, wheel to come nearer; or Tab to it, and press arrow keys, + and -. Hold Ctrl and drag a body to pull it; press Shift when letting go to pin it there.'),
        element('h2', {}, 'Keys'),
        element('dl', { class: 'keys' }, ...list.flatMap(({ keys, words }) => [
            element('dt', {}, ...keys.split(' ').map((key) => element('kbd', {}, key))), element('dd', {}, words)])),
        element('div', { class: 'dialog-buttons' }, button({ text: 'Close', label: 'Close', kind: 'primary', press: () => dialog.close() })),
    );
    document.body.append(dialog);
    window.addEventListener('keydown', (event) => {
        if (document.querySelector('dialog[open]')) return;
        if (event.key === 'Escape') {
            targets.store.update({ gallery: false, selected: null });
            return;
        }
        if (isTaken(event)) return;
        const found = list.find((shortcut) => shortcut.matches(event));
        if (!found) return;
        event.preventDefault();
        // What was typed counts before the command does.
        const target = event.target as HTMLElement | null;
        if (target?.matches?.('.number')) target.blur();
        found.press();
    });
    return show;
}
