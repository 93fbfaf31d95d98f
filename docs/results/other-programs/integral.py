"""Light that materials reflect, by numerical integrals of the glTF 2.0 specification (appendix B, and the extensions) over all texels
of a panorama. Microfacets reflect once; what they would reflect again is added for metals, by their albedo (Fdez-Agüera 2019)."""
import math

import numpy as np

WIDTH, HEIGHT = 512, 256
HALF = 180 / math.tan(math.radians(12))  # px of a unit at distance 1, in pictures of 640 x 360 px seen with 24 degrees


def panorama(path, every):
    """Directions of blocks of `every` x `every` texels, and their irradiance when faced."""
    data = path.read_bytes()
    pixels = np.frombuffer(data[-4 * WIDTH * HEIGHT:], np.uint8).reshape(HEIGHT, WIDTH, 4).astype(float)
    light = pixels[..., :3] * np.exp2(pixels[..., 3:] - 136)
    light = light.reshape(HEIGHT // every, every, WIDTH // every, every, 3).mean((1, 3))
    rows, columns = light.shape[:2]
    theta = (np.arange(rows) + 0.5) / rows * math.pi
    phi = ((np.arange(columns) + 0.5) / columns - 0.5) * 2 * math.pi
    theta, phi = np.meshgrid(theta, phi, indexing="ij")
    # The middle of the panorama is at +Z, since it is turned by 180 degrees.
    directions = np.stack([-np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], -1)
    area = np.sin(theta) * (math.pi / rows) * (2 * math.pi / columns)
    return directions.reshape(-1, 3), (light * area[..., None]).reshape(-1, 3)


def hemisphere(n, t, b, rows=48, columns=96):
    z, phi = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns * 2 * math.pi)
    s = np.sqrt(1 - z * z)
    return ((s * np.cos(phi))[..., None] * t + (s * np.sin(phi))[..., None] * b + z[..., None] * n).reshape(-1, 3)


def ggx(n, t, b, v, lights, along, across):
    """GGX with two roughnesses times its visibility and the cosine, and the cosine between half vector and eye."""
    half = lights + v
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    nl, nv = np.clip(lights @ n, 1e-5, 1), max(n @ v, 1e-4)
    product = along * across
    f = np.stack([across * (half @ t), along * (half @ b), product * (half @ n)], -1)
    w = product / (f * f).sum(-1)
    distribution = product * w * w / math.pi
    eye = nl * math.sqrt((along * (t @ v)) ** 2 + (across * (b @ v)) ** 2 + nv * nv)
    light = nv * np.sqrt((along * (lights @ t)) ** 2 + (across * (lights @ b)) ** 2 + nl * nl)
    return np.where(lights @ n > 0, distribution * 0.5 / (eye + light) * nl, 0), np.clip((half * v).sum(-1), 0, 1)


def charlie(n, v, lights, roughness):
    """The distribution of fibres times its visibility and the cosine (Conty and Kulla 2017)."""
    a = max(roughness, 0.07) ** 2
    share = (1 - a) ** 2
    pairs = [(25.3245, 21.5473), (3.32435, 3.82987), (0.16801, 0.19823), (-1.27393, -1.97760), (-4.85967, -4.32054)]
    p, q, r, s, u = (x * share + y * (1 - share) for x, y in pairs)

    def fitted(x):
        return p / (1 + q * np.maximum(x, 1e-9) ** r) + s * x + u

    def shadow(c):
        return np.where(c < 0.5, np.exp(fitted(c)), np.exp(2 * fitted(np.array(0.5)) - fitted(1 - c)))

    half = lights + v
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    nl, nv = np.clip(lights @ n, 1e-4, 1), max(n @ v, 1e-4)
    sine = np.sqrt(np.maximum(1 - np.clip(half @ n, 0, 1) ** 2, 1e-12))
    distribution = (2 + 1 / a) * sine ** (1 / a) / (2 * math.pi)
    visibility = np.clip(1 / ((1 + shadow(np.array(nv)) + shadow(nl)) * 4 * nv * nl), 0, 1)
    return np.where(lights @ n > 0, distribution * visibility * nl, 0)


AXES = np.eye(3)


def sheen_albedo(cosine, roughness, known={}):
    key = (round(100 * cosine), roughness)
    if key not in known:
        cosine = max(key[0] / 100, 0.005)
        v = np.array([math.sqrt(1 - cosine * cosine), 0, cosine])
        lights = hemisphere(AXES[2], AXES[0], AXES[1], 64, 64)
        known[key] = charlie(AXES[2], v, lights, roughness).mean() * 2 * math.pi
    return known[key]


