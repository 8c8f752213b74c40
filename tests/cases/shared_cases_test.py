#!/usr/bin/env python3
"""shared_cases_test.py PROGRAM LIBRARY: inputs that once failed, each with its right value.

The folder `shared/cases` next to the checkout holds them; without it the test is skipped (77). A case in `reported/` has a README
with a command and linear radiance at pixels; this script runs the command for every technique that the README names and
reads the EXR by itself. Tests in the other folders generate equivalent inputs."""
import os
import pathlib
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = pathlib.Path(os.environ.get("LIGHTGRID_SHARED") or ROOT.parent / "shared") / "cases"
PROGRAM, LIBRARY = None, None

# What a case without pixels shows: the exit status, and what stderr must say.
STATUS = {
    "asset_source": (0, ""),
    "basisu_required": (2, "KHR_texture_basisu"),
    "image_missing": (0, "gone.png"),
    "light_negative": (0, "intensity"),
}


def read_exr(path):
    """(width, height, {channel: rows}) of a scanline EXR with float channels, uncompressed or with ZIP."""
    data = pathlib.Path(path).read_bytes()
    at, header = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        header[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names, channels = [], header["channels"]
    while channels[0]:
        name, channels = channels.split(b"\0", 1)
        assert struct.unpack_from("<i", channels)[0] == 2, "not a float channel"
        names.append(name.decode())
        channels = channels[16:]
    compression = header["compression"][0]
    rows_in_block = {0: 1, 2: 1, 3: 16}[compression]
    planes = {name: [None] * height for name in names}
    for block in range((height + rows_in_block - 1) // rows_in_block):
        offset = struct.unpack_from("<Q", data, at + 8 * block)[0]
        y, size = struct.unpack_from("<2i", data, offset)
        rows = min(rows_in_block, height - (y - y0))
        raw, bytes_ = data[offset + 8:offset + 8 + size], 4 * width * len(names) * rows
        if compression and size < bytes_:
            raw = unpredicted(zlib.decompress(raw))
        for row in range(rows):
            for c, name in enumerate(names):
                planes[name][y - y0 + row] = struct.unpack_from(f"<{width}f", raw, 4 * width * (row * len(names) + c))
    return width, height, planes


def unpredicted(deltas):
    """OpenEXR stores differences of bytes, and even and odd bytes apart."""
    out = bytearray(deltas)
    for i in range(1, len(out)):
        out[i] = (out[i - 1] + out[i] - 128) & 255
    half = (len(out) + 1) // 2
    joined = bytearray(len(out))
    joined[0::2], joined[1::2] = out[:half], out[half:]
    return bytes(joined)


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
            subprocess.run(["cc", "-I", ROOT / "src/c_api", CASES / "not_quite_rigid.c", LIBRARY, "-lm", f"-Wl,-rpath,{folder}",
                            "-o", f"{out}/a.out"], check=True)
            ran = subprocess.run([f"{out}/a.out", "0", "2.4e-6", "3.5e-6", "4.9e-6"], text=True, capture_output=True)
            lines = ran.stdout.splitlines()
            self.assertEqual(len(lines), 20, ran.stdout + ran.stderr)
            self.assertFalse([line for line in lines if "LOST" in line])


def add_reported():
    for folder in sorted(CASES.glob("reported/*/")):
        setattr(Reported, f"test_{folder.name}", lambda self, folder=folder: self.check(folder))


if __name__ == "__main__":
    if not CASES.is_dir():
        print(f"skipped: no folder {CASES.name} of shared inputs beside the checkout")
        sys.exit(77)
    PROGRAM, LIBRARY = sys.argv[1:3]
    add_reported()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
