"""Devices, and what is made on them: views, light lists, comparisons."""
from __future__ import annotations

import html
import json
import os
import sys
import tempfile
from typing import Any, Callable, Iterable, Mapping, Sequence

import numpy as np

from . import _arrays as arrays
from ._arrays import Camera, Image, Projection, c_image, output
from ._c import check, encoded, ffi, in_callbacks, lib, made, strings, text, warned, word, words
from ._scene import Scene, handle_of


class Device:
    """Device(): an OpenCL device, a GPU if there is one, and OpenGL where it can be had. opengl: "auto", "egl", "osmesa", or
    "none": OpenCL alone, for visibility, techniques with raster="opencl", light lists and rasterising."""

    def __init__(self, name: str | None = None, opengl: str = "auto") -> None:
        wish = ffi.NULL if name is None else name.encode()
        self._handle = made("lightgrid_device", lib.lightgrid_device_close,
                            lambda out: lib.lightgrid_device_open(wish, opengl.encode(), out))

    @property
    def name(self) -> str:
        """The OpenCL device's name."""
        return text(lib.lightgrid_device_name(self._handle))

    @property
    def opengl(self) -> str:
        """The renderer's name; empty without one."""
        return text(lib.lightgrid_device_opengl(self._handle))

    def __repr__(self) -> str:
        return f"<lightgrid device {self.name}, {self.opengl or 'without OpenGL'}>"

    def view(self, scene: Scene, technique: str | None = None, **settings: Any) -> "View":
        """view(scene, "forward_plus", tile=32, cull_test="exact"): settings as --set has them, underscores for dashes."""
        return View(self, scene, technique, settings)

    def render(self, scene: Scene, technique: str | None = None, **settings: Any) -> Image:
        """One frame. A view draws several faster."""
        return self.view(scene, technique, **settings).render()

    def cull(self, projection: Projection, depth: Any, lights: Any, technique: str = "forward_plus",
             **settings: Any) -> "Lists":
        """The lights that may reach each tile's surfaces. depth: height x width, float32, the top row first, 1 at the near
        plane; None: with depth_bounds="none"."""
        array = None if depth is None else arrays.as_array(depth)
        given = arrays.as_lights(lights)
        image = ffi.NULL if array is None else c_image(array, "depth", "R_F32")
        return Lists(made("lightgrid_lists", lib.lightgrid_lists_free, lambda out: lib.lightgrid_cull(
            self._handle, projection._c(), image, arrays.c_lights(given), len(given), technique.encode(),
            words(settings), out)), projection.size)

    def rasterize(self, scene: Scene, projection: Projection) -> tuple[np.ndarray, np.ndarray]:
        """The nearest opaque triangle's number at each pixel (0xffffffff: none), and its depth; the top row first."""
        width, height = projection.size
        triangles, depth = np.empty((height, width), np.uint32), np.empty((height, width), np.float32)
        check(lib.lightgrid_rasterize(self._handle, handle_of(scene), projection._c(),
                                      c_image(triangles, "triangles", "R_U32"), c_image(depth, "depth", "R_F32")))
        return triangles, depth

    def compare(self, scene: Scene, techniques: Iterable[str] | None = None, *, frames: int = 5, warmup: int = 1,
                reference: str = "auto", flip: bool = False, compare: Mapping[str, Iterable[Any]] | None = None,
                progress: Callable[[float, str], Any] | bool = False, **settings: Any) -> "Report":
        """Techniques side by side, held against every light at every pixel and the oracle. compare: values of settings to try,
        {"tile": [8, 16]}. progress: a function of the share done and the next step, which ends the comparison by returning
        True or raising; True: a line on stderr."""
        fields: list[tuple[str, Any]] = [("frames", frames), ("warmup", warmup), ("reference", reference), ("flip", int(flip))]
        fields += [("set", f"{k.replace('_', '-')}={word(v)}") for k, v in settings.items()]
        fields += [("compare", f"{k.replace('_', '-')}={word(v)}") for k, v in (compare or {}).items()]
        tell = _line_on_stderr if progress is True else progress or None
        raised: list[BaseException] = []

        @ffi.callback("int(double, const char*, void*)", error=1,
                      onerror=lambda kind, error, trace: raised.append(error.with_traceback(trace)))
        def step(done: float, what: Any, _: Any) -> int:
            return int(bool(tell and tell(done, text(what))))

        if isinstance(techniques, str):
            techniques = [techniques]
        chosen = ffi.NULL if techniques is None else strings(techniques)
        try:
            with in_callbacks():
                handle = made("lightgrid_report", lib.lightgrid_report_free, lambda out: lib.lightgrid_compare(
                    self._handle, handle_of(scene), chosen, words(fields), step, ffi.NULL, out))
        except Exception:
            if raised:
                raise raised[0] from None
            raise
        return Report(handle)


