#!/usr/bin/env python3
"""Draws what scenes.py wrote with pnaen, and compares it with pictures of renderer.mjs. Prints the rows of the page's tables.

    compare.py FOLDER THEIRS OUT

Pictures of both, ours on the left, are written to OUT. Needs pnaen, numpy and Pillow.
"""
import json, subprocess, sys, tempfile
from pathlib import Path

import numpy as np
from PIL import Image

import integral

FOLDER, THEIRS, OUT = map(Path, sys.argv[1:])
OUT.mkdir(parents=True, exist_ok=True)


def drawn(scene, *more):
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"
        # glTF asks for flat normals where a file has none.
        command = ["pnaen", "render", FOLDER / scene["file"], "--surface", "flat", "--factor", "1", "--crease-angle", "0",
                   "--file-camera", "0", "--size", "640x360", "-o", picture, *more]
        subprocess.run(command, check=True, capture_output=True)
        return np.asarray(Image.open(picture)).astype(float)


for scene in json.loads((FOLDER / "scenes.json").read_text()) + json.loads((FOLDER / "files.json").read_text()):
    name, light = scene["name"], FOLDER / f"{scene['light']}.hdr"
    ours = drawn(scene, "--environment", light, "--environment-background", "--light-rotation", "180", "--tone-curve", "none")[..., :3]
    theirs = np.asarray(Image.open(THEIRS / f"{name}.png").convert("RGB")).astype(float)
    covered = drawn(scene, "--lighting", "camera", "--transparent")[..., 3] > 250
    difference = np.abs(ours - theirs)[covered].mean()
    row = [scene["about"] or name, f"![{name}](materials/{name}.jpg)", f"{difference:.1f}"]
    if name in integral.MATERIALS:
        lights = integral.panorama(light, 1 if scene["light"] == "sun" else 2)
        pixels = list(integral.balls(name, *lights))
        row += [f"{np.mean([np.abs(picture[at] - truth) for at, truth in pixels]):.1f}" for picture in (ours, theirs)]
    else:
        row += ["", ""]
    print("|", " | ".join(row), "|", flush=True)
    pair = np.concatenate([ours, theirs], 1).astype(np.uint8)
    Image.fromarray(pair).save(OUT / f"{name}.jpg", quality=82)
