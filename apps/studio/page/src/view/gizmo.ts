// Arrows and rings on a handle or an obstacle. What is dragged becomes a motion's key.

import { Object3D, Quaternion, Vector3 } from 'three';
import { TransformControls } from 'three/addons/controls/TransformControls.js';

import type { MotionKey, Vec3 } from '../protocol';
import type { Pose, Rotation } from '../motion';
import { motionTo, moved, poseAt, rotationFromDegrees, rotate, subtract, add } from '../motion';
import type { Stage } from './stage';

export interface GizmoTarget {
    /** Where it goes in the scene, such as /handles/0/motion. */
    pointer: string;
    keys: MotionKey[];
    /** Where its middle is wanted at time t. */
    place: Vec3;
    /** The axes that it can be shifted along. */
    axes: string;
    t: number;
    timeStep: number;
}

export type MoveListener = (pointer: string, keys: MotionKey[], isDone: boolean) => void;

export class Gizmo {
    private readonly anchor = new Object3D();
    private readonly controls: TransformControls;
    private target: GizmoTarget | null = null;
    private start: { target: GizmoTarget; pose: Pose; position: Vector3; turn: Quaternion } | null = null;

    constructor(
        stage: Stage,
        private readonly onMove: MoveListener,
    ) {
        this.controls = new TransformControls(stage.camera, stage.renderer.domElement);
        this.controls.size = 0.85;
        this.controls.setColors(0xd9534f, 0x4f9d69, 0x2138c9, 0xf2b705);
        stage.scene.add(this.anchor, this.controls.getHelper());
        this.controls.addEventListener('change', () => stage.invalidate());
        this.controls.addEventListener('objectChange', () => this.report(false));
        this.controls.addEventListener('dragging-changed', (event) => {
            stage.controls.enabled = event.value !== true;
            if (event.value === true) this.begin();
            else this.end();
        });
    }

    get isDragging(): boolean {
        return this.start !== null;
    }

    /** Puts the gizmo on a thing, or away; a drag that is under way goes on undisturbed. */
    show(target: GizmoTarget | null, mode: 'translate' | 'rotate'): void {
        if (this.start) return;
        this.target = target;
        this.controls.setMode(mode);
        const axes = mode === 'rotate' || !target ? 'xyz' : target.axes;
        [this.controls.showX, this.controls.showY, this.controls.showZ] = [...'xyz'].map((axis) => axes.includes(axis)) as [
            boolean, boolean, boolean,
        ];
        if (!target) {
            this.controls.detach();
            return;
        }
        this.anchor.position.set(...target.place);
        this.anchor.quaternion.identity();
        this.controls.attach(this.anchor);
    }

    private begin(): void {
        if (!this.target) return;
        const pose = currentPose(this.target);
        this.start = {
            target: this.target, pose, position: this.anchor.position.clone(), turn: this.anchor.quaternion.clone(),
        };
    }

    private end(): void {
        this.report(true);
        this.start = null;
    }

    private report(isDone: boolean): void {
        if (!this.start) return;
        const { target, pose, position, turn } = this.start;
        const rotation = toRotation(this.anchor.quaternion.clone().multiply(turn.clone().invert()));
        const shift = this.anchor.position.clone().sub(position).toArray() as Vec3;
        const next = moved(pose, rotation, position.toArray() as Vec3, shift);
        this.onMove(target.pointer, motionTo(target.keys, next, target.timeStep), isDone);
    }
}

/** The pose that a thing is in, turning about its own middle where its motion names no pivot. */
export function currentPose(target: GizmoTarget): Pose {
    const pose = poseAt(target.keys, target.t);
    if (target.keys.some((key) => key.about)) return pose;
    // The same motion written about the thing's resting middle: x -> R x + T = R (x - m) + m + (T + R m - m).
    const rotation = rotationFromDegrees(pose.rotate_deg);
    const transpose: Rotation = [
        [rotation[0][0], rotation[1][0], rotation[2][0]],
        [rotation[0][1], rotation[1][1], rotation[2][1]],
        [rotation[0][2], rotation[1][2], rotation[2][2]],
    ];
    const middle = rotate(transpose, subtract(target.place, pose.translate));
    return {
        about: middle,
        rotate_deg: pose.rotate_deg,
        translate: subtract(add(pose.translate, rotate(rotation, middle)), middle),
    };
}

function toRotation(q: Quaternion): Rotation {
    const column = (x: number, y: number, z: number): Vector3 => new Vector3(x, y, z).applyQuaternion(q);
    const [x, y, z] = [column(1, 0, 0), column(0, 1, 0), column(0, 0, 1)];
    return [[x.x, y.x, z.x], [x.y, y.y, z.y], [x.z, y.z, z.z]];
}
