import { describe, expect, it } from 'vitest';

import { isTaken } from '../src/shortcuts';

/** A key pressed in an element that answers to these selectors. */
const pressed = (key: string, selectors: string, modifiers: Partial<KeyboardEvent> = {}): KeyboardEvent => ({
    key, ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, ...modifiers,
    target: { matches: (list: string) => list.split(', ').some((selector) => selectors.split(' ').includes(selector)) },
}) as unknown as KeyboardEvent;

const number = '.number input[type=text]';

describe('keys', () => {
    it.each(['r', 'R', 'b', ' ', '?', 'l'])('%j is a command while a number has the focus', (key) =>
        expect(isTaken(pressed(key, number))).toBe(false));
    it.each(['7', '.', ',', '-', 'e', 'ArrowUp', 'Enter', 'Backspace'])('%j belongs to the number that has the focus', (key) =>
        expect(isTaken(pressed(key, number))).toBe(true));
    it('undo what is typed first, but save the scene', () => {
        expect(isTaken(pressed('z', number, { ctrlKey: true }))).toBe(true);
        expect(isTaken(pressed('s', number, { ctrlKey: true }))).toBe(false);
    });
    it('are text where a name is typed', () => expect(isTaken(pressed('r', 'input[type=text]'))).toBe(true));
    it('choose in a select', () => {
        expect(isTaken(pressed('r', 'select'))).toBe(true);
        expect(isTaken(pressed('F5', 'select'))).toBe(false);
    });
    it('are commands on a slider and on a button, but for the space that presses it', () => {
        expect(isTaken(pressed('r', 'button'))).toBe(false);
        expect(isTaken(pressed(' ', 'button'))).toBe(true);
        expect(isTaken(pressed(' ', 'input[type=range]'))).toBe(false);
    });
});
