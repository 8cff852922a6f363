import { describe, expect, it } from 'vitest';

import { Cloth } from '../dev/fake_surface';
import { colorScalars } from '../src/view/colormap';
import { vertexNormals } from '../src/view/normals';
import { firstHit } from '../src/view/picking';
import { edgesOf, enclosedVolume, hasSharpEdges, isClosed, sortedByPart } from '../src/view/topology';

// A unit tetrahedron at the origin, outward.
const positions = Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1);
const corners = Uint32Array.of(0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3);
const all = { part: 0, start: 0, count: 12 };

describe('a surface', () => {
    it('has normals that point out and have length 1', () => {
        const normals = new Float32Array(12).fill(9);
        vertexNormals(positions, corners, normals);
        expect(normals[0]).toBeCloseTo(-1 / Math.sqrt(3));
        for (let i = 0; i < 12; i += 3) expect(Math.hypot(...normals.subarray(i, i + 3))).toBeCloseTo(1);
    });

    it('has each edge once, a volume where it is closed, and creases', () => {
        expect(edgesOf(corners, 4).length).toBe(12);
        expect(enclosedVolume(corners, positions, all)).toBeCloseTo(1 / 6);
        expect(isClosed(corners, 4, all)).toBe(true);
        expect(isClosed(corners, 4, { ...all, count: 9 })).toBe(false);
        expect(hasSharpEdges(corners, positions)).toBe(true);
        expect(hasSharpEdges(Uint32Array.of(0, 1, 2, 1, 3, 2), Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.1))).toBe(false);
    });

    it('is sorted by part, each part in its own order', () => {
        const sorted = sortedByPart({
            kind: 'mesh', level: 0, version: 0, vertices: 4, t: 0, unusable: false, corners,
            parts: Uint32Array.of(2, 0, 2, 0), marked: new Uint32Array(0),
        });
        expect(sorted.groups).toEqual([{ part: 0, start: 0, count: 6 }, { part: 2, start: 6, count: 6 }]);
        expect([...sorted.corners]).toEqual([0, 1, 3, 1, 2, 3, 0, 2, 1, 0, 3, 2]);
    });

    it('is hit by a ray where it first meets it', () => {
        const hit = firstHit(positions, corners, [0.1, 0.2, 5], [0, 0, -1]);
        expect(hit?.at[2]).toBeCloseTo(0.7);
        expect(hit?.vertex).toBe(3);
        expect(firstHit(positions, corners, [0.1, 0.2, -5], [0, 0, 1])?.at[2]).toBeCloseTo(0);
        expect(firstHit(positions, corners, [0.1, 0.2, 5], [0, 0, 1])).toBeNull();
        expect(firstHit(positions, corners, [2, 2, 5], [0, 0, -1])).toBeNull();
    });

    it('is coloured from dark to bright, and grey where there is no value', () => {
        const colors = new Float32Array(12);
        colorScalars(Float32Array.of(-5, 0.5, 9, NaN), 0, 1, colors);
        const brightness = [0, 1, 2].map((i) => colors[i * 3]! * 0.21 + colors[i * 3 + 1]! * 0.72 + colors[i * 3 + 2]! * 0.07);
        expect(brightness[0]!).toBeLessThan(brightness[1]!);
        expect(brightness[1]!).toBeLessThan(brightness[2]!);
        expect(colors[9]).toBe(colors[10]);
        colorScalars(Float32Array.of(1, 1, 1, 1), 1, 1, colors);
        expect(colors.every(Number.isFinite)).toBe(true);
    });
});

it('normals and colours of 20,000 vertices take far less than a sixtieth of a second', () => {
    const cloth = new Cloth(141);
    const count = cloth.grid.vertices;
    const laid = new Float32Array(count * 3);
    const scalars = new Float32Array(count);
    cloth.lay(
        { t: 1, pressure: 0, gravity: 9.81, stiffness: 1e6, ball: [0, 0, 0], lift: [0, 0, 0], pulls: [], detail: 3 },
        laid, scalars,
    );
    const [target, normals, colors] = [0, 1, 2].map(() => new Float32Array(count * 3)) as [Float32Array, Float32Array, Float32Array];
    const once = (): number => {
        const start = performance.now();
        target.set(laid);
        vertexNormals(target, cloth.grid.corners, normals);
        colorScalars(scalars, 1, 1.1, colors);
        return performance.now() - start;
    };
    const times = Array.from({ length: 60 }, once).sort((a, b) => a - b);
    console.log(`${count} vertices: ${times[30]!.toFixed(2)} ms an update`);
    expect(times[30]!).toBeLessThan(1000 / 60);
});
