// The numbers of what is shown: level, vertices, time, speed.

import { element } from '../dom';
import { words } from '../scale';
import type { State, Store } from '../store';

const stateNames: Record<string, string> = {
    empty: '', building: 'building', idle: 'paused', playing: 'running', refining: 'refining', at_rest: 'at rest', failed: 'failed',
};

export interface Measures {
    volume: number | null;
    /** Milliseconds from a change of a parameter to the first picture after it. */
    editShown: number | null;
    /** As the page has seen them come. */
    stepsPerSecond: number | null;
    vertices: number;
    level: number;
    detail: boolean;
}

/** Which level is shown, and what that is to the user. */
export function levelWords({ level, levels, detail }: { level: number; levels: number; detail: boolean }): string {
    if (detail) return `Level ${level} shown on the finest mesh`;
    const name = level + 1 >= levels ? ' · your mesh' : level === 0 ? ' · preview' : '';
    return `Level ${level} of ${levels - 1}${name}`;
}

export class Readout {
    readonly root = element('div', { class: 'readout', 'aria-label': 'State' });
    private readonly level = element('strong', { 'data-readout': 'level' });
    private readonly state = element('span', { class: 'state', 'data-readout': 'state' });
    private readonly rest = element('span', { class: 'quiet' });
    private readonly cells = new Map<string, HTMLElement>();

    constructor(store: Store) {
        for (const name of ['vertices', 'time', 'speed', 'change', 'volume']) {
            const cell = element('span', { 'data-readout': name });
            this.cells.set(name, cell);
            this.rest.append(cell);
        }
        this.root.append(element('span', { class: 'readout-head' }, this.level, this.state), this.rest);
        store.watch((state) => [state.status, state.frame, state.unusable], (state) => this.showStatus(state));
    }

    private set(name: string, text: string): void {
        const cell = this.cells.get(name)!;
        cell.textContent = text;
        cell.hidden = text === '';
    }

    private showStatus(state: State): void {
        const { status } = state;
        this.root.hidden = !status || status.state === 'empty' || state.unusable !== null;
        if (!status) return;
        this.root.dataset.state = state.frame === null ? status.state : 'frame';
        this.state.textContent = state.frame === null ? (stateNames[status.state] ?? status.state) : 'saved frame';
        if (state.frame === null) this.set('time', `t ${words(status.t)} of ${words(status.duration)} s`);
        else this.set('time', `t ${words(state.frames[state.frame]?.t)} s`);
        this.running = { level: status.level, levels: status.levels };
        this.showLevel();
        this.set('speed', status.state === 'playing' && status.steps_per_second ? `${words(status.steps_per_second, 2)} steps/s` : '');
    }

    private running = { level: 0, levels: 1 };
    private shown = { level: 0, detail: false };

    /** What is shown and what runs are told apart, in either order. The finest detail is that of the level that runs. */
    private showLevel(): void {
        const { detail } = this.shown;
        const level = detail ? this.running.level : this.shown.level;
        this.level.textContent = levelWords({ level, levels: this.running.levels, detail });
        this.root.dataset.level = String(level);
    }

    showMeasures(measures: Measures): void {
        this.shown = { level: measures.level, detail: measures.detail };
        this.showLevel();
        this.root.dataset.volume = measures.volume === null ? '' : String(measures.volume);
        this.root.dataset.steps = measures.stepsPerSecond === null ? '' : measures.stepsPerSecond.toFixed(2);
        this.root.dataset.change = measures.editShown === null ? '' : measures.editShown.toFixed(0);
        this.set('vertices', `${measures.vertices.toLocaleString('en')} vertices`);
        this.set('change', measures.editShown === null ? '' : `change seen in ${measures.editShown.toFixed(0)} ms`);
        this.set('volume', measures.volume === null ? '' : `encloses ${words(measures.volume * 1000)} L`);
    }
}
