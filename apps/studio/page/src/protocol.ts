// What page and server say to each other: docs/studio-protocol.md. Metres, seconds; binary is little-endian.

export type Vec3 = [number, number, number];
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** A scripted rigid motion's key: a field that is null or left out keeps its last value. */
export interface MotionKey {
    t: number;
    translate?: Vec3 | null;
    rotate_deg?: Vec3 | null;
    about?: Vec3 | null;
}

export interface Material {
    density: number;
    youngs_modulus: number;
    poisson_ratio: number;
    thickness: number;
    [key: string]: Json;
}

/** Dead loads on the selected vertices of a body (null: all of it): either a force or a traction. */
export interface Load {
    body: string;
    select: { [key: string]: Json } | null;
    /** N in all; a vector, or keyframes. */
    force?: Json;
    /** Pa; likewise. */
    traction?: Json;
}

/** The parts of a scene file, with its defaults filled in, that the page reads. */
export interface Scene {
    name: string;
    bodies: { name: string; material: Material; pressure: Json }[];
    loads: Load[];
    obstacles: { name: string; motion: MotionKey[] | { [key: string]: Json } }[];
    handles: { name: string; body: string; axes: string; motion: MotionKey[] }[];
    gravity: Json;
    contact: { distance: number; thickness: number; friction: number };
    hierarchy: { levels: number; coarsest_vertices: number; source: string; operator: string; bending_on: string };
    solve: { method: string; time_step: number; duration: number; tolerance: number };
}

export type ColorBy = 'none' | 'stretch' | 'curvature' | 'gap' | 'level';
export const colorings: readonly ColorBy[] = ['none', 'stretch', 'curvature', 'gap', 'level'];

export type ExportFormat = 'obj' | 'ply' | 'gltf' | 'usd' | 'pvd' | 'pc2';

export interface Edit {
    set: string;
    value: Json;
}

export type PageMessage =
    | { type: 'open'; gallery: string }
    | { type: 'open'; file: string }
    | { type: 'play' | 'pause' | 'step' | 'undo' | 'redo' | 'stop' | 'preview' | 'restart' }
    | { type: 'set'; edits: Edit[]; gesture: string }
    | { type: 'grab'; id: string; vertex: number; to: Vec3 }
    | { type: 'release' | 'pin'; id: string }
    | { type: 'refine'; to: 'next' | 'finest' }
    | { type: 'show'; detail: boolean; color: ColorBy }
    | { type: 'frame'; index: number | null }
    | { type: 'save'; name: string }
    | { type: 'export'; format: ExportFormat; what: 'animation' | 'state' };

export interface SessionMessage {
    type: 'session';
    scene: Scene | null;
    presets: Record<string, Material>;
    live: string[];
    edited: boolean;
    can_undo: boolean;
    can_redo: boolean;
    file_name: string;
}

export type RunState = 'empty' | 'building' | 'idle' | 'playing' | 'refining' | 'at_rest' | 'failed';

export interface StatusMessage {
    type: 'status';
    state: RunState;
    level: number;
    levels: number;
    vertices: number;
    phase: string;
    t: number;
    duration: number;
    step: number;
    equilibrium: boolean;
    steps_per_second: number | null;
    edit_to_step_ms: number | null;
    message: string;
}

export interface Sample {
    level: number;
    t: number;
    step: number;
    energy: number | null;
    residual: number | null;
    gap: number | null;
    iterations: number;
    seconds: number;
}

export interface Frame {
    index: number;
    level: number;
    t: number;
    phase: string;
}

export interface GizmoPlace {
    name: string;
    /** Where its middle is now. */
    place: Vec3;
    /** Where its middle is before any motion. */
    rest?: Vec3;
}

export interface Pull {
    id: string;
    at: Vec3;
    to: Vec3;
}

export interface PartsMessage {
    type: 'parts';
    parts: { name: string; kind: 'body' | 'obstacle' }[];
    handles: GizmoPlace[];
    obstacles: GizmoPlace[];
    pulls: Pull[];
}

export interface Progress {
    /** Of the whole run. */
    fraction: number;
    text: string;
    /** While collapses are undone: how many batches of this refinement are done, and of how many. */
    batch?: number;
    batches?: number;
}

export type ServerMessage =
    | SessionMessage
    | StatusMessage
    | ({ type: 'progress' } & Progress)
    | ({ type: 'sample' } & Sample)
    | { type: 'samples'; samples: Sample[] }
    | { type: 'frames'; count: number; list: Frame[]; from: number }
    | PartsMessage
    | { type: 'saved'; files: string[] }
    | { type: 'error'; message: string; in_answer_to?: string };

export interface GalleryEntry {
    id: string;
    title: string;
    words: string;
    picture: string;
    vertices: number;
    levels: number;
}

/** What `plisse check --json` says of a mesh: counts by name among other things. */
export type Findings = { [key: string]: Json };

const serverTypes = new Set([
    'session', 'status', 'progress', 'sample', 'samples', 'frames', 'parts', 'saved', 'error',
]);

/** A message from the server, or null where the text is none (a newer server may say more than the page knows). */
export function parseServerMessage(text: string): ServerMessage | null {
    let value: unknown;
    try {
        value = JSON.parse(text);
    } catch {
        return null;
    }
    if (typeof value !== 'object' || value === null) return null;
    const type = (value as { type?: unknown }).type;
    return typeof type === 'string' && serverTypes.has(type) ? (value as ServerMessage) : null;
}
