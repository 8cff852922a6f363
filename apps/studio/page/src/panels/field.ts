// A quantity of the scene: its name, a slider, a number and its unit.

import type { Actions } from '../actions';
import { newGesture } from '../actions';
import { element } from '../dom';
import { isLive, valueAt } from '../pointer';
import type { Json, SessionMessage } from '../protocol';
import type { Scale } from '../scale';
import { fromFraction, toFraction, words } from '../scale';
import { Throttle } from '../throttle';

const sliderSteps = 1000;
const wait = 60;
let fields = 0;

export interface FieldOptions {
    label: string;
    pointer: string;
    unit?: string;
    scale?: Scale;
    /** Bounds of what may be typed. */
    min?: number;
    max?: number;
    isWhole?: boolean;
    /** The number in the scene's value, or null where it holds something else; the value itself when left out. */
    read?: (value: Json | undefined) => number | null;
    write?: (number: number, old: Json | undefined) => Json;
    /** What an emptied field means, and the word for it. */
    empty?: { value: Json; words: string };
    /** Said where the value is no number, such as "scripted". */
    otherwise?: string;
}

export class NumberField {
    readonly root: HTMLElement;
    private readonly number: HTMLInputElement;
    private readonly slider: HTMLInputElement | null;
    private readonly note: HTMLElement;
    private gesture = '';
    private isHeld = false;
    private isLive = false;
    private value: Json | undefined;
    private readonly send = new Throttle<number>(wait, (number) => this.write(number));

    constructor(
        private readonly options: FieldOptions,
        private readonly actions: Actions,
    ) {
        const id = `field-${++fields}`;
        this.note = element('span', { class: 'note', id: `${id}-note` });
        this.number = element('input', {
            type: 'text', inputmode: 'decimal', id, class: 'number', autocomplete: 'off', spellcheck: 'false',
            'data-pointer': options.pointer, 'aria-describedby': `${id}-note`, placeholder: options.empty?.words ?? null,
            onchange: () => this.typed(),
            onkeydown: (event: KeyboardEvent) => this.nudge(event),
        });
        this.slider = options.scale
            ? element('input', {
                  type: 'range', min: 0, max: sliderSteps, step: 1, 'aria-label': `${options.label}, slider`,
                  'data-pointer': options.pointer, oninput: () => this.slid(), onchange: () => this.letGo(),
                  onpointerdown: () => (this.isHeld = true), onpointerup: () => (this.isHeld = false),
                  onpointercancel: () => (this.isHeld = false),
              })
            : null;
        this.root = element('div', { class: 'field' },
            element('label', { for: id }, options.label),
            element('span', { class: 'amount' }, this.number, element('span', { class: 'unit' }, options.unit ?? '')),
            this.slider,
            this.note);
    }

    update(session: SessionMessage): void {
        this.isLive = isLive(session.live, this.options.pointer);
        this.value = valueAt(session.scene, this.options.pointer);
        const number = this.read();
        this.root.classList.toggle('anew', !this.isLive);
        const isOther = number === null && this.value !== null && this.value !== undefined;
        this.note.textContent = isOther ? (this.options.otherwise ?? '') : this.isLive ? '' : 'starts anew';
        if (this.isHeld) return;
        if (document.activeElement !== this.number) this.number.value = number === null ? '' : words(number, 6);
        this.placeSlider(number);
    }

    private read(): number | null {
        if (this.options.read) return this.options.read(this.value);
        return typeof this.value === 'number' ? this.value : null;
    }

    private write(number: number): void {
        const value = this.options.write ? this.options.write(number, this.value) : number;
        this.actions.set([{ set: this.options.pointer, value }], this.gesture);
    }

    private placeSlider(number: number | null): void {
        if (!this.slider || !this.options.scale) return;
        this.slider.value = String(Math.round(toFraction(this.options.scale, number ?? 0) * sliderSteps));
        this.fill();
        this.slider.setAttribute('aria-valuetext', `${words(number)} ${this.options.unit ?? ''}`);
    }

    private fill(): void {
        this.slider?.style.setProperty('--fill', `${Number(this.slider.value) / (sliderSteps / 100)}%`);
    }

    /** While the slider moves, changes that the running state survives are made at once, any other at the end. */
    private slid(): void {
        if (this.gesture === '') this.gesture = newGesture();
        const number = this.sliderNumber();
        this.number.value = words(number, 6);
        this.fill();
        if (this.isLive) this.send.push(number);
    }

    private letGo(): void {
        if (this.gesture === '') this.gesture = newGesture();
        if (!this.isLive) this.send.push(this.sliderNumber());
        this.send.flush();
        this.gesture = '';
        this.isHeld = false;
    }

    private sliderNumber(): number {
        const number = fromFraction(this.options.scale!, Number(this.slider!.value) / sliderSteps);
        return this.options.isWhole ? Math.round(number) : number;
    }

    private typed(): void {
        const { empty } = this.options;
        if (empty && this.number.value.trim() === '') {
            this.number.setAttribute('aria-invalid', 'false');
            this.actions.set([{ set: this.options.pointer, value: empty.value }], newGesture());
            return;
        }
        const number = Number(this.number.value.replace(',', '.'));
        const { min = -Infinity, max = Infinity, isWhole } = this.options;
        const isRight = this.number.value.trim() !== '' && Number.isFinite(number) && number >= min && number <= max;
        this.number.setAttribute('aria-invalid', String(!isRight));
        if (!isRight) {
            this.note.textContent = `${words(min)} to ${words(max)}`;
            return;
        }
        this.gesture = newGesture();
        this.write(isWhole ? Math.round(number) : number);
        this.placeSlider(number);
        this.gesture = '';
    }

    /** Up and down change by a tenth of the number's size; with Shift by a hundredth. */
    private nudge(event: KeyboardEvent): void {
        if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
        event.preventDefault();
        const sign = event.key === 'ArrowUp' ? 1 : -1;
        const now = Number(this.number.value) || 0;
        const size = now === 0 ? 1 : 10 ** Math.floor(Math.log10(Math.abs(now)));
        const by = this.options.isWhole ? 1 : size * (event.shiftKey ? 0.01 : 0.1);
        const { min = -Infinity, max = Infinity } = this.options;
        this.number.value = words(Math.min(max, Math.max(min, now + sign * by)), 6);
        this.typed();
    }
}
