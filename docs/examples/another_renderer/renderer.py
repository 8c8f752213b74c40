#!/usr/bin/env python3
"""A renderer that takes part in `lightgrid frontier --external renderer.json`: docs/put_your_renderer_on_the_plane.md.

Reads a request a line from standard input, draws the frame, and answers a line on standard output. Forward shading in
double, without any package: opaque triangles without textures, with point, spot and directional lights. Written from
the page and the glTF specification alone, so that its picture shows whether these suffice.
"""
import json
import math
import struct
import sys
import time


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def unit(a):
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length)


def placed(m, p, w):
    """The column-major matrix m times (p, w)."""
    return tuple(m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i] * w for i in range(3))


class Scene:
    """World space: triangles (three positions, three normals, material) and lights."""

    def __init__(self, path):
        data = open(path, "rb").read()
        length = struct.unpack_from("<I", data, 12)[0]
        self.gltf = json.loads(data[20:20 + length])
        self.bytes = data[28 + length:]
        if self.gltf.get("textures"):
            raise ValueError("this renderer has no textures")
        self.triangles, self.lights = [], []
        for node in self.gltf["nodes"]:  # all of them are roots
            if "mesh" in node:
                self.add_mesh(node)
            elif "KHR_lights_punctual" in node.get("extensions", {}):
                self.add_light(node)

    def values(self, index, components, code):
        accessor = self.gltf["accessors"][index]
        start = self.gltf["bufferViews"][accessor["bufferView"]]["byteOffset"]
        count = accessor["count"] * components
        flat = struct.unpack_from(f"<{count}{code}", self.bytes, start)
        return flat if components == 1 else [flat[i:i + components] for i in range(0, count, components)]

    def add_mesh(self, node):
        matrix = node["matrix"]
        rows = [[matrix[4 * column + row] for column in range(3)] for row in range(3)]
        # Of normals: the inverse transposed, times the determinant.
        cofactors = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])]
        mirrored = dot(rows[0], cofactors[0]) < 0
        for primitive in self.gltf["meshes"][node["mesh"]]["primitives"]:
            material = self.gltf["materials"][primitive["material"]]
            if material["alphaMode"] != "OPAQUE" or "extensions" in material:
                raise ValueError(f"material {material['name']}: this renderer has no such material")
            attributes = primitive["attributes"]
            positions = [placed(matrix, p, 1) for p in self.values(attributes["POSITION"], 3, "f")]
            sign = -1 if mirrored else 1
            normals = [tuple(sign * dot(c, n) for c in cofactors) for n in self.values(attributes["NORMAL"], 3, "f")]
            indices = self.values(primitive["indices"], 1, "I")
            for a, b, c in zip(indices[::3], indices[1::3], indices[2::3]):
                if mirrored:
                    b, c = c, b
                self.triangles.append(((positions[a], positions[b], positions[c]),
                                       (normals[a], normals[b], normals[c]), material))

    def add_light(self, node):
        extension = self.gltf["extensions"]["KHR_lights_punctual"]
        light = extension["lights"][node["extensions"]["KHR_lights_punctual"]["light"]]
        matrix = node["matrix"]
        self.lights.append({"type": light["type"], "position": matrix[12:15], "axis": unit([-v for v in matrix[8:11]]),
                            "power": [light["intensity"] * c for c in light["color"]],
                            "range": light.get("range", math.inf), "spot": light.get("spot")})


def arriving(light, position):
    """Unit vector to the light and the factor on its intensity, or None."""
    if light["type"] == "directional":
        return tuple(-v for v in light["axis"]), 1.0
    offset = minus(light["position"], position)
    squared = dot(offset, offset)
    if squared >= light["range"] ** 2 or squared == 0:
        return None
    to_light = unit(offset)
    factor = (1 - (squared / light["range"] ** 2) ** 2) / squared
    if light["spot"]:
        inner, outer = math.cos(light["spot"]["innerConeAngle"]), math.cos(light["spot"]["outerConeAngle"])
        factor *= min(max((-dot(light["axis"], to_light) - outer) / (inner - outer), 0), 1) ** 2
    return to_light, factor


