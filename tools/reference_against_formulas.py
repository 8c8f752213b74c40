#!/usr/bin/env python3
"""Compares `lightgrid reference` with formulas written independently, after pbrt-v4 (scattering.h: TrowbridgeReitz and
Smith's Lambda in tangents, in the surface's frame), glTF 2.0 appendix B and KHR_lights_punctual.

    reference_against_formulas.py LIGHTGRID

Writes a scene of six quads (dielectrics, metals and mixtures, one quad that casts shadows) under point, spot and
directional lights, and traces its rays analytically. Prints errors relative to the brightest channel, and ends with
status 1 if one is above BOUND. Then it plants faults into the formulas: each must exceed the bound. At last it prints how
far pbrt-v4's own models are: Fresnel's equations for an index of 1.5 in place of Schlick's term, a smoothstep in place of
a square in cones, and no end of ranges.
"""
import base64
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests" / "support"))
from exr_files import read_exr  # noqa: E402

BOUND = 1e-7
WIDTH, HEIGHT, FOV_Y = 64, 48, 1.0
EYE = (0.25, 1.5, 4.0)
# Corners, counter-clockwise; base colour, metallic, roughness. Numbers that floats hold exactly.
QUADS = [
    ([(-3, 0, 3), (3, 0, 3), (3, 0, -3), (-3, 0, -3)], (0.5, 0.5, 0.375), 0, 0.375),
    ([(-3, 0, -3), (3, 0, -3), (3, 3, -3), (-3, 3, -3)], (0.875, 0.625, 0.25), 1, 0.25),
    ([(-3, 0, 3), (-3, 0, -3), (-3, 3, -3), (-3, 3, 3)], (0.75, 0.125, 0.125), 0, 0.75),
    ([(3, 0, -3), (3, 0, 3), (3, 3, 3), (3, 3, -3)], (0.125, 0.25, 0.75), 0.5, 0.5),
    ([(-3, 3, -3), (3, 3, -3), (3, 3, 3), (-3, 3, 3)], (0.75, 0.75, 0.75), 0, 1),
    ([(-0.75, 0.75, 0.5), (0.75, 0.75, 0.5), (0.75, 0.75, -0.5), (-0.75, 0.75, -0.5)], (0.25, 0.75, 0.25), 0, 0.125)]
# Type, position, direction, colour, intensity, range (0: none), cosines of the inner and outer cone.
LIGHTS = [("point", (1.5, 2.25, -1), None, (1, 0.75, 0.5), 8, 6, None),
          ("point", (-2, 1.25, 1.5), None, (0.25, 0.5, 1), 4, 0, None),
          ("spot", (0.25, 2.75, 0.25), (0, -0.96, -0.28), (1, 1, 1), 24, 5, (0.25, 0.625)),
          ("directional", None, (0.28, -0.96, 0), (0.5, 0.5, 0.5), 0.5, 0, None)]


def sub(a, b): return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
def add(a, b, s=1): return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): return add((0, 0, 0), a, 1 / math.sqrt(dot(a, a)))


def gltf():
    """The scene as a glTF document."""
    data, views, accessors, meshes, materials, nodes, lights = b"", [], [], [], [], [], []
    for n, (corners, color, metallic, roughness) in enumerate(QUADS):
        for values, kind, target in ((corners, "VEC3", 34962), ([0, 1, 2, 0, 2, 3], "SCALAR", 34963)):
            raw = b"".join(struct.pack("<3f", *v) if kind == "VEC3" else struct.pack("<I", v) for v in values)
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(raw), "target": target})
            data += raw
            accessors.append({"bufferView": len(views) - 1, "componentType": 5126 if kind == "VEC3" else 5125,
                              "count": len(values), "type": kind})
        accessors[-2] |= {"min": [min(c[i] for c in corners) for i in range(3)],
                          "max": [max(c[i] for c in corners) for i in range(3)]}
        meshes.append({"primitives": [{"attributes": {"POSITION": 2 * n}, "indices": 2 * n + 1, "material": n}]})
        materials.append({"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic,
                                                   "roughnessFactor": roughness}})
        nodes.append({"mesh": n})
    for n, (kind, position, direction, color, intensity, range_m, cone) in enumerate(LIGHTS):
        light = {"type": kind, "color": color, "intensity": intensity} | ({"range": range_m} if range_m else {})
        if cone:
            light["spot"] = {"innerConeAngle": cone[0], "outerConeAngle": cone[1]}
        lights.append(light)
        node = {"extensions": {"KHR_lights_punctual": {"light": n}}} | ({"translation": position} if position else {})
        if direction:  # the rotation from -z: half way about the cross product
            axis, w = cross((0, 0, -1), direction), 1 - direction[2]
            node["rotation"] = [x / math.sqrt(dot(axis, axis) + w * w) for x in (*axis, w)]
        nodes.append(node)
    nodes.append({"camera": 0, "translation": EYE})
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
            "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": lights}},
            "cameras": [{"type": "perspective", "perspective": {"yfov": FOV_Y, "znear": 0.125}}],
            "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": len(data),
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}


def hit(origin, direction, corners):
    """The ray's parameter on a rectangle, or infinity."""
    x, y = sub(corners[1], corners[0]), sub(corners[3], corners[0])
    normal = cross(x, y)
    facing = dot(direction, normal)
    if facing == 0:
        return math.inf
    t = dot(sub(corners[0], origin), normal) / facing
    inside = sub(add(origin, direction, t), corners[0])
    return t if 0 <= dot(inside, x) <= dot(x, x) and 0 <= dot(inside, y) <= dot(y, y) else math.inf


