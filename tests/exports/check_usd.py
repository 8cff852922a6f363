"""Reads a USD stage with Pixar's library, runs its validators, and compares with what was exported."""

import json
import sys

import numpy as np
from pxr import Usd, UsdGeom, UsdValidation

path, expected_path = sys.argv[1:]
with open(expected_path) as file:
    expected = json.load(file)
stage = Usd.Stage.Open(path)

validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
assert len(validators) > 10, len(validators)
errors = UsdValidation.ValidationContext(validators).Validate(stage)
assert not errors, [error.GetMessage() for error in errors]

assert stage.GetDefaultPrim().GetName() == "two_things___a_floor"
assert stage.GetDefaultPrim().GetDisplayName() == "two things & a floor"
assert UsdGeom.GetStageUpAxis(stage) == "Y" and UsdGeom.GetStageMetersPerUnit(stage) == 1
rate = stage.GetTimeCodesPerSecond()
codes = [stage.GetStartTimeCode()] + [round(t * rate, 9) for t in expected["times"][1:-1]] + [stage.GetEndTimeCode()]
assert np.allclose(np.array(codes) / rate, expected["times"], atol=1e-12), codes

meshes = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
names = [mesh.GetPrim().GetDisplayName() or mesh.GetPrim().GetName() for mesh in meshes]
assert names == expected["parts"], names
for part, mesh in enumerate(meshes):
    of_part = [f for f, p in enumerate(expected["face_part"]) if p == part]
    faces = np.array(expected["faces"])[of_part]
    vertices = np.unique(faces)
    corners = vertices[np.array(mesh.GetFaceVertexIndicesAttr().Get())].reshape(-1, 3)
    assert (corners == faces).all() and list(mesh.GetFaceVertexCountsAttr().Get()) == [3] * len(faces)
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none" and mesh.GetDoubleSidedAttr().Get()
    assert mesh.GetPointsAttr().GetTimeSamples() == ([] if part == 2 else codes)
    for code, points in zip(codes, expected["points"]):
        here = np.array(mesh.GetPointsAttr().Get(code))
        assert (here == np.float32(points)[vertices]).all(), (part, code)
        extent = np.array(mesh.GetExtentAttr().Get(code))
        assert (extent == [here.min(0), here.max(0)]).all(), (part, code)
    texture = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    assert texture.GetInterpolation() == "faceVarying"
    uv = np.float32(expected["corner_uv"]).reshape(-1, 3, 2)[of_part]
    assert (np.array(texture.ComputeFlattened()).reshape(-1, 3, 2) == uv).all()
print("all as expected")
