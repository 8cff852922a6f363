// Where vertices are pulled: a line from each to where it is wanted.

import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Points, PointsMaterial } from 'three';

import type { Pull } from '../protocol';
import type { Palette } from './palette';

const most = 64;

export class Pulls {
    readonly group = new Group();
    private readonly ends = new Float32Array(most * 6);
    private readonly geometry = new BufferGeometry();
    private readonly lines = new LineBasicMaterial({ depthTest: false });
    private readonly points = new PointsMaterial({ size: 9, sizeAttenuation: false, depthTest: false });

    constructor() {
        this.geometry.setAttribute('position', new BufferAttribute(this.ends, 3));
        for (const object of [new LineSegments(this.geometry, this.lines), new Points(this.geometry, this.points)]) {
            object.frustumCulled = false;
            object.renderOrder = 2;
            this.group.add(object);
        }
        this.show([]);
    }

    show(pulls: readonly Pull[]): void {
        const shown = pulls.slice(0, most);
        shown.forEach((pull, i) => {
            this.ends.set(pull.at, i * 6);
            this.ends.set(pull.to, i * 6 + 3);
        });
        this.geometry.setDrawRange(0, shown.length * 2);
        this.geometry.getAttribute('position').needsUpdate = true;
    }

    applyPalette(palette: Palette): void {
        this.lines.color.copy(palette.accent);
        this.points.color.copy(palette.accent);
    }
}