def fresnel_dielectric(cosine, eta=1.5):
    across = math.sqrt(1 - (1 - cosine * cosine) / (eta * eta))
    parallel = (eta * cosine - across) / (eta * cosine + across)
    perpendicular = (cosine - eta * across) / (cosine + eta * across)
    return (parallel ** 2 + perpendicular ** 2) / 2


def brdf(wo, wi, color, metallic, roughness, change):
    """Of directions in the frame in which z is the normal, for each channel."""
    alpha = roughness if change == "alpha" else roughness * roughness
    tan2 = lambda w: (w[0] ** 2 + w[1] ** 2) / w[2] ** 2  # noqa: E731
    wm = unit(add(wo, wi))
    d = 1 / (math.pi * alpha ** 2 * wm[2] ** 4 * (1 + tan2(wm) / alpha ** 2) ** 2)
    lambdas = [(math.sqrt(1 + alpha ** 2 * tan2(w)) - 1) / 2 for w in (wo, wi)]
    g = 1 / ((1 + lambdas[0]) * (1 + lambdas[1])) if change == "separable" else 1 / (1 + sum(lambdas))
    lobe = d * g / (4 * wo[2] * wi[2])
    grazing = (1 - dot(wo, wm)) ** (4 if change == "fresnel" else 5)
    dielectric = 0.04 + 0.96 * grazing
    if change == "pbrt":
        dielectric = fresnel_dielectric(dot(wo, wm))
    return [metallic * (c + (1 - c) * grazing) * lobe +
            (1 - metallic) * (dielectric * lobe + (1 - dielectric) * c / math.pi) for c in color]


def arriving(light, point, change):
    """The direction to the light, its distance, and the irradiance on a surface that faces it."""
    kind, position, direction, _, intensity, range_m, cone = light
    if kind == "directional":
        return add((0, 0, 0), direction, -1), math.inf, intensity
    offset = sub(position, point)
    distance = math.sqrt(dot(offset, offset))
    to_light, irradiance = unit(offset), intensity / distance ** 2
    if range_m and change != "pbrt":
        irradiance *= min(max(1 - (distance / range_m) ** (2 if change == "window" else 4), 0), 1)
    if cone:
        inner, outer = math.cos(cone[0]), math.cos(cone[1])
        t = min(max((-dot(to_light, direction) - outer) / (inner - outer), 0), 1)
        irradiance *= t * t * (3 - 2 * t) if change in ("pbrt", "cone") else t * t
    return to_light, distance, irradiance


def radiance(x, y, change):
    """What a point of the image shows; y upwards."""
    scale = 2 * math.tan(FOV_Y / 2) / HEIGHT
    ray = ((x - WIDTH / 2) * scale, (y - HEIGHT / 2) * scale, -1)
    t, (corners, color, metallic, roughness) = min(((hit(EYE, ray, q[0]), q) for q in QUADS), key=lambda h: h[0])
    if t == math.inf:
        return [0, 0, 0]
    point, u = add(EYE, ray, t), unit(sub(corners[1], corners[0]))
    normal = unit(cross(u, sub(corners[3], corners[0])))
    local = lambda w: (dot(w, u), dot(w, cross(normal, u)), dot(w, normal))  # noqa: E731
    wo, total = local(unit(sub(EYE, point))), [0, 0, 0]
    for light in LIGHTS:
        to_light, distance, irradiance = arriving(light, point, change)
        wi = local(to_light)
        hidden = change != "shadows" and any(1e-3 < hit(point, to_light, q[0]) < distance
                                             for q in QUADS if q[0] is not corners)
        if wi[2] > 0 and irradiance > 0 and not hidden:
            back = brdf(wo, wi, color, metallic, roughness, change)
            total = [s + b * c * irradiance * wi[2] for s, b, c in zip(total, back, light[3])]
    return total


def main():
    with tempfile.TemporaryDirectory() as folder:
        scene, out = pathlib.Path(folder, "scene.gltf"), pathlib.Path(folder, "reference.exr")
        scene.write_text(json.dumps(gltf()))
        subprocess.run([sys.argv[1], "--quiet", "reference", scene, "--size", f"{WIDTH}x{HEIGHT}", "--places", "1",
                        "--shadows", "all", "--ambient", "0", "-o", out], check=True)
        planes = read_exr(out)[2]
    # Not where a shadow turns on the rounding of vertices.
    pixels = [(x, row) for row in range(HEIGHT) for x in range(WIDTH)
              if not any(planes["doubt." + c][row][x] for c in "RGB")]
    brightest = max(planes[c][row][x] for c in "RGB" for x, row in pixels)
    failed = False
    for change in ("", "alpha", "separable", "fresnel", "window", "cone", "shadows", "pbrt"):
        errors = []
        for x, row in pixels:
            want = radiance(x + 128.5 / 256, HEIGHT - 1 - row + 128.5 / 256, change)
            errors.append(max(abs(planes[c][row][x] - w) for c, w in zip("RGB", want)) / brightest)
        errors.sort()
        mean, p99, largest = sum(errors) / len(errors), errors[len(errors) * 99 // 100], errors[-1]
        failed |= change != "pbrt" and (largest > BOUND) != bool(change)
        print(f"{change or 'formulas':10} mean {mean:.2g}, p99 {p99:.2g}, largest {largest:.2g}")
    print(f"{len(pixels)} of {WIDTH * HEIGHT} pixels, bound {BOUND:.2g}: {'FAILED' if failed else 'passed'}")
    return failed


if __name__ == "__main__":
    sys.exit(main())
