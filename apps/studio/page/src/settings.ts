// How this page looks at the session, kept over a reload.

import type { PerspectiveCamera } from 'three';
import type { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { colorings } from './protocol';
import type { State, Store } from './store';

const lookKey = 'plisse-look';
const cameraKey = 'plisse-camera';

function stored(key: string): Record<string, unknown> | null {
    try {
        const value: unknown = JSON.parse(sessionStorage.getItem(key) ?? 'null');
        return typeof value === 'object' ? (value as Record<string, unknown> | null) : null;
    } catch {
        return null;
    }
}

export function storedLook(): Partial<State> {
    const look = stored(lookKey);
    if (!look) return {};
    const color = colorings.find((name) => name === look.color) ?? 'none';
    return { edges: look.edges === true, detail: look.detail === true, color };
}

export function keepLook(store: Store): void {
    store.watch((state) => [state.edges, state.detail, state.color], ({ edges, detail, color }) =>
        sessionStorage.setItem(lookKey, JSON.stringify({ edges, detail, color })));
}

export function keepCamera(camera: PerspectiveCamera, controls: OrbitControls, scene: () => string): void {
    controls.addEventListener('end', () =>
        sessionStorage.setItem(cameraKey, JSON.stringify({
            scene: scene(), position: camera.position.toArray(), target: controls.target.toArray(),
        })));
}

/** Puts the camera where it was when the page last showed this scene. */
export function restoreCamera(camera: PerspectiveCamera, controls: OrbitControls, scene: string): void {
    const kept = stored(cameraKey);
    const isPlace = (v: unknown): v is number[] => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
    if (!kept || kept.scene !== scene || !isPlace(kept.position) || !isPlace(kept.target)) return;
    camera.position.fromArray(kept.position);
    controls.target.fromArray(kept.target);
}
