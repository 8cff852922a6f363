// The panel at the right: everything of the scene that can be changed by hand.

import type { Actions } from '../actions';
import { newGesture } from '../actions';
import { element, select } from '../dom';
import type { Json, Material, Scene, SessionMessage, Vec3 } from '../protocol';
import type { Store } from '../store';
import type { ChoiceOptions } from './choice';
import { ChoiceField } from './choice';
import type { FieldOptions } from './field';
import { NumberField } from './field';
import { findingsPanel } from './findings';
import { loadFields } from './loads';
import { ThingsPanel } from './things';
import { isVec3, ofLength } from './vector_field';

type Updater = (session: SessionMessage) => void;

/** A material's name among the presets; `custom` where it is none of them. */
export function presetOf(presets: Record<string, Material>, material: Material): string {
    const same = Object.entries(presets).find(([, preset]) =>
        Object.entries(preset).every(([key, value]) => material[key] === value),
    );
    return same?.[0] ?? 'custom';
}

const dominant = (v: Vec3): number => v.findIndex((x) => Math.abs(x) === Math.max(...v.map(Math.abs)));

export function gravitySize(value: Json | undefined): number | null {
    if (!isVec3(value)) return null;
    return Number(Math.hypot(...value).toPrecision(6)) * (value[dominant(value)]! > 0 && value[1] > 0 ? -1 : 1);
}

const levelChoices: ChoiceOptions[] = [
    {
        label: 'Prolongation', pointer: '/hierarchy/operator',
        values: [
            { value: 'shell', words: 'shell' },
            { value: 'intrinsic', words: 'intrinsic' },
            { value: 'blend', words: 'blend' },
            { value: 'affine', words: 'affine', whyNot: ({ hierarchy }) => (hierarchy.source === 'loop' ? 'Not for levels by subdivision' : null) },
            { value: 'loop', words: 'loop', whyNot: ({ hierarchy }) => (hierarchy.source === 'loop' ? null : 'Only for levels by subdivision') },
        ],
    },
    {
        label: 'Bending on', pointer: '/hierarchy/bending_on',
        values: [{ value: 'level', words: 'level' }, { value: 'finest', words: 'finest' }],
    },
];

export class SteeringPanel {
    readonly root = element('aside', { class: 'steering', 'aria-label': 'Parameters' });
    private shape = '';
    private updaters: Updater[] = [];
    private readonly things: ThingsPanel;

    constructor(
        store: Store,
        private readonly actions: Actions,
    ) {
        this.things = new ThingsPanel(store, actions);
        store.watch((state) => [state.session, state.unusable], (state) => {
            if (state.unusable) this.root.replaceChildren(findingsPanel(state.unusable, store));
            else if (state.session?.scene) this.update(state.session, state.session.scene);
            if (state.unusable) this.shape = '';
        });
    }

    private update(session: SessionMessage, scene: Scene): void {
        const names = [scene.bodies, scene.obstacles, scene.handles].map((list) => list.map((part) => part.name));
        const loads = scene.loads.map(({ body, select, force }) => [body, select, force !== undefined]);
        const shape = JSON.stringify([names, loads, scene.name, Object.keys(session.presets)]);
        if (shape !== this.shape) {
            this.shape = shape;
            this.build(session, scene);
        }
        for (const update of this.updaters) update(session);
    }

    private build(session: SessionMessage, scene: Scene): void {
        this.updaters = [];
        const sections = scene.bodies.map((body, i) =>
            this.section(scene.bodies.length > 1 ? body.name : 'Material', i === 0, i + 1, this.body(session, i)),
        );
        sections.push(
            this.section('Surroundings', true, 0, this.fields([
                {
                    label: 'Gravity', pointer: '/gravity', unit: 'm/s²', scale: { kind: 'linear', low: 0, high: 20 },
                    read: gravitySize, write: (size, old) => ofLength(old, size), otherwise: 'scripted',
                },
                {
                    label: 'Friction', pointer: '/contact/friction', min: 0,
                    scale: { kind: 'linear', low: 0, high: 1.5 },
                },
                {
                    label: 'Contact distance', pointer: '/contact/distance', unit: 'm', min: 1e-9,
                    scale: { kind: 'log', low: 1e-5, high: 1e-2 },
                },
            ])),
            this.things.root,
            ...this.loads(scene),
            this.section('Time', false, 0, this.fields([
                {
                    label: 'Time step', pointer: '/solve/time_step', unit: 's', min: 1e-9,
                    scale: { kind: 'log', low: 1e-3, high: 1 },
                },
                { label: 'Duration', pointer: '/solve/duration', unit: 's', min: 0 },
            ])),
            this.section('Levels of detail', false, 0, [...this.fields([
                {
                    label: 'Levels', pointer: '/hierarchy/levels', min: 1, max: 12, isWhole: true,
                    scale: { kind: 'linear', low: 1, high: 8 },
                },
                {
                    label: 'Coarsest vertices', pointer: '/hierarchy/coarsest_vertices', min: 4, isWhole: true,
                    scale: { kind: 'log', low: 50, high: 5000 },
                },
            ]), ...levelChoices.map((options) => this.choice(options))]),
        );
        this.root.replaceChildren(...sections);
    }