def metal(color, along, across=None, rotation=0):
    def reflected(n, t, b, v, lights, light):
        t, b = math.cos(rotation) * t + math.sin(rotation) * b, math.cos(rotation) * b - math.sin(rotation) * t
        weight, cosine = ggx(n, t, b, v, lights, along, across or along)
        fresnel = color + (1 - color) * ((1 - cosine) ** 5)[:, None]
        albedo = min(1, ggx(n, t, b, v, hemisphere(n, t, b), along, across or along)[0].mean() * 2 * math.pi)
        return (weight[:, None] * fresnel * light).sum(0) * (1 + color * (1 - albedo) / albedo)
    return reflected


def dielectric(color, along, across=None, sheen=None, sheen_roughness=0):
    def reflected(n, t, b, v, lights, light):
        weight, cosine = ggx(n, t, b, v, lights, along, across or along)
        fresnel = 0.04 + 0.96 * (1 - cosine) ** 5
        diffuse = (1 - fresnel) * np.clip(lights @ n, 0, None) / math.pi
        base = ((weight * fresnel)[:, None] * light).sum(0) + color * (diffuse[:, None] * light).sum(0)
        if sheen is None:
            return base
        own = sheen * (charlie(n, v, lights, sheen_roughness)[:, None] * light).sum(0)
        return own + base * (1 - sheen.max() * min(1, sheen_albedo(max(n @ v, 0), sheen_roughness)))
    return reflected


def anisotropic(roughness, strength):
    """Squared roughness along and across the direction of KHR_materials_anisotropy."""
    squared = roughness ** 2
    return squared + (1 - squared) * strength ** 2, squared


RED, GREY, WHITE, GOLD, BLUE = (np.array(c) for c in ((0.7, 0.1, 0.08), (0.4,) * 3, (0.9,) * 3, (0.9, 0.6, 0.2), (0.1, 0.25, 0.7)))
# What the balls of some scenes are. Roughness 0.05 and 0.1 are too smooth for the panorama's texels.
MATERIALS = {
    "rough-metal": [metal(np.ones(3), r * r) for r in (0.6, 0.8, 1)],
    "gold-roughness": [metal(GOLD, r * r) for r in (0.15, 0.5, 1)],
    "plastic-roughness": [dielectric(RED, r * r) for r in (0.05, 0.3, 0.7)],
    "white-roughness": [dielectric(WHITE, r * r) for r in (0.2, 0.6, 1)],
    "matte": [dielectric(np.full(3, x), 1) for x in (0.05, 0.3, 0.9)],
    "sheen-roughness": [dielectric(np.zeros(3), 1, None, np.ones(3), r) for r in (0.3, 0.5, 1)],
    "sheen-colour": [dielectric(BLUE, 0.81, None, np.array(c), 0.5) for c in ((0.9, 0.2, 0.1), (0.9, 0.8, 0.3), (0.4, 0.9, 0.9))],
    "anisotropy": [metal(WHITE, *anisotropic(0.4, s)) for s in (0.3, 0.6, 1)],
    "anisotropy-rotation": [metal(GOLD, *anisotropic(0.35, 0.8), r) for r in (0, 0.785, 1.571)],
    "anisotropy-plastic": [dielectric(RED, *anisotropic(0.3, s)) for s in (0.3, 0.6, 1)],
    "sun-matte": [dielectric(np.full(3, x), 1) for x in (0.1, 0.3, 0.6)],
    "sun-metal": [metal(GREY, r * r) for r in (0.3, 0.5, 0.8)],
}


def encoded(light):
    light = np.clip(light, 0, 1)
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def balls(name, lights, light, every=7):
    """Pixels of the three balls of a scene, row and column, with the colour that the integral gives there."""
    for k, material in enumerate(MATERIALS[name]):
        eye = np.array([-2.3 * (k - 1), 0, 10.0])
        for y in range(3, 360, every):
            for x in range(3, 640, every):
                ray = np.array([(x + 0.5 - 320) / HALF, (180 - y - 0.5) / HALF, -1])
                ray /= np.linalg.norm(ray)
                along = -(eye @ ray)
                root = along ** 2 - (eye @ eye - 1)
                if root < 0.03:
                    continue
                n = eye + (along - math.sqrt(root)) * ray
                t = np.array([n[2], 0, -n[0]])
                t = t / max(np.linalg.norm(t), 1e-9)
                yield (y, x), encoded(material(n, t, np.cross(n, t), -ray, lights, light))
