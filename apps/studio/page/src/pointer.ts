// JSON pointers (RFC 6901) into a scene, and the patterns of those that a running state survives.

import type { Json } from './protocol';

function segments(pointer: string): string[] {
    return pointer
        .split('/')
        .slice(1)
        .map((segment) => segment.replace(/~1/g, '/').replace(/~0/g, '~'));
}

/** The value that a pointer leads to; undefined where it leads nowhere. */
export function valueAt(document: unknown, pointer: string): Json | undefined {
    let value: unknown = document;
    for (const segment of segments(pointer)) {
        if (typeof value !== 'object' || value === null) return undefined;
        value = (value as Record<string, unknown>)[segment];
    }
    return value as Json | undefined;
}

/** Whether a change of the pointer's value, or inside of it, keeps the running state. `*` stands for any one segment. */
export function isLive(patterns: readonly string[], pointer: string): boolean {
    const path = segments(pointer);
    return patterns.some((pattern) => {
        const wanted = segments(pattern);
        return wanted.length <= path.length && wanted.every((segment, i) => segment === '*' || segment === path[i]);
    });
}
