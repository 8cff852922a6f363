// What the user can do: each changes the store, tells the server, or both.

import type { Connection } from './connection';
import { confirmed } from './dom';
import type { ColorBy, Edit, ExportFormat, PageMessage, Vec3 } from './protocol';
import type { Store, Tool } from './store';
import { isBusy, withToast } from './store';
import { destination, sendFile } from './uploads';

let gestures = 0;

/** A name for a run of edits that are undone together, different from those of other pages. */
export function newGesture(): string {
    return `${Date.now().toString(36)}-${(gestures++).toString(36)}`;
}

export class Actions {
    private exportsAwaited = 0;

    constructor(
        private readonly store: Store,
        private readonly connection: Connection,
        /** Told of each change that goes out, so that its way to the screen can be measured. */
        private readonly onEdit: () => void,
    ) {}

    playOrPause(): void {
        const state = this.store.state.status?.state;
        if (state === 'refining') this.stop();
        else if (state === 'playing') this.send({ type: 'pause' });
        else {
            this.showLive();
            this.send({ type: 'play' });
        }
    }

    step(): void {
        this.showLive();
        this.send({ type: 'step' });
    }

    set(edits: Edit[], gesture: string): void {
        if (this.send({ type: 'set', edits, gesture })) this.onEdit();
    }

    undo(): void {
        if (this.store.state.session?.can_undo) this.send({ type: 'undo' });
    }

    redo(): void {
        if (this.store.state.session?.can_redo) this.send({ type: 'redo' });
    }

    refine(to: 'next' | 'finest'): void {
        if (!this.canRefine()) return;
        this.showLive();
        this.send({ type: 'refine', to });
    }

    canRefine(): boolean {
        const { status } = this.store.state;
        return status !== null && status.level + 1 < status.levels && !isBusy(status) && status.state !== 'empty';
    }

    stop(): void {
        this.send({ type: 'stop' });
    }

    backToPreview(): void {
        this.showLive();
        this.send({ type: 'preview' });
    }

    restart(): void {
        this.showLive();
        this.send({ type: 'restart' });
    }

    grab(id: string, vertex: number, to: Vec3): void {
        if (this.send({ type: 'grab', id, vertex, to })) this.onEdit();
    }

    letGo(id: string, stays: boolean): void {
        this.send({ type: stays ? 'pin' : 'release', id });
    }

    look(change: { detail?: boolean; color?: ColorBy; edges?: boolean }): void {
        this.store.update(change);
        this.tellLook();
    }

    /** What this page alone wants to see; told again to a new connection. */
    tellLook(): void {
        const { detail, color } = this.store.state;
        this.connection.send({ type: 'show', detail, color });
    }

    useTool(tool: Tool): void {
        this.store.update({ tool });
        // A grab names a vertex of the level, which the finest detail is not made of.
        if (tool === 'grab' && this.store.state.detail) this.look({ detail: false });
    }

    showFrame(index: number | null): void {
        if (this.store.state.frame === index) return;
        this.store.update({ frame: index });
        this.send({ type: 'frame', index });
    }

    showLive(): void {
        this.showFrame(null);
    }

    /** Opens a scene of the gallery, or one that has been saved. */
    async openScene(which: { gallery: string } | { file: string }): Promise<void> {
        if (!(await this.mayLeave())) return;
        this.store.update({ gallery: false, unusable: null });
        this.send({ type: 'open', ...which });
    }

    async openFile(file: File): Promise<void> {
        const place = destination(file.name, file.size);
        if ('refusal' in place) {
            this.store.toast('error', place.refusal);
            return;
        }
        if (!(await this.mayLeave())) return;
        this.store.toast('info', `Reading ${file.name} …`);
        const answer = await sendFile(file, place.address);
        this.store.update((state) => {
            const toasts = state.toasts.filter((toast) => !toast.text.startsWith('Reading '));
            const next = { ...state, toasts };
            if (answer.ok) return { ...next, gallery: false, unusable: null };
            if (!answer.findings) return withToast(next, { kind: 'error', text: answer.message });
            return { ...next, gallery: false, unusable: { message: answer.message, findings: answer.findings } };
        });
    }

    save(name: string): void {
        this.send({ type: 'save', name });
    }

    exportAs(format: ExportFormat, what: 'animation' | 'state'): void {
        if (!this.send({ type: 'export', format, what })) return;
        ++this.exportsAwaited;
        this.store.toast('info', `Writing ${format.toUpperCase()} …`);
    }

    /** Whether a file that has come to be is one that this page has asked to export. */
    takesExport(): boolean {
        if (this.exportsAwaited === 0) return false;
        --this.exportsAwaited;
        return true;
    }

    private async mayLeave(): Promise<boolean> {
        if (!this.store.state.session?.edited) return true;
        return confirmed('Open another scene? Changes that are not saved will be gone.', 'Open');
    }

    private send(message: PageMessage): boolean {
        if (this.connection.send(message)) return true;
        this.store.toast('error', 'Not connected: nothing was changed. Trying again …');
        return false;
    }
}
