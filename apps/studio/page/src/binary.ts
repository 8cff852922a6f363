// The binary messages. Views into the message are handed out, never copies: every array begins at a multiple of four.

/** The surface that positions of the same version are laid over. */
export interface MeshMessage {
    kind: 'mesh';
    level: number;
    version: number;
    vertices: number;
    t: number;
    unusable: boolean;
    /** Three vertex numbers a face. */
    corners: Uint32Array;
    /** The part of each face, a place in the `parts` message's list. */
    parts: Uint32Array;
    /** Faces that make the mesh unusable. */
    marked: Uint32Array;
}

export interface PositionsMessage {
    kind: 'positions';
    level: number;
    version: number;
    t: number;
    step: number;
    /** Three coordinates a vertex. */
    positions: Float32Array;
    /** One number a vertex, NaN where there is none; null where none was asked for. */
    scalars: Float32Array | null;
    low: number;
    high: number;
    /** A saved frame, not the running state. */
    saved: boolean;
    /** The finest mesh by prolongation alone. */
    detail: boolean;
}

export type BinaryMessage = MeshMessage | PositionsMessage;

const headerBytes = 24;
const hasScalars = 1;
const isSaved = 2;
const isDetail = 4;

/** Reads one binary message. Throws RangeError where it is shorter than it says, or of no known kind. */
export function decodeBinary(data: ArrayBuffer): BinaryMessage {
    const view = new DataView(data);
    const kind = view.getUint32(0, true);
    if (kind === 1) return decodeMesh(data, view);
    if (kind === 2) return decodePositions(data, view);
    throw new RangeError(`binary message of unknown kind ${kind}`);
}

function decodeMesh(data: ArrayBuffer, view: DataView): MeshMessage {
    const faces = view.getUint32(headerBytes, true);
    const unusable = (view.getUint32(headerBytes + 4, true) & 1) !== 0;
    const cornersAt = headerBytes + 8;
    const partsAt = cornersAt + faces * 12;
    const markedAt = partsAt + faces * 4;
    const marked = unusable
        ? new Uint32Array(data, markedAt + 4, view.getUint32(markedAt, true))
        : new Uint32Array(0);
    const mesh: MeshMessage = {
        kind: 'mesh',
        ...common(view),
        vertices: view.getUint32(12, true),
        unusable,
        corners: new Uint32Array(data, cornersAt, faces * 3),
        parts: new Uint32Array(data, partsAt, faces),
        marked,
    };
    // A corner out of range would read outside every array on the way to the screen.
    for (const corner of mesh.corners)
        if (corner >= mesh.vertices) throw new RangeError(`corner ${corner} of ${mesh.vertices} vertices`);
    return mesh;
}

function decodePositions(data: ArrayBuffer, view: DataView): PositionsMessage {
    const count = view.getUint32(12, true);
    const flags = view.getUint32(headerBytes, true);
    const positionsAt = headerBytes + 8;
    const rangeAt = positionsAt + count * 12;
    const scalars = (flags & hasScalars) !== 0;
    return {
        kind: 'positions',
        ...common(view),
        step: view.getUint32(headerBytes + 4, true),
        positions: new Float32Array(data, positionsAt, count * 3),
        scalars: scalars ? new Float32Array(data, rangeAt + 8, count) : null,
        low: scalars ? view.getFloat32(rangeAt, true) : 0,
        high: scalars ? view.getFloat32(rangeAt + 4, true) : 0,
        saved: (flags & isSaved) !== 0,
        detail: (flags & isDetail) !== 0,
    };
}

function common(view: DataView): { level: number; version: number; t: number } {
    return { level: view.getUint32(4, true), version: view.getUint32(8, true), t: view.getFloat64(16, true) };
}
