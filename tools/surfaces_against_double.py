#!/usr/bin/env python3
"""How far pictures of forward and visibility are from light and surfaces in double, side by side, as a table.

Usage: surfaces_against_double.py PROGRAM [scene...]

Draws scenes of large triangles that it writes itself, the built-in ones, and the scenes or files that are
given. Figures are compare's error.surfaces, relative to the brightest channel. Ends with status 1 where
visibility's RMSE is above forward's.
"""
import base64
import json
import math
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SIZE = "640x360"
SLIVER_SEEDS = 20  # one seed's RMSE is a few pixels' chance: docs/details/visibility.md#surfaces-against-double
BUILT_IN = ["hall", "street", "terrain", "spheres", "rooms", "square"]


class Document:
    """A glTF file of triangles with one normal each, lamps and a camera."""

    def __init__(self, eye, yaw=0.3, pitch=-0.15, near=0.1, camera=None):
        self.blob, self.views, self.accessors, self.meshes, self.lights = b"", [], [], [], []
        a, b, c, d = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
        self.camera = camera or {"type": "perspective", "perspective": {"yfov": 1.0, "znear": near}}
        self.nodes = [{"camera": 0, "translation": eye, "rotation": [a * d, b * c, -b * d, a * c]}]

    def accessor(self, values, code, component, kind):
        data = struct.pack(f"<{len(values)}{code}", *values)
        self.views.append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)})
        self.blob += data
        width = 3 if kind == "VEC3" else 1
        bounds = {"min": [min(values[i::3]) for i in range(3)], "max": [max(values[i::3]) for i in range(3)]}
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "type": kind,
                               "count": len(values) // width, **(bounds if width == 3 else {})})
        return len(self.accessors) - 1

    def triangles(self, corners, normal, indices):
        flat = [x for corner in corners for x in corner]
        attributes = {"POSITION": self.accessor(flat, "f", 5126, "VEC3"),
                      "NORMAL": self.accessor(list(normal) * len(corners), "f", 5126, "VEC3")}
        indices = self.accessor(indices, "I", 5125, "SCALAR")
        self.meshes.append({"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]})
        self.nodes.append({"mesh": len(self.meshes) - 1})

    def quad(self, origin, u, v):
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.hypot(*n)
        corners = [[origin[i] + s * u[i] + t * v[i] for i in range(3)] for s, t in ((0, 0), (1, 0), (1, 1), (0, 1))]
        self.triangles(corners, [x / length for x in n], [0, 1, 2, 0, 2, 3])

    def lamps(self, count, low, high, radius):
        for _ in range(count):
            at = [random.uniform(*side) for side in zip(low, high)]
            light = {"type": "point", "intensity": 20, "range": radius, "color": [1, 0.9, 0.8]}
            self.nodes.append({"translation": at, "extensions": {"KHR_lights_punctual": {"light": len(self.lights)}}})
            self.lights.append(light)

    def write(self, path):
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(self.nodes)))}],
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": self.lights}},
            "nodes": self.nodes, "meshes": self.meshes, "accessors": self.accessors, "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.blob), "uri": "data:application/octet-stream;base64," +
                         base64.b64encode(self.blob).decode()}],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.6, 0.5, 1], "metallicFactor": 0,
                                                    "roughnessFactor": 0.5}, "doubleSided": True}],
            "cameras": [self.camera]}
        path.write_text(json.dumps(document))


def room(size, **camera):
    d = Document([0.19 * size / 2, 1.7, 0.75 * size / 2], **camera)
    h, height = size / 2, 6
    d.quad([-h, 0, h], [size, 0, 0], [0, 0, -size])
    d.quad([-h, 0, -h], [size, 0, 0], [0, height, 0])
    d.quad([-h, 0, h], [0, 0, -size], [0, height, 0])
    d.lamps(60, [-0.8 * h, 0.5, -0.8 * h], [0.8 * h, 4, 0.5 * h], max(5, size / 8))
    return d


def plane(half):
    d = Document([1.5, 1.7, 6])
    d.quad([-half, 0, half], [2 * half, 0, 0], [0, 0, -2 * half])
    d.lamps(60, [-30, 0.5, -50], [30, 4, 4], 9)
    return d


def slivers(width):
    d = Document([0, 1.7, 6], yaw=0.1, pitch=-0.25)
    for i in range(200):
        x = -5 + 0.05 * i
        end = x + 3 * (random.random() - 0.5)
        d.triangles([[x, 0, 5], [x + width * random.random(), 0, 5], [end, random.random(), -40]], [0, 1, 0], [0, 1, 2])
    d.lamps(60, [-6, 0.5, -16], [6, 4, 4], 7)
    return d


