// The drawn scene: which mesh is shown, by what positions, with what gizmos.

import { Box3, Vector3 } from 'three';

import type { BinaryMessage, MeshMessage, PositionsMessage } from '../binary';
import type { PartsMessage, Pull, Vec3 } from '../protocol';
import type { GizmoTarget, MoveListener } from './gizmo';
import { Gizmo } from './gizmo';
import type { GrabHandlers } from './grab';
import { Grab } from './grab';
import { readPalette } from './palette';
import { Pulls } from './pulls';
import { Stage } from './stage';
import { Surface } from './surface';

/** Bytes of meshes that are kept, so that older versions can be shown again (undo, scrubbing). */
const mostMeshBytes = 400e6;

export interface ViewHandlers extends Omit<GrabHandlers, 'surface'> {
    moved: MoveListener;
    /** Positions have come of a mesh that the page does not have. */
    unknownMesh(): void;
    /** New positions are on the screen. */
    shown(message: PositionsMessage): void;
}

export class SceneView {
    readonly stage: Stage;
    readonly gizmo: Gizmo;
    readonly grab: Grab;
    private readonly pulls = new Pulls();
    private readonly meshes = new Map<number, MeshMessage>();
    private surface: Surface | null = null;
    private kinds: ('body' | 'obstacle')[] = [];
    private palette = readPalette();
    private showsEdges = false;
    private framed = { radius: 0, needsCamera: true };
    private readonly box = new Box3();

    constructor(
        host: HTMLElement,
        private readonly handlers: ViewHandlers,
    ) {
        this.stage = new Stage(host);
        this.stage.scene.add(this.pulls.group);
        // Grabbing listens first: the gizmo and the orbit come behind it.
        this.grab = new Grab(this.stage, {
            wants: (event) => handlers.wants(event),
            prepare: () => handlers.prepare(),
            grab: (id, vertex, to) => handlers.grab(id, vertex, to),
            letGo: (id, stays) => handlers.letGo(id, stays),
            picked: (part) => handlers.picked(part),
            surface: () => this.surface,
        });
        this.gizmo = new Gizmo(this.stage, handlers.moved);
        const draw = (): void => {
            this.stage.draw();
            requestAnimationFrame(draw);
        };
        requestAnimationFrame(draw);
    }

    /** What a new connection begins with: the server sends every mesh again. */
    forgetMeshes(): void {
        this.meshes.clear();
    }

    receive(message: BinaryMessage): void {
        if (message.kind === 'mesh') this.keep(message);
        else this.lay(message);
    }

    setParts(parts: PartsMessage | null): void {
        const kinds = parts?.parts.map((part) => part.kind) ?? [];
        const hasChanged = kinds.join() !== this.kinds.join();
        this.kinds = kinds;
        if (hasChanged && this.surface) this.rebuild();
        this.setPulls(parts?.pulls ?? []);
    }

    setPulls(pulls: readonly Pull[]): void {
        this.pulls.show(pulls);
        this.stage.invalidate();
    }

    setGizmo(target: GizmoTarget | null, mode: 'translate' | 'rotate'): void {
        this.gizmo.show(target, mode);
        this.stage.invalidate();
    }

    setEdges(shown: boolean): void {
        this.showsEdges = shown;
        this.surface?.showEdges(shown);
        this.stage.invalidate();
    }

    applyTheme(isDark: boolean): void {
        this.palette = readPalette();
        this.surface?.applyPalette(this.palette);
        this.pulls.applyPalette(this.palette);
        this.stage.applyPalette(this.palette, isDark);
    }

    /** The next positions are framed by the camera. */
    resetCamera(): void {
        this.framed.needsCamera = true;
        if (this.surface) this.frame(this.surface.positions);
    }

    /** Shows nothing, for a scene that is to come. */
    clear(): void {
        this.replaceSurface(null);
        this.framed = { radius: 0, needsCamera: true };
        this.stage.invalidateShadows();
    }

    get volume(): number | null {
        return this.surface?.volume() ?? null;
    }

    get shownPositions(): Float32Array | null {
        return this.surface?.positions ?? null;
    }

    /** Where a place is seen, in pixels of the window, and how far it is from the eye. */
    seenAt(place: Vec3): { x: number; y: number; distance: number } {
        const { camera, renderer } = this.stage;
        const at = new Vector3(...place);
        const distance = at.distanceTo(camera.position);
        const { left, top, width, height } = renderer.domElement.getBoundingClientRect();
        const { x, y } = at.project(camera);
        return { x: left + (width * (x + 1)) / 2, y: top + (height * (1 - y)) / 2, distance };
    }

    private keep(mesh: MeshMessage): void {
        this.meshes.set(mesh.version, mesh);
        let bytes = 0;
        for (const kept of this.meshes.values()) bytes += kept.corners.buffer.byteLength;
        for (const [version, kept] of this.meshes) {
            if (bytes <= mostMeshBytes || version === mesh.version) break;
            bytes -= kept.corners.buffer.byteLength;
            this.meshes.delete(version);
        }
    }

    private lay(message: PositionsMessage): void {
        const mesh = this.meshes.get(message.version);
        if (!mesh || mesh.vertices * 3 !== message.positions.length) {
            this.handlers.unknownMesh();
            return;
        }
        if (this.surface?.mesh !== mesh) this.replaceSurface(new Surface(mesh, this.kinds, this.palette));
        this.surface!.update(message);
        this.surface!.showEdges(this.showsEdges);
        this.frame(message.positions);
        this.stage.invalidateShadows();
        this.handlers.shown(message);
    }

    private rebuild(): void {
        const old = this.surface!;
        const next = new Surface(old.mesh, this.kinds, this.palette);
        next.update({
            kind: 'positions', level: old.mesh.level, version: old.mesh.version, t: 0, step: 0,
            positions: old.positions, scalars: null, low: 0, high: 0, saved: false, detail: false,
        });
        next.showEdges(this.showsEdges);
        this.replaceSurface(next);
        this.stage.invalidateShadows();
    }

    private replaceSurface(next: Surface | null): void {
        if (this.surface) {
            this.stage.scene.remove(this.surface.group);
            this.surface.dispose();
        }
        this.surface = next;
        if (next) this.stage.scene.add(next.group);
    }

    /** Light and ground follow a scene that outgrows them; the camera moves only at first and when asked to. */
    private frame(positions: Float32Array): void {
        this.box.setFromArray(positions);
        const radius = this.box.getSize(new Vector3()).length() / 2;
        const fits = radius < 1.3 * this.framed.radius && radius > 0.4 * this.framed.radius;
        if (fits && !this.framed.needsCamera && this.box.min.y > this.stage.groundHeight) return;
        this.stage.frame(this.box, this.framed.needsCamera);
        this.framed = { radius, needsCamera: false };
    }
}
