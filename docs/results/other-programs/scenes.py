#!/usr/bin/env python3
"""Writes documents about one feature of glTF materials each, panoramas, a table, and lists of the documents.

    scenes.py FOLDER [FILE...]

A document has three balls of radius 1 beside each other, with three values of the feature, and a camera. Each FILE, a glTF file, is
copied with such a camera. Needs numpy and Pillow, and `pnaen` for the bounds of files.
"""
import json, math, shutil, struct, subprocess, sys, zlib
from pathlib import Path

import numpy as np
from PIL import Image

from integral import sheen_albedo

COLUMNS, ROWS = 96, 48
STUDIO_GREY = 0.25


def ball(uv_scale=1.0):
    """Positions, normals, tangents, texture coordinates and indices of a ball."""
    rows = []
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            u, v = i / COLUMNS, j / ROWS
            theta, phi = math.pi * v, 2 * math.pi * u
            n = (-math.cos(phi) * math.sin(theta), math.cos(theta), math.sin(phi) * math.sin(theta))
            t = (math.sin(phi), 0.0, math.cos(phi), 1.0)
            rows.append((n, n, t, (u * 2 * uv_scale, v * uv_scale)))
    triangles = []
    for j in range(ROWS):
        for i in range(COLUMNS):
            a = j * (COLUMNS + 1) + i
            b, c, d = a + 1, a + COLUMNS + 1, a + COLUMNS + 2
            if j > 0:
                triangles += [a, c, b]
            if j < ROWS - 1:
                triangles += [b, c, d]
    return rows, triangles


