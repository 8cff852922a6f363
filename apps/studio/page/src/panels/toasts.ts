import { button, element } from '../dom';
import type { Store, Toast } from '../store';
import { download } from '../uploads';

const shownFor = { info: 6000, error: 12000 };

/** Short messages that go away by themselves; errors stay longer. */
export function toasts(store: Store): HTMLElement {
    const root = element('div', { class: 'toasts', role: 'status', 'aria-live': 'polite' });
    const shown = new Map<number, HTMLElement>();
    const show = (toast: Toast): HTMLElement => {
        const made = element('div', { class: `toast ${toast.kind}`, role: toast.kind === 'error' ? 'alert' : null },
            element('span', {}, toast.text));
        const { file } = toast;
        if (file) made.append(button({ text: 'Download', label: `Download ${file}`, kind: 'chip', press: () => download(file) }));
        made.append(button({ icon: 'close', label: 'Dismiss', kind: 'chip', press: () => store.dismiss(toast.id) }));
        setTimeout(() => store.dismiss(toast.id), toast.file ? 2 * shownFor.info : shownFor[toast.kind]);
        return made;
    };
    store.watch((state) => [state.toasts], (state) => {
        for (const [id, made] of shown)
            if (!state.toasts.some((toast) => toast.id === id)) {
                made.remove();
                shown.delete(id);
            }
        for (const toast of state.toasts) {
            if (shown.has(toast.id)) continue;
            const made = show(toast);
            shown.set(toast.id, made);
            root.append(made);
        }
    });
    return root;
}
