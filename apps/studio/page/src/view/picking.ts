import type { Vec3 } from '../protocol';

export interface Hit {
    /** Place of the face's first corner in the list of corners. */
    corner: number;
    /** The face's vertex nearest to where it was hit. */
    vertex: number;
    distance: number;
    at: Vec3;
}

/** The first face that a ray meets, from either side (Moeller-Trumbore); `direction` has length 1. */
export function firstHit(positions: Float32Array, corners: Uint32Array, origin: Vec3, direction: Vec3): Hit | null {
    const [ox, oy, oz] = origin;
    const [dx, dy, dz] = direction;
    let best = Infinity;
    let bestCorner = -1;
    for (let f = 0; f < corners.length; f += 3) {
        const a = corners[f]! * 3;
        const b = corners[f + 1]! * 3;
        const c = corners[f + 2]! * 3;
        const ux = positions[b]! - positions[a]!;
        const uy = positions[b + 1]! - positions[a + 1]!;
        const uz = positions[b + 2]! - positions[a + 2]!;
        const vx = positions[c]! - positions[a]!;
        const vy = positions[c + 1]! - positions[a + 1]!;
        const vz = positions[c + 2]! - positions[a + 2]!;
        const px = dy * vz - dz * vy;
        const py = dz * vx - dx * vz;
        const pz = dx * vy - dy * vx;
        const determinant = ux * px + uy * py + uz * pz;
        if (determinant === 0) continue;
        const sx = ox - positions[a]!;
        const sy = oy - positions[a + 1]!;
        const sz = oz - positions[a + 2]!;
        const s = (sx * px + sy * py + sz * pz) / determinant;
        if (s < 0 || s > 1) continue;
        const qx = sy * uz - sz * uy;
        const qy = sz * ux - sx * uz;
        const qz = sx * uy - sy * ux;
        const t = (dx * qx + dy * qy + dz * qz) / determinant;
        if (t < 0 || s + t > 1) continue;
        const distance = (vx * qx + vy * qy + vz * qz) / determinant;
        if (distance > 0 && distance < best) {
            best = distance;
            bestCorner = f;
        }
    }
    if (bestCorner < 0) return null;
    const at: Vec3 = [ox + best * dx, oy + best * dy, oz + best * dz];
    return { corner: bestCorner, vertex: nearestCorner(positions, corners, bestCorner, at), distance: best, at };
}

function nearestCorner(positions: Float32Array, corners: Uint32Array, corner: number, at: Vec3): number {
    let vertex = corners[corner]!;
    let nearest = Infinity;
    for (let k = 0; k < 3; ++k) {
        const v = corners[corner + k]!;
        const d = Math.hypot(
            positions[v * 3]! - at[0], positions[v * 3 + 1]! - at[1], positions[v * 3 + 2]! - at[2],
        );
        if (d < nearest) {
            nearest = d;
            vertex = v;
        }
    }
    return vertex;
}
