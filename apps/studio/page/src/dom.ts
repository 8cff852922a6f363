// Elements made by hand.

type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | null | ((event: never) => void)>;

/** An element; attributes that begin with `on` are listeners, null and false ones are left out. */
export function element<K extends keyof HTMLElementTagNameMap>(
    tag: K, attributes: Attributes = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === 'function') made.addEventListener(name.slice(2), value as unknown as EventListener);
        else if (value === true) made.setAttribute(name, '');
        else if (value !== false && value !== null) made.setAttribute(name, String(value));
    }
    made.append(...children.filter((child) => child !== null));
    return made;
}

const icons = {
    play: '<path d="M7 4.8v14.4a.8.8 0 0 0 1.2.7l11.6-7.2a.8.8 0 0 0 0-1.4L8.2 4.1A.8.8 0 0 0 7 4.8z" fill="currentColor" stroke="none"/>',
    pause: '<path d="M8 5v14M16 5v14" stroke-width="3.4"/>',
    step: '<path d="M5 5.6v12.8l9-6.4z" fill="currentColor" stroke="none"/><path d="M18 5v14" stroke-width="2.6"/>',
    stop: '<rect x="6" y="6" width="12" height="12" rx="2" fill="currentColor" stroke="none"/>',
    restart: '<path d="M5 12a7 7 0 1 0 2.4-5.3M5 4v4h4"/>',
    undo: '<path d="M9 7 4.5 11.5 9 16M5 11.5h9a5.5 4.5 0 0 1 0 9h-3"/>',
    redo: '<path d="m15 7 4.5 4.500L15 16M19 11.500h-9a5.5 4.5 0 0 0 0 9h3"/>',
    refine: '<path d="M12 3 3.5 18.500h17zM7.8 10.700h8.400L12 18.500z"/>',
    finest: '<path d="m12 3 2.3 5.900L20.5 11l-6.2 2.300L12 20l-2.3-6.700L3.5 11l6.2-2.100z"/>',
    back: '<path d="M11 6 5 12l6 6M5 12h14"/>',
    look: '<path d="M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12z"/><circle cx="12" cy="12" r="2.8"/>',
    grab: '<path d="M7 11.500V6.800a1.6 1.6 0 0 1 3.2 0V11m0-.500V5a1.6 1.6 0 0 1 3.2 0v6m0-5a1.6 1.6 0 0 1 3.2 0v6m0-3a1.6 1.6 0 0 1 3.2 0v5.500c0 4-2.6 6.5-6.4 6.5-3 0-4.6-1.2-6-3.600l-3-5.200c-1-1.9 1.4-3.3 2.6-1.700z"/>',
    move: '<path d="M12 3v18M3 12h18M12 3 9.5 5.500M12 3l2.5 2.500M12 21l-2.5-2.500M12 21l2.5-2.500M3 12l2.5-2.500M3 12l2.5 2.500M21 12l-2.5-2.500M21 12l-2.5 2.5"/>',
    turn: '<path d="M20 12a8 8 0 1 1-2.6-5.900M20.5 3v4h-4"/><circle cx="12" cy="12" r="1.6"/>',
    edges: '<path d="M4 18 12 4l8 14zM8 11h8m-8 0 4 7 4-7"/>',
    detail: '<circle cx="10.5" cy="10.5" r="6"/><path d="m15 15 5.5 5.500M10.5 8v5M8 10.500h5"/>',
    frame: '<path d="M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5"/>',
    scenes: '<rect x="3.5" y="4" width="7" height="7" rx="1.5"/><rect x="13.5" y="4" width="7" height="7" rx="1.5"/><rect x="3.5" y="14" width="7" height="6.5" rx="1.5"/><rect x="13.5" y="14" width="7" height="6.5" rx="1.5"/>',
    save: '<path d="M12 4v11m0 0-4.5-4.500M12 15l4.5-4.500M4 17v2.500h16V17"/>',
    export: '<path d="M12 15V4m0 0L7.5 8.500M12 4l4.5 4.500M4 15v4.500h16V15"/>',
    theme: '<circle cx="12" cy="12" r="4.2"/><path d="M12 2.500v2.500M12 19v2.500M2.5 12H5M19 12h2.500M5.3 5.3 7 7M17 17l1.7 1.700M18.7 5.3 17 7M7 17l-1.7 1.7"/>',
    help: '<path d="M8.5 9a3.5 3.5 0 1 1 5 3.200c-1 .5-1.5 1.1-1.5 2.3"/><circle cx="12" cy="18" r=".6" fill="currentColor"/>',
    close: '<path d="m6 6 12 12M18 6 6 18"/>',
    live: '<circle cx="12" cy="12" r="4" fill="currentColor" stroke="none"/><circle cx="12" cy="12" r="8"/>',
    upload: '<path d="M12 16V5m0 0L7 10m5-5 5 5M5 19.500h14"/>',
};
export type IconName = keyof typeof icons;