def through_the_near_plane():
    """Slanted walls that begin behind the eye and pass it closely."""
    d = Document([0, 1.7, 6], yaw=0, pitch=0, near=0.5)
    for i in range(8):
        turn = 2 * math.pi * (i + 0.3) / 8
        away = [math.cos(turn), 1.7 + math.sin(turn), 8]
        d.quad(away, [4 * math.sin(turn), -4 * math.cos(turn), 0.5], [0.5 * math.cos(turn), 0.5 * math.sin(turn), -50])
    d.lamps(60, [-2, 0, -16], [2, 4, 5], 7)
    return d


def facets():
    """Triangles of hundreds of metres at all slopes."""
    d = Document([0, 1.7, 0])
    for _ in range(60):
        corners = [[random.uniform(-400, 400), random.uniform(-60, 60), random.uniform(-800, -5)] for _ in range(3)]
        a, b = ([corners[k][i] - corners[0][i] for i in range(3)] for k in (1, 2))
        n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        d.triangles(corners, [x / math.hypot(*n) for x in n], [0, 1, 2])
    d.lamps(60, [-200, -50, -400], [200, 50, -5], 150)
    return d


def generated():
    flat = {"type": "orthographic", "orthographic": {"xmag": 8, "ymag": 4.5, "znear": 0.1, "zfar": 60}}
    far = {"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1, "zfar": 40}}
    return {
        "room of three quads, 16 m": lambda: room(16),
        "the same with a far plane at 40 m": lambda: room(16, camera=far),
        "the same, orthographic": lambda: room(16, camera=flat, pitch=-0.4),
        "room of three quads, 100 m": lambda: room(100),
        "walls through the near plane": through_the_near_plane,
        "facets of hundreds of metres": facets,
        "plane of 10 km": lambda: plane(5000),
    }


def joined(errors):
    """The errors of several scenes with about as many pixels, as of one."""
    return {"rmse_rel": math.sqrt(sum(e["rmse_rel"] ** 2 for e in errors) / len(errors)),
            "max_rel": max(e["max_rel"] for e in errors), "pixels": sum(e["pixels"] for e in errors)}


def measure_slivers(program, folder):
    """One row of all seeds."""
    measured = []
    for seed in range(1, SLIVER_SEEDS + 1):
        random.seed(seed)
        slivers(0.002).write(folder / "slivers.gltf")
        measured.append(measure(program, folder / "slivers.gltf", folder))
    forward, visibility, silhouettes = zip(*measured)
    return joined(forward), joined(visibility), sum(silhouettes)


def measure(program, scene, folder):
    out = folder / "results.json"
    done = subprocess.run([program, "compare", scene, "--size", SIZE, "--frames", "1", "--warmup", "0", "-t",
                           "forward,visibility", "-o", folder / "report", "--json", out],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if not out.exists():
        sys.exit(f"{scene}: {done.stdout.strip().splitlines()[-1]}")
    rows = {row["technique"]: row["error"] for row in json.loads(out.read_text())["rows"]}
    out.unlink()
    silhouettes = rows["visibility"]["silhouettes"]["pixels"]
    return rows["forward"]["surfaces"], rows["visibility"]["surfaces"], silhouettes


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    worse = []
    print("| scene | RMSE `forward` | RMSE `visibility` | at most `forward` | at most `visibility` | pixels | other triangle |")
    print("| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenes = {}
        for title, make in generated().items():
            random.seed(3)
            path = folder / f"{len(scenes)}.gltf"
            make().write(path)
            scenes[title] = path
        scenes[f"slivers of 2 mm by 45 m, {SLIVER_SEEDS} seeds"] = None
        scenes.update({f"`{s}`": s for s in BUILT_IN})
        scenes.update({Path(s).stem: s for s in sys.argv[2:]})
        for title, scene in scenes.items():
            forward, visibility, silhouettes = (measure(sys.argv[1], scene, folder) if scene
                                                else measure_slivers(sys.argv[1], folder))
            print(f"| {title} | {forward['rmse_rel']:.1e} | {visibility['rmse_rel']:.1e} | {forward['max_rel']:.1e} "
                  f"| {visibility['max_rel']:.1e} | {visibility['pixels']} | {silhouettes} |", flush=True)
            if visibility["rmse_rel"] > forward["rmse_rel"]:
                worse.append(title)
    if worse:
        sys.exit(f"visibility is farther from surfaces in double than forward: {', '.join(worse)}")


if __name__ == "__main__":
    main()
