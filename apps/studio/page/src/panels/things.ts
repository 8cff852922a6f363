// Handles, obstacles and pulls: chosen here or in the view, moved by the gizmo or by numbers.

import type { Actions } from '../actions';
import { newGesture } from '../actions';
import { button, element, setPressed } from '../dom';
import { applied, moved, motionTo, poseAt } from '../motion';
import type { MotionKey, Vec3 } from '../protocol';
import type { State, Store } from '../store';
import { words } from '../scale';
import { currentPose } from '../view/gizmo';
import type { GizmoTarget } from '../view/gizmo';

const identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] as const;

/** What the gizmo would sit on: null where nothing is chosen, or something that cannot be moved by keys. */
export function gizmoTarget(state: State): GizmoTarget | null {
    const [, list, index] = state.selected?.split('/') ?? [];
    if ((list !== 'handles' && list !== 'obstacles') || !state.session?.scene || !state.parts) return null;
    const thing = state.session.scene[list][Number(index)];
    const part = state.parts[list].find((other) => other.name === thing?.name);
    if (!thing || !part || !Array.isArray(thing.motion)) return null;
    const timeStep = state.session.scene.solve.time_step;
    // Where it is wanted after the next step: a change made while paused shows at once, and the next goes on from there.
    const t = Math.max(state.status?.t ?? 0, timeStep);
    const keys = thing.motion as MotionKey[];
    const place = part.rest ? applied(poseAt(keys, t), part.rest) : part.place;
    return { pointer: `${state.selected}/motion`, keys, place, axes: 'axes' in thing ? thing.axes : 'xyz', t, timeStep };
}

export class ThingsPanel {
    readonly root = element('details', { class: 'section', open: true }, element('summary', {}, 'Handles and obstacles'));
    private readonly list = element('div', { class: 'things' });
    private readonly place = element('div', { class: 'place', role: 'group', 'aria-label': 'Place' });
    private readonly inputs: HTMLInputElement[];
    private readonly pulls = element('div', { class: 'things' });

    constructor(
        private readonly store: Store,
        private readonly actions: Actions,
    ) {
        this.inputs = ['x', 'y', 'z'].map((axis, k) =>
            element('input', {
                type: 'text', inputmode: 'decimal', class: 'number', 'aria-label': `${axis}, metres`, 'data-axis': axis,
                onchange: () => this.typed(k),
            }),
        );
        this.place.append(...this.inputs.flatMap((input, k) => [element('span', { class: 'axis' }, 'xyz'[k]!), input]));
        this.root.append(this.list, this.place, this.pulls);
        store.watch((state) => [state.session?.scene, state.selected], (state) => this.listThings(state));
        store.watch((state) => [state.parts, state.selected, state.session?.scene], (state) => this.showPlace(state));
        store.watch((state) => [state.parts?.pulls], (state) => this.listPulls(state));
    }

    private listThings(state: State): void {
        const scene = state.session?.scene;
        const entries = scene
            ? (['handles', 'obstacles'] as const).flatMap((list) =>
                  scene[list].map((thing, i) => ({ pointer: `/${list}/${i}`, name: thing.name, kind: list.slice(0, -1) })))
            : [];
        const focused = (document.activeElement as HTMLElement | null)?.dataset.thing;
        this.list.replaceChildren(...entries.map(({ pointer, name, kind }) => {
            const made = button({
                text: name, label: `${name}, ${kind}`, kind: 'thing', icon: 'move',
                press: () => this.choose(state.selected === pointer ? null : pointer),
            });
            made.dataset.thing = pointer;
            made.append(element('span', { class: 'quiet' }, kind));
            setPressed(made, state.selected === pointer);
            return made;
        }));
        if (focused) this.list.querySelector<HTMLElement>(`[data-thing="${focused}"]`)?.focus();
        this.root.hidden = entries.length === 0 && !state.parts?.pulls.length;
    }

    private choose(pointer: string | null): void {
        const { tool } = this.store.state;
        const keepsTool = tool === 'move' || tool === 'turn';
        this.store.update({ selected: pointer, tool: pointer === null ? 'look' : keepsTool ? tool : 'move' });
    }

    private showPlace(state: State): void {
        const target = gizmoTarget(state);
        this.place.hidden = !target;
        if (!target) return;
        this.inputs.forEach((input, k) => {
            if (document.activeElement !== input) input.value = words(Math.round(target.place[k]! * 1e5) / 1e5, 4);
        });
    }

    private typed(axis: number): void {
        const target = gizmoTarget(this.store.state);
        const value = Number(this.inputs[axis]!.value.replace(',', '.'));
        if (!target || !Number.isFinite(value)) return;
        const shift: Vec3 = [0, 0, 0];
        shift[axis] = value - target.place[axis]!;
        const pose = moved(currentPose(target), identity.map((row) => [...row]) as [Vec3, Vec3, Vec3], target.place, shift);
        const motion = motionTo(target.keys, pose, target.timeStep);
        this.actions.set([{ set: target.pointer, value: JSON.parse(JSON.stringify(motion)) }], newGesture());
    }

    private listPulls(state: State): void {
        const pulls = state.parts?.pulls ?? [];
        this.pulls.replaceChildren(...pulls.map((pull, i) => button({
            text: `Pull ${i + 1}`, label: `Let go of pull ${i + 1}`, kind: 'thing', icon: 'close',
            press: () => this.actions.letGo(pull.id, false),
        })));
        if (pulls.length > 0) this.root.hidden = false;
    }
}