def png(pixels, size):
    """A PNG file of `size` x `size` pixels, each of four bytes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    lines = b"".join(b"\0" + pixels[4 * size * y:4 * size * (y + 1)] for y in range(size))
    head = struct.pack(">IIBBBBB", size, size, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b"")


def image(color, size=256):
    """An image whose pixel at (u, v) is `color(u, v)`, four numbers from 0 to 1."""
    pixels = bytearray()
    for y in range(size):
        for x in range(size):
            pixels += bytes(max(0, min(255, round(255 * c))) for c in color((x + 0.5) / size, (y + 0.5) / size))
    return png(bytes(pixels), size)


def smooth(x):
    return 0.5 - 0.5 * math.cos(2 * math.pi * x)


def waves(u, v):
    """A normal map of waves, in both directions."""
    dx, dy = 0.35 * math.cos(8 * math.pi * u), 0.35 * math.cos(8 * math.pi * v)
    length = math.sqrt(1 + dx * dx + dy * dy)
    return (0.5 + 0.5 * dx / length, 0.5 + 0.5 * dy / length, 0.5 + 0.5 / length, 1)


IMAGES = {
    "squares": lambda u, v: (0.9, 0.55, 0.2, 1) if (int(4 * u) + int(4 * v)) % 2 else (0.15, 0.3, 0.6, 1),
    "rough": lambda u, v: (1, 0.1 + 0.8 * smooth(2 * u), smooth(2 * v), 1),
    "waves": waves,
    "share": lambda u, v: (smooth(2 * u),) * 4,
    "holes": lambda u, v: (0.8, 0.5, 0.3, 1 if (int(6 * u) + int(6 * v)) % 2 else 0),
    "veil": lambda u, v: (0.8, 0.5, 0.3, 0.2 + 0.6 * smooth(2 * u)),
    "tint": lambda u, v: (1, 0.4 + 0.6 * smooth(2 * u), 0.4 + 0.6 * smooth(2 * v), 1),
    "turned": lambda u, v: (0.5 + 0.5 * math.cos(2 * math.pi * u), 0.5 + 0.5 * math.sin(2 * math.pi * u), 1, 1),
    "lamps": lambda u, v: (1, 0.8, 0.3, 1) if (u * 4 % 1 - 0.5) ** 2 + (v * 4 % 1 - 0.5) ** 2 < 0.08 else (0, 0, 0, 1),
}


class Document:
    def __init__(self):
        self.bytes, self.images, self.json = b"", {}, {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
            "accessors": [], "bufferViews": [], "cameras": [{"type": "perspective", "perspective": {
                "yfov": math.radians(24), "aspectRatio": 16 / 9, "znear": 0.1, "zfar": 100}}]}
        self.node({"camera": 0, "translation": [0, 0, 10]})

    def node(self, node):
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]))
        self.json["nodes"].append(node)

    def view(self, data):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, kind, component=5126):
        flat = [x for value in values for x in value] if kind != "SCALAR" else values
        data = struct.pack(f"<{len(flat)}{'f' if component == 5126 else 'I'}", *flat)
        accessor = {"bufferView": self.view(data), "componentType": component, "count": len(values), "type": kind}
        if kind == "VEC3":
            accessor |= {"min": [min(c) for c in zip(*values)], "max": [max(c) for c in zip(*values)]}
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def texture(self, name, **more):
        """A reference to an image by its name, with members of its own."""
        if name not in self.images:
            self.images[name] = len(self.images)
            self.json.setdefault("images", []).append({"bufferView": self.view(image(IMAGES[name])), "mimeType": "image/png"})
            self.json.setdefault("textures", []).append({"source": self.images[name]})
        return {"index": self.images[name], **more}

    def used(self, value):
        if isinstance(value, dict):
            if "extensions" in value:
                self.json.setdefault("extensionsUsed", [])
                self.json["extensionsUsed"] += [name for name in value["extensions"] if name not in self.json["extensionsUsed"]]
            for inner in value.values():
                self.used(inner)

    def mesh(self, rows, triangles, material, at=(0, 0, 0), colors=None, second=None):
        self.used(material)
        self.json["materials"].append(material)
        attributes = {name: self.accessor([row[k] for row in rows], kind) for k, (name, kind) in enumerate(
            [("POSITION", "VEC3"), ("NORMAL", "VEC3"), ("TANGENT", "VEC4"), ("TEXCOORD_0", "VEC2")])}
        if colors:
            attributes["COLOR_0"] = self.accessor([colors(*row[0]) for row in rows], "VEC4")
        if second:
            attributes["TEXCOORD_1"] = self.accessor([(row[3][0] * second, row[3][1] * second) for row in rows], "VEC2")
        primitive = {"attributes": attributes, "indices": self.accessor(triangles, "SCALAR", 5125),
                     "material": len(self.json["materials"]) - 1}
        self.json["meshes"].append({"primitives": [primitive]})
        self.node({"mesh": len(self.json["meshes"]) - 1, "translation": list(at)})

    def wall(self):
        """A wall of coloured stripes behind the balls."""
        corners = [(-4.2, -1.6), (4.2, -1.6), (4.2, 1.6), (-4.2, 1.6)]
        rows = [((x, y, -2.2), (0, 0, 1), (1, 0, 0, 1), ((x + 4.2) / 2.1, (1.6 - y) / 2.1)) for x, y in corners]
        self.mesh(rows, [0, 1, 2, 0, 2, 3], pbr(1, 0, baseColorTexture=self.texture("squares")))

    def light(self, light, **node):
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        self.json.setdefault("extensionsUsed", []).append("KHR_lights_punctual")
        self.node({"extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}, **node})

    def glb(self):
        self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        data = self.bytes + b"\0" * (-len(self.bytes) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
        return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def pbr(roughness, metallic, color=(1, 1, 1, 1), extensions=None, more=None, **members):
    inner = {"roughnessFactor": roughness, "metallicFactor": metallic, "baseColorFactor": list(color), **members}
    return {"pbrMetallicRoughness": inner, **({"extensions": extensions} if extensions else {}), **(more or {})}


RED, GREY, WHITE, GOLD, BLUE = (0.7, 0.1, 0.08, 1), (0.4, 0.4, 0.4, 1), (0.9, 0.9, 0.9, 1), (0.9, 0.6, 0.2, 1), (0.1, 0.25, 0.7, 1)


def ext(name, **members):
    return {f"KHR_materials_{name}": members}


def glass(d, roughness, color=(1, 1, 1, 1), transmission=None, volume=None, ior=None):
    e = ext("transmission", transmissionFactor=1.0, **(transmission or {}))
    e |= ext("volume", **volume) if volume else {}
    e |= ext("ior", ior=ior) if ior else {}
    return pbr(roughness, 0, color, e)


# Name, what it is about, three values, a material from document and value, and what else is in the scene.
SCENES = [
    ("metal-roughness", "a white metal, roughness", (0.05, 0.3, 0.7), lambda d, x: pbr(x, 1), ""),
    ("rough-metal", "a rough white metal, roughness", (0.6, 0.8, 1), lambda d, x: pbr(x, 1), ""),
    ("gold-roughness", "a coloured metal, roughness", (0.15, 0.5, 1), lambda d, x: pbr(x, 1, GOLD), ""),
    ("plastic-roughness", "a red dielectric, roughness", (0.05, 0.3, 0.7), lambda d, x: pbr(x, 0, RED), ""),
    ("white-roughness", "a white dielectric, roughness", (0.2, 0.6, 1), lambda d, x: pbr(x, 0, WHITE), ""),
    ("metalness", "metalness", (0, 0.5, 1), lambda d, x: pbr(0.35, x, GOLD), ""),
    ("matte", "brightness of a matte surface", (0.05, 0.3, 0.9), lambda d, x: pbr(1, 0, (x, x, x, 1)), ""),
    ("base-colour-map", "an image of the base colour, roughness", (0.1, 0.5, 1),
     lambda d, x: pbr(x, 0, baseColorTexture=d.texture("squares")), ""),
    ("metal-rough-map", "an image of metalness and roughness, base colour", (GOLD, GREY, BLUE),
     lambda d, x: pbr(1, 1, x, metallicRoughnessTexture=d.texture("rough")), ""),
    ("normal-map", "a normal map, roughness", (0.15, 0.4, 0.9),
     lambda d, x: pbr(x, 1, GREY, more={"normalTexture": d.texture("waves")}), ""),
    ("normal-scale", "scale of a normal map", (0.3, 1, 2),
     lambda d, x: pbr(0.4, 0, RED, more={"normalTexture": d.texture("waves", scale=x)}), ""),
    ("occlusion", "strength of occlusion", (0.3, 0.7, 1),
     lambda d, x: pbr(0.6, 0, WHITE, more={"occlusionTexture": d.texture("share", strength=x)}), ""),
    ("occlusion-metal", "occlusion on a metal, roughness", (0.1, 0.4, 0.9),
     lambda d, x: pbr(x, 1, GOLD, more={"occlusionTexture": d.texture("share")}), ""),
    ("second-coordinates", "occlusion at second coordinates, strength", (0.3, 0.7, 1),
     lambda d, x: pbr(0.6, 0, WHITE, more={"occlusionTexture": d.texture("share", strength=x, texCoord=1)}), "second"),
    ("emission", "emission", (0.1, 0.4, 0.9), lambda d, x: pbr(0.5, 0, (0, 0, 0, 1), more={"emissiveFactor": [x, x / 2, x / 4]}), ""),
    ("emission-map", "an image of emission, factor", (0.2, 0.5, 1),
     lambda d, x: pbr(0.5, 0, GREY, more={"emissiveFactor": [x, x, x], "emissiveTexture": d.texture("lamps")}), ""),
    ("emission-strength", "strength of emission", (0.5, 2, 5),
     lambda d, x: pbr(0.5, 0, GREY, ext("emissive_strength", emissiveStrength=x), {"emissiveFactor": [0.3, 0.15, 0.05]}), ""),
    ("mask", "a mask, cutoff", (0.25, 0.5, 0.75), lambda d, x: pbr(0.5, 0, more={
        "alphaMode": "MASK", "alphaCutoff": x, "doubleSided": True}, baseColorTexture=d.texture("holes")), ""),
    ("blend", "alpha of a blended surface", (0.2, 0.5, 0.8),
     lambda d, x: pbr(0.5, 0, (*RED[:3], x), more={"alphaMode": "BLEND"}), "wall"),
    ("blend-map", "an image of alpha, base colour", (WHITE, RED, BLUE),
     lambda d, x: pbr(0.5, 0, x, more={"alphaMode": "BLEND"}, baseColorTexture=d.texture("veil")), "wall"),
    ("unlit", "an unlit surface", (RED, WHITE, BLUE), lambda d, x: pbr(0.5, 0, x, {"KHR_materials_unlit": {}}), ""),
    ("vertex-colours", "vertex colours, roughness", (0.2, 0.5, 1), lambda d, x: pbr(x, 0), "colors"),
    ("texture-transform", "a texture transform, rotation", (0, 0.5, 1.2), lambda d, x: pbr(0.8, 0, baseColorTexture=d.texture(
        "squares", extensions={"KHR_texture_transform": {"rotation": x, "scale": [1.5, 0.75], "offset": [0.1, 0.2]}})), ""),
    ("ior", "index of refraction", (1.0, 1.33, 2.4), lambda d, x: pbr(0.15, 0, BLUE, ext("ior", ior=x)), ""),
    ("specular", "strength of specular reflection", (0, 0.5, 1), lambda d, x: pbr(0.15, 0, RED, ext("specular", specularFactor=x)), ""),
    ("specular-colour", "colour of specular reflection", ([1, 0.5, 0.2], [0.2, 1, 0.4], [0.3, 0.5, 2]),
     lambda d, x: pbr(0.2, 0, GREY, ext("specular", specularColorFactor=x)), ""),
    ("specular-maps", "images of specular reflection, roughness", (0.1, 0.3, 0.6), lambda d, x: pbr(x, 0, RED, ext(
        "specular", specularTexture=d.texture("share"), specularColorTexture=d.texture("tint"))), ""),
    ("coat", "strength of a clear coat", (0.3, 0.6, 1),
     lambda d, x: pbr(0.7, 0, RED, ext("clearcoat", clearcoatFactor=x)), ""),
    ("coat-roughness", "roughness of a clear coat", (0.1, 0.3, 0.7),
     lambda d, x: pbr(0.7, 0, BLUE, ext("clearcoat", clearcoatFactor=1, clearcoatRoughnessFactor=x)), ""),
    ("coat-metal", "a clear coat over a metal, the metal's roughness", (0.2, 0.5, 0.9),
     lambda d, x: pbr(x, 1, GOLD, ext("clearcoat", clearcoatFactor=1)), ""),
    ("coat-normal-map", "a coat's normal map, scale", (0.3, 1, 2),
     lambda d, x: pbr(0.7, 0, RED, ext("clearcoat", clearcoatFactor=1, clearcoatNormalTexture=d.texture("waves", scale=x))), ""),
    ("sheen-roughness", "a white sheen over black, roughness", (0.3, 0.5, 1), lambda d, x: pbr(
        1, 0, (0, 0, 0, 1), ext("sheen", sheenColorFactor=[1, 1, 1], sheenRoughnessFactor=x)), ""),
    ("sheen-colour", "colour of a sheen over blue", ([0.9, 0.2, 0.1], [0.9, 0.8, 0.3], [0.4, 0.9, 0.9]), lambda d, x: pbr(
        0.9, 0, BLUE, ext("sheen", sheenColorFactor=x, sheenRoughnessFactor=0.5)), ""),
    ("anisotropy", "strength of anisotropy, a metal", (0.3, 0.6, 1),
     lambda d, x: pbr(0.4, 1, WHITE, ext("anisotropy", anisotropyStrength=x)), ""),
    ("anisotropy-rotation", "rotation of anisotropy", (0, 0.785, 1.571),
     lambda d, x: pbr(0.35, 1, GOLD, ext("anisotropy", anisotropyStrength=0.8, anisotropyRotation=x)), ""),
    ("anisotropy-plastic", "strength of anisotropy, a dielectric", (0.3, 0.6, 1),
     lambda d, x: pbr(0.3, 0, RED, ext("anisotropy", anisotropyStrength=x)), ""),
    ("anisotropy-map", "an image of anisotropy, roughness", (0.2, 0.4, 0.6),
     lambda d, x: pbr(x, 1, WHITE, ext("anisotropy", anisotropyStrength=1, anisotropyTexture=d.texture("turned"))), ""),
    ("transmission", "share of transmission through a thin surface", (0.3, 0.6, 1),
     lambda d, x: pbr(0.1, 0, WHITE, ext("transmission", transmissionFactor=x)), "wall"),
    ("transmission-roughness", "transmission through a thin rough surface, roughness", (0.1, 0.3, 0.6),
     lambda d, x: glass(d, x), "wall"),
    ("transmission-colour", "transmission through a coloured surface", (RED, GOLD, BLUE), lambda d, x: glass(d, 0.05, x), "wall"),
    ("transmission-map", "an image of transmission, roughness", (0.05, 0.2, 0.4),
     lambda d, x: glass(d, x, GOLD, {"transmissionTexture": d.texture("share")}), "wall"),
    ("volume-ior", "refraction in a body, index", (1.1, 1.33, 1.5),
     lambda d, x: glass(d, 0, volume={"thicknessFactor": 1.0}, ior=x), "wall"),
    ("volume-attenuation", "absorption in a body, distance", (0.5, 1, 3), lambda d, x: glass(
        d, 0, volume={"thicknessFactor": 1.0, "attenuationDistance": x, "attenuationColor": [0.9, 0.4, 0.2]}), "wall"),
    ("volume-roughness", "refraction in a rough body, roughness", (0.1, 0.25, 0.5),
     lambda d, x: glass(d, x, volume={"thicknessFactor": 1.0}), "wall"),
    ("volume-map", "an image of thickness, index", (1.2, 1.4, 1.6), lambda d, x: glass(
        d, 0.05, volume={"thicknessFactor": 1.5, "thicknessTexture": d.texture("share")}, ior=x), "wall"),
    ("directional", "a directional light of the file, roughness", (0.2, 0.5, 1), lambda d, x: pbr(x, 0, RED), "directional"),
    ("point", "a point light of the file, roughness", (0.2, 0.5, 1), lambda d, x: pbr(x, 1, GOLD), "point"),
    ("spot", "a spot light of the file, roughness", (0.2, 0.5, 1), lambda d, x: pbr(x, 0, WHITE), "spot"),
    ("sun-matte", "a matte surface under a small sun, brightness", (0.1, 0.3, 0.6), lambda d, x: pbr(1, 0, (x, x, x, 1)), "sun"),
    ("sun-metal", "a metal under a small sun, roughness", (0.3, 0.5, 0.8), lambda d, x: pbr(x, 1, GREY), "sun"),
]


def made(name, values, material, extra):
    document = Document()
    for k, value in enumerate(values):
        rows, triangles = ball()
        color = (lambda x, y, z: (0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * z, 1)) if extra == "colors" else None
        document.mesh(rows, triangles, material(document, value), (2.3 * (k - 1), 0, 0), color, 2 if extra == "second" else None)
    if extra == "wall":
        document.wall()
    if extra == "directional":
        document.light({"type": "directional", "intensity": 3}, rotation=[-0.3, 0.3, 0, 0.9055])
    if extra == "point":
        document.light({"type": "point", "intensity": 20}, translation=[0, 2, 2.5])
    if extra == "spot":
        spot = {"innerConeAngle": 0.2, "outerConeAngle": 0.6}
        document.light({"type": "spot", "intensity": 60, "spot": spot}, translation=[0, 0, 5])
    return document.glb()


def panorama(sun):
    """A Radiance file: three lamps in grey surroundings, or a sun of 2 x 2 px in a sky over a darker ground."""
    width, height = 512, 256
    lamps = [((200, 280, 32, 72), 4), ((60, 100, 80, 140), 2), ((400, 460, 100, 120), 3)]
    data = bytearray(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
    for y in range(height):
        for x in range(width):
            if sun:
                light = (6000,) * 3 if 180 <= x < 182 and 70 <= y < 72 else (0.3, 0.45, 0.7) if y < height / 2 else (0.15, 0.13, 0.1)
            else:
                lit = [radiance for (left, right, top, bottom), radiance in lamps if left <= x < right and top <= y < bottom]
                light = (lit[0] if lit else STUDIO_GREY,) * 3
            exponent = math.frexp(max(light))[1]
            data += bytes(min(255, int(c * 256 / 2 ** exponent)) for c in light) + bytes([exponent + 128])
    return bytes(data)


def with_camera(file, folder):
    """Copies a glTF file with what is beside it, and gives it a camera that sees all of it from the front, right and above."""
    info = json.loads(subprocess.run(["pnaen", "info", file, "--json"], capture_output=True, check=True).stdout)
    low, high = (np.array(info["bounds"][end]) for end in ("min", "max"))
    middle, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    back = np.array([0.45, 0.3, 1]) / np.linalg.norm([0.45, 0.3, 1])
    right = np.array([back[2], 0, -back[0]]) / np.hypot(back[2], back[0])
    columns = [right, np.cross(back, right), back, middle + 2.2 * radius * back]
    matrix = [float(x) for column, last in zip(columns, (0, 0, 0, 1)) for x in (*column, last)]
    data = Path(file).read_bytes()
    length = struct.unpack("<I", data[12:16])[0] if data[:4] == b"glTF" else None
    document = json.loads(data[20:20 + length] if length else data)
    for node in document["nodes"]:
        node.pop("camera", None)
    perspective = {"yfov": math.radians(40), "aspectRatio": 16 / 9, "znear": radius * 0.05, "zfar": radius * 10}
    document["cameras"] = [{"type": "perspective", "perspective": perspective}]
    document["nodes"].append({"camera": 0, "matrix": matrix})
    document["scenes"][document.get("scene", 0)]["nodes"].append(len(document["nodes"]) - 1)
    name = Path(file).stem
    if not length:
        shutil.copytree(Path(file).parent, folder / name, dirs_exist_ok=True, copy_function=shutil.copyfile)
        (folder / name / f"{name}.gltf").write_text(json.dumps(document))
        return name, f"{name}/{name}.gltf"
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length:]
    head = struct.pack("<IIIII", 0x46546C67, 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
    (folder / f"{name}.glb").write_bytes(head + text + rest)
    return name, f"{name}.glb"


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for sun in (False, True):
        (folder / f"{'sun' if sun else 'lamps'}.hdr").write_bytes(panorama(sun))
    scenes = []
    for name, about, values, material, extra in SCENES:
        (folder / f"{name}.glb").write_bytes(made(name, values, material, extra))
        light = "sun" if extra == "sun" else "lamps"
        scenes.append({"name": name, "file": f"{name}.glb", "about": about, "light": light})
    files = [with_camera(file, folder) for file in sys.argv[2:]]
    files = [{"name": name, "file": file, "about": "", "light": "lamps"} for name, file in files]
    (folder / "scenes.json").write_text(json.dumps(scenes, indent=1))
    (folder / "files.json").write_text(json.dumps(files, indent=1))
    # The renderer's library reads a table that isn't in its package: the albedo of a sheen by cosine and roughness.
    table = [[sheen_albedo((i + 0.5) / 64, (j + 0.5) / 64) for i in range(64)] for j in range(64)]
    Image.fromarray((255 * np.clip(table, 0, 1)).round().astype(np.uint8)).save(folder / "sheen.png")


main()
