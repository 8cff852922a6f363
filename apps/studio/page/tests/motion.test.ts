import { describe, expect, it } from 'vitest';

import { add, applied, degreesFromRotation, motionTo, moved, poseAt, rotate, rotationFromDegrees, subtract } from '../src/motion';
import type { MotionKey, Vec3 } from '../src/protocol';
import { currentPose } from '../src/view/gizmo';

function expectNear(actual: Vec3, expected: Vec3): void {
    actual.forEach((value, k) => expect(value).toBeCloseTo(expected[k]!, 8));
}

describe('rotations', () => {
    it('turn about the fixed axes x, y and z in turn', () => {
        expectNear(rotate(rotationFromDegrees([90, 0, 0]), [0, 1, 0]), [0, 0, 1]);
        // About x first: z goes to -y, which then turns about z to x.
        expectNear(rotate(rotationFromDegrees([90, 0, 90]), [0, 0, 1]), [1, 0, 0]);
    });

    it.each<[Vec3]>([[[10, 20, 30]], [[0, 90, 40]], [[25, -90, 10]], [[720, 5, 0]], [[170, 100, -200]]])(
        'come back from their matrix as the nearest angles: %j',
        (degrees) => expectNear(degreesFromRotation(rotationFromDegrees(degrees), degrees), degrees),
    );
});

describe('a motion', () => {
    const keys: MotionKey[] = [
        { t: 0 }, { t: 2, translate: [2, 0, 0], about: [0, 1, 0] }, { t: 4, rotate_deg: [0, 0, 90] },
    ];

    it('is interpolated, keeps what a key leaves out, and holds beyond its ends', () => {
        expect(poseAt(keys, 1)).toEqual({ translate: [1, 0, 0], rotate_deg: [0, 0, 0], about: [0, 1, 0] });
        expect(poseAt(keys, 3)).toEqual({ translate: [2, 0, 0], rotate_deg: [0, 0, 45], about: [0, 1, 0] });
        expect(poseAt(keys, -1).translate).toEqual([0, 0, 0]);
        expect(poseAt(keys, 9).rotate_deg).toEqual([0, 0, 90]);
        expect(poseAt([], 1)).toEqual({ translate: [0, 0, 0], rotate_deg: [0, 0, 0], about: [0, 0, 0] });
    });

    it('goes on from where it is when a gizmo turns and shifts it', () => {
        const pose = poseAt(keys, 4);
        const turn = rotationFromDegrees([15, -40, 70]);
        const place: Vec3 = [0.3, 0.1, -2];
        const shift: Vec3 = [0, 0.5, 1];
        const next = moved(pose, turn, place, shift);
        for (const x of [[0, 0, 0], [1, 2, 3], [-1, 0.5, 0]] as Vec3[]) {
            const expected = add(add(rotate(turn, subtract(applied(pose, x), place)), place), shift);
            expectNear(applied(next, x), expected);
        }
        expect(next.about).toEqual(pose.about);
    });

    it('keeps its first key at its own time and arrives a time step later', () => {
        const pose = poseAt(keys, 4);
        const motion = motionTo([{ t: 0, translate: null, rotate_deg: [0, 5, 0], about: null }], pose, 0.1);
        expect(motion).toEqual([{ t: 0, rotate_deg: [0, 5, 0] }, { t: 0.1, ...pose }]);
        expect(motionTo([], pose, 0.1)[0]).toEqual({ t: 0 });
        expect(motionTo([{ t: 3 }], pose, 0.5)[1]!.t).toBe(3.5);
    });

    it('without a pivot turns about the middle of what it moves', () => {
        const rest: Vec3 = [1, 2, 3];
        const turned: MotionKey[] = [{ t: 0, translate: [0.5, 0, 0], rotate_deg: [0, 30, 0] }];
        const place = applied(poseAt(turned, 0), rest);
        const pose = currentPose({ pointer: '', keys: turned, place, axes: 'xyz', t: 0, timeStep: 0.1 });
        expectNear(pose.about, rest);
        expectNear(applied(pose, [4, -1, 0]), applied(poseAt(turned, 0), [4, -1, 0]));
    });

    it('keeps the pivot that it names', () => {
        const pose = currentPose({ pointer: '', keys, place: [5, 5, 5], axes: 'xyz', t: 4, timeStep: 0.1 });
        expect(pose).toEqual(poseAt(keys, 4));
    });
});
