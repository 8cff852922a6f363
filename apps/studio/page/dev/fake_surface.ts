// Surfaces that move by formulas, in place of a solver: a cloth over a ball, and a balloon.

import type { Vec3 } from '../src/protocol';

export interface Grid {
    vertices: number;
    corners: Uint32Array;
    parts: Uint32Array;
    /** Vertices before this one are the body's. */
    bodyVertices: number;
}

export interface Shape {
    t: number;
    pressure: number;
    gravity: number;
    stiffness: number;
    ball: Vec3;
    lift: Vec3;
    pulls: { vertex: number; to: Vec3; level: number }[];
    detail: number;
}

function lattice(n: number, m: number, wraps: boolean, base: number): number[] {
    const corners: number[] = [];
    for (let i = 0; i + 1 < n; ++i)
        for (let j = 0; j + 1 < (wraps ? m + 1 : m); ++j) {
            const [a, b] = [base + i * m + (j % m), base + i * m + ((j + 1) % m)];
            const [c, d] = [a + m, b + m];
            corners.push(...((i + j) % 2 === 0 ? [a, d, c, a, b, d] : [a, b, c, b, d, c]));
        }
    return corners;
}

/** A sphere's corners: rings between two poles. */
function globe(rings: number, around: number, base: number): { corners: number[]; vertices: number } {
    const corners = lattice(rings, around, true, base).slice();
    const [south, north] = [base + rings * around, base + rings * around + 1];
    for (let j = 0; j < around; ++j) {
        const k = (j + 1) % around;
        corners.push(south, base + k, base + j);
        corners.push(north, base + (rings - 1) * around + j, base + (rings - 1) * around + k);
    }
    return { corners, vertices: rings * around + 2 };
}

function globePoint(index: number, rings: number, around: number): Vec3 {
    if (index >= rings * around) return [0, index === rings * around ? -1 : 1, 0];
    const theta = Math.PI * ((Math.floor(index / around) + 1) / (rings + 1) - 0.5);
    const phi = (2 * Math.PI * (index % around)) / around;
    return [Math.cos(theta) * Math.cos(phi), Math.sin(theta), Math.cos(theta) * Math.sin(phi)];
}

const ballRings = 22;
const ballAround = 40;

export class Cloth {
    readonly grid: Grid;

    constructor(private readonly n: number) {
        const sheet = lattice(n, n, false, 0);
        const ball = globe(ballRings, ballAround, n * n);
        this.grid = {
            vertices: n * n + ball.vertices,
            corners: Uint32Array.from([...sheet, ...ball.corners]),
            parts: Uint32Array.from([...new Array(sheet.length / 3).fill(0), ...new Array(ball.corners.length / 3).fill(1)]),
            bodyVertices: n * n,
        };
    }

    lay(shape: Shape, positions: Float32Array, scalars: Float32Array): void {
        const { n } = this;
        const fall = (1 - Math.exp(-3 * shape.t)) * Math.min(1.4, shape.gravity / 9.81);
        const soft = 1 / (1 + shape.stiffness / 4e6);
        const radius = 0.262;
        const around = 1.2;
        for (let i = 0; i < n; ++i)
            for (let j = 0; j < n; ++j) {
                const [x, z] = [0.8 * (i / (n - 1) - 0.5), 0.8 * (j / (n - 1) - 0.5)];
                const r = Math.hypot(x, z);
                const angle = Math.atan2(z, x);
                const past = Math.max(0, r - radius * around);
                const bent = Math.min(r / radius, around);
                const fold = soft * past * (1 + Math.sin(8 * angle + 0.4 * Math.sin(4 * shape.t))) * 0.45;
                const fine = shape.detail * 0.02 * past * (1 + Math.sin(23 * angle));
                const out = radius * Math.sin(bent) + past * 0.15 + fold + fine;
                const scale = r > 0 ? (fall * out + (1 - fall) * r) / r : 1;
                const low = radius * Math.cos(bent) - past * 0.95;
                const y = fall * low + (1 - fall) * radius + 0.006 * (1 + Math.sin(6 * shape.t + 9 * x)) * (1.2 - fall);
                const at = (i * n + j) * 3;
                positions[at] = x * scale + (shape.ball[0] + shape.lift[0]) * fall;
                positions[at + 1] = y + shape.ball[1] + shape.lift[1] + shape.pressure * 2e-4;
                positions[at + 2] = z * scale + (shape.ball[2] + shape.lift[2]) * fall;
                scalars[i * n + j] = 1 + 0.04 * past + fold * 0.4 + 0.01 * Math.cos(20 * r);
            }
        pullTowards(positions, n * n, shape.pulls, 0.12);
        for (let k = n * n; k < this.grid.vertices; ++k) {
            const p = globePoint(k - n * n, ballRings, ballAround);
            positions.set(p.map((c, axis) => c * 0.25 + shape.ball[axis]!), k * 3);
            scalars[k] = NaN;
        }
    }
}

export class Balloon {
    readonly grid: Grid;
    private readonly rings: number;

    constructor(private readonly around: number) {
        this.rings = Math.round(around / 2);
        const { corners, vertices } = globe(this.rings, around, 0);
        this.grid = {
            vertices, corners: Uint32Array.from(corners), parts: new Uint32Array(corners.length / 3), bodyVertices: vertices,
        };
    }

    lay(shape: Shape, positions: Float32Array, scalars: Float32Array): void {
        const size = 0.2 * (1 + 0.25 * Math.tanh(shape.pressure / 800));
        for (let k = 0; k < this.grid.vertices; ++k) {
            const [x, y, z] = globePoint(k, this.rings, this.around);
            const wobble = 1 + 0.02 * Math.sin(5 * shape.t + 4 * y) + 0.03 * Math.cos(6 * Math.atan2(z, x)) * (1 - y * y);
            positions.set([x * size * wobble, y * size * 1.15 * wobble, z * size * wobble], k * 3);
            scalars[k] = wobble * (1 + 0.3 * y);
        }
        pullTowards(positions, this.grid.vertices, shape.pulls, 0.08);
    }
}

function pullTowards(positions: Float32Array, bodyVertices: number, pulls: Shape['pulls'], reach: number): void {
    for (const { vertex, to } of pulls) {
        if (vertex >= bodyVertices) continue;
        const from = [0, 1, 2].map((k) => positions[vertex * 3 + k]!);
        const by = to.map((x, k) => x - from[k]!);
        for (let i = 0; i < bodyVertices; ++i) {
            const d = Math.hypot(...[0, 1, 2].map((k) => positions[i * 3 + k]! - from[k]!));
            const w = Math.exp(-((d / reach) ** 2));
            if (w > 1e-3) for (let k = 0; k < 3; ++k) positions[i * 3 + k]! += w * by[k]!;
        }
    }
}