def shade(scene, request, position, normal, material):
    pbr = material["pbrMetallicRoughness"]
    base, metallic = pbr["baseColorFactor"][:3], pbr["metallicFactor"]
    alpha2 = max(pbr["roughnessFactor"], 0.045) ** 4
    f0 = [0.04 * (1 - metallic) + b * metallic for b in base]
    diffuse = [b * (1 - metallic) for b in base]
    orthographic = "fov_y_rad" not in request
    to_eye = [-v for v in request["direction"]] if orthographic else unit(minus(request["eye"], position))
    n_v = max(dot(normal, to_eye), 1e-4)
    radiance = [a * (d + f) + e for a, d, f, e in zip(request["ambient"], diffuse, f0, material["emissiveFactor"])]
    for light in scene.lights:
        arrival = arriving(light, position)
        n_l = dot(normal, arrival[0]) if arrival else 0
        if n_l <= 0 or arrival[1] == 0:
            continue
        half = unit(tuple(a + b for a, b in zip(arrival[0], to_eye)))
        n_h = dot(normal, half)
        d = alpha2 / (math.pi * (n_h * n_h * (alpha2 - 1) + 1) ** 2)
        v = 0.5 / (n_l * math.sqrt(n_v * n_v * (1 - alpha2) + alpha2) + n_v * math.sqrt(n_l * n_l * (1 - alpha2) + alpha2))
        grazing = (1 - dot(to_eye, half)) ** 5
        lobe = d * v
        for i in range(3):
            # mix(dielectric, metal, metallic): both have Schlick's Fresnel, with 0.04 and the base colour.
            fresnel = f0[i] + (1 - f0[i]) * grazing
            under = diffuse[i] * (1 - (0.04 + 0.96 * grazing)) / math.pi
            radiance[i] += (under + fresnel * lobe) * n_l * arrival[1] * light["power"][i]
    return radiance


def nearest_surfaces(scene, request):
    """{pixel: (depth, triangle, barycentric weights)}; row 0 at the top."""
    width, height = request["size"]
    view, clip = request["view_from_world"], request["clip_from_view"]
    to_clip = [[sum(clip[4 * r + k] * view[4 * k + c] for k in range(4)) for c in range(4)] for r in range(4)]
    rows = to_clip[0], to_clip[1], to_clip[3], to_clip[2]
    found = {}
    for triangle in scene.triangles:
        corners = []
        for p in triangle[0]:
            x, y, w, z = (r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3] for r in rows)
            corners.append(((x / w + 1) / 2 * width, (1 - y / w) / 2 * height, 1 / w, z / w) if w > 0 else None)
        if None in corners:  # crosses the eye's plane, or is behind it: this renderer does not clip
            continue
        (ax, ay, aw, az), (bx, by, bw, bz), (cx, cy, cw, cz) = corners
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if area > 0 and not triangle[2]["doubleSided"] or area == 0:  # y grows downwards: front faces are below 0
            continue
        x0, x1 = math.ceil(min(ax, bx, cx) - 0.5), math.floor(max(ax, bx, cx) - 0.5)
        y0, y1 = math.ceil(min(ay, by, cy) - 0.5), math.floor(max(ay, by, cy) - 0.5)
        for y in range(max(y0, 0), min(y1, height - 1) + 1):
            for x in range(max(x0, 0), min(x1, width - 1) + 1):
                px, py = x + 0.5, y + 0.5
                a = ((bx - px) * (cy - py) - (cx - px) * (by - py)) / area
                b = ((cx - px) * (ay - py) - (ax - px) * (cy - py)) / area
                c = 1 - a - b
                if a < 0 or b < 0 or c < 0:
                    continue
                depth = a * az + b * bz + c * cz  # 1 at the near plane
                if 0 <= depth <= 1 and depth > found.get((x, y), (-1,))[0]:
                    weights = a * aw, b * bw, c * cw
                    total = sum(weights)
                    found[x, y] = depth, triangle, [w / total for w in weights], area > 0
    return found


def mixed(corners, weights):
    return tuple(sum(w * p[i] for w, p in zip(weights, corners)) for i in range(3))


def draw(scene, request):
    width, height = request["size"]
    picture = [request["background"]] * (width * height)
    for (x, y), (_, triangle, weights, back) in nearest_surfaces(scene, request).items():
        normal = unit(mixed([unit(n) for n in triangle[1]], weights))
        if back:
            normal = tuple(-v for v in normal)
        picture[y * width + x] = shade(scene, request, mixed(triangle[0], weights), normal, triangle[2])
    return picture


def write_exr(path, width, height, picture):
    """Floats, not compressed, row 0 at the top."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(c + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels)
    header += attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", box)
    header += attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    size = 8 + 12 * width
    first = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header + struct.pack(f"<{height}Q", *(first + y * size for y in range(height))))
        for y in range(height):
            row = picture[y * width:(y + 1) * width]
            file.write(struct.pack("<ii", y, 12 * width))
            for channel in (2, 1, 0):
                file.write(struct.pack(f"<{width}f", *(pixel[channel] for pixel in row)))


def main():
    scenes = {}
    for line in sys.stdin:
        request = json.loads(line)
        try:
            if request["scene"] not in scenes:  # loading is no part of a frame's time
                scenes[request["scene"]] = Scene(request["scene"])
            begin = time.perf_counter()
            picture = draw(scenes[request["scene"]], request)
            answer = {"frame_ms": 1000 * (time.perf_counter() - begin)}
            if request["picture"]:
                write_exr(request["picture"], *request["size"], picture)
        except (KeyError, OSError, ValueError) as error:
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
