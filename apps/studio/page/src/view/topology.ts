// What a mesh's corners say once and for all: its faces sorted by part, its edges, where it has creases.

import type { MeshMessage } from '../binary';

export interface FaceGroup {
    part: number;
    /** The first corner, and how many. */
    start: number;
    count: number;
}

/** The corners with the faces of each part together, in their order; and where each part's begin. */
export function sortedByPart(mesh: MeshMessage): { corners: Uint32Array; groups: FaceGroup[] } {
    const counts = new Map<number, number>();
    for (const part of mesh.parts) counts.set(part, (counts.get(part) ?? 0) + 1);
    const groups: FaceGroup[] = [];
    let start = 0;
    for (const part of [...counts.keys()].sort((a, b) => a - b)) {
        groups.push({ part, start, count: counts.get(part)! * 3 });
        start += counts.get(part)! * 3;
    }
    const next = new Map(groups.map((group) => [group.part, group.start]));
    const corners = new Uint32Array(mesh.corners.length);
    for (let f = 0; f < mesh.parts.length; ++f) {
        const at = next.get(mesh.parts[f]!)!;
        corners.set(mesh.corners.subarray(f * 3, f * 3 + 3), at);
        next.set(mesh.parts[f]!, at + 3);
    }
    return { corners, groups };
}

/** Two vertex numbers for each edge, each edge once. */
export function edgesOf(corners: Uint32Array, vertices: number): Uint32Array {
    const keys = new Float64Array(corners.length);
    for (let f = 0; f < corners.length; f += 3)
        for (let k = 0; k < 3; ++k) {
            const a = corners[f + k]!;
            const b = corners[f + ((k + 1) % 3)]!;
            keys[f + k] = Math.min(a, b) * vertices + Math.max(a, b);
        }
    keys.sort();
    const edges = new Uint32Array(keys.length * 2);
    let count = 0;
    for (let i = 0; i < keys.length; ++i) {
        if (i > 0 && keys[i] === keys[i - 1]) continue;
        edges[count++] = Math.floor(keys[i]! / vertices);
        edges[count++] = keys[i]! % vertices;
    }
    return edges.slice(0, count);
}

/** Whether some edge of these faces is sharp, as a box's are: smooth shading would blur it. */
export function hasSharpEdges(corners: Uint32Array, positions: Float32Array, cosine = 0.5): boolean {
    const normals = new Map<string, [number, number, number]>();
    for (let f = 0; f < corners.length; f += 3) {
        const [a, b, c] = [corners[f]! * 3, corners[f + 1]! * 3, corners[f + 2]! * 3];
        const u = [0, 1, 2].map((k) => positions[b + k]! - positions[a + k]!);
        const v = [0, 1, 2].map((k) => positions[c + k]! - positions[a + k]!);
        const n = [u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!, u[0]! * v[1]! - u[1]! * v[0]!];
        const length = Math.hypot(...n) || 1;
        const normal: [number, number, number] = [n[0]! / length, n[1]! / length, n[2]! / length];
        for (let k = 0; k < 3; ++k) {
            const [p, q] = [corners[f + k]!, corners[f + ((k + 1) % 3)]!];
            const key = p < q ? `${p},${q}` : `${q},${p}`;
            const other = normals.get(key);
            if (other && other[0] * normal[0] + other[1] * normal[1] + other[2] * normal[2] < cosine) return true;
            normals.set(key, normal);
        }
    }
    return false;
}

/** Volume between a part's faces and the origin, with the faces' signs: what it encloses where it is closed. */
export function enclosedVolume(corners: Uint32Array, positions: Float32Array, group: FaceGroup): number {
    let six = 0;
    for (let f = group.start; f < group.start + group.count; f += 3) {
        const [a, b, c] = [corners[f]! * 3, corners[f + 1]! * 3, corners[f + 2]! * 3];
        six +=
            positions[a]! * (positions[b + 1]! * positions[c + 2]! - positions[b + 2]! * positions[c + 1]!) +
            positions[a + 1]! * (positions[b + 2]! * positions[c]! - positions[b]! * positions[c + 2]!) +
            positions[a + 2]! * (positions[b]! * positions[c + 1]! - positions[b + 1]! * positions[c]!);
    }
    return Math.abs(six) / 6;
}

/** Whether each edge of a part's faces is run through once each way. */
export function isClosed(corners: Uint32Array, vertices: number, group: FaceGroup): boolean {
    const balance = new Map<number, number>();
    for (let f = group.start; f < group.start + group.count; f += 3)
        for (let k = 0; k < 3; ++k) {
            const a = corners[f + k]!;
            const b = corners[f + ((k + 1) % 3)]!;
            const key = Math.min(a, b) * vertices + Math.max(a, b);
            balance.set(key, (balance.get(key) ?? 0) + (a < b ? 1 : -1));
        }
    for (const value of balance.values()) if (value !== 0) return false;
    return true;
}
