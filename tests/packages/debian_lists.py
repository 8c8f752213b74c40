#!/usr/bin/env python3
"""debian_lists.py CMAKE BUILD LIBRARY: debian/ against what it lists.

The lists of files against what `cmake --install` writes, Build-Depends and Depends against the packages of ./lightgrid, the
symbols file against what the library exports, versions against the project's. No package is built: that is tests/packages/run."""
import fnmatch
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[2]
debian = root / "debian"
cmake, build, library = sys.argv[1:4]
# Needed only to make the packages, not to build the program. git: `lightgrid --version` names the commit.
packaging = {"debhelper-compat", "dh-sequence-python3", "git", "pybuild-plugin-pyproject", "python3-all", "python3-setuptools",
             "python3-wheel"}


def output(*words: str, **environment: str) -> str:
    return subprocess.run(words, check=True, capture_output=True, text=True, env={**os.environ, **environment}).stdout


def installed() -> set[str]:
    """Paths of files as with the prefix /usr, without the architecture's folder below lib."""
    with tempfile.TemporaryDirectory() as folder:
        output(cmake, "--install", build, "--prefix", "/usr", DESTDIR=folder)
        files = [p.relative_to(folder) for p in pathlib.Path(folder).rglob("*") if p.is_symlink() or not p.is_dir()]
    return {re.sub(r"^usr/lib/[^/]+-linux-[^/]+/", "usr/lib/", str(p)) for p in files}


def listed() -> dict[str, str]:
    """Each pattern of debian/*.install, and its package. A folder stands for all in it."""
    return {line.replace("usr/lib/*/", "usr/lib/"): path.stem
            for path in debian.glob("*.install") for line in path.read_text().split("\n") if line}


def fits(path: str, pattern: str) -> bool:
    return fnmatch.fnmatchcase(path, pattern) or fnmatch.fnmatchcase(path, pattern + "/*")


def names(field: str) -> set[str]:
    """The names of packages; the first of alternatives."""
    items = (item.split("|")[0].split("(")[0].strip() for item in field.split(","))
    return {item for item in items if item and not item.startswith("${")}


def fields() -> list[dict[str, str]]:
    """The fields of each paragraph of debian/control."""
    return [{name: " ".join(value.split()) for name, value in re.findall(r"^(\S+):((?:.*\n)(?:\s.*\n)*)", part + "\n", re.M)}
            for part in (debian / "control").read_text().strip().split("\n\n")]


def of_script(array: str) -> set[str]:
    """The packages that ./lightgrid has in `array`."""
    return set(re.search(rf"^{array}=\(([^)]*)\)", (root / "lightgrid").read_text(), re.M)[1].split())


class DebianLists(unittest.TestCase):
    def test_name_each_installed_file_once_and_nothing_else(self):
        files, patterns = installed(), listed()
        self.assertGreater(len(files), 30)
        for file in sorted(files):
            self.assertEqual([p for p in patterns if fits(file, p)][1:], [], f"{file} is in several packages")
            self.assertTrue(any(fits(file, p) for p in patterns), f"{file} is in no package")
        for pattern, package in patterns.items():
            self.assertTrue(any(fits(file, pattern) for file in files), f"{package}: {pattern} is not installed")

    def test_packages_to_build_are_the_scripts(self):
        source, *packages = fields()
        wanted = of_script("packages") | of_script("optional")
        to_build = names(source["Build-Depends"])
        to_run = set().union(*(names(package.get(kind, "")) for package in packages if package["Package"] == "lightgrid"
                               for kind in ("Depends", "Recommends", "Suggests")))
        own = {package["Package"] for package in packages}
        # dpkg-buildpackage brings g++ along (build-essential).
        self.assertEqual(wanted - to_build - to_run, {"g++"})
        self.assertEqual(to_build - wanted, packaging)
        self.assertEqual(to_run - wanted, own & to_run)

    def test_packages_of_the_headers_are_those_of_cmake(self):
        found = set(re.findall(r"find_dependency\((\w+)", (root / "cmake/lightgridConfig.cmake").read_text())) - {"Threads"}
        [dev] = [p for p in fields() if p.get("Package") == "liblightgrid-dev"]
        self.assertEqual(found, {"glm", "fmt", "OpenCL"})
        self.assertLessEqual({"libglm-dev", "libfmt-dev", "ocl-icd-opencl-dev", "opencl-clhpp-headers"}, names(dev["Depends"]))

    def test_symbols_are_the_librarys(self):
        first, *lines = (debian / "liblightgrid0.symbols").read_text().splitlines()
        soname = re.search(r"SONAME.*\[(.*)\]", output("readelf", "-d", library, LC_ALL="C"))[1]
        self.assertEqual(first.split()[:2], [soname, re.sub(r"\.so\.", "", soname)])
        shown = {line.split()[-1] for line in output("nm", "-D", "--defined-only", library).splitlines()}
        known = {line.split()[0] for line in lines if line.startswith(" ")}
        # nm: NAME@@VERSION, and the version's own name alone.
        self.assertEqual(known, {name.replace("@@", "@") if "@" in name else f"{name}@{name}" for name in shown})

    def test_versions_are_the_projects(self):
        version = re.search(r"project\(lightgrid VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text())[1]
        self.assertEqual(re.match(r"lightgrid \(([^)]+)\)", (debian / "changelog").read_text())[1], version)
        for recipe, pattern in (("vcpkg/vcpkg.json", '"version": "([^"]+)"'), ("conda/meta.yaml", 'version: "([^"]+)"')):
            self.assertEqual(re.search(pattern, (root / "packaging" / recipe).read_text())[1], version, recipe)
        [metainfo] = (root / "packaging").glob("*.metainfo.xml")
        self.assertEqual(re.search(r'<release version="([^"]+)"', metainfo.read_text())[1], version)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
