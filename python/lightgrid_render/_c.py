"""The C library: found, declared by its own header, and its errors as exceptions."""
from __future__ import annotations

import atexit
import ctypes.util
import json
import logging
import os
import pathlib
import re
import sys
import threading
import weakref
from typing import Any, Callable, Iterable, Mapping

import cffi

_here = pathlib.Path(__file__).resolve().parent
log = logging.getLogger("lightgrid_render")


class LightgridError(Exception):
    """An error of the library: one line, and the field, setting or argument that it is about ("" if none)."""

    def __init__(self, message: str, field: str = "") -> None:
        super().__init__(message)
        self.field = field


class InputError(LightgridError, ValueError):
    """An argument, a field or a file is wrong."""


class MachineError(LightgridError, RuntimeError):
    """This machine cannot do it; the message says what would help."""


class Cancelled(LightgridError):
    """The progress function ended it."""


def _declarations() -> str:
    """lightgrid.h without what only a preprocessor reads."""
    places = (_here / "lightgrid.h", _here / "../../src/apps/c_api/lightgrid.h", pathlib.Path("/usr/include/lightgrid.h"))
    header = next((p for p in places if p.exists()), None)
    if header is None:
        raise ImportError("lightgrid_render: lightgrid.h is neither in the package nor in /usr/include")
    text = re.sub(r"#ifdef __cplusplus\n.*?#endif", "", header.read_text(), flags=re.S)
    return re.sub(r"^#.*$", "", text, flags=re.M)


def _open(ffi: cffi.FFI) -> Any:
    tried = []
    for name in (os.environ.get("LIGHTGRID_LIBRARY"), str(_here / "liblightgrid.so.0"), "liblightgrid.so.0",
                 ctypes.util.find_library("lightgrid")):
        if not name:
            continue
        try:
            return ffi.dlopen(name)
        except OSError as error:
            tried.append(str(error))
    advice = "LIGHTGRID_LIBRARY names another place"
    if any("libOpenCL" in fault for fault in tried):
        advice = "OpenCL's loader and a driver are missing (Debian: ocl-icd-libopencl1, pocl-opencl-icd)"
    raise ImportError(f"lightgrid_render: liblightgrid.so.0 cannot be loaded: {'; '.join(tried)}. {advice}")


ffi = cffi.FFI()
ffi.cdef(_declarations())
lib = _open(ffi)


def text(of: Any) -> str:
    return "" if of == ffi.NULL else ffi.string(of).decode("utf-8", "replace")


def check(status: int) -> None:
    if status == lib.LIGHTGRID_OK:
        return
    kind = {lib.LIGHTGRID_INPUT: InputError, lib.LIGHTGRID_CANCELLED: Cancelled}.get(status, MachineError)
    raise kind(text(lib.lightgrid_error_message()), text(lib.lightgrid_error_field()))


# Objects whose last reference goes while a callback runs are freed after the call.
_thread = threading.local()


class in_callbacks:
    def __enter__(self) -> None:
        _thread.left = getattr(_thread, "left", None) or []
        _thread.depth = getattr(_thread, "depth", 0) + 1

    def __exit__(self, *_: Any) -> None:
        _thread.depth -= 1
        while _thread.depth == 0 and _thread.left:
            free, handle = _thread.left.pop()
            free(handle)


def owned(handle: Any, free: Any) -> Any:
    def let_go(of: Any) -> None:
        if getattr(_thread, "depth", 0):
            _thread.left.append((free, ffi.cast(ffi.typeof(handle), of)))
        else:
            free(of)

    return ffi.gc(handle, let_go)


def made(type_name: str, free: Any, make: Any) -> Any:
    """Calls make(out) for a new object of that type."""
    out = ffi.new(f"{type_name}**")
    check(make(out))
    return owned(out[0], free)


def warned() -> list[dict[str, Any]]:
    """Warnings of this thread's last call: text, and settings that would help ("KEY=VALUE" each)."""
    return described("warnings")


def encoded(value: Any) -> bytes:
    return os.fspath(value).encode() if isinstance(value, (str, os.PathLike)) else str(value).encode()


def word(value: Any) -> str:
    """A value as the command line has it: True is "on", (640, 360) "640,360"."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, Iterable):
        return ",".join(word(v) for v in value)
    return repr(value.item() if hasattr(value, "item") else value)


def words(pairs: Mapping[str, Any] | Iterable[tuple[str, Any]]) -> Any:
    """NAME=VALUE each, null-terminated; underscores of names become dashes."""
    pairs = pairs.items() if isinstance(pairs, Mapping) else pairs
    return strings(f"{name.replace('_', '-')}={word(value)}" for name, value in pairs)


_kept: Any = weakref.WeakKeyDictionary()  # what arrays of pointers point to


def strings(texts: Iterable[str]) -> Any:
    kept = [ffi.new("char[]", t.encode()) for t in texts]
    array = ffi.new("const char*[]", kept + [ffi.NULL])
    _kept[array] = kept
    return array


def described(table: str) -> Any:
    """One of the library's tables."""
    out = ffi.new("char**")
    check(lib.lightgrid_describe(table.encode(), out))
    try:
        return json.loads(text(out[0]))
    finally:
        lib.lightgrid_free(out[0])


@ffi.callback("void(int, const char*, void*)")
def _log_line(is_warning: int, line: Any, _: Any) -> None:
    log.log(logging.WARNING if is_warning else logging.INFO, "%s", text(line))


def show_compiling(kernels: int, total: int) -> None:
    """One line in a terminal or a notebook, which is cleared when the kernels are compiled."""
    if not (sys.stderr.isatty() or "ipykernel" in sys.modules):
        return
    line = f"compiling kernels for this machine, first time only: {kernels} of {total}" if kernels else ""
    print(f"\r{line:<70}", end="" if kernels else "\r", file=sys.stderr, flush=True)


_compiling: Callable[[int, int], Any] | None = show_compiling


@ffi.callback("void(int, int, void*)")
def _first_compilation(kernels: int, total: int, _: Any) -> None:
    if _compiling:
        _compiling(kernels, total)


def on_compiling(function: Callable[[int, int], Any] | None = show_compiling) -> None:
    """Calls function(kernels, total) before each kernel that is compiled for its first time on this machine, with the number so
    far and of those known to be needed, and with 0, 0 when none is left. None: no calls. Without an argument: a line in terminals and notebooks, as at first."""
    global _compiling
    _compiling = function


def _stop_calls() -> None:
    lib.lightgrid_set_log(ffi.NULL, ffi.NULL)
    lib.lightgrid_set_compiling(ffi.NULL, ffi.NULL)


lib.lightgrid_set_log(_log_line, ffi.NULL)
lib.lightgrid_set_compiling(_first_compilation, ffi.NULL)
atexit.register(_stop_calls)
