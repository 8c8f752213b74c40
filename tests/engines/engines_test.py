#!/usr/bin/env python3
"""tools/engines: lists of engines judged by PROGRAM, and their pictures on its plane.

    engines_test.py PROGRAM

It needs node, chromium, and the packages in node_modules of $LIGHTGRID_ENGINES or the current folder; without them it is skipped (77).
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = os.path.abspath(sys.argv.pop(1))
TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools/engines"
TOOL, PLANE = TOOLS / "judge_engine.mjs", TOOLS / "plane_engine.mjs"
PACKAGES = ("three", "playcanvas", "babylonjs", "babylonjs-loaders")
ENGINES = pathlib.Path(os.environ.get("LIGHTGRID_ENGINES", ".")).resolve()


def run(*words):
    return subprocess.run([str(w) for w in words], cwd=ENGINES, capture_output=True, text=True, timeout=1500)


class Engines(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def judged(self, size, engine, *settings):
        frame = self.folder / size
        if not frame.exists():
            made = run(PROGRAM, "capture", "spheres", "--lights", 300, "--size", size, "-o", frame)
            self.assertEqual(made.returncode, 0, made.stderr)
        made = run("node", TOOL, engine, frame, *settings)
        self.assertEqual(made.returncode, 0, made.stderr)
        report = self.folder / "judged.json"
        judge = run(PROGRAM, "cull", frame, "--judge", "-o", self.folder / "judged", "--json", report)
        result = json.loads(report.read_text())
        self.assertEqual(judge.returncode, 1 if result["lost_lights"] else 0, judge.stderr)
        self.assertGreater(result["pairs"]["lit"], 50_000)
        self.assertEqual(result["pairs"]["wrong"], 0)
        return result

    def test_three_loses_nothing_if_tiles_divide_the_size(self):
        self.assertEqual(self.judged("320x192", "three")["lost_lights"], [])
        self.assertEqual(self.judged("320x200", "three", "tileSize=8")["lost_lights"], [])

    def test_three_loses_lights_where_its_tiles_do_not_divide_the_size(self):
        self.assertGreater(self.judged("320x200", "three", "maxLightsPerCluster=300")["pairs"]["lost"], 0)

    def test_playcanvas_loses_nothing_with_room_for_all_lights(self):
        result = self.judged("320x200", "playcanvas", "maxLights=300", "cells=20x20x20")
        self.assertEqual(result["lost_lights"], [])
        self.assertLess(result["pairs"]["listed"], 60 * result["pairs"]["lit"])

    def test_playcanvas_loses_the_lights_after_the_first_that_have_room(self):
        lost = self.judged("320x200", "playcanvas", "maxLights=100", "cells=20x20x20")["lost_lights"]
        self.assertGreater(len(lost), 50)
        self.assertGreaterEqual(min(light["light"] for light in lost), 100)

    def test_the_tool_refuses(self):
        self.judged("320x192", "playcanvas")
        frame = self.folder / "320x192"
        grid = (frame / "grid.json").read_bytes()
        self.assertIn("maxlights: no setting; settings are cells, maxLights", run("node", TOOL, "playcanvas", frame, "maxlights=3").stderr)
        view = json.loads((frame / "view.json").read_text())
        view["clip_from_view"][2] = 0.25
        (frame / "view.json").write_text(json.dumps(view))
        self.assertIn("only centred perspective views", run("node", TOOL, "playcanvas", frame).stderr)
        self.assertEqual((frame / "grid.json").read_bytes(), grid)

    def points(self, engines):
        """Each of (engine, settings) as a point of a sweep, by its label."""
        words = []
        for number, (engine, settings) in enumerate(engines):
            file = self.folder / f"{number}.json"
            command = ["node", str(PLANE), engine, *(f"{key}={value}" for key, value in settings.items())]
            # The tool finds the packages from the folder in which it runs.
            command = ["sh", "-c", 'cd "$1" && shift && exec "$@"', "sh", str(ENGINES), *command]
            file.write_text(json.dumps({"name": engine, "settings": settings, "command": command, "timeout_s": 300}))
            words += ["--external", file]
        made = run(PROGRAM, "frontier", "spheres", "--lights", 24, "--size", "160x90", "--views", 1, "--rounds", 3, "--no-growth", "--truth", "own",
                   "-t", "visibility", *words, "-o", self.folder / "plane")
        self.assertEqual(made.returncode, 0, made.stderr)
        answer = json.loads((self.folder / "plane/frontier.json").read_text())
        self.assertEqual(answer["failures"], [])
        return {point["label"]: point for point in answer["points"]}

    def test_pictures_differ_by_the_formulas_that_the_page_names(self):
        points = self.points([(engine, settings) for engine in ("three", "playcanvas", "babylon") for settings in ({}, {"gltf": "all"})])
        for engine in ("three", "playcanvas", "babylon"):
            own, changed = (points[label]["error"]["total"]["displayed_flip"]["mean"] for label in (engine, engine + ":gltf=all"))
            self.assertLess(changed, 0.02, engine)
            self.assertGreater(own, 5 * changed, engine)
            self.assertGreater(points[engine]["cpu_ms"]["median"], 0)

    def test_a_killed_tool_leaves_no_browser(self):
        def browsers():
            commands = []
            for process in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    commands.append((process / "cmdline").read_text())
                except OSError:
                    pass  # it has ended
            return [command for command in commands if f"--user-data-dir={self.folder}" in command]

        def wait_until(condition):
            end = time.monotonic() + 60
            while not condition() and time.monotonic() < end:
                time.sleep(0.1)
            return condition()

        for end in (signal.SIGKILL, signal.SIGTERM):
            tool = subprocess.Popen(["node", PLANE, "three"], cwd=ENGINES, stdin=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                    env=os.environ | {"TMPDIR": str(self.folder)})
            self.assertTrue(wait_until(browsers))
            tool.send_signal(end)
            tool.communicate()
            self.assertTrue(wait_until(lambda: not browsers()), end)


if __name__ == "__main__":
    missing = [name for name in ("node", os.environ.get("CHROMIUM", "chromium")) if not shutil.which(name)]
    missing += [name for name in PACKAGES if not (ENGINES / "node_modules" / name / "package.json").exists()]
    if missing:
        print(f"skipped: not installed: {', '.join(missing)}")
        sys.exit(77)
    unittest.main(verbosity=2)