export function icon(name: IconName): SVGSVGElement {
    const holder = document.createElement('template');
    holder.innerHTML =
        '<svg class="icon" viewBox="0 0 24 24" fill="none" stroke="currentColor" stroke-width="1.7" ' +
        `stroke-linecap="round" stroke-linejoin="round" aria-hidden="true">${icons[name]}</svg>`;
    return holder.content.firstElementChild as SVGSVGElement;
}

export interface ButtonOptions {
    icon?: IconName;
    /** Shown; without it the label is heard and seen as a tooltip only. */
    text?: string;
    label: string;
    /** A key that does the same, for the tooltip. */
    key?: string;
    kind?: string;
    press: () => void;
}

export function button(options: ButtonOptions): HTMLButtonElement {
    const made = element('button', {
        type: 'button',
        class: `button ${options.kind ?? ''} ${options.text ? '' : 'bare'}`,
        'aria-label': options.text === options.label ? null : options.label,
        title: options.key ? `${options.label} (${options.key})` : options.label,
        onclick: options.press,
    });
    if (options.icon) made.append(icon(options.icon));
    if (options.text) made.append(element('span', {}, options.text));
    return made;
}

/** A select that gives the focus back once a pointer has chosen: what is typed then is a command, not another choice. */
export function select(attributes: Attributes, ...options: HTMLOptionElement[]): HTMLSelectElement {
    const made = element('select', attributes, ...options);
    let byPointer = false;
    made.addEventListener('pointerdown', () => (byPointer = true));
    made.addEventListener('keydown', () => (byPointer = false));
    made.addEventListener('change', () => {
        if (byPointer) made.blur();
    });
    return made;
}

export function setPressed(toggle: HTMLElement, pressed: boolean): void {
    toggle.setAttribute('aria-pressed', String(pressed));
}

/** Swaps a button's icon, text and name for another's. */
export function relabel(target: HTMLButtonElement, name: IconName, text: string, label: string, key = ''): void {
    if (target.dataset.relabelled === name + text) return;
    target.dataset.relabelled = name + text;
    target.replaceChildren(icon(name), element('span', {}, text));
    target.title = key ? `${label} (${key})` : label;
}

/** Asks before something that cannot be taken back. */
export function confirmed(question: string, yes: string): Promise<boolean> {
    return new Promise((resolve) => {
        const dialog = element('dialog', { class: 'dialog', 'aria-label': question });
        const answer = (value: boolean): void => {
            dialog.close();
            dialog.remove();
            resolve(value);
        };
        dialog.append(
            element('p', {}, question),
            element('div', { class: 'dialog-buttons' },
                button({ text: 'Cancel', label: 'Cancel', press: () => answer(false) }),
                button({ text: yes, label: yes, kind: 'primary', press: () => answer(true) })),
        );
        dialog.addEventListener('cancel', (event) => {
            event.preventDefault();
            answer(false);
        });
        document.body.append(dialog);
        dialog.showModal();
    });
}
