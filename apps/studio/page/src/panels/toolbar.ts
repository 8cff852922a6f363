// Over the view: tools at the left, what is shown at the right, a legend below.

import type { Actions } from '../actions';
import type { IconName } from '../dom';
import { button, element, setPressed } from '../dom';
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
    const color = element('select', {
        id: 'color', 'aria-label': 'Colour by', title: 'Colour by (C)',
        onchange: () => actions.look({ color: color.value as ColorBy }),
    }, ...colorings.map((value) => element('option', { value }, colorNames[value])));
    store.watch((state) => [state.edges, state.detail, state.color], (state) => {
        setPressed(edges, state.edges);
        setPressed(detail, state.detail);
        color.value = state.color;
    });
    return element('div', { class: 'look', role: 'toolbar', 'aria-label': 'What is shown' },
        element('label', { class: 'chip-select' }, element('span', {}, 'Colour'), color), edges, detail,
        button({ icon: 'frame', label: 'Whole scene in view', key: 'F', kind: 'chip', press: resetCamera }));
}

/** The colours' meaning. */
export class Legend {
    readonly root = element('div', { class: 'legend', role: 'img', hidden: true });
    private readonly title = element('span', { class: 'legend-title' });
    private readonly low = element('span');
    private readonly high = element('span');
    private last = '';

    constructor(private readonly store: Store) {
        const bar = element('span', { class: 'legend-bar', style: `background: ${cssGradient('to right')}` });
        this.root.append(this.title, bar, element('span', { class: 'legend-ends' }, this.low, this.high));
        store.watch((state) => [state.color], (state) => {
            if (state.color === 'none') this.root.hidden = true;
        });
    }

    show(hasScalars: boolean, low: number, high: number): void {
        const { color } = this.store.state;
        this.root.hidden = color === 'none' || !hasScalars;
        const text = `${colorNames[color]} ${words(low)} ${words(high)}`;
        if (this.root.hidden || text === this.last) return;
        this.last = text;
        this.title.textContent = colorNames[color];
        this.low.textContent = `${words(low)} ${colorUnits[color]}`;
        this.high.textContent = `${words(high)} ${colorUnits[color]}`;
        this.root.setAttribute('aria-label', `${colorNames[color]} from ${words(low)} to ${words(high)} ${colorUnits[color]}`);
    }
}
