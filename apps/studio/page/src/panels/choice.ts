// A value of the scene that is one of a few words.

import type { Actions } from '../actions';
import { newGesture } from '../actions';
import { element, select } from '../dom';
import { isLive, valueAt } from '../pointer';
import type { Scene, SessionMessage } from '../protocol';

let choices = 0;

export interface ChoiceOptions {
    label: string;
    pointer: string;
    values: readonly {
        value: string;
        words: string;
        /** Why the scene cannot have it; null where it can. */
        whyNot?: (scene: Scene) => string | null;
    }[];
}

export class ChoiceField {
    readonly root: HTMLElement;
    private readonly select: HTMLSelectElement;
    private readonly note: HTMLElement;

    constructor(
        private readonly options: ChoiceOptions,
        actions: Actions,
    ) {
        const id = `choice-${++choices}`;
        const { label, pointer, values } = options;
        this.note = element('span', { class: 'note', id: `${id}-note` });
        this.select = select({
            id, 'data-pointer': pointer, 'aria-describedby': `${id}-note`,
            onchange: () => actions.set([{ set: pointer, value: this.select.value }], newGesture()),
        }, ...values.map(({ value, words }) => element('option', { value }, words)));
        this.root = element('div', { class: 'field choice' }, element('label', { for: id }, label), this.select, this.note);
    }

    update(session: SessionMessage): void {
        const { pointer, values } = this.options;
        this.note.textContent = isLive(session.live, pointer) ? '' : 'starts anew';
        this.select.value = String(valueAt(session.scene, pointer));
        values.forEach(({ whyNot }, i) => {
            const reason = session.scene && whyNot ? whyNot(session.scene) : null;
            const option = this.select.options[i]!;
            option.disabled = reason !== null;
            option.title = reason ?? '';
        });
    }
}
