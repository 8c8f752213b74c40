#!/usr/bin/env python3
"""Tests whether two builds of the rasteriser in OpenCL cover the same pixels, as a table.

Usage: same_coverage.py OLD NEW [scene...]

Draws each triangle unlit in a colour that is its number, with `visibility` of both programs; NEW exports the scenes. Where the programs show different triangles,
each side's are drawn again without the others: if both still cover the pixel in both programs, only depth decided otherwise. Ends with status 1 if coverage differs.
"""
import json
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from exr_files import read_exr  # noqa: E402

SIZE = "641x359"
SCENES = ["hall", "street", "terrain", "spheres", "square", "rooms"]
UNIT = 2.0 ** -22  # a triangle's number times this is exact in a float, and at most 1
COMPONENTS = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}


class Triangles:
    """An exported scene's triangles by node, without sharing vertices, and its cameras."""

    def __init__(self, path):
        data = path.read_bytes()
        size = struct.unpack_from("<I", data, 12)[0]
        self.document, self.blob = json.loads(data[20:20 + size]), data[28 + size:]
        self.nodes = [(node, self.parts(node)) for node in self.document["nodes"]]

    def accessor(self, index, columns):
        accessor = self.document["accessors"][index]
        start = self.document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = np.frombuffer(self.blob, COMPONENTS[accessor["componentType"]], accessor["count"] * columns, start)
        return values.reshape(-1, columns)

    def parts(self, node):
        """(corners of all triangles, whether they are seen from both sides) of each primitive."""
        found = []
        for primitive in self.document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            positions = self.accessor(primitive["attributes"]["POSITION"], 3)
            material = self.document["materials"][primitive["material"]]
            found.append((positions[self.accessor(primitive["indices"], 1).ravel()], material.get("doubleSided", False)))
        return found

    def write(self, path, kept=lambda numbers: numbers > 0):
        """Triangles that are not kept shrink to a point."""
        out = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(self.nodes)))}],
               "nodes": [], "meshes": [], "accessors": [], "bufferViews": [], "cameras": self.document["cameras"],
               "materials": [{"doubleSided": bool(side), "extensions": {"KHR_materials_unlit": {}}} for side in range(2)],
               "extensionsUsed": ["KHR_materials_unlit"]}
        blobs, first = [], 1

        def add(values):
            offset = sum(map(len, blobs))
            blobs.append(values.astype(np.float32).tobytes())
            out["bufferViews"].append({"buffer": 0, "byteOffset": offset, "byteLength": len(blobs[-1])})
            out["accessors"].append({"bufferView": len(blobs) - 1, "componentType": 5126, "type": "VEC3", "count": len(values),
                                     "min": values.min(0).tolist(), "max": values.max(0).tolist()})
            return len(blobs) - 1

        for node, parts in self.nodes:
            node = {key: value for key, value in node.items() if key in ("matrix", "translation", "rotation", "scale", "camera")}
            primitives = []
            for corners, two_sided in parts:
                numbers = np.repeat(np.arange(first, first + len(corners) // 3), 3)
                first += len(corners) // 3
                colors = np.zeros((len(corners), 3), np.float32)
                colors[:, 0] = numbers * UNIT
                places = np.where(kept(numbers)[:, None], corners, corners[:1])
                primitives.append({"attributes": {"POSITION": add(places), "COLOR_0": add(colors)}, "material": int(two_sided)})
            if primitives:
                node["mesh"] = len(out["meshes"])
                out["meshes"].append({"primitives": primitives})
            out["nodes"].append(node)
        assert first * UNIT < 1
        blob = b"".join(blobs)
        out["buffers"] = [{"byteLength": len(blob)}]
        text = json.dumps(out).encode()
        text += b" " * (-len(text) % 4)
        path.write_bytes(struct.pack("<4s3I4s", b"glTF", 2, 28 + len(text) + len(blob), len(text), b"JSON") + text +
                         struct.pack("<I4s", len(blob), b"BIN\0") + blob)


def shown(program, path):
    """The number of the triangle at each pixel; 0 without one."""
    out = path.with_suffix(".exr")
    subprocess.run([program, "render", path, "-t", "visibility", "--gl", "none", "--size", SIZE, "-o", out], check=True,
                   capture_output=True)
    return np.rint(np.array(read_exr(out)[2]["R"]) / UNIT).astype(int)


def compare(programs, triangles, path):
    """Pixels with a surface, in one program only, with another triangle, and how many of these both triangles cover."""
    triangles.write(path)
    old, new = (shown(program, path) for program in programs)
    other = (old != new) & (old > 0) & (new > 0)
    covered = other.copy()
    for image in (old, new) if other.any() else ():
        seen = np.unique(image[other])
        triangles.write(path, lambda numbers: np.isin(numbers, seen))
        for program in programs:
            covered &= shown(program, path) > 0
    return int((old > 0).sum()), int(((old > 0) != (new > 0)).sum()), int(other.sum()), int(covered.sum())


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    programs, scenes, same = sys.argv[1:3], sys.argv[3:] or SCENES, True
    print("| scene | pixels with a surface | in one program only | other triangle | of these, covered by both in both |")
    print("| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            subprocess.run([programs[1], "frontier", "export", scene, "--size", "64x36", "--views", "1", "-o", folder], check=True,
                           capture_output=True)
            path = Path(folder) / Path(scene).stem
            surfaces, one_only, other, covered = compare(programs, Triangles(path / "scene.glb"), path / "numbers.glb")
            print(f"| {Path(scene).stem} | {surfaces} | {one_only} | {other} | {covered} |", flush=True)
            same &= one_only == 0 and other == covered
    sys.exit(not same)


if __name__ == "__main__":
    main()