def _line_on_stderr(done: float, step: str) -> None:
    print(f"\r{100 * done:3.0f} % {step[:60]:<60}", end="" if done < 1 else "\n", file=sys.stderr, flush=True)


class View:
    """A scene seen by one camera and drawn by one technique. Images have the top row first."""

    def __init__(self, device: Device, scene: Scene, technique: str | None, settings: Mapping[str, Any]) -> None:
        name = ffi.NULL if technique is None else technique.encode()
        self.device, self.scene = device, scene
        self._handle = made("lightgrid_view", lib.lightgrid_view_close, lambda out: lib.lightgrid_view_open(
            device._handle, handle_of(scene), name, words(settings), out))
        #: What opening it warned of, as Scene.warnings.
        self.warnings: list[dict[str, Any]] = warned()

    @property
    def size(self) -> tuple[int, int]:
        """Width, height."""
        sides = ffi.new("int32_t[2]")
        check(lib.lightgrid_view_size(self._handle, sides, sides + 1))
        return sides[0], sides[1]

    def look(self, camera: Camera | Any = None, size: Sequence[int] | None = None) -> None:
        """Another camera (None: the scene's; a Camera, a name, or dict(eye=, target=)) or size for the frames that follow."""
        width, height = size or self.size
        if camera is not None and not isinstance(camera, Camera):
            camera = self.scene.camera(camera, width / height if height else 0)
        check(lib.lightgrid_view_look(self._handle, ffi.NULL if camera is None else camera._c(), width, height))

    def _draw(self, function: Any, out: Any, kind: str) -> np.ndarray:
        width, height = self.size
        array = output(out, "out", kind, height, width)
        arrays.check_sides(array, "out", height, width)
        check(function(self._handle, c_image(array, "out", kind)))
        return array

    def render(self, out: Any = None) -> np.ndarray:
        """A frame: height x width x 4, float32, linear. out: an array to write to, of any row order, which is returned; of
        bytes with the setting picture="bytes": sRGB, alpha 255."""
        if getattr(out, "dtype", None) == np.uint8:
            return self._draw(lib.lightgrid_view_render, out, "RGBA_U8")
        return self._draw(lib.lightgrid_view_render, out, "RGBA_F32").view(Image)

    def draw(self) -> np.ndarray:
        """A frame as render() has it, with picture="bytes" in bytes, where the library has it: without a copy on an OpenCL
        device that is a CPU. The array shows the view's last frame: the next one may overwrite it. Its memory lives as long
        as the array does."""
        image = ffi.new("lightgrid_image*")
        frame = made("lightgrid_frame", lib.lightgrid_frame_free,
                     lambda out: lib.lightgrid_view_draw(self._handle, image, out))
        linear = image.format == lib.LIGHTGRID_RGBA_F32
        array = _memory(frame, image.pixels, (image.height, image.width, 4), "<f4" if linear else "|u1")[::-1]
        return array.view(Image) if linear else array

    def depth(self, out: Any = None) -> np.ndarray:
        """The depth of the last frame: 1 at the near plane, 0 where no opaque surface is."""
        return self._draw(lib.lightgrid_view_depth, out, "R_F32")

    def listed(self, out: Any = None) -> np.ndarray:
        """The number of lights in each pixel's list, in the last frame."""
        return self._draw(lib.lightgrid_view_listed, out, "R_U32")

    def profile(self) -> dict[str, Any]:
        """The last frame's figures, with the times of its passes, for which it draws up to five more."""
        out = ffi.new("char**")
        check(lib.lightgrid_view_profile(self._handle, out))
        try:
            return json.loads(text(out[0]))
        finally:
            lib.lightgrid_free(out[0])


