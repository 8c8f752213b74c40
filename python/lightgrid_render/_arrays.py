"""NumPy arrays as the library's images, lights and matrices, without copies where their layout allows it."""
from __future__ import annotations

import math
import os
import tempfile
from typing import Any, Mapping, Sequence

import numpy as np

from ._c import InputError, check, encoded, ffi, lib, word

_formats = {
    "RGBA_F32": (lib.LIGHTGRID_RGBA_F32, np.dtype(np.float32), 4),
    "R_F32": (lib.LIGHTGRID_R_F32, np.dtype(np.float32), None),
    "R_U32": (lib.LIGHTGRID_R_U32, np.dtype(np.uint32), None),
    "RGB_U8": (lib.LIGHTGRID_RGB_U8, np.dtype(np.uint8), 3),
    "RGBA_U8": (lib.LIGHTGRID_RGBA_U8, np.dtype(np.uint8), 4),
}


def as_array(value: Any) -> np.ndarray:
    """An array; one of another library through DLPack, without a copy."""
    if isinstance(value, np.ndarray) or not hasattr(value, "__dlpack__"):
        return np.asarray(value)
    return np.from_dlpack(value)


def real_array(value: Any, kind: Any, name: str) -> np.ndarray:
    """An array of that type. Refuses complex numbers, whose imaginary part NumPy would drop."""
    array = as_array(value)
    if np.iscomplexobj(array):
        raise InputError(f"{name}: has complex numbers", name)
    return np.asarray(array, kind)


class Image(np.ndarray):
    """Linear light, float32, height x width x 4 (RGBA), the top row first. A NumPy array that notebooks show as a picture."""

    def picture(self, exposure: float | str = 0) -> np.ndarray:
        """The bytes of its PNG file: height x width x 3. Exposure in stops, or "auto"."""
        return srgb(self, exposure)

    def save(self, path: str | os.PathLike, exposure: float | str = 0) -> None:
        """By its extension: .png as picture() has it, .exr linear."""
        save(path, self, exposure)

    def _repr_png_(self) -> bytes | None:
        if self.ndim != 3 or self.shape[2] not in (3, 4) or self.size == 0 or self.dtype != np.float32:
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "image.png")
            save(path, self, "auto")
            with open(path, "rb") as file:
                return file.read()


def c_image(array: np.ndarray, name: str, kind: str) -> Any:
    """The array's own memory as a lightgrid_image. Its rows may be anywhere, their pixels side by side."""
    number, dtype, channels = _formats[kind]
    shape = "height x width" + (f" x {channels}" if channels else "")
    if array.dtype != dtype or array.ndim != (3 if channels else 2) or (channels and array.shape[2] != channels):
        raise InputError(f"{name}: {array.dtype} of shape {array.shape} is not {dtype}, {shape}", name)
    pixel = dtype.itemsize * (channels or 1)
    if array.size == 0 or (array.shape[1] > 1 and array.strides[1] != pixel) or (
            channels and array.strides[2] != dtype.itemsize):
        raise InputError(f"{name}: has no pixels, or gaps between the pixels of a row", name)
    bottom = array.ctypes.data + (array.shape[0] - 1) * array.strides[0]
    row = -array.strides[0] if array.shape[0] > 1 else pixel * array.shape[1]
    return ffi.new("lightgrid_image*", {"pixels": ffi.cast("void*", bottom), "width": array.shape[1],
                                        "height": array.shape[0], "format": number, "row_bytes": row})


class Memory:
    """Memory that is not NumPy's as an array, which keeps its owner. Writable, since NumPy 1 exports no other by DLPack."""

    def __init__(self, owner: Any, address: int, shape: tuple[int, ...], kind: str, strides: Any = None) -> None:
        self._owner = owner
        self.__array_interface__ = {"data": (address, False), "shape": shape, "typestr": kind, "strides": strides,
                                    "version": 3}


def output(out: Any, name: str, kind: str, height: int, width: int) -> np.ndarray:
    """The caller's array, or a new one."""
    _, dtype, channels = _formats[kind]
    if out is None:
        return np.empty((height, width) + ((channels,) if channels else ()), dtype)
    array = as_array(out)
    if not isinstance(out, np.ndarray) and hasattr(out, "__dlpack__"):
        # NumPy calls all such memory read-only, since DLPack cannot say that it is not.
        return np.asarray(Memory(array, array.ctypes.data, array.shape, array.dtype.str, array.strides))
    if not isinstance(out, np.ndarray) or not array.flags.writeable:
        raise InputError(f"{name}: is read-only", name)
    return array


def check_sides(array: np.ndarray, name: str, height: int, width: int) -> None:
    if array.shape[:2] != (height, width):
        raise InputError(f"{name}: {array.shape[:2]} is not {(height, width)}, height and width", name)


