#!/usr/bin/env python3
"""Writes OUT.gltf and OUT.bin: hills of SIDE x SIDE quads, 200 m wide, for frames with very many triangles.

    many_triangles.py hills 2240        10,035,200 triangles
    lightgrid compare hills.gltf --camera eye:0,14,60,target:0,0,0,fov:60 --lights 1000000 \\
        --light-radius 0.3,1.2 --seed 3 -t visibility --reference sampled --frames 5

Needs numpy (Debian package python3-numpy).
"""
import json
import pathlib
import sys

import numpy as np


def height(x, z):
    return 4 * np.sin(0.11 * x) * np.cos(0.13 * z) + 0.6 * np.sin(0.9 * x + 0.4 * z)


def hills(side):
    """Positions, normals (a row a vertex) and indices of two triangles a quad, counter-clockwise from above."""
    across = np.linspace(-100, 100, side + 1)
    x, z = np.meshgrid(across, across)
    step = 1e-3
    slope_x = (height(x + step, z) - height(x - step, z)) / (2 * step)
    slope_z = (height(x, z + step) - height(x, z - step)) / (2 * step)
    length = np.sqrt(slope_x**2 + slope_z**2 + 1)
    positions = np.stack([x, height(x, z), z], -1)
    normals = np.stack([-slope_x / length, 1 / length, -slope_z / length], -1)
    near_left = np.arange(side * (side + 1), dtype=np.uint32).reshape(side, side + 1)[:, :side]
    near_right, far_left = near_left + 1, near_left + side + 1
    corners = [near_left, far_left, near_right, near_right, far_left, far_left + 1]
    return (positions.astype("<f4").reshape(-1, 3), normals.astype("<f4").reshape(-1, 3),
            np.stack(corners, -1).astype("<u4").reshape(-1))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    out, side = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    positions, normals, indices = hills(side)
    parts = [positions.tobytes(), normals.tobytes(), indices.tobytes()]
    out.with_suffix(".bin").write_bytes(b"".join(parts))
    begins = np.cumsum([0] + [len(part) for part in parts]).tolist()
    of_vertices = {"componentType": 5126, "count": len(positions), "type": "VEC3"}
    box = {"min": positions.min(0).tolist(), "max": positions.max(0).tolist()}
    material = {"baseColorFactor": [0.7, 0.7, 0.72, 1], "metallicFactor": 0.1, "roughnessFactor": 0.5}
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}
    model = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "materials": [{"pbrMetallicRoughness": material}],
        "buffers": [{"uri": out.with_suffix(".bin").name, "byteLength": begins[-1]}],
        "bufferViews": [{"buffer": 0, "byteOffset": begins[i], "byteLength": len(parts[i])} for i in range(3)],
        "accessors": [
            {"bufferView": 0} | of_vertices | box,
            {"bufferView": 1} | of_vertices,
            {"bufferView": 2, "componentType": 5125, "count": len(indices), "type": "SCALAR"},
        ],
    }
    out.with_suffix(".gltf").write_text(json.dumps(model))
    print(len(indices) // 3, "triangles")


if __name__ == "__main__":
    main()