def _memory(owner: Any, pointer: Any, shape: tuple[int, ...], kind: str = "<u4") -> np.ndarray:
    if pointer == ffi.NULL or 0 in shape:
        return np.zeros(shape, kind)
    return np.asarray(arrays.Memory(owner, int(ffi.cast("uintptr_t", pointer)), shape, kind))


class Lists:
    """Light lists of the tiles of a view, read where the library has them.

    cells: slices x rows x columns x 2, the first row at the top: the first of the cell's indices, and how many.
    indices: numbers of lights, without directional ones. masks: slices x rows x columns x words, or None."""

    def __init__(self, handle: Any, size: tuple[int, int]) -> None:
        self._handle, self._size = handle, size
        grid = ffi.new("lightgrid_grid*")
        check(lib.lightgrid_lists_get(handle, grid))
        shape = (grid.slices, grid.cells_y, grid.cells_x)
        self.tile: int = grid.tile
        self.cells = _memory(handle, grid.cells, shape + (2,))[:, ::-1]
        self.indices = _memory(handle, grid.indices, (grid.index_count,))
        self.masks = _memory(handle, grid.masks, shape + (grid.mask_words,))[:, ::-1] if grid.mask_words else None
        self.z_bins = _memory(handle, grid.z_bins, (grid.z_bin_count,)) if grid.z_bin_count else None
        self.slice_edges = _memory(handle, grid.slice_edges, (grid.slices - 1,), "<f4")

    def at(self, x: int, y: int, slice: int = 0) -> np.ndarray:
        """The lights of the tile at a pixel; y counts from the top."""
        width, height = self._size
        if not (0 <= x < width and 0 <= y < height):
            raise IndexError(f"({x}, {y}) is not in an image of {width} x {height}")
        row = self.cells.shape[1] - 1 - (height - 1 - y) // self.tile
        first, count = self.cells[slice, row, x // self.tile]
        return self.indices[first:first + count]

    def counts(self, slice: int = 0) -> np.ndarray:
        """How many lights each pixel's tile has: height x width."""
        width, height = self._size
        tiles = self.cells[slice, ::-1, :, 1]
        return tiles.repeat(self.tile, 0).repeat(self.tile, 1)[:height, :width][::-1]


class Report:
    """A comparison. In a notebook it is the page that `lightgrid compare` writes."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle
        #: results.json (docs/results_json.md).
        self.results: dict[str, Any] = json.loads(text(lib.lightgrid_report_json(handle)))

    @property
    def rows(self) -> list[dict[str, Any]]:
        """A dictionary a technique and settings: the rows of results.json."""
        return self.results["rows"]

    def image(self, row: int) -> Image:
        """The picture of a row."""
        width, height = self._sides()
        array = np.empty((height, width, 4), np.float32)
        check(lib.lightgrid_report_image(self._handle, row, c_image(array, "image", "RGBA_F32")))
        return array.view(Image)

    def _sides(self) -> tuple[int, int]:
        return self.results["size"][0], self.results["size"][1]

    def table(self) -> Any:
        """A line a row: a pandas.DataFrame, or a list of dictionaries without pandas."""
        lines = [_flat(row) for row in self.rows]
        try:
            import pandas
        except ImportError:
            return lines
        return pandas.DataFrame(lines)

    def save(self, folder: str | os.PathLike) -> None:
        """index.html, results.json, results.csv and pictures."""
        check(lib.lightgrid_report_save(self._handle, encoded(folder)))

    def page(self) -> str:
        """index.html: one file that loads nothing else."""
        with tempfile.TemporaryDirectory() as folder:
            self.save(folder)
            with open(os.path.join(folder, "index.html"), encoding="utf-8") as file:
                return file.read()

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.page())}" style="width:100%;height:80vh;border:0" '
                'title="lightgrid comparison"></iframe>')


def _flat(row: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in row.items():
        if isinstance(value, Mapping):
            flat.update(_flat(value, f"{before}{key}."))
        elif not isinstance(value, list):
            flat[before + key] = value
    return flat
