import type { Actions } from '../actions';
import { button, element, icon } from '../dom';
import type { ExportFormat } from '../protocol';
import type { Store } from '../store';
import { hasScene } from '../store';
import { toggleTheme } from '../theme';

const formats: { format: ExportFormat; name: string; words: string }[] = [
    { format: 'gltf', name: 'glTF', words: 'for the web and most programs' },
    { format: 'usd', name: 'USD', words: 'for film pipelines' },
    { format: 'pvd', name: 'VTK', words: 'for ParaView' },
    { format: 'pc2', name: 'PC2', words: 'for Blender and Houdini' },
    { format: 'obj', name: 'OBJ', words: 'a sequence of meshes' },
    { format: 'ply', name: 'PLY', words: 'a sequence of meshes' },
];

/** A button with a panel under it that closes by Escape or a press elsewhere. */
function menu(trigger: HTMLButtonElement, panel: HTMLElement): HTMLElement {
    const root = element('div', { class: 'menu' }, trigger, panel);
    const show = (shown: boolean): void => {
        panel.hidden = !shown;
        trigger.setAttribute('aria-expanded', String(shown));
        if (shown) panel.querySelector<HTMLElement>('button, input')?.focus();
    };
    trigger.addEventListener('click', () => show(panel.hidden));
    root.addEventListener('keydown', (event) => {
        if (event.key !== 'Escape' || panel.hidden) return;
        event.stopPropagation();
        show(false);
        trigger.focus();
    });
    document.addEventListener('pointerdown', (event) => {
        if (!root.contains(event.target as Node)) show(false);
    });
    panel.addEventListener('done', () => show(false));
    show(false);
    return root;
}

function exportMenu(actions: Actions): HTMLElement {
    let what: 'animation' | 'state' = 'animation';
    const choice = (value: typeof what, text: string): HTMLElement =>
        element('label', {}, element('input', {
            type: 'radio', name: 'what', value, checked: value === what, onchange: () => (what = value),
        }), text);
    const panel = element('div', { class: 'menu-panel', role: 'group', 'aria-label': 'Export' },
        element('div', { class: 'choice-row', role: 'radiogroup', 'aria-label': 'What to export' },
            choice('animation', 'Animation'), choice('state', 'This state')));
    for (const { format, name, words } of formats)
        panel.append(element('button', {
            type: 'button', class: 'menu-item', 'data-format': format,
            onclick: () => {
                actions.exportAs(format, what);
                panel.dispatchEvent(new Event('done'));
            },
        }, element('strong', {}, name), element('span', { class: 'quiet' }, words)));
    return menu(button({ icon: 'export', text: 'Export', label: 'Export', press: () => {} }), panel);
}

function saveMenu(store: Store, actions: Actions): HTMLElement {
    const name = element('input', { type: 'text', class: 'text', id: 'save-name', autocomplete: 'off', maxlength: 80, required: true });
    store.watch((state) => [state.session?.file_name], (state) => (name.value = state.session?.file_name ?? ''));
    const form = element('form', {
        class: 'menu-panel', 'aria-label': 'Save the scene',
        onsubmit: (event: SubmitEvent) => {
            event.preventDefault();
            actions.save(name.value.trim());
            form.dispatchEvent(new Event('done'));
        },
    },
        element('label', { for: 'save-name' }, 'Name'), name,
        element('p', { class: 'quiet' }, 'The scene, and beside it what was changed while it ran: plisse run replays it.'),
        element('button', { type: 'submit', class: 'button primary' }, 'Save'));
    return menu(button({ icon: 'save', text: 'Save', label: 'Save the scene', key: 'Ctrl+S', press: () => {} }), form);
}

export function topBar(store: Store, actions: Actions, showHelp: () => void): HTMLElement {
    const scenes = button({
        icon: 'scenes', text: 'Scenes', label: 'Open another scene', press: () => store.update((state) => ({ ...state, gallery: !state.gallery })),
    });
    const undo = button({ icon: 'undo', label: 'Undo', key: 'Ctrl+Z', press: () => actions.undo() });
    const redo = button({ icon: 'redo', label: 'Redo', key: 'Ctrl+Shift+Z', press: () => actions.redo() });
    const name = element('span', { class: 'scene-name' });
    const tools = element('div', { class: 'bar-group' }, undo, redo, saveMenu(store, actions), exportMenu(actions));
    const link = element('span', { class: 'link-state', role: 'status' });
    store.watch((state) => [state.session], ({ session }) => {
        undo.disabled = !session?.can_undo;
        redo.disabled = !session?.can_redo;
        name.textContent = session?.scene ? `${session.scene.name}${session.edited ? ' · changed' : ''}` : '';
    });
    store.watch((state) => [hasScene(state), state.unusable], (state) => {
        scenes.hidden = !hasScene(state);
        tools.hidden = !hasScene(state) || state.unusable !== null;
    });
    store.watch((state) => [state.connection], ({ connection }) => {
        link.dataset.connection = connection;
        link.textContent = connection === 'lost' ? 'Connection lost; trying again …' : connection === 'connecting' ? 'Connecting …' : '';
    });
    return element('header', { class: 'topbar' },
        element('span', { class: 'brand' }, icon('refine'), 'plisse', element('span', { class: 'quiet' }, 'studio')),
        scenes, name, link, element('span', { class: 'spring' }), tools,
        element('div', { class: 'bar-group' },
            button({ icon: 'theme', label: 'Light or dark', press: toggleTheme }),
            button({ icon: 'help', label: 'Keys and help', key: '?', press: showHelp })));
}