def input_image(value: Any, name: str) -> np.ndarray:
    """RGBA, float32: as it is, or with the alpha that it lacks, or converted."""
    array = as_array(value)
    if array.ndim == 3 and array.shape[2] == 3:
        filled = np.ones(array.shape[:2] + (4,), np.float32)
        filled[..., :3] = array
        return filled
    fits = array.dtype == np.float32 and array.ndim == 3 and array.strides[1:] == (16, 4)
    return array.view(np.ndarray) if fits else np.ascontiguousarray(array, np.float32)


def exposure(image: Any) -> float:
    """The exposure, in stops, that brings the image's mean to the middle: what "auto" means."""
    stops = ffi.new("double*")
    array = input_image(image, "image")
    check(lib.lightgrid_exposure(c_image(array, "image", "RGBA_F32"), stops))
    return stops[0]


def _stops(image: np.ndarray, wish: float | str) -> float:
    return exposure(image) if wish == "auto" else float(wish)


def srgb(image: Any, exposure: float | str = 0, out: Any = None) -> np.ndarray:
    """2^exposure times the linear values, tone map and sRGB curve: height x width x 3 bytes."""
    array = input_image(image, "image")
    to = output(out, "out", "RGB_U8", *array.shape[:2])
    check(lib.lightgrid_srgb(c_image(array, "image", "RGBA_F32"), _stops(array, exposure),
                             c_image(to, "out", "RGB_U8")))
    return to


def save(path: str | os.PathLike, image: Any, exposure: float | str = 0) -> None:
    """By the extension: .png as srgb() has it, .exr linear."""
    array = input_image(image, "image")
    check(lib.lightgrid_save(encoded(path), c_image(array, "image", "RGBA_F32"), _stops(array, exposure)))


def measure(image: Any, reference: Any, name: str) -> float:
    """How far an image is from a reference, by one of measures()."""
    value = ffi.new("double*")
    a, b = input_image(image, "image"), input_image(reference, "reference")
    check(lib.lightgrid_measure(c_image(a, "image", "RGBA_F32"), c_image(b, "reference", "RGBA_F32"), name.encode(),
                                value))
    return value[0]


def flip(image: Any, reference: Any, pixels_per_degree: float = 0, out: Any = None) -> np.ndarray:
    """HDR-FLIP of each pixel, 0 to 1: height x width, float32."""
    a, b = input_image(image, "image"), input_image(reference, "reference")
    to = output(out, "out", "R_F32", *b.shape[:2])
    check(lib.lightgrid_flip(c_image(a, "image", "RGBA_F32"), c_image(b, "reference", "RGBA_F32"), pixels_per_degree,
                             c_image(to, "out", "R_F32")))
    return to


def _dtype_of(struct: str) -> np.dtype:
    kinds = {"double": "f8", "float": "f4", "int32_t": "i4", "uint32_t": "u4"}
    names, formats, offsets = [], [], []
    for name, field in ffi.typeof(struct).fields:
        of, count = (field.type.item, field.type.length) if field.type.kind == "array" else (field.type, None)
        kind = "i4" if of.kind == "enum" else kinds[of.cname]
        names.append(name), formats.append((kind, (count,)) if count else kind), offsets.append(field.offset)
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": ffi.sizeof(struct)})


#: A light, as the library reads it: arrays of this type are handed over without a copy.
light_dtype = _dtype_of("lightgrid_light")
light_types = {"point": 0, "spot": 1, "directional": 2, "virtual": 3}


def _default_light() -> np.ndarray:
    one = np.zeros(1, light_dtype)
    lib.lightgrid_default_light(ffi.cast("lightgrid_light*", one.ctypes.data))
    return one


def lights(count: int | None = None, **columns: Any) -> np.ndarray:
    """Lights by columns, each a value for all or one a light: lights(position=p, color=(1, .9, .8), radius_m=3).

    Columns are those of light_dtype; `type` may be a word. Others than given have their defaults: a white point light
    of 1 candela without a range."""
    if count is None:
        rank = {"position": 2, "direction": 2, "color": 2}
        given = [len(v) for k, v in columns.items() if not isinstance(v, str) and np.ndim(v) == rank.get(k, 1)]
        count = max(given, default=1)
    made = np.zeros(count, light_dtype)
    made[:] = _default_light()
    for name, value in columns.items():
        if name not in (light_dtype.names or ()):
            raise InputError(f"{name}: is no column of a light; columns are {', '.join(light_dtype.names or ())}", name)
        if name == "type":
            kinds = np.asarray(value)
            if kinds.dtype.kind == "U":
                unknown = [k for k in kinds.ravel() if k not in light_types]
                if unknown:
                    raise InputError(f"type: {unknown[0]} is not {', '.join(light_types)}", "type")
                value = np.vectorize(light_types.__getitem__, otypes=[np.int32])(kinds)
        if np.iscomplexobj(value):
            raise InputError(f"{name}: has complex numbers", name)
        try:
            made[name] = value
        except ValueError as error:
            raise InputError(f"{name}: {error}", name) from None
    return made


