"""Scenes: built-in ones, glTF files, and arrays."""
from __future__ import annotations

import json
from typing import Any, Iterable, Mapping, Sequence

import numpy as np

from . import _arrays as arrays
from ._arrays import Camera, Projection
from ._c import InputError, check, encoded, ffi, lib, made, warned, word, words

_maps = ("base_color_map", "metallic_roughness_map", "normal_map", "occlusion_map", "emissive_map")
_alphas = {"opaque": 0, "mask": 1, "blend": 2}


def _fields(fields: Mapping[str, Any]) -> Any:
    """Keyword arguments as the command line's options: size=(640, 360), shadows="all", light_radius=(1, 2)."""
    pairs = []
    for name, value in fields.items():
        if value is None:
            continue
        if name == "size" and np.iterable(value) and not isinstance(value, str):
            value = "x".join(word(v) for v in value)
        elif name == "camera":
            value = arrays.camera_word(value)
        pairs.append((name, value))
    return words(pairs)


class Scene:
    """Scene("hall", size=(640, 360), lights=255): a built-in scene or a .gltf or .glb file, with the command line's
    options as keyword arguments (see fields()). It may serve several devices as long as nothing changes it."""

    def __init__(self, name: str, **fields: Any) -> None:
        self._handle = made("lightgrid_scene", lib.lightgrid_scene_free,
                            lambda out: lib.lightgrid_scene_load(encoded(name), _fields(fields), out))
        #: What loading warned of, as in results.json: a list of dictionaries of text, settings and command.
        self.warnings: list[dict[str, Any]] = warned()

    @classmethod
    def empty(cls, name: str = "scene", **fields: Any) -> "Scene":
        """Without anything yet; fields as above, which apply at the first view."""
        scene = cls.__new__(cls)
        scene._handle = made("lightgrid_scene", lib.lightgrid_scene_free,
                             lambda out: lib.lightgrid_scene_create(encoded(name), _fields(fields), out))
        scene.warnings = warned()
        return scene

    @classmethod
    def from_arrays(cls, meshes: Iterable[Mapping[str, Any]], lights: Any = None, ambient: Any = None,
                    background: Any = None, name: str = "scene", **fields: Any) -> "Scene":
        """Each mesh is a dictionary: positions and indices, and where wanted normals, uv, colors, material (a dictionary as
        add_material has it, or its number), at (a matrix or a list of them), casts_shadow."""
        scene = cls.empty(name, **fields)
        for number, mesh in enumerate(meshes):
            mesh = dict(mesh)
            at = arrays.real_array(mesh.pop("at", np.eye(4)), np.float64, "at")
            casts = mesh.pop("casts_shadow", True)
            material = mesh.pop("material", {})
            if isinstance(material, Mapping):
                material = scene.add_material(**material)
            try:
                added = scene.add_mesh(material=material, **mesh)
            except TypeError as error:
                raise InputError(f"meshes[{number}]: {error}", f"meshes[{number}]") from None
            for matrix in at.reshape(-1, 4, 4) if at.ndim == 3 else [at]:
                scene.add_instance(added, matrix, casts)
        scene.set_ambient(ambient, background)
        if lights is not None:
            scene.lights = lights
        return scene

    def add_texture(self, pixels: Any, srgb: bool = True) -> int:
        """height x width x 4 bytes, the row of v = 0 first."""
        array = np.ascontiguousarray(pixels, np.uint8)
        if array.ndim != 3 or array.shape[2] != 4:
            raise InputError(f"pixels: shape {array.shape} is not height x width x 4", "pixels")
        number = ffi.new("int32_t*")
        check(lib.lightgrid_scene_add_texture(self._handle, array.shape[1], array.shape[0],
                                              ffi.cast("uint8_t*", array.ctypes.data), int(srgb), number))
        return number[0]

    def add_material(self, **values: Any) -> int:
        """glTF's: base_color, metallic, roughness, emissive, ior, clearcoat, alpha ("opaque", "mask", "blend"), maps…"""
        material = ffi.new("lightgrid_material*")
        lib.lightgrid_default_material(material)
        known = [name for name, _ in ffi.typeof("lightgrid_material").fields]
        for name, value in values.items():
            if name not in known:
                raise InputError(f"{name}: is nothing of a material; there are {', '.join(known)}", name)
            if name == "alpha" and isinstance(value, str):
                if value not in _alphas:
                    raise InputError(f"alpha: {value} is not {', '.join(_alphas)}", "alpha")
                value = _alphas[value]
            try:
                if name in ("base_color", "emissive"):
                    value = [float(v) for v in value]
                    if name == "base_color" and len(value) == 3:
                        value.append(1.0)
                    if len(value) != len(getattr(material, name)):
                        raise ValueError(f"{len(value)} values are not {len(getattr(material, name))}")
                setattr(material, name, int(value) if isinstance(value, bool) else value)
            except (TypeError, ValueError, OverflowError) as error:
                raise InputError(f"{name}: {error}", name) from None
        number = ffi.new("int32_t*")
        check(lib.lightgrid_scene_add_material(self._handle, material, number))
        return number[0]

    def add_mesh(self, positions: Any, indices: Any, normals: Any = None, uv: Any = None, colors: Any = None,
                 material: int = 0) -> int:
        """positions, normals: vertices x 3; uv: x 2; colors: x 4; indices: triangles x 3, counter-clockwise from the front."""
        kept = []

        def values(name: str, given: Any, columns: int) -> Any:
            if given is None:
                return ffi.NULL
            array = np.ascontiguousarray(arrays.real_array(given, np.float32, name))
            if array.ndim != 2 or array.shape[1] != columns or len(array) != count:
                raise InputError(f"{name}: shape {array.shape} is not ({count}, {columns})", name)
            kept.append(array)
            return ffi.cast("float*", array.ctypes.data)

        count = len(positions)
        triangles = np.asarray(indices)
        if triangles.size and (triangles.dtype.kind not in "iu" or triangles.min() < 0 or triangles.max() >= 2**32):
            raise InputError("indices: are not whole numbers from 0", "indices")
        triangles = np.ascontiguousarray(triangles, np.uint32).reshape(-1)
        mesh = ffi.new("lightgrid_mesh*", {
            "positions": values("positions", positions, 3), "normals": values("normals", normals, 3),
            "uv": values("uv", uv, 2), "colors": values("colors", colors, 4), "vertex_count": count,
            "indices": ffi.cast("uint32_t*", triangles.ctypes.data), "index_count": triangles.size,
            "material": material})
        number = ffi.new("int32_t*")
        check(lib.lightgrid_scene_add_mesh(self._handle, mesh, number))
        return number[0]

    def add_instance(self, mesh: int, world_from_object: Any = None, casts_shadow: bool = True) -> int:
        """A mesh, by its number, at a place: a matrix as written on paper, or None. Returns the instance's number."""
        matrix = ffi.NULL if world_from_object is None else arrays.c_matrix(world_from_object, "world_from_object")
        number = ffi.new("int32_t*")
        check(lib.lightgrid_scene_add_instance(self._handle, mesh, matrix, int(casts_shadow), number))
        return number[0]

    def move_instance(self, instance: int, world_from_object: Any) -> None:
        """Another place for an instance, from the next frame of all views on."""
        check(lib.lightgrid_scene_move_instance(self._handle, instance,
                                                arrays.c_matrix(world_from_object, "world_from_object")))

    @property
    def lights(self) -> np.ndarray:
        """A copy, of light_dtype. Assign lights, or dictionaries, to change them for the next frames of all views."""
        count = ffi.new("size_t*")
        check(lib.lightgrid_scene_get_lights(self._handle, ffi.NULL, 0, count))
        array = np.zeros(count[0], arrays.light_dtype)
        check(lib.lightgrid_scene_get_lights(self._handle, arrays.c_lights(array), len(array), count))
        return array

    @lights.setter
    def lights(self, value: Any) -> None:
        array = arrays.as_lights(value)
        check(lib.lightgrid_scene_set_lights(self._handle, arrays.c_lights(array), len(array)))

    def light_properties(self, light: int) -> dict[str, Any]:
        """The properties of a light that differ from the default, by their keys in lights files."""
        out = ffi.new("char**")
        check(lib.lightgrid_scene_get_light_properties(self._handle, light, out))
        try:
            return json.loads(ffi.string(out[0]))
        finally:
            lib.lightgrid_free(out[0])

    def set_light_properties(self, light: int, **values: Any) -> None:
        """Sets some of them: set_light_properties(3, groups=["kitchen", 7])."""
        check(lib.lightgrid_scene_set_light_properties(self._handle, light, json.dumps(values).encode()))

    def set_ambient(self, ambient: Sequence[float] | None = None, background: Sequence[float] | None = None) -> None:
        """Radiance from all sides, and where nothing is; None: as it is."""

        def color(value: Any, name: str) -> Any:
            if value is None:
                return ffi.NULL
            values = np.broadcast_to(arrays.real_array(value, np.float32, name), (3,))
            return ffi.new("float[3]", values.tolist())

        check(lib.lightgrid_scene_set_ambient(self._handle, color(ambient, "ambient"), color(background, "background")))

    def camera(self, which: Any = None, aspect: float = 16 / 9) -> Camera:
        """One of the scene's by name or number, or dict(eye=, target=, fov=, near=); None: the scene's own choice."""
        out = ffi.new("lightgrid_camera*")
        wish = ffi.NULL if which is None else arrays.camera_word(which).encode()
        check(lib.lightgrid_scene_camera(self._handle, wish, aspect, out))
        return Camera._from_c(out)

    def projection(self, size: Sequence[int], which: Any = None) -> Projection:
        """The projection of camera(), for an image of this width and height."""
        return self.camera(which, size[0] / size[1] if size[1] else 0).project(size)


def handle_of(scene: Any) -> Any:
    if not isinstance(scene, Scene):
        raise InputError(f"scene: {scene!r} is no Scene, such as Scene('hall')", "scene")
    return scene._handle
