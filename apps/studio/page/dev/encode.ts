// Writes the binary messages, as a server does: for the fake server and the decoder's tests.

export interface MeshContent {
    level: number;
    version: number;
    t: number;
    vertices: number;
    corners: Uint32Array;
    parts: Uint32Array;
    marked?: Uint32Array;
}

export function encodeMesh(mesh: MeshContent): ArrayBuffer {
    const faces = mesh.parts.length;
    const marked = mesh.marked ? 4 + mesh.marked.length * 4 : 0;
    const data = new ArrayBuffer(32 + faces * 16 + marked);
    const view = header(data, 1, mesh.level, mesh.version, mesh.vertices, mesh.t);
    view.setUint32(24, faces, true);
    view.setUint32(28, mesh.marked ? 1 : 0, true);
    new Uint32Array(data, 32, faces * 3).set(mesh.corners);
    new Uint32Array(data, 32 + faces * 12, faces).set(mesh.parts);
    if (mesh.marked) {
        view.setUint32(32 + faces * 16, mesh.marked.length, true);
        new Uint32Array(data, 36 + faces * 16, mesh.marked.length).set(mesh.marked);
    }
    return data;
}

export interface PositionsContent {
    level: number;
    version: number;
    t: number;
    step: number;
    positions: Float32Array;
    scalars?: Float32Array | null;
    saved?: boolean;
    detail?: boolean;
}

export function encodePositions(content: PositionsContent): ArrayBuffer {
    const count = content.positions.length / 3;
    const { scalars } = content;
    const data = new ArrayBuffer(32 + count * 12 + (scalars ? 8 + count * 4 : 0));
    const view = header(data, 2, content.level, content.version, count, content.t);
    view.setUint32(24, (scalars ? 1 : 0) | (content.saved ? 2 : 0) | (content.detail ? 4 : 0), true);
    view.setUint32(28, content.step, true);
    new Float32Array(data, 32, count * 3).set(content.positions);
    if (scalars) {
        const finite = scalars.filter((x) => !Number.isNaN(x));
        view.setFloat32(32 + count * 12, finite.reduce((a, b) => Math.min(a, b), Infinity), true);
        view.setFloat32(36 + count * 12, finite.reduce((a, b) => Math.max(a, b), -Infinity), true);
        new Float32Array(data, 40 + count * 12, count).set(scalars);
    }
    return data;
}

function header(
    data: ArrayBuffer, kind: number, level: number, version: number, count: number, t: number,
): DataView {
    const view = new DataView(data);
    [kind, level, version, count].forEach((value, i) => view.setUint32(i * 4, value, true));
    view.setFloat64(16, t, true);
    return view;
}
