// Over the view: tools at the left, what is shown at the right, a legend below.

import type { Actions } from '../actions';
import { whyNot } from '../colorings';
import type { IconName } from '../dom';
import { button, element, select, setPressed } from '../dom';
import type { ColorBy } from '../protocol';
import { colorings } from '../protocol';
import { words } from '../scale';
import type { Store, Tool } from '../store';
import { cssGradient } from '../view/colormap';

const tools: { tool: Tool; icon: IconName; label: string; key: string }[] = [
    { tool: 'look', icon: 'look', label: 'Look around', key: '1' },
    { tool: 'grab', icon: 'grab', label: 'Grab a body (or hold Ctrl); let go with Shift to pin', key: '2' },
    { tool: 'move', icon: 'move', label: 'Move a handle or an obstacle', key: '3' },
    { tool: 'turn', icon: 'turn', label: 'Turn a handle or an obstacle', key: '4' },
];

const colorNames: Record<ColorBy, string> = {
    none: 'Plain', stretch: 'Stretch', curvature: 'Curvature', gap: 'Gap', level: 'Level',
};
const colorUnits: Record<ColorBy, string> = { none: '', stretch: '×', curvature: '1/m', gap: 'm', level: '' };

export function toolBar(store: Store, actions: Actions): HTMLElement {
    const made = tools.map(({ tool, icon, label, key }) => ({
        tool, root: button({ icon, label, key, kind: 'tool', press: () => actions.useTool(tool) }),
    }));
    store.watch((state) => [state.tool], (state) => made.forEach(({ tool, root }) => setPressed(root, tool === state.tool)));
    return element('div', { class: 'tools', role: 'toolbar', 'aria-label': 'Tools', 'aria-orientation': 'vertical' }, ...made.map(({ root }) => root));
}

export function lookBar(store: Store, actions: Actions, resetCamera: () => void): HTMLElement {
    const edges = button({
        icon: 'edges', text: 'Edges', label: 'Edges', key: 'E', kind: 'chip',
        press: () => actions.look({ edges: !store.state.edges }),
    });
    const detail = button({
        icon: 'detail', text: 'Finest detail', label: 'Show this state on the finest mesh, by prolongation alone', key: 'D', kind: 'chip',
        press: () => actions.look({ detail: !store.state.detail }),
    });
    const options = colorings.map((value) => element('option', { value }, colorNames[value]));
    const color = select({
        id: 'color', 'aria-label': 'Colour by', onchange: () => actions.look({ color: color.value as ColorBy }),
    }, ...options);
    store.watch((state) => [state.detail, state.status?.level, state.status?.levels], (state) => {
        const reasons = colorings.map((value) => whyNot(value, state));
        options.forEach((option, i) => {
            option.disabled = reasons[i] !== null;
            option.title = reasons[i] ?? '';
        });
        color.title = ['Colour by (C)', ...reasons.filter((reason) => reason !== null)].join('. ');
    });
    store.watch((state) => [state.edges, state.detail, state.color], (state) => {
        setPressed(edges, state.edges);
        setPressed(detail, state.detail);
        color.value = state.color;
    });
    return element('div', { class: 'look', role: 'toolbar', 'aria-label': 'What is shown' },
        element('label', { class: 'chip-select' }, element('span', {}, 'Colour'), color), edges, detail,
        button({ icon: 'frame', label: 'Whole scene in view', key: 'F', kind: 'chip', press: resetCamera }));
}

/** Why nothing is coloured; empty where something is. */
export function lackOf(scalars: Float32Array | null, color: ColorBy): string {
    if (!scalars) return 'A saved frame is kept without its colours';
    if (scalars.some((value) => Number.isFinite(value))) return '';
    return color === 'gap' ? 'Nothing is near enough to touch' : 'There is nothing to colour';
}

/** The colours' meaning. */
export class Legend {
    readonly root = element('div', { class: 'legend', role: 'img', hidden: true });
    private readonly title = element('span', { class: 'legend-title' });
    private readonly low = element('span');
    private readonly high = element('span');
    private readonly bar = element('span', { class: 'legend-bar', style: `background: ${cssGradient('to right')}` });
    private last = '';

    constructor(private readonly store: Store) {
        this.root.append(this.title, this.bar, element('span', { class: 'legend-ends' }, this.low, this.high));
        store.watch((state) => [state.color], (state) => {
            if (state.color === 'none') this.root.hidden = true;
        });
    }

    show(scalars: Float32Array | null, low: number, high: number): void {
        const { color } = this.store.state;
        this.root.hidden = color === 'none';
        const [from, to] = [low, high].map((end) => `${words(end)} ${colorUnits[color]}`);
        const lack = lackOf(scalars, color);
        const meaning = lack || `${colorNames[color]} from ${from} to ${to}`;
        if (this.root.hidden || meaning === this.last) return;
        this.last = meaning;
        this.bar.hidden = lack !== '';
        this.title.textContent = lack || colorNames[color];
        this.low.textContent = lack ? '' : from!;
        this.high.textContent = lack ? '' : to!;
        this.root.setAttribute('aria-label', meaning);
    }
}
