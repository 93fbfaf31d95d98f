"""Prints how many seconds trimesh or pymeshlab takes to load a mesh, elapsed and of processors: peers.py trimesh|pymeshlab FILE."""

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


start, before = time.perf_counter(), time.process_time()
triangles = load()
taken, processor = time.perf_counter() - start, time.process_time() - before
assert triangles > 0, "no triangles"
print(taken, processor)
