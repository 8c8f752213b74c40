"""The notebooks of docs/notebooks run from their first cell to their last."""
import contextlib
import io
import json
import os
import pathlib
import tempfile
import unittest

notebooks = sorted((pathlib.Path(__file__).resolve().parents[2] / "docs/notebooks").glob("*.ipynb"))


def cell_with(name, words):
    """The source of the notebook's code cell that has these words."""
    notebook = next(path for path in notebooks if path.stem == name)
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return next("".join(c["source"]) for c in cells if c["cell_type"] == "code" and words in "".join(c["source"]))


class Notebooks(unittest.TestCase):
    def test_print_points_whose_probability_was_not_measured(self):
        def point(label, on, probability):
            return {"label": label, "relative_time": {"estimate": 1, "ci95": [0.9, 1.1]},
                    "error": {"total": {"displayed_flip": {"mean": 0.5}}},
                    "fronts": {"total": {"on": on, "probability": probability}}}

        with tempfile.TemporaryDirectory() as folder:
            answer = {"points": [point("known", True, 0.97), point("fast", True, None), point("slow", False, None)]}
            pathlib.Path(folder, "frontier.json").write_text(json.dumps(answer))
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(cell_with("frontier_of_a_scene", "def figures"), {"json": json, "os": os, "folder": folder})
        known, fast, slow = printed.getvalue().splitlines()
        self.assertTrue(known.endswith("front (97%)"), known)
        self.assertTrue(fast.endswith("front (not measured)"), fast)
        self.assertTrue(slow.endswith(")         (not measured)"), slow)

    def test_run_clean(self):
        try:
            import ipykernel  # noqa: F401
            import nbformat
            from nbclient import NotebookClient
        except ImportError:
            self.skipTest("there is no nbclient or ipykernel (Debian: python3-nbclient, python3-ipykernel)")
        self.assertGreaterEqual(len(notebooks), 5)
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "IPYTHONDIR": folder, "JUPYTER_RUNTIME_DIR": folder, "JUPYTER_CONFIG_DIR": folder}
            for path in notebooks:
                with self.subTest(path.name):
                    notebook = nbformat.read(path, as_version=4)
                    self.assertTrue(all(not cell.outputs for cell in notebook.cells if cell.cell_type == "code"))
                    client = NotebookClient(notebook, timeout=300, resources={"metadata": {"path": folder}})
                    client.execute(env=environment)


if __name__ == "__main__":
    unittest.main()
