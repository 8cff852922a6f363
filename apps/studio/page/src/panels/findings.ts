import { button, element, icon } from '../dom';
import type { Findings, Json } from '../protocol';
import type { State, Store } from '../store';

/** Findings in words, worst first: what it is, and what would put it right. */
const phrases: Record<string, { one: string; many: string; cure: string }> = {
    intersecting_face_pairs: {
        one: 'pair of faces that meet', many: 'pairs of faces that meet',
        cure: 'Surfaces must not pass through each other; move them apart or join them.',
    },
    degenerate_faces: { one: 'face without area', many: 'faces without area', cure: 'Remove them or merge their vertices.' },
    duplicate_faces: { one: 'face that is there twice', many: 'faces that are there twice', cure: 'Keep one of each.' },
    non_manifold_vertices: {
        one: 'vertex where surfaces touch in a point', many: 'vertices where surfaces touch in a point',
        cure: 'Give each surface a vertex of its own.',
    },
    non_manifold_edges: {
        one: 'edge with more than two faces', many: 'edges with more than two faces',
        cure: 'These are allowed where sheets are joined on purpose.',
    },
    inconsistent_edges: {
        one: 'edge between faces that turn opposite ways', many: 'edges between faces that turn opposite ways',
        cure: 'Flip the faces of one side.',
    },
};

export interface Phrase {
    text: string;
    cure: string;
}

/** What a check has found, one phrase for each kind of fault. */
export function phrasesOf(findings: Findings): Phrase[] {
    return Object.entries(phrases).flatMap(([key, { one, many, cure }]) => {
        const count = findings[key];
        if (typeof count !== 'number' || count === 0) return [];
        return [{ text: `${count} ${count === 1 ? one : many}`, cure }];
    });
}

function notes(findings: Findings): string[] {
    const meshes = findings.meshes;
    if (!Array.isArray(meshes)) return [];
    return meshes.flatMap((mesh: Json) => {
        const list = typeof mesh === 'object' && mesh !== null && !Array.isArray(mesh) ? mesh.notes : [];
        return Array.isArray(list) ? list.filter((note): note is string => typeof note === 'string') : [];
    });
}

export function findingsPanel(unusable: NonNullable<State['unusable']>, store: Store): HTMLElement {
    const found = phrasesOf(unusable.findings);
    return element('section', { class: 'findings', role: 'alert' },
        element('h2', {}, 'This mesh cannot be used yet'),
        element('p', {}, unusable.message),
        element('ul', {}, ...found.map(({ text, cure }) =>
            element('li', {}, element('strong', {}, text), element('span', {}, cure)))),
        ...notes(unusable.findings).map((note) => element('p', { class: 'quiet' }, note)),
        found.length > 0
            ? element('p', { class: 'key' }, element('span', { class: 'swatch', style: '--swatch: var(--marked)' }), 'Where it is, in the view')
            : null,
        button({
            text: 'Choose another', label: 'Choose another', kind: 'primary', icon: 'scenes',
            press: () => store.update({ gallery: true, unusable: null }),
        }),
        element('p', { class: 'quiet' }, icon('upload'), ' or drop a mended file here'));
}
