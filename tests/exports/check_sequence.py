"""Reads a folder of OBJ or PLY files with trimesh and compares with what was exported."""

import json
import os
import sys

import numpy as np
import trimesh

folder, expected_path = sys.argv[1:]
with open(expected_path) as file:
    expected = json.load(file)
files = sorted(os.listdir(folder))
assert len(files) == len(expected["times"]), files

for file, points in zip(files, expected["points"]):
    mesh = trimesh.load(os.path.join(folder, file), process=False, force="mesh")
    assert mesh.faces.shape == (9, 3), (file, mesh.faces.shape)
    # trimesh doubles vertices on the seam, so corners are compared.
    assert np.array_equal(mesh.vertices[mesh.faces], np.array(points)[np.array(expected["faces"])]), file
    uv = np.array(expected["corner_uv"]).reshape(-1, 3, 2)
    assert np.allclose(mesh.visual.uv[mesh.faces], uv, atol=1e-12), file
    if file.endswith(".ply"):
        assert mesh.metadata["_ply_raw"]["face"]["data"]["body"].ravel().tolist() == expected["face_part"], file
print("all as expected")
