import { describe, expect, it } from 'vitest';

import { encodeMesh, encodePositions } from '../dev/encode';
import { decodeBinary } from '../src/binary';

const triangle = {
    level: 1, version: 7, t: 0.25, vertices: 4, corners: Uint32Array.of(0, 1, 2, 0, 2, 3), parts: Uint32Array.of(0, 1),
};

describe('binary messages', () => {
    it('carry a mesh', () => {
        const mesh = decodeBinary(encodeMesh(triangle));
        expect(mesh).toMatchObject({ kind: 'mesh', level: 1, version: 7, t: 0.25, vertices: 4, unusable: false });
        if (mesh.kind !== 'mesh') throw new Error();
        expect([...mesh.corners]).toEqual([0, 1, 2, 0, 2, 3]);
        expect([...mesh.parts]).toEqual([0, 1]);
        expect(mesh.marked.length).toBe(0);
    });

    it('carry the faces that make a mesh unusable', () => {
        const mesh = decodeBinary(encodeMesh({ ...triangle, marked: Uint32Array.of(1) }));
        expect(mesh).toMatchObject({ unusable: true, marked: Uint32Array.of(1) });
    });

    it('carry positions, with and without scalars', () => {
        const positions = Float32Array.of(1, 2, 3, 4, 5, 6);
        const plain = decodeBinary(encodePositions({ level: 0, version: 7, t: 1, step: 3, positions, saved: true }));
        expect(plain).toMatchObject({ kind: 'positions', step: 3, saved: true, detail: false, scalars: null, positions });
        const scalars = Float32Array.of(0.5, NaN);
        const colored = decodeBinary(
            encodePositions({ level: 0, version: 7, t: 1, step: 3, positions, scalars, detail: true }),
        );
        expect(colored).toMatchObject({ saved: false, detail: true, scalars, low: 0.5, high: 0.5 });
    });

    it('are views into the message, not copies', () => {
        const data = encodePositions({ level: 0, version: 1, t: 0, step: 0, positions: new Float32Array(3) });
        const message = decodeBinary(data);
        if (message.kind !== 'positions') throw new Error();
        expect(message.positions.buffer).toBe(data);
    });

    it('are refused where they are cut short, of no known kind, or refer to vertices that are not', () => {
        const data = encodePositions({ level: 0, version: 1, t: 0, step: 0, positions: new Float32Array(30) });
        expect(() => decodeBinary(data.slice(0, 60))).toThrow(RangeError);
        expect(() => decodeBinary(new ArrayBuffer(8))).toThrow(RangeError);
        new DataView(data).setUint32(0, 9, true);
        expect(() => decodeBinary(data)).toThrow(RangeError);
        expect(() => decodeBinary(encodeMesh({ ...triangle, vertices: 3 }))).toThrow(RangeError);
    });
});
