// One session of the fake server: it honours what the protocol says a page may ask for.

import type { ColorBy, Frame, MotionKey, PageMessage, Sample, Scene, ServerMessage, Vec3 } from '../src/protocol';
import { poseAt } from '../src/motion';
import { encodeMesh, encodePositions } from './encode';
import { live, presets, sceneOf } from './fake_scenes';
import type { Shape } from './fake_surface';
import { Balloon, Cloth } from './fake_surface';

export interface Page {
    send(data: string | ArrayBuffer): void;
    look: { detail: boolean; color: ColorBy };
    /** Versions of meshes that have gone out to it. */
    known: Set<number>;
    frame: number | null;
}

interface Past {
    scene: string;
    step: number;
    level: number;
    pulls: string;
}

const clothSizes = [22, 45, 80, 141];
const balloonSizes = [30, 56, 100, 156];
const stepWait = 60;

export class FakeSession {
    readonly pages = new Set<Page>();
    readonly files = new Map<string, string>();
    private id: string | null = null;
    private scene: Scene | null = null;
    private state: 'empty' | 'building' | 'idle' | 'playing' | 'refining' | 'at_rest' = 'empty';
    private level = 0;
    private step = 0;
    private base = 0;
    private surfaces: (Cloth | Balloon)[] = [];
    private pulls = new Map<string, { vertex: number; to: Vec3; level: number }>();
    private samples: Sample[] = [];
    private frames: (Frame & { step: number })[] = [];
    private undos: Past[] = [];
    private redos: Past[] = [];
    private gesture = '';
    private timer: ReturnType<typeof setTimeout> | undefined;

    join(page: Page): void {
        this.pages.add(page);
        this.tellSession([page]);
        this.tell({ type: 'samples', samples: this.samples }, [page]);
        this.tell({ type: 'frames', count: this.frames.length, list: this.frames, from: 0 }, [page]);
        this.tellStatus([page]);
        if (!this.scene) return;
        this.tellParts([page]);
        this.show(page);
    }

    receive(page: Page, message: PageMessage): void {
        switch (message.type) {
            case 'open':
                if ('gallery' in message) return this.open(message.gallery);
                return this.tell({ type: 'error', message: 'the fake opens no files', in_answer_to: 'open' }, [page]);
            case 'play': return this.play();
            case 'pause': return this.rest('idle');
            case 'step': this.rest('idle'); return this.advance();
            case 'set': return this.set(message);
            case 'undo': return this.travel(this.undos, this.redos);
            case 'redo': return this.travel(this.redos, this.undos);
            case 'grab': {
                if (!this.pulls.has(message.id)) this.remember(message.id);
                this.pulls.set(message.id, { vertex: message.vertex, to: message.to, level: this.level });
                return this.changed();
            }
            case 'release': this.pulls.delete(message.id); return this.changed();
            case 'pin': return this.changed();
            case 'refine': return this.refine(message.to);
            case 'stop': return this.rest('idle');
            case 'preview': this.level = 0; this.rest('idle'); return this.showAll();
            case 'restart': this.step = 0; this.level = 0; this.samples = []; this.frames = []; this.pulls.clear(); this.rest('idle'); return this.tellAll();
            case 'show': page.look = { detail: message.detail, color: message.color }; return this.show(page);
            case 'frame': page.frame = message.index; return this.show(page);
            case 'save': return this.save(`${message.name}.json`, JSON.stringify(this.scene));
            case 'export': return this.save(`${this.id}.${message.format === 'gltf' ? 'glb' : message.format === 'usd' ? 'usdc' : 'zip'}`, 'not a real one');
            default: this.tell({ type: 'error', message: 'not understood', in_answer_to: (message as { type: string }).type }, [page]);
        }
    }

    open(id: string): void {
        this.rest('idle');
        this.id = id;
        this.scene = sceneOf(id);
        this.surfaces = id === 'balloon' ? balloonSizes.map((n) => new Balloon(n)) : clothSizes.map((n) => new Cloth(n));
        this.base += this.surfaces.length;
        [this.level, this.step, this.samples, this.frames, this.undos, this.redos] = [0, 0, [], [], [], []];
        this.pulls.clear();
        this.state = 'building';
        this.tellAll();
        [0.3, 0.7].forEach((fraction, i) => setTimeout(() => this.tell({ type: 'progress', fraction, text: `level ${2 - i}: collapsing edges` }), 120 * i));
        this.timer = setTimeout(() => {
            this.state = 'idle';
            this.tellAll();
        }, 300);
    }

