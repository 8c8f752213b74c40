#!/usr/bin/env python3
"""shared_cases_test.py PROGRAM LIBRARY: inputs that once failed, each with its right value.

The folder `shared/cases` next to the checkout holds them; without it the test is skipped (77). A case in `reported/` has a README
with a command and linear radiance at pixels; this script runs the command for every technique that the README names and
reads the EXR by itself. Tests in the other folders generate equivalent inputs."""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from exr_files import read_exr  # noqa: E402

CASES = pathlib.Path(os.environ.get("LIGHTGRID_SHARED") or ROOT.parent / "shared") / "cases"
PROGRAM, LIBRARY = None, None

# The result of a case without pixels: the exit status, and text that stderr must contain.
STATUS = {
    "asset_source": (0, ""),
    "basisu_required": (2, "KHR_texture_basisu"),
    "image_missing": (0, "gone.png"),
    "light_negative": (0, "intensity"),
}


def command_of(readme):
    """The arguments of the README's command, and the techniques that it names."""
    line = re.search(r"^command: lightgrid (.*)$", readme, re.M).group(1)
    line, _, others = line.partition("   (and -t ")
    arguments = shlex.split(line)
    technique = arguments[arguments.index("-t") + 1]
    return arguments, [technique, *others.rstrip(")").split(", ")]


def checks_of(readme):
    pattern = r"^ +(\d+),(\d+) from the top left: (\S+) (\S+) (\S+) \(relative tolerance (\S+)\)"
    return [(int(x), int(y), [float(r), float(g), float(b)], float(t)) for x, y, r, g, b, t in re.findall(pattern, readme, re.M)]


class Reported(unittest.TestCase):
    def check(self, folder):
        readme = (folder / "README").read_text()
        arguments, techniques = command_of(readme)
        checks = checks_of(readme)
        self.assertTrue(checks or folder.name in STATUS, "neither pixels nor a status to compare with")
        for technique in techniques:
            with self.subTest(technique=technique), tempfile.TemporaryDirectory() as out:
                self.check_technique(folder, arguments, technique, checks, f"{out}/out.exr")

    def check_technique(self, folder, arguments, technique, checks, out):
        arguments = list(arguments)
        arguments[arguments.index("-t") + 1] = technique
        arguments[arguments.index("-o") + 1] = out
        if folder.name == "uri_parent_folder":
            arguments.append("--files=anywhere")  # the option that the message without it names
        ran = subprocess.run([PROGRAM, *arguments], cwd=folder, text=True, capture_output=True)
        status, words = STATUS.get(folder.name, (0, ""))
        self.assertEqual(ran.returncode, status, ran.stderr)
        self.assertIn(words, ran.stderr)
        if not checks:
            return
        width, height, planes = read_exr(out)
        for x, y, right, tolerance in checks:
            for channel, value in zip("RGB", right):
                seen = planes[channel][y][x]
                self.assertLessEqual(abs(seen - value), tolerance * max(abs(value), 1e-3 if value else 1.0),
                                     f"{channel} at {x},{y} from the top left is {seen}, right is {value}")


class Attacked(unittest.TestCase):
    def test_light_beside_a_wall_does_not_leak(self):
        with tempfile.TemporaryDirectory() as out:
            ran = subprocess.run([PROGRAM, *"compare scene.glb --lights-file lights.json --size 160x120 --gl none -t visibility"
                                  " --shadows all --frames 1 --warmup 0 -o".split(), out], cwd=CASES / "kept_leak", text=True,
                                 capture_output=True)
            self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)

    def test_flat_instance_is_lit_from_the_right_side(self):
        environment = os.environ | {"LIGHTGRID_LIBRARY": LIBRARY, "PYTHONPATH": str(ROOT / "python")}
        python = next((p for p in ("python3", "/usr/bin/python3")
                       if not subprocess.run([p, "-c", "import cffi, numpy"], capture_output=True).returncode), None)
        if not python:
            self.skipTest("no Python 3 with cffi and NumPy")
        ran = subprocess.run([python, CASES / "flat_instance/flat.py"], env=environment, text=True, capture_output=True)
        dark = [int(n) for n in re.findall(r"dark (\d+)", ran.stdout)]
        self.assertEqual(dark, [0, 0], ran.stdout + ran.stderr)

    def test_light_under_a_nearly_rigid_matrix_is_listed_or_refused(self):
        with tempfile.TemporaryDirectory() as out:
            folder = pathlib.Path(LIBRARY).parent
            subprocess.run(["cc", "-I", ROOT / "src/apps/c_api", CASES / "not_quite_rigid.c", LIBRARY, "-lm", f"-Wl,-rpath,{folder}",
                            "-o", f"{out}/a.out"], check=True)
            ran = subprocess.run([f"{out}/a.out", "0", "2.4e-6", "3.5e-6", "4.9e-6"], text=True, capture_output=True)
            lines = ran.stdout.splitlines()
            self.assertEqual(len(lines), 20, ran.stdout + ran.stderr)
            self.assertFalse([line for line in lines if "LOST" in line])


class Folder(unittest.TestCase):
    def test_each_entry_has_a_test(self):
        self.assertEqual({entry.name for entry in CASES.iterdir()},
                         {"README.md", "flat_instance", "kept_leak", "not_quite_rigid.c", "reported"})

    def test_each_file_is_drawn_by_a_case(self):
        """But for the control of meshopt_khr: the same stream under its older name, which always drew."""
        drawn = {folder / command_of((folder / "README").read_text())[0][1] for folder in CASES.glob("reported/*/")}
        self.assertEqual({file.name for file in CASES.glob("reported/**/*.gl*") if file not in drawn}, {"meshopt_ext_control.gltf"})


def add_reported():
    for folder in sorted(CASES.glob("reported/*/")):
        setattr(Reported, f"test_{folder.name}", lambda self, folder=folder: self.check(folder))


if __name__ == "__main__":
    if not CASES.is_dir():
        print(f"skipped: no folder {CASES.name} of shared inputs next to the checkout")
        sys.exit(77)
    PROGRAM, LIBRARY = map(os.path.abspath, sys.argv[1:3])
    add_reported()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
