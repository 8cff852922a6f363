// What goes by plain HTTP: the gallery, meshes and scenes that are dropped, and files that the session has saved.

import type { Findings, GalleryEntry } from './protocol';

const meshEndings = ['obj', 'ply', 'stl', 'off'];
const mostMeshBytes = 256 * 2 ** 20;
const mostSceneBytes = 4 * 2 ** 20;

export const acceptedFiles = [...meshEndings, 'json'].map((ending) => `.${ending}`).join(',');

export interface Answer {
    ok: boolean;
    message: string;
    findings: Findings | null;
}

/** Where a file is sent, or why it is not. */
export function destination(name: string, bytes: number): { address: string } | { refusal: string } {
    const ending = name.toLowerCase().split('.').pop() ?? '';
    const isScene = ending === 'json';
    if (!isScene && !meshEndings.includes(ending))
        return { refusal: `${name} is none of OBJ, PLY, STL, OFF or a scene's JSON` };
    if (bytes > (isScene ? mostSceneBytes : mostMeshBytes))
        return { refusal: `${name} is larger than ${isScene ? '4' : '256'} MB` };
    return { address: isScene ? '/api/scene' : `/api/mesh?name=${encodeURIComponent(name)}` };
}

export async function sendFile(file: File, address: string): Promise<Answer> {
    try {
        const response = await fetch(address, { method: 'POST', body: file });
        const answer = (await response.json()) as Partial<Answer>;
        return {
            ok: response.ok && answer.ok === true,
            message: answer.message ?? `the server answered ${response.status}`,
            findings: answer.findings ?? null,
        };
    } catch {
        return { ok: false, message: `${file.name} could not be sent`, findings: null };
    }
}

export async function fetchGallery(): Promise<GalleryEntry[]> {
    const response = await fetch('/api/gallery');
    if (!response.ok) throw new Error(`the gallery answered ${response.status}`);
    return (await response.json()) as GalleryEntry[];
}

const lastSession = 'last-session.json';

/** The scenes among the files of a session: the one that was kept by itself comes first. */
export function savedScenes(names: string[]): { file: string; words: string }[] {
    const scenes = names.filter((name) => name.endsWith('.json') && !name.endsWith('.edits.json'));
    const saved = scenes.filter((name) => name !== lastSession).map((file) => ({ file, words: file.slice(0, -'.json'.length) }));
    return scenes.includes(lastSession) ? [{ file: lastSession, words: 'Go on where the last session ended' }, ...saved] : saved;
}

export async function fetchSavedScenes(): Promise<{ file: string; words: string }[]> {
    const response = await fetch('/api/files');
    if (!response.ok) throw new Error(`the list of files answered ${response.status}`);
    return savedScenes(((await response.json()) as { name: string }[]).map((entry) => entry.name));
}

export function fileAddress(name: string): string {
    return `/api/files/${encodeURIComponent(name)}`;
}

/** Has the browser keep a file of the session. */
export function download(name: string): void {
    const link = document.createElement('a');
    link.href = fileAddress(name);
    link.download = name;
    document.body.append(link);
    link.click();
    link.remove();
}
