// Smooth normals, on typed arrays and without allocation: this runs for every set of positions that arrives.

/** Writes to `normals` the normalised sum of the area-weighted normals of the faces around each vertex. */
export function vertexNormals(positions: Float32Array, corners: Uint32Array, normals: Float32Array): void {
    normals.fill(0);
    for (let f = 0; f < corners.length; f += 3) {
        const a = corners[f]! * 3;
        const b = corners[f + 1]! * 3;
        const c = corners[f + 2]! * 3;
        const ax = positions[a]!;
        const ay = positions[a + 1]!;
        const az = positions[a + 2]!;
        const ux = positions[b]! - ax;
        const uy = positions[b + 1]! - ay;
        const uz = positions[b + 2]! - az;
        const vx = positions[c]! - ax;
        const vy = positions[c + 1]! - ay;
        const vz = positions[c + 2]! - az;
        const nx = uy * vz - uz * vy;
        const ny = uz * vx - ux * vz;
        const nz = ux * vy - uy * vx;
        normals[a]! += nx;
        normals[a + 1]! += ny;
        normals[a + 2]! += nz;
        normals[b]! += nx;
        normals[b + 1]! += ny;
        normals[b + 2]! += nz;
        normals[c]! += nx;
        normals[c + 1]! += ny;
        normals[c + 2]! += nz;
    }
    for (let i = 0; i < normals.length; i += 3) {
        const x = normals[i]!;
        const y = normals[i + 1]!;
        const z = normals[i + 2]!;
        const length = Math.sqrt(x * x + y * y + z * z);
        const scale = length > 0 ? 1 / length : 0;
        normals[i] = x * scale;
        normals[i + 1] = y * scale;
        normals[i + 2] = z * scale;
    }
}
