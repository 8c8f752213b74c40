"""Copies the header and the library into the wheel, which then serves every Python 3 of this kind of machine.

LIGHTGRID_LIBRARY: the library; without it the wheel holds none, and finds the system's. With LIGHTGRID_BUNDLE=1 the wheel also
holds the libraries that this one needs, under names of their own, but for those that every system has and for the loader of
OpenCL drivers; needs patchelf and ldd. On Debian their licences are beside them. The tag is then that of this system's C library
(manylinux)."""
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sysconfig

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

here = pathlib.Path(__file__).resolve().parent
header = next(h for h in (here / "../src/apps/c_api/lightgrid.h", here / "lightgrid_render/lightgrid.h") if h.exists())
bundle = os.environ.get("LIGHTGRID_BUNDLE") == "1"
of_every_system = re.compile(r"(ld-linux.*|linux-vdso|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+|z|OpenCL))\.so.*")


def version() -> str:
    cmake = (here / "../CMakeLists.txt").read_text()
    return re.search(r"project\(lightgrid VERSION ([0-9.]+)", cmake).group(1)


def copy_licence(name: str, folder: pathlib.Path) -> None:
    """Copies the licence of the Debian package that has the library `name`; nothing on other systems."""
    if not shutil.which("dpkg-query"):
        return
    owner = subprocess.run(["dpkg-query", "-S", f"*/{name}"], check=True, capture_output=True, text=True).stdout.split(":")[0]
    folder.mkdir(exist_ok=True)
    shutil.copyfile(f"/usr/share/doc/{owner}/copyright", folder / f"{owner}.txt")


def bundle_needed(library: pathlib.Path) -> None:
    """The libraries that it needs into its folder, where they find each other."""
    lines = subprocess.run(["ldd", str(library)], check=True, capture_output=True, text=True).stdout.splitlines()
    found = dict(match.groups() for line in lines if (match := re.match(r"\s*(\S+) => (/\S+)", line)))
    own = {name: f"liblightgrid_{name[3:]}" for name in found if not of_every_system.fullmatch(name)}
    for name, renamed in own.items():
        shutil.copyfile(found[name], library.parent / renamed)
        copy_licence(name, library.parent / "licenses")
        subprocess.run(["patchelf", "--set-soname", renamed, str(library.parent / renamed)], check=True)
    for file in [library] + [library.parent / renamed for renamed in own.values()]:
        needed = subprocess.run(["patchelf", "--print-needed", str(file)], check=True, capture_output=True, text=True)
        for name in needed.stdout.split():
            if name in own:
                subprocess.run(["patchelf", "--replace-needed", name, own[name], str(file)], check=True)
        subprocess.run(["patchelf", "--set-rpath", "$ORIGIN", str(file)], check=True)


class BuildWithLibrary(build_py):
    def run(self):
        super().run()
        to = pathlib.Path(self.build_lib) / "lightgrid_render"
        to.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(header, to / "lightgrid.h")
        if "LIGHTGRID_LIBRARY" not in os.environ:
            return
        library = to / "liblightgrid.so.0"
        shutil.copyfile(os.environ["LIGHTGRID_LIBRARY"], library)
        subprocess.run(["strip", "--strip-unneeded", str(library)], check=True)
        if bundle:
            bundle_needed(library)


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return "LIGHTGRID_LIBRARY" in os.environ


class WheelOfOneMachine(bdist_wheel):
    def get_tag(self):
        if not self.distribution.has_ext_modules():
            return "py3", "none", "any"
        machine = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        if bundle:
            machine = f"manylinux_{platform.libc_ver()[1].replace('.', '_')}_{platform.machine()}"
        return "py3", "none", machine


setup(version=version(), distclass=WithLibrary, cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": WheelOfOneMachine})
