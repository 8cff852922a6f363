// Three numbers of the scene that belong together: x, y and z.

import type { Actions } from '../actions';
import { newGesture } from '../actions';
import { element } from '../dom';
import { valueAt } from '../pointer';
import type { Json, SessionMessage, Vec3 } from '../protocol';
import { words } from '../scale';

export function isVec3(value: Json | undefined): value is Vec3 {
    return Array.isArray(value) && value.length === 3 && value.every((x) => typeof x === 'number');
}

/** A vector of another length along the way it points; downward where there was none. */
export function ofLength(old: Json | undefined, length: number): Vec3 {
    const v: Vec3 = isVec3(old) ? old : [0, 0, 0];
    const before = Math.hypot(...v);
    if (before === 0) return [0, -length, 0];
    return v.map((x) => (x === 0 ? 0 : Number(((x / before) * length).toPrecision(6)))) as Vec3;
}

/** Hidden where the value is no vector, such as keyframes. */
export class VectorField {
    readonly root: HTMLElement;
    private readonly inputs: HTMLInputElement[];
    private value: Vec3 = [0, 0, 0];

    constructor(
        private readonly options: { label: string; pointer: string; unit: string },
        private readonly actions: Actions,
    ) {
        const { label, pointer, unit } = options;
        this.inputs = ['x', 'y', 'z'].map((axis, k) => element('input', {
            type: 'text', inputmode: 'decimal', class: 'number', autocomplete: 'off', spellcheck: 'false',
            'aria-label': `${label} along ${axis}, ${unit}`, 'data-pointer': `${pointer}/${k}`, onchange: () => this.typed(k),
        }));
        this.root = element('div', { class: 'place', role: 'group', 'aria-label': `${label} along the axes` },
            ...this.inputs.flatMap((input, k) => [element('span', { class: 'axis' }, 'xyz'[k]!), input]));
    }

    update(session: SessionMessage): void {
        const value = valueAt(session.scene, this.options.pointer);
        this.root.hidden = !isVec3(value);
        if (!isVec3(value)) return;
        this.value = value;
        this.inputs.forEach((input, k) => {
            if (document.activeElement !== input) input.value = words(value[k], 6);
        });
    }

    private typed(axis: number): void {
        const input = this.inputs[axis]!;
        const number = Number(input.value.replace(',', '.'));
        const isRight = input.value.trim() !== '' && Number.isFinite(number);
        input.setAttribute('aria-invalid', String(!isRight));
        if (!isRight) return;
        const value = this.value.map((x, k) => (k === axis ? number : x));
        this.actions.set([{ set: this.options.pointer, value }], newGesture());
    }
}
