"""Scenes with very many lights: rendered by every known technique into NumPy arrays, culled, measured.

    import lightgrid_render as lg

    scene = lg.Scene("hall", size=(640, 360))
    image = lg.Device().render(scene, "forward_plus", tile=32)

Every image has its top row first. Errors are InputError, MachineError and Cancelled, with the program's own message and the
field that it is about. Notes and warnings go to the logger "lightgrid_render". Calls on one device take turns; a scene must
not change while another thread uses it.
"""
from typing import Any

from ._arrays import (Camera, Image, Projection, exposure, flip, light_dtype, lights, measure, save, srgb)
from ._c import (Cancelled, InputError, LightgridError, MachineError, described as _described, lib as _lib, on_compiling,
                 text as _text)
from ._device import Device, Lists, Report, View
from ._scene import Scene

__all__ = ["Camera", "Cancelled", "Device", "Image", "InputError", "LightgridError", "Lists", "MachineError", "Projection",
           "Report", "Scene", "View", "devices", "exposure", "fields", "flip", "light_dtype", "lights", "measure", "measures",
           "on_compiling", "save", "scenes", "settings", "srgb", "techniques", "version"]


def version() -> str:
    """The library's version, with its commit."""
    return _text(_lib.lightgrid_version())


def techniques() -> dict[str, dict[str, Any]]:
    """By name: summary, source, settings."""
    return {t["name"]: t for t in _described("techniques")["techniques"]}


def settings() -> dict[str, dict[str, Any]]:
    """By key, as --set has it: values, the default first, and meaning."""
    return {s["key"]: s for s in _described("techniques")["settings"]}


def scenes() -> dict[str, str]:
    """The built-in scenes, with a line on each."""
    return {s["name"]: s["summary"] for s in _described("scenes")}


def fields() -> dict[str, str]:
    """The keyword arguments of Scene, with dashes, and what each means."""
    return {f["name"]: f["help"] for f in _described("fields")}


def measures() -> list[str]:
    """The names that measure() knows."""
    return _described("measures")


def devices() -> list[dict[str, Any]]:
    """The machine's OpenCL devices."""
    return _described("devices")
