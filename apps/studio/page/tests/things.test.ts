import { describe, expect, it } from 'vitest';

import { sceneOf } from '../dev/fake_scenes';
import { gizmoTarget } from '../src/panels/things';
import type { MotionKey, PartsMessage, SessionMessage, StatusMessage } from '../src/protocol';
import type { State } from '../src/store';
import { initialState } from '../src/store';

const parts: PartsMessage = {
    type: 'parts', parts: [], pulls: [],
    handles: [{ name: 'crown', place: [9, 9, 9], rest: [0, 1, 0] }], obstacles: [{ name: 'ball', place: [3, 0, 0] }],
};

function stateWith(motion: MotionKey[], t = 0): State {
    const scene = sceneOf('drape');
    scene.handles[0]!.motion = motion;
    return {
        ...initialState, parts, selected: '/handles/0', session: { scene } as SessionMessage, status: { t } as StatusMessage,
    };
}

describe('the gizmo', () => {
    const motion: MotionKey[] = [{ t: 0 }, { t: 0.05, translate: [1, 0, 0] }, { t: 1, translate: [1, 2, 0] }];

    it('sits where its thing is wanted after the next step', () => {
        expect(gizmoTarget(stateWith(motion))).toMatchObject({ pointer: '/handles/0/motion', place: [1, 1, 0], axes: 'xz', t: 0.05 });
        expect(gizmoTarget(stateWith(motion, 2))!.place).toEqual([1, 3, 0]);
    });

    it('sits where its thing is, when that has no place of rest', () => {
        expect(gizmoTarget({ ...stateWith(motion), selected: '/obstacles/0' })).toMatchObject({ place: [3, 0, 0], axes: 'xyz' });
    });

    it('sits on nothing that has not been chosen, or that moves by files', () => {
        const state = stateWith(motion);
        expect(gizmoTarget({ ...state, selected: null })).toBeNull();
        expect(gizmoTarget({ ...state, selected: '/bodies/0' })).toBeNull();
        expect(gizmoTarget({ ...state, selected: '/handles/7' })).toBeNull();
        state.session!.scene!.obstacles[0]!.motion = { frames: '*.obj', dt: 0.04 };
        expect(gizmoTarget({ ...state, selected: '/obstacles/0' })).toBeNull();
    });
});
