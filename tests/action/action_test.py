#!/usr/bin/env python3
"""action_test.py PROGRAM: the composite action's steps, run by bash as a runner does, with a built program.

Not run here: what a runner alone does (uploads, `if:`); apt-get and the build of a checkout are stand-ins.
77, skipped, without PyYAML (Debian: python3-yaml)."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import yaml
except ImportError:
    if os.path.exists("/usr/bin/python3") and not os.environ.get("ACTION_TEST_RETRIED"):
        os.environ["ACTION_TEST_RETRIED"] = "1"  # this Python was a virtual environment's
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])
    print("skipped: no PyYAML (Debian: python3-yaml)")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
ACTION = ROOT / ".github/actions/lightgrid"
PROGRAM = None


def load(path):
    return yaml.safe_load(path.read_text())


class Runner:
    """Runs the steps that have `run`, with `env` as expressions say; stops at the first that fails."""

    def __init__(self, folder, inputs, action_path=ACTION):
        action = load(ACTION / "action.yml")
        values = {name: str(i.get("default", "")) for name, i in action["inputs"].items()} | inputs
        self.known = {f"inputs.{name}": value for name, value in values.items()}
        self.summary = folder / "summary"
        self.out, self.status = "", 0
        for step in action["runs"]["steps"]:
            if "run" not in step:
                continue
            outputs = folder / f"outputs_{step['id']}"
            env = os.environ | {name: self.value_of(text) for name, text in step.get("env", {}).items()}
            env |= {"GITHUB_OUTPUT": str(outputs), "GITHUB_STEP_SUMMARY": str(self.summary),
                    "GITHUB_ACTION_PATH": str(action_path), "PATH": f"{folder}/bin:{os.environ['PATH']}"}
            # As GitHub's documentation has `shell: bash`.
            command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
            ran = subprocess.run(command, cwd=folder, env=env, text=True, capture_output=True)
            self.out += ran.stdout + ran.stderr
            self.status = ran.returncode
            for line in outputs.read_text().splitlines() if outputs.exists() else []:
                name, value = line.split("=", 1)
                self.known[f"steps.{step['id']}.outputs.{name}"] = value
            if self.status:
                break

    def value_of(self, text):
        return re.sub(r"\$\{\{ ([\w.-]+) \}\}", lambda found: self.known[found[1]], text)


class Action(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.golden = json.loads((ROOT / "assets/golden_hashes/visibility/golden.json").read_text())
        self.golden["scenes"] = [s for s in self.golden["scenes"] if s["scene"] == "rooms"]
        self.assertEqual(len(self.golden["scenes"]), 1)

    def run_steps(self, inputs=None, folder="pictures in a folder", **paths):
        (self.folder / folder).mkdir()
        (self.folder / folder / "golden.json").write_text(json.dumps(self.golden))
        return Runner(self.folder, {"folder": folder, "program": PROGRAM} | (inputs or {}), **paths)

    def stand_in(self, path, script):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/bash\n" + script)
        path.chmod(0o755)

    def test_same(self):
        ran = self.run_steps()
        self.assertEqual(ran.status, 0, ran.out)
        self.assertIn("rooms visibility 0: same", ran.summary.read_text())
        self.assertEqual(ran.known["steps.check.outputs.status"], "0")
        self.assertIn('failures="0"', (self.folder / "golden-output/junit.xml").read_text())
        sarif = json.loads((self.folder / "golden-output/golden.sarif").read_text())
        self.assertEqual(sarif["runs"][0]["results"], [])

    def test_a_difference_fails_and_leaves_its_files(self):
        self.golden["scenes"][0]["set"] = ["window=none"]
        ran = self.run_steps({"output": "out"})
        self.assertEqual(ran.status, 1, ran.out)
        self.assertEqual(ran.known["steps.check.outputs.status"], "1")
        self.assertRegex(ran.out, r"::error title=golden::rooms visibility 0: differs first in radiance: ")
        self.assertIn("differs first in radiance", ran.summary.read_text())
        for name in ["junit.xml", "golden.sarif", "results.json", "pictures/00_0000.drawn.png"]:
            self.assertTrue((self.folder / "out" / name).exists(), name)

    def test_wrong_input_fails(self):
        self.golden["scenes"][0]["scene"] = "no such scene"
        ran = self.run_steps()
        self.assertEqual(ran.status, 2, ran.out)
        self.assertIn("::error title=golden::exit status 2", ran.out)

    def test_no_package_fails(self):
        ran = self.run_steps({"program": "", "deb": "none.deb"})
        self.assertEqual(ran.status, 2, ran.out)
        self.assertIn("::error::deb: there is no file none.deb", ran.out)

    def test_a_package_is_installed_with_its_opencl(self):
        log = self.folder / "log"
        self.stand_in(self.folder / "bin/sudo", 'exec "$@"\n')
        self.stand_in(self.folder / "bin/apt-get", f'printf "%s|" "$@" >> "{log}"\n')
        self.stand_in(self.folder / "bin/lightgrid", 'printf "%s|" "$@"\n')
        (self.folder / "a package.deb").touch()
        ran = self.run_steps({"program": "", "deb": "a package.deb"})
        self.assertEqual(ran.status, 0, ran.out)
        self.assertEqual(log.read_text(), "update|install|-y|--no-install-recommends|"
                         f"{self.folder.resolve()}/a package.deb|pocl-opencl-icd|")
        self.assertIn("golden|check|pictures in a folder|-o|golden-output/pictures|", ran.out)

    def test_a_checkout_is_built(self):
        self.stand_in(self.folder / "checkout/lightgrid", 'printf "%s|" "$@"\n')
        path = self.folder / "checkout/.github/actions/lightgrid"
        path.mkdir(parents=True)
        ran = self.run_steps({"program": ""}, action_path=path)
        self.assertEqual(ran.status, 0, ran.out)
        self.assertTrue(ran.out.startswith("--yes|--version|"), ran.out)
        self.assertIn("golden|check|pictures in a folder|", ran.out)

    def test_expressions_and_inputs_are_declared(self):
        action = load(ACTION / "action.yml")
        text = (ACTION / "action.yml").read_text()
        steps = {s["id"]: s for s in action["runs"]["steps"] if "id" in s}
        for name in re.findall(r"inputs\.([\w-]+)", text):
            self.assertIn(name, action["inputs"])
        for step, output in re.findall(r"steps\.(\w+)\.outputs\.(\w+)", text):
            self.assertIn(f'echo "{output}=', steps[step]["run"])
        for step in action["runs"]["steps"]:
            self.assertNotIn("${{", step.get("run", ""), "an input within a script may be a command")
            self.assertEqual("run" in step, "shell" in step)

    def test_workflows_use_it_as_it_is(self):
        inputs = load(ACTION / "action.yml")["inputs"]
        used = 0
        for path in (ROOT / ".github/workflows").glob("*.yml"):
            for job in load(path)["jobs"].values():
                for step in job["steps"]:
                    if step.get("uses") != "./.github/actions/lightgrid":
                        continue
                    used += 1
                    self.assertLessEqual(set(step["with"]), set(inputs))
                    self.assertIn("folder", step["with"])
                    for folder in job["strategy"]["matrix"]["folder"]:
                        path = step["with"]["folder"].replace("${{ matrix.folder }}", folder)
                        self.assertTrue((ROOT / path / "golden.json").exists(), path)
        self.assertGreater(used, 0)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
