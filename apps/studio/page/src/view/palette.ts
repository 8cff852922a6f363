// Colours of the drawn scene, read from the style sheet so that light and dark have one source.

import { Color } from 'three';

const bodyCount = 6;

export interface Palette {
    background: Color;
    ground: Color;
    bodies: Color[];
    obstacle: Color;
    marked: Color;
    edge: Color;
    accent: Color;
}

export function readPalette(): Palette {
    const style = getComputedStyle(document.documentElement);
    const color = (name: string): Color => new Color(style.getPropertyValue(name).trim() || '#888');
    return {
        background: color('--view-background'),
        ground: color('--view-ground'),
        bodies: Array.from({ length: bodyCount }, (_, i) => color(`--body-${i + 1}`)),
        obstacle: color('--obstacle'),
        marked: color('--marked'),
        edge: color('--edge'),
        accent: color('--accent'),
    };
}