    private section(title: string, open: boolean, color: number, content: HTMLElement[]): HTMLElement {
        const swatch = color > 0 ? element('span', { class: 'swatch', style: `--swatch: var(--body-${((color - 1) % 6) + 1})` }) : null;
        return element('details', { class: 'section', open }, element('summary', {}, swatch, title), ...content);
    }

    private fields(list: FieldOptions[]): HTMLElement[] {
        return list.map((options) => {
            const field = new NumberField(options, this.actions);
            this.updaters.push((session) => field.update(session));
            return field.root;
        });
    }

    private choice(options: ChoiceOptions): HTMLElement {
        const field = new ChoiceField(options, this.actions);
        this.updaters.push((session) => field.update(session));
        return field.root;
    }

    private loads(scene: Scene): HTMLElement[] {
        if (scene.loads.length === 0) return [];
        const { content, update } = loadFields(scene.loads, this.actions);
        this.updaters.push(update);
        return [this.section('Loads', true, 0, content)];
    }

    private body(session: SessionMessage, index: number): HTMLElement[] {
        const at = `/bodies/${index}`;
        const material = `${at}/material`;
        return [
            this.presets(session, index),
            ...this.fields([
                {
                    label: 'Stiffness', pointer: `${material}/youngs_modulus`, unit: 'Pa', min: 1,
                    scale: { kind: 'log', low: 1e3, high: 1e12 },
                },
                {
                    label: 'Thickness', pointer: `${material}/thickness`, unit: 'm', min: 1e-9,
                    scale: { kind: 'log', low: 1e-5, high: 1e-2 },
                },
                {
                    label: 'Density', pointer: `${material}/density`, unit: 'kg/m³', min: 0,
                    scale: { kind: 'log', low: 10, high: 20000 },
                },
                {
                    label: 'Poisson’s ratio', pointer: `${material}/poisson_ratio`, min: 0, max: 0.499,
                    scale: { kind: 'linear', low: 0, high: 0.49 },
                },
                {
                    label: 'Bending', pointer: `${material}/bending_scale`, unit: '×', min: 0,
                    scale: { kind: 'log', low: 0.01, high: 100 },
                },
                {
                    label: 'Strain limit', pointer: `${material}/strain_limit`, unit: '×', min: 1.0001, max: 100,
                    empty: { value: null, words: 'none' },
                },
                {
                    label: 'Pressure', pointer: `${at}/pressure`, unit: 'Pa',
                    scale: { kind: 'signed', high: 1e5, unit: 10 },
                    otherwise: 'scripted; a number here replaces the script',
                },
            ]),
        ];
    }

    private presets(session: SessionMessage, index: number): HTMLElement {
        const pointer = `/bodies/${index}/material`;
        const id = `preset-${index}`;
        const choice = select({
            id, 'data-pointer': pointer,
            onchange: () => this.actions.set([{ set: pointer, value: choice.value }], newGesture()),
        });
        const custom = element('option', { value: 'custom', disabled: true }, 'custom');
        choice.append(custom, ...Object.keys(session.presets).map((name) => element('option', { value: name }, name)));
        this.updaters.push(({ scene, presets }) => {
            const material = scene?.bodies[index]?.material;
            if (material && document.activeElement !== choice) choice.value = presetOf(presets, material);
            else if (material) queueMicrotask(() => (choice.value = presetOf(presets, material)));
        });
        return element('div', { class: 'field choice' }, element('label', { for: id }, 'Material'), choice);
    }
}
