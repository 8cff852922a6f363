import { element } from '../dom';
import { Plot } from '../plot';
import type { Sample } from '../protocol';
import { words } from '../scale';
import type { Store } from '../store';
import { onTheme } from '../theme';

const curves: { key: 'energy' | 'residual' | 'gap'; name: string; unit: string; isLog: boolean; color: string }[] = [
    { key: 'energy', name: 'Energy', unit: 'J', isLog: false, color: '--curve-1' },
    { key: 'residual', name: 'Residual', unit: '', isLog: true, color: '--curve-2' },
    { key: 'gap', name: 'Gap', unit: 'm', isLog: true, color: '--curve-3' },
];

/** Energy, residual and smallest gap, step by step. */
export function curvesPanel(store: Store): HTMLElement {
    const made = curves.map((curve) => {
        const plot = new Plot(curve.isLog, curve.color);
        const value = element('span', { class: 'curve-value' });
        const root = element('figure', { class: 'curve', 'data-curve': curve.key },
            element('figcaption', {}, element('span', {}, curve.name), value), plot.canvas);
        onTheme(() => plot.schedule());
        return { curve, plot, value, root };
    });
    store.watch((state) => [state.samples, state.samples.length], ({ samples }) => {
        const levels = samples.map((sample: Sample) => sample.level);
        for (const { curve, plot, value } of made) {
            plot.show({ values: samples.map((sample) => sample[curve.key]), levels });
            value.textContent = `${words(samples[samples.length - 1]?.[curve.key])} ${curve.unit}`;
        }
    });
    return element('div', { class: 'curves', role: 'group', 'aria-label': 'Curves' }, ...made.map(({ root }) => root));
}
