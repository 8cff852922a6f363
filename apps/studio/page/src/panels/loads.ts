// The scene's loads: on which vertices of which body, how much, which way.

import type { Actions } from '../actions';
import { element } from '../dom';
import type { Json, Load, SessionMessage } from '../protocol';
import { NumberField } from './field';
import { VectorField, isVec3, ofLength } from './vector_field';

/** The selected vertices of a load, in words. */
export function selectionWords(select: Load['select']): string {
    if (select === null) return 'all over';
    if (Array.isArray(select.vertices)) {
        const { vertices } = select;
        return vertices.length === 1 ? `vertex ${String(vertices[0])}` : `${vertices.length} vertices`;
    }
    if (typeof select.boundary_loop === 'number') return `boundary loop ${select.boundary_loop}`;
    return 'box' in select ? 'inside of a box' : 'inside of a sphere';
}

const sizeOf = (value: Json | undefined): number | null => (isVec3(value) ? Number(Math.hypot(...value).toPrecision(6)) : null);

/** The fields of all loads, and what brings them up to date. */
export function loadFields(loads: readonly Load[], actions: Actions): { content: HTMLElement[]; update: (session: SessionMessage) => void } {
    const updaters: ((session: SessionMessage) => void)[] = [];
    const content = loads.map((load, i) => {
        const isForce = load.force !== undefined;
        const [label, key, unit] = isForce ? ['Force in all', 'force', 'N'] : ['Traction', 'traction', 'Pa'];
        const pointer = `/loads/${i}/${key}`;
        const where = `${load.body}, ${selectionWords(load.select)}`;
        const size = new NumberField({
            label, pointer, unit, min: 0, scale: isForce ? { kind: 'log', low: 1e-4, high: 1e4 } : { kind: 'log', low: 1e-2, high: 1e6 },
            read: sizeOf, write: (length, old) => ofLength(old, length), otherwise: 'scripted; a number here replaces the script',
        }, actions);
        const vector = new VectorField({ label, pointer, unit }, actions);
        updaters.push((session) => size.update(session), (session) => vector.update(session));
        return element('div', { class: 'load', role: 'group', 'aria-label': `Load on ${where}` },
            element('p', { class: 'quiet' }, where), size.root, vector.root);
    });
    return { content, update: (session) => updaters.forEach((update) => update(session)) };
}
