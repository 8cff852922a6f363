// Scripted motions as scene files have them: turn about `about` by angles about the fixed axes x, y and z in turn, then
// translate. What a gizmo does to a moved thing is composed into one more key.

import type { MotionKey, Vec3 } from './protocol';

/** Row by row. */
export type Rotation = [Vec3, Vec3, Vec3];

/** x goes to R (x - about) + about + translate, R made of rotate_deg. */
export interface Pose {
    translate: Vec3;
    rotate_deg: Vec3;
    about: Vec3;
}

const zero: Vec3 = [0, 0, 0];

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const rotate = (r: Rotation, v: Vec3): Vec3 => [dot(r[0], v), dot(r[1], v), dot(r[2], v)];

function product(a: Rotation, b: Rotation): Rotation {
    const columns: Rotation = [
        [b[0][0], b[1][0], b[2][0]],
        [b[0][1], b[1][1], b[2][1]],
        [b[0][2], b[1][2], b[2][2]],
    ];
    const row = (r: Vec3): Vec3 => [dot(r, columns[0]), dot(r, columns[1]), dot(r, columns[2])];
    return [row(a[0]), row(a[1]), row(a[2])];
}

/** Rz Ry Rx. */
export function rotationFromDegrees(degrees: Vec3): Rotation {
    const [a, b, c] = degrees.map((angle) => (angle * Math.PI) / 180) as Vec3;
    const [ca, sa, cb, sb, cc, sc] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b), Math.cos(c), Math.sin(c)];
    return [
        [cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa],
        [sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa],
        [-sb, cb * sa, cb * ca],
    ];
}

/** The angles about x, y and z that make up a rotation; of all that do, those nearest to the given ones. */
export function degreesFromRotation(r: Rotation, near: Vec3): Vec3 {
    const toDegrees = 180 / Math.PI;
    const b = Math.asin(Math.max(-1, Math.min(1, -r[2][0])));
    let first: Vec3;
    if (Math.abs(r[2][0]) < 1 - 1e-12) {
        first = [Math.atan2(r[2][1], r[2][2]), b, Math.atan2(r[1][0], r[0][0])];
    } else {
        // Only a difference or a sum of the other two is determined: keep the one about z.
        const c = near[2] / toDegrees;
        const a = b > 0 ? Math.atan2(r[0][1], r[1][1]) + c : Math.atan2(-r[0][1], r[1][1]) - c;
        first = [a, b, c];
    }
    const second: Vec3 = [first[0] + Math.PI, Math.PI - first[1], first[2] + Math.PI];
    const candidates = [first, second].map((angles) => {
        const unwound = angles.map((angle, k) => {
            const degrees = angle * toDegrees;
            return degrees + 360 * Math.round((near[k]! - degrees) / 360);
        }) as Vec3;
        return { unwound, distance: Math.hypot(...subtract(unwound, near)) };
    });
    candidates.sort((p, q) => p.distance - q.distance);
    return candidates[0]!.unwound.map((angle) => Math.round(angle * 1e9) / 1e9) as Vec3;
}

interface Track {
    t: number;
    value: Vec3;
}

function fieldTrack(keys: readonly MotionKey[], field: 'translate' | 'rotate_deg' | 'about', atFirst: Vec3): Track[] {
    let value = atFirst;
    return keys.map((key) => {
        value = key[field] ?? value;
        return { t: key.t, value };
    });
}

function evaluate(track: readonly Track[], t: number): Vec3 {
    const after = track.findIndex((key) => key.t > t);
    if (track.length === 0) return zero;
    if (after === 0) return track[0]!.value;
    if (after < 0) return track[track.length - 1]!.value;
    const [a, b] = [track[after - 1]!, track[after]!];
    const w = (t - a.t) / (b.t - a.t);
    return a.value.map((x, k) => x + w * (b.value[k]! - x)) as Vec3;
}

/** A pivot says where to turn, not a way to go: before it is first given it is what is given first. */
function firstPivot(keys: readonly MotionKey[]): Vec3 {
    return keys.find((key) => key.about)?.about ?? zero;
}

/** Where a motion has taken its thing at time t. */
export function poseAt(keys: readonly MotionKey[], t: number): Pose {
    return {
        translate: evaluate(fieldTrack(keys, 'translate', zero), t),
        rotate_deg: evaluate(fieldTrack(keys, 'rotate_deg', zero), t),
        about: evaluate(fieldTrack(keys, 'about', firstPivot(keys)), t),
    };
}

/** Where a pose takes a point. */
export function applied(pose: Pose, x: Vec3): Vec3 {
    return add(add(rotate(rotationFromDegrees(pose.rotate_deg), subtract(x, pose.about)), pose.about), pose.translate);
}

/** The pose that comes of turning by `turn` about `place` and then shifting by `shift`, after `pose`. */
export function moved(pose: Pose, turn: Rotation, place: Vec3, shift: Vec3): Pose {
    const rotation = product(turn, rotationFromDegrees(pose.rotate_deg));
    const offset = rotate(turn, subtract(add(pose.about, pose.translate), place));
    return {
        translate: subtract(add(add(offset, place), shift), pose.about),
        rotate_deg: degreesFromRotation(rotation, pose.rotate_deg),
        about: pose.about,
    };
}

/** The motion that leads to a pose within a time step: its first key is kept, so that what was at rest stays so. */
export function motionTo(keys: readonly MotionKey[], pose: Pose, timeStep: number): MotionKey[] {
    const first: MotionKey = { ...(keys[0] ?? { t: 0 }) };
    for (const field of ['translate', 'rotate_deg', 'about'] as const) if (first[field] === null) delete first[field];
    const round = (v: Vec3): Vec3 => v.map((x) => Number(x.toPrecision(9))) as Vec3;
    const arrival = first.t < timeStep ? timeStep : first.t + timeStep;
    return [
        first,
        { t: arrival, translate: round(pose.translate), rotate_deg: round(pose.rotate_deg), about: round(pose.about) },
    ];
}