    /** Shows a mesh that cannot be used, as a dropped one may be. */
    showUnusable(): void {
        const grid = this.surfaceOf('drape', 1).grid;
        const marked = Uint32Array.from({ length: 40 }, (_, i) => 300 + i * 3);
        this.base += 10;
        for (const page of this.pages) {
            page.send(encodeMesh({ level: 0, version: this.base, t: 0, ...grid, marked }));
            const { positions } = this.laid(this.surfaceOf('drape', 1), 20, 0);
            page.send(encodePositions({ level: 0, version: this.base, t: 0, step: 0, positions }));
        }
    }

    private surfaceOf(id: string, level: number): Cloth | Balloon {
        return id === 'balloon' ? new Balloon(balloonSizes[level]!) : new Cloth(clothSizes[level]!);
    }

    private play(): void {
        if (!this.scene || this.state === 'playing' || this.state === 'building') return;
        this.state = 'playing';
        this.tellStatus();
        const next = (): void => {
            this.advance();
            this.timer = setTimeout(next, stepWait);
        };
        this.timer = setTimeout(next, stepWait);
    }

    private rest(state: 'idle' | 'at_rest'): void {
        clearTimeout(this.timer);
        this.timer = undefined;
        this.state = this.scene ? state : 'empty';
        this.tellStatus();
    }

    private advance(): void {
        ++this.step;
        const decay = Math.exp(-0.06 * this.step);
        const sample: Sample = {
            level: this.level, t: this.t, step: this.step, energy: -0.4 + 0.5 * decay + 0.01 * Math.sin(this.step),
            residual: 0.3 * decay * (1.2 + Math.sin(1.7 * this.step)) + 1e-4, gap: 8e-4 + 3e-3 * decay * (1 + 0.3 * Math.sin(this.step)),
            iterations: 5, seconds: 0.03,
        };
        this.samples.push(sample);
        this.tell({ type: 'sample', ...sample });
        if (this.step % 4 === 0) this.keepFrame('preview');
        this.tellStatus();
        this.showAll();
    }

    private keepFrame(phase: string): void {
        const frame = { index: this.frames.length, level: this.level, t: this.t, phase, step: this.step };
        this.frames.push(frame);
        this.tell({ type: 'frames', count: this.frames.length, list: [frame], from: frame.index });
    }

    private set(message: Extract<PageMessage, { type: 'set' }>): void {
        if (!this.scene) return;
        this.remember(message.gesture);
        for (const { set, value } of message.edits) {
            const path = set.split('/').slice(1);
            const last = path.pop()!;
            let place = this.scene as unknown as Record<string, unknown>;
            for (const key of path) place = place[key] as Record<string, unknown>;
            const isPreset = last === 'material' && typeof value === 'string';
            place[last] = isPreset ? { ...presets[value] } : value;
        }
        this.changed();
    }

    private remember(gesture: string): void {
        if (gesture !== this.gesture) this.undos.push(this.now());
        this.gesture = gesture;
        this.redos = [];
    }

    private now(): Past {
        return { scene: JSON.stringify(this.scene), step: this.step, level: this.level, pulls: JSON.stringify([...this.pulls]) };
    }

    private travel(from: Past[], to: Past[]): void {
        const past = from.pop();
        if (!past) return;
        to.push(this.now());
        this.scene = JSON.parse(past.scene) as Scene;
        this.step = past.step;
        this.level = past.level;
        this.pulls = new Map(JSON.parse(past.pulls) as [string, { vertex: number; to: Vec3; level: number }][]);
        this.gesture = '';
        this.samples = this.samples.filter((sample) => sample.step <= this.step);
        this.frames = this.frames.filter((frame) => frame.step <= this.step);
        this.rest('idle');
        this.tellAll();
    }

    private refine(to: 'next' | 'finest'): void {
        this.rest('idle');
        if (this.level + 1 >= this.surfaces.length) return;
        this.state = 'refining';
        this.tellStatus();
        let batch = 0;
        const next = (): void => {
            this.tell({ type: 'progress', fraction: ++batch / 12, text: `level ${this.level + 1}: undoing collapses, batch ${batch}`, batch, batches: 12 });
            if (batch < 12) {
                this.timer = setTimeout(next, 70);
                return;
            }
            ++this.level;
            this.keepFrame('refine');
            if (to === 'finest' && this.level + 1 < this.surfaces.length) {
                this.tellStatus();
                this.showAll();
                batch = 0;
                this.timer = setTimeout(next, 70);
                return;
            }
            this.rest('at_rest');
            this.showAll();
        };
        this.timer = setTimeout(next, 70);
    }

    private save(name: string, content: string): void {
        this.files.set(name, content);
        this.tell({ type: 'saved', files: [name] });
    }

