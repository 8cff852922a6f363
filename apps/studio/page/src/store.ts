// What the page knows: one state, changed only by the functions below, and watched by the parts of the page.

import type {
    ColorBy, Findings, Frame, PartsMessage, Progress, Sample, ServerMessage, SessionMessage, StatusMessage,
} from './protocol';

export type Connection = 'connecting' | 'open' | 'lost' | 'refused';
export type Tool = 'look' | 'grab' | 'move' | 'turn';

export interface Toast {
    id: number;
    kind: 'info' | 'error';
    text: string;
    /** A file of the session to offer. */
    file?: string;
}

export interface State {
    connection: Connection;
    session: SessionMessage | null;
    status: StatusMessage | null;
    progress: Progress | null;
    samples: Sample[];
    frames: Frame[];
    /** The saved frame that is looked at; null for the running state. */
    frame: number | null;
    parts: PartsMessage | null;
    toasts: Toast[];
    /** Why an offered mesh cannot be used. */
    unusable: { message: string; findings: Findings } | null;
    /** The gallery lies over a session that goes on. */
    gallery: boolean;
    detail: boolean;
    color: ColorBy;
    edges: boolean;
    tool: Tool;
    /** What the gizmo sits on, a pointer such as /handles/0. */
    selected: string | null;
}

export const initialState: State = {
    connection: 'connecting',
    session: null,
    status: null,
    progress: null,
    samples: [],
    frames: [],
    frame: null,
    parts: null,
    toasts: [],
    unusable: null,
    gallery: false,
    detail: false,
    color: 'none',
    edges: false,
    tool: 'look',
    selected: null,
};

let lastToast = 0;

export function withToast(state: State, toast: Omit<Toast, 'id'>): State {
    const others = state.toasts.filter((other) => other.text !== toast.text).slice(-3);
    return { ...state, toasts: [...others, { ...toast, id: ++lastToast }] };
}

/** Of a status that comes before there is a run. */
const noRun = {
    level: 0, levels: 1, vertices: 0, phase: '', t: 0, duration: 0, step: 0, equilibrium: false, steps_per_second: null, edit_to_step_ms: null,
};

/** The state after a message from the server. */
export function reduce(state: State, message: ServerMessage): State {
    switch (message.type) {
        case 'session':
            return afterSession(state, message);
        case 'status':
            return {
                ...state,
                status: { ...noRun, ...message },
                progress: isBusy(message) ? state.progress : null,
            };
        case 'progress': {
            const { type: _, ...progress } = message;
            return { ...state, progress };
        }
        case 'sample': {
            // Appended in place: a long run has too many to copy at every step. The new outer state is what is watched.
            const { type: _, ...sample } = message;
            state.samples.push(sample);
            return { ...state };
        }
        case 'samples':
            return { ...state, samples: message.samples };
        case 'frames': {
            const frames = [...state.frames.slice(0, message.from), ...message.list];
            const frame = state.frame !== null && state.frame >= frames.length ? null : state.frame;
            return { ...state, frames, frame };
        }
        case 'parts':
            return { ...state, parts: message };
        case 'saved':
            return message.files.reduce(
                (next, file) => withToast(next, { kind: 'info', text: `${file} is ready`, file }),
                state,
            );
        case 'error':
            return withToast(state, { kind: 'error', text: message.message });
    }
}

function afterSession(state: State, session: SessionMessage): State {
    const isAnother = session.scene?.name !== state.session?.scene?.name;
    const keptSelection = isAnother || !selectable(session, state.selected) ? null : state.selected;
    return { ...state, session, selected: keptSelection, unusable: null, gallery: isAnother ? false : state.gallery };
}

function selectable(session: SessionMessage, pointer: string | null): boolean {
    const [, list, index] = pointer?.split('/') ?? [];
    if (!session.scene || (list !== 'handles' && list !== 'obstacles')) return false;
    return Number(index) < session.scene[list].length;
}

export function isBusy(status: StatusMessage | null): boolean {
    return status?.state === 'building' || status?.state === 'refining';
}

/** Whether the studio has something to show, or only the gallery does. */
export function hasScene(state: State): boolean {
    return state.status !== null && (state.status.state !== 'empty' || state.unusable !== null);
}

type Watcher = (state: State) => void;

/** Holds the state and tells the watchers, at most once a task, that it has changed. */
export class Store {
    private current: State;
    private watchers = new Set<Watcher>();
    private isScheduled = false;

    constructor(initial: Partial<State> = {}) {
        this.current = { ...initialState, samples: [], ...initial };
    }

    get state(): State {
        return this.current;
    }

    update(change: Partial<State> | ((state: State) => State)): void {
        this.current = typeof change === 'function' ? change(this.current) : { ...this.current, ...change };
        if (this.isScheduled) return;
        this.isScheduled = true;
        queueMicrotask(() => {
            this.isScheduled = false;
            for (const watcher of this.watchers) watcher(this.current);
        });
    }

    receive(message: ServerMessage): void {
        this.update((state) => reduce(state, message));
    }

    /** Calls `watcher` now and whenever one of what `pick` reads has changed. */
    watch<T extends readonly unknown[]>(pick: (state: State) => T, watcher: (state: State) => void): void {
        let last = pick(this.current);
        watcher(this.current);
        this.watchers.add((state) => {
            const next = pick(state);
            if (next.every((value, i) => Object.is(value, last[i]))) return;
            last = next;
            watcher(state);
        });
    }

    toast(kind: Toast['kind'], text: string): void {
        this.update((state) => withToast(state, { kind, text }));
    }

    dismiss(id: number): void {
        this.update((state) => ({ ...state, toasts: state.toasts.filter((toast) => toast.id !== id) }));
    }
}
