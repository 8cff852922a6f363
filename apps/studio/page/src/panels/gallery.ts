// Where one begins: examples with pictures, and a place to drop a file.

import type { Actions } from '../actions';
import { button, element, icon } from '../dom';
import type { GalleryEntry } from '../protocol';
import type { Store } from '../store';
import { hasScene } from '../store';
import { acceptedFiles, fetchGallery, fetchSavedScenes } from '../uploads';

export class Gallery {
    readonly root = element('section', { class: 'gallery', 'aria-label': 'Scenes' });
    private readonly cards = element('div', { class: 'cards' });
    private readonly saved = element('nav', { class: 'saved', 'aria-label': 'Saved scenes', hidden: true });
    private readonly back: HTMLElement;
    private hasCards = false;
    private isFetching = false;

    constructor(
        private readonly store: Store,
        private readonly actions: Actions,
    ) {
        this.back = button({
            text: 'Back to the studio', label: 'Back to the studio', icon: 'back', key: 'Esc',
            press: () => store.update({ gallery: false }),
        });
        this.root.append(element('div', { class: 'gallery-inner' },
            element('header', { class: 'gallery-head' },
                element('h1', {}, 'Choose something to shape'),
                element('p', {}, 'A coarse preview moves at once; steer it by hand, then press Refine.'),
                this.back),
            this.saved, this.cards, this.dropZone()));
        this.cards.append(...Array.from({ length: 6 }, () => element('div', { class: 'card waiting' })));
        store.watch((state) => [state.gallery, hasScene(state), state.connection, state.status], (state) => {
            const wasHidden = this.root.hidden;
            this.root.hidden = !(state.gallery || (state.status !== null && !hasScene(state)));
            this.back.hidden = !hasScene(state);
            if (this.root.hidden || state.connection !== 'open') return;
            void this.load();
            if (wasHidden || this.saved.hidden) void this.loadSaved();
        });
    }

    private async load(): Promise<void> {
        if (this.hasCards || this.isFetching) return;
        this.isFetching = true;
        try {
            const entries = await fetchGallery();
            this.cards.replaceChildren(...entries.map((entry) => this.card(entry)));
            this.hasCards = true;
        } catch {
            this.store.toast('error', 'The gallery could not be read.');
        }
        this.isFetching = false;
    }

    private async loadSaved(): Promise<void> {
        try {
            const scenes = await fetchSavedScenes();
            this.saved.hidden = scenes.length === 0;
            this.saved.replaceChildren(element('span', {}, 'Saved here'), ...scenes.map(({ file, words }) => element('button', {
                type: 'button', class: 'saved-scene', 'data-file': file, onclick: () => void this.actions.openScene({ file }),
            }, words)));
        } catch {
            this.store.toast('error', 'What has been saved could not be listed.');
        }
    }

    private card(entry: GalleryEntry): HTMLElement {
        const facts = `${entry.vertices.toLocaleString('en')} vertices · ${entry.levels} levels`;
        return element('button', {
            type: 'button', class: 'card', 'data-gallery': entry.id, 'aria-label': `${entry.title}: ${entry.words}`,
            onclick: () => void this.actions.openScene({ gallery: entry.id }),
        },
            element('img', { src: entry.picture, alt: '', loading: 'lazy', draggable: 'false' }),
            element('span', { class: 'card-text' },
                element('strong', {}, entry.title), element('span', {}, entry.words),
                element('span', { class: 'facts' }, facts)),
            element('span', { class: 'card-go' }, icon('play')));
    }

    private dropZone(): HTMLElement {
        const input = element('input', {
            type: 'file', accept: acceptedFiles, class: 'visually-hidden', id: 'file',
            onchange: () => {
                const file = input.files?.[0];
                input.value = '';
                if (file) void this.actions.openFile(file);
            },
        });
        return element('label', { class: 'drop', for: 'file' }, input, icon('upload'),
            element('span', {}, element('strong', {}, 'Drop a mesh of your own, or press to choose one'),
                element('span', {}, 'OBJ, PLY, STL or OFF; or a scene’s JSON')));
    }
}

/** Files may be dropped anywhere on the page. */
export function acceptDrops(actions: Actions): void {
    const cover = element('div', { class: 'drop-cover', hidden: true }, icon('upload'), 'Drop to open');
    document.body.append(cover);
    const carriesFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes('Files') ?? false;
    window.addEventListener('dragover', (event) => {
        if (!carriesFiles(event)) return;
        event.preventDefault();
        cover.hidden = false;
    });
    window.addEventListener('dragleave', (event) => {
        if (event.relatedTarget === null) cover.hidden = true;
    });
    window.addEventListener('drop', (event) => {
        event.preventDefault();
        cover.hidden = true;
        const file = event.dataTransfer?.files[0];
        if (file) void actions.openFile(file);
    });
}
