// Pulling a body's vertex with the pointer, in the plane through it that faces the camera.

import { Plane, Raycaster, Vector2, Vector3 } from 'three';

import type { Vec3 } from '../protocol';
import { Throttle } from '../throttle';
import { firstHit } from './picking';
import type { Stage } from './stage';
import type { Surface } from './surface';

/** Thirty messages a second are more than the solver takes steps. */
const wait = 34;

export interface GrabHandlers {
    /** Whether a press of this pointer is to grab. */
    wants(event: PointerEvent): boolean;
    surface(): Surface | null;
    /** Asked before a grab begins: false where what is shown is not what can be grabbed. */
    prepare(): boolean;
    grab(id: string, vertex: number, to: Vec3): void;
    letGo(id: string, stays: boolean): void;
    picked(part: number | null): void;
}

export class Grab {
    private readonly ray = new Raycaster();
    private active: { id: string; vertex: number; plane: Plane; pointer: number } | null = null;
    private readonly send = new Throttle<Vec3>(wait, (to) => {
        if (this.active) this.handlers.grab(this.active.id, this.active.vertex, to);
    });
    private pressed: { x: number; y: number } | null = null;
    private count = 0;

    constructor(
        private readonly stage: Stage,
        private readonly handlers: GrabHandlers,
    ) {
        const canvas = stage.renderer.domElement;
        // Before the orbit controls see it, so that they can be kept from turning the view.
        canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
        canvas.addEventListener('pointermove', (event) => this.move(event));
        canvas.addEventListener('pointerup', (event) => this.release(event, event.shiftKey));
        canvas.addEventListener('pointercancel', (event) => this.release(event, false));
    }

    /** The vertex that is held, and where the pointer wants it. */
    get isActive(): boolean {
        return this.active !== null;
    }

    private press(event: PointerEvent): void {
        if (event.button !== 0) return;
        this.pressed = { x: event.clientX, y: event.clientY };
        if (!this.handlers.wants(event) || !this.handlers.prepare()) return;
        const surface = this.handlers.surface();
        const hit = surface && this.hit(event, surface);
        if (!surface || !hit || surface.kindOf(surface.partAt(hit.corner)) !== 'body') return;
        event.stopImmediatePropagation();
        event.preventDefault();
        this.stage.renderer.domElement.setPointerCapture(event.pointerId);
        const place = new Vector3().fromArray(surface.positions, hit.vertex * 3);
        const facing = this.stage.camera.getWorldDirection(new Vector3());
        this.active = {
            id: `g${Date.now().toString(36)}${this.count++}`,
            vertex: hit.vertex,
            plane: new Plane().setFromNormalAndCoplanarPoint(facing, place),
            pointer: event.pointerId,
        };
    }

    private move(event: PointerEvent): void {
        if (this.active?.pointer !== event.pointerId) return;
        this.aim(event);
        const to = this.ray.ray.intersectPlane(this.active.plane, new Vector3());
        if (to) this.send.push(to.toArray() as Vec3);
    }

    private release(event: PointerEvent, stays: boolean): void {
        const press = this.pressed;
        this.pressed = null;
        if (this.active?.pointer === event.pointerId) {
            this.send.flush();
            this.handlers.letGo(this.active.id, stays);
            this.active = null;
            return;
        }
        if (press && Math.hypot(event.clientX - press.x, event.clientY - press.y) < 4) this.pick(event);
    }

    private pick(event: PointerEvent): void {
        const surface = this.handlers.surface();
        const hit = surface && this.hit(event, surface);
        this.handlers.picked(surface && hit ? surface.partAt(hit.corner) : null);
    }

    private aim(event: PointerEvent): void {
        const box = this.stage.renderer.domElement.getBoundingClientRect();
        const x = ((event.clientX - box.left) / box.width) * 2 - 1;
        const y = 1 - ((event.clientY - box.top) / box.height) * 2;
        this.ray.setFromCamera(new Vector2(x, y), this.stage.camera);
    }

    private hit(event: PointerEvent, surface: Surface): ReturnType<typeof firstHit> {
        this.aim(event);
        const { origin, direction } = this.ray.ray;
        return firstHit(
            surface.positions, surface.corners, origin.toArray() as Vec3, direction.toArray() as Vec3,
        );
    }
}
