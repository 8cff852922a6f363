"""Plays a PC2 point cache on the mesh beside it with Blender's Mesh Cache modifier, and compares with what was exported."""

import json
import os
import sys

import bpy

path, expected_path = sys.argv[1:]
with open(expected_path) as file:
    expected = json.load(file)

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=os.path.splitext(path)[0] + ".obj")
assert len(bpy.data.objects) == 1, [surface.name for surface in bpy.data.objects]
surface = bpy.data.objects[0]
assert [list(face.vertices) for face in surface.data.polygons] == expected["faces"]
cache = surface.modifiers.new("cache", "MESH_CACHE")
cache.cache_format = "PC2"
cache.filepath = os.path.abspath(path)

used = sorted({vertex for face in expected["faces"] for vertex in face})
assert used == list(range(len(used)))  # so that the faces have the same numbers
for frame, all_points in enumerate(expected["points"]):
    points = all_points[: len(used)]
    bpy.context.scene.frame_set(frame)
    played = surface.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices
    assert len(played) == len(points), (len(played), len(points))
    for vertex, point in zip(played, points):
        assert max(abs(a - b) for a, b in zip(vertex.co, point)) < 1e-6, (frame, vertex.index, tuple(vertex.co), point)
print("all as expected")
