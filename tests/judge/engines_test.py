#!/usr/bin/env python3
"""tools/judge: the lists of three.js and PlayCanvas for a captured frame, judged by PROGRAM.

    engines_test.py PROGRAM

It needs node, chromium, and the two packages in node_modules of $LIGHTGRID_ENGINES or the current folder; without them it is skipped (77).
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv.pop(1))
TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools/judge/judge_engine.mjs"
ENGINES = pathlib.Path(os.environ.get("LIGHTGRID_ENGINES", ".")).resolve()


def run(*words):
    return subprocess.run([str(w) for w in words], cwd=ENGINES, capture_output=True, text=True, timeout=400)


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


if __name__ == "__main__":
    missing = [name for name in ("node", os.environ.get("CHROMIUM", "chromium")) if not shutil.which(name)]
    missing += [name for name in ("three", "playcanvas") if not (ENGINES / "node_modules" / name / "package.json").exists()]
    if missing:
        print(f"skipped: not installed: {', '.join(missing)}")
        sys.exit(77)
    unittest.main(verbosity=2)