def as_lights(value: Any) -> np.ndarray:
    """An array of lights, from one, or from dictionaries."""
    if isinstance(value, np.ndarray) and value.dtype == light_dtype:
        return np.ascontiguousarray(value.reshape(-1))
    given = list(value)
    if not all(isinstance(row, Mapping) for row in given):
        raise InputError("lights: neither an array of light_dtype nor dictionaries of its columns", "lights")
    rows = [lights(1, **row) for row in given]
    made = np.zeros(len(rows), light_dtype)  # np.concatenate would leave out the gaps between fields
    for i, row in enumerate(rows):
        made[i] = row[0]
    return made


def c_lights(array: np.ndarray) -> Any:
    return ffi.cast("lightgrid_light*", array.ctypes.data) if len(array) else ffi.NULL


def c_matrix(matrix: Any, name: str) -> Any:
    """Rows and columns as written on paper, to the library's columns."""
    values = real_array(matrix, np.float64, name)
    if values.shape != (4, 4):
        raise InputError(f"{name}: shape {values.shape} is not (4, 4)", name)
    return ffi.new("double[16]", values.T.ravel().tolist())


def from_c_matrix(values: Any) -> np.ndarray:
    return np.array(list(values), np.float64).reshape(4, 4).T


class Projection:
    """A view as light lists and the rasteriser see it. Matrices as written on paper: rows and columns."""

    def __init__(self, clip_from_view: Any, view_from_world: Any, eye: Sequence[float], size: Sequence[int]) -> None:
        self.clip_from_view = real_array(clip_from_view, np.float64, "clip_from_view")
        self.view_from_world = real_array(view_from_world, np.float64, "view_from_world")
        self.eye = real_array(eye, np.float64, "eye")
        self.size = (int(size[0]), int(size[1]))

    @staticmethod
    def _from_c(c: Any) -> "Projection":
        return Projection(from_c_matrix(c.clip_from_view), from_c_matrix(c.view_from_world), list(c.eye),
                          (c.width, c.height))

    def _c(self) -> Any:
        if self.eye.shape != (3,):
            raise InputError(f"eye: shape {self.eye.shape} is not (3,)", "eye")
        return ffi.new("lightgrid_projection*",
                       {"clip_from_view": list(c_matrix(self.clip_from_view, "clip_from_view")),
                        "view_from_world": list(c_matrix(self.view_from_world, "view_from_world")),
                        "eye": self.eye.tolist(), "width": self.size[0], "height": self.size[1]})


class Camera:
    """world_from_view looks along its -z, y up; fov in radians, of the height."""

    def __init__(self, world_from_view: Any, fov_y_rad: float = math.pi / 3, near_m: float = 0.1,
                 far_m: float = math.inf, orthographic: bool = False, half_height_m: float = 1) -> None:
        self.world_from_view = real_array(world_from_view, np.float64, "world_from_view")
        self.fov_y_rad, self.near_m, self.far_m = float(fov_y_rad), float(near_m), float(far_m)
        self.orthographic, self.half_height_m = bool(orthographic), float(half_height_m)

    @staticmethod
    def _from_c(c: Any) -> "Camera":
        return Camera(from_c_matrix(c.world_from_view), c.fov_y_rad, c.near_m, c.far_m, bool(c.orthographic),
                      c.half_height_m)

    def _c(self) -> Any:
        return ffi.new("lightgrid_camera*",
                       {"world_from_view": list(c_matrix(self.world_from_view, "world_from_view")),
                        "fov_y_rad": self.fov_y_rad, "near_m": self.near_m, "far_m": self.far_m,
                        "orthographic": int(self.orthographic), "half_height_m": self.half_height_m})

    def project(self, size: Sequence[int]) -> Projection:
        """The projection for an image of this width and height."""
        out = ffi.new("lightgrid_projection*")
        check(lib.lightgrid_project(self._c(), int(size[0]), int(size[1]), out))
        return Projection._from_c(out)


def camera_word(camera: Any) -> str:
    """A dictionary of eye, target, fov and near as the command line has it; a name or a number as it is."""
    if not isinstance(camera, dict):
        return str(camera)
    return ",".join(f"{key}:{word(value)}" for key, value in camera.items())