    private get t(): number {
        return this.step * (this.scene?.solve.time_step ?? 0);
    }

    private changed(): void {
        this.tellSession();
        this.tellParts();
        if (this.state !== 'playing') this.showAll();
    }

    private tellAll(): void {
        this.tellSession();
        this.tellStatus();
        this.tell({ type: 'samples', samples: this.samples });
        this.tell({ type: 'frames', count: this.frames.length, list: this.frames, from: 0 });
        this.tellParts();
        this.showAll();
    }

    private tell(message: ServerMessage, pages: Iterable<Page> = this.pages): void {
        const text = JSON.stringify(message);
        for (const page of pages) page.send(text);
    }

    private tellSession(pages: Iterable<Page> = this.pages): void {
        this.tell({
            type: 'session', scene: this.scene, presets, live, edited: this.undos.length > 0,
            can_undo: this.undos.length > 0, can_redo: this.redos.length > 0, file_name: this.id ?? '',
        }, pages);
    }

    private tellStatus(pages: Iterable<Page> = this.pages): void {
        this.tell({
            type: 'status', state: this.state, level: this.level, levels: this.surfaces.length || 1,
            vertices: this.surfaces[this.level]?.grid.vertices ?? 0, phase: 'preview', t: this.t,
            duration: this.scene?.solve.duration ?? 0, step: this.step, equilibrium: this.state === 'at_rest',
            steps_per_second: 14.2, edit_to_step_ms: 48, message: '',
        }, pages);
    }

    private pose(list: 'handles' | 'obstacles'): Vec3 {
        const keys = this.scene?.[list][0]?.motion;
        return Array.isArray(keys) ? poseAt(keys as MotionKey[], Infinity).translate : [0, 0, 0];
    }

    private tellParts(pages: Iterable<Page> = this.pages): void {
        const hasBall = (this.scene?.obstacles.length ?? 0) > 0;
        const place = (list: 'handles' | 'obstacles', y: number): Vec3 => this.pose(list).map((x, k) => (k === 1 ? x + y : x)) as Vec3;
        const { positions } = this.laid(this.surfaces[this.level]!, this.step, this.level);
        this.tell({
            type: 'parts',
            parts: [{ name: this.scene!.bodies[0]!.name, kind: 'body' }, ...(hasBall ? [{ name: 'ball', kind: 'obstacle' as const }] : [])],
            handles: hasBall ? [{ name: 'crown', place: place('handles', 0.26), rest: [0, 0.26, 0] }] : [],
            obstacles: hasBall ? [{ name: 'ball', place: place('obstacles', 0), rest: [0, 0, 0] }] : [],
            pulls: [...this.pulls].map(([id, { vertex, to }]) => ({ id, at: [...positions.subarray(vertex * 3, vertex * 3 + 3)] as Vec3, to })),
        }, pages);
    }

    private showAll(): void {
        for (const page of this.pages) this.show(page);
    }

    private show(page: Page): void {
        if (!this.scene) return;
        const frame = page.frame === null ? null : this.frames[page.frame];
        const level = frame?.level ?? this.level;
        const shown = page.look.detail && !frame ? this.surfaces.length - 1 : level;
        const surface = this.surfaces[shown]!;
        const version = this.base + shown;
        if (!page.known.has(version)) page.send(encodeMesh({ level: shown, version, t: this.t, ...surface.grid }));
        page.known.add(version);
        const step = frame?.step ?? this.step;
        const { positions, scalars } = this.laid(surface, step, level);
        page.send(encodePositions({
            level, version, t: step * this.scene.solve.time_step, step, positions,
            scalars: page.look.color === 'none' ? null : scalars, saved: Boolean(frame), detail: shown !== level,
        }));
    }

    private laid(surface: Cloth | Balloon, step: number, level: number): { positions: Float32Array; scalars: Float32Array } {
        const body = this.scene?.bodies[0];
        const gravity = this.scene?.gravity;
        const shape: Shape = {
            t: step * 0.05, detail: level, ball: this.pose('obstacles'), lift: this.pose('handles'),
            pressure: typeof body?.pressure === 'number' ? body.pressure : 0,
            gravity: Array.isArray(gravity) ? Math.abs(Number(gravity[1])) : 9.81,
            stiffness: body?.material.youngs_modulus ?? 8e5,
            pulls: [...this.pulls.values()].filter((pull) => pull.level === level),
        };
        const positions = new Float32Array(surface.grid.vertices * 3);
        const scalars = new Float32Array(surface.grid.vertices);
        surface.lay(shape, positions, scalars);
        return { positions, scalars };
    }
}
