// Validates a glTF asset with the Khronos validator, then poses it at each key and compares with what was exported.
const assert = require('node:assert');
const fs = require('node:fs');
const path = require('node:path');
const validator = require('gltf-validator');

const [assetPath, expectedPath] = process.argv.slice(2);
const expected = JSON.parse(fs.readFileSync(expectedPath, 'utf8'));
const bytes = fs.readFileSync(assetPath);
const beside = (uri) => fs.readFileSync(path.join(path.dirname(assetPath), decodeURIComponent(uri)));

function open() {
    if (assetPath.endsWith('.gltf')) {
        const json = JSON.parse(bytes.toString('utf8'));
        return { json, buffer: beside(json.buffers[0].uri) };
    }
    const jsonLength = bytes.readUInt32LE(12);
    return { json: JSON.parse(bytes.toString('utf8', 20, 20 + jsonLength)), buffer: bytes.subarray(28 + jsonLength) };
}

function numbers({ json, buffer }, accessorNumber) {
    const accessor = json.accessors[accessorNumber];
    const view = json.bufferViews[accessor.bufferView];
    const width = { SCALAR: 1, VEC2: 2, VEC3: 3 }[accessor.type];
    return Array.from({ length: accessor.count * width }, (_, i) => accessor.componentType === 5126
        ? buffer.readFloatLE(view.byteOffset + 4 * i) : buffer.readUInt32LE(view.byteOffset + 4 * i));
}

function comparePoses(asset) {
    const { json } = asset;
    const sampler = json.animations[0].samplers[0];
    const times = numbers(asset, sampler.input);
    assert.deepStrictEqual(times, expected.times.map(Math.fround));
    const weights = numbers(asset, sampler.output);
    const root = json.nodes[json.scenes[json.scene].nodes[0]];
    assert.deepStrictEqual(root.children.map((node) => json.nodes[node].name), expected.parts);
    root.children.forEach((node, part) => {
        const primitive = json.meshes[json.nodes[node].mesh].primitives[0];
        const corners = numbers(asset, primitive.indices);
        const base = numbers(asset, primitive.attributes.POSITION);
        const targets = (primitive.targets ?? []).map((target) => numbers(asset, target.POSITION));
        assert.strictEqual(targets.length, part === 2 ? 0 : times.length - 1);
        const ofPart = expected.faces.flatMap((_, f) => expected.face_part[f] === part ? [f] : []);
        const uv = numbers(asset, primitive.attributes.TEXCOORD_0);
        ofPart.forEach((f, i) => [0, 1, 2].forEach((c) => {
            const corner = corners[3 * i + c];
            const [u, v] = expected.corner_uv.slice(6 * f + 2 * c, 6 * f + 2 * c + 2);
            assert(Math.abs(uv[2 * corner] - u) < 1e-6 && Math.abs(uv[2 * corner + 1] - (1 - v)) < 1e-6);
            times.forEach((_, k) => [0, 1, 2].forEach((axis) => {
                const index = 3 * corner + axis;
                const posed = targets.reduce((sum, target, t) => sum + weights[k * targets.length + t] * target[index],
                    base[index]);
                const wanted = expected.points[k][expected.faces[f][c]][axis];
                assert(Math.abs(posed - wanted) < 1e-6, `part ${part}, time ${k}: ${posed} for ${wanted}`);
            }));
        }));
    });
}

validator.validateBytes(new Uint8Array(bytes), { externalResourceFunction: async (uri) => new Uint8Array(beside(uri)) })
    .then(({ issues }) => {
        // Texture coordinates without a texture are meant: they are for the user's own.
        const messages = issues.messages.filter((message) => message.code !== 'UNUSED_OBJECT');
        assert.deepStrictEqual(messages, []);
        comparePoses(open());
        console.log('all as expected');
    })
    .catch((error) => { console.error(error); process.exitCode = 1; });
