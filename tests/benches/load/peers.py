"""Prints how many seconds trimesh or pymeshlab takes to load a mesh: peers.py trimesh|pymeshlab FILE."""

import sys
import time

program, path = sys.argv[1:]
if program == "trimesh":
    import trimesh

    def load():
        return len(trimesh.load(path, force="mesh").faces)

else:
    import pymeshlab

    def load():
        meshes = pymeshlab.MeshSet()
        meshes.load_new_mesh(path)
        return meshes.current_mesh().face_number()


start = time.perf_counter()
triangles = load()
taken = time.perf_counter() - start
assert triangles > 0, "no triangles"
print(taken)
