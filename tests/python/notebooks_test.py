"""The notebooks of docs/notebooks run from their first cell to their last."""
import os
import pathlib
import tempfile
import unittest

notebooks = sorted((pathlib.Path(__file__).resolve().parents[2] / "docs/notebooks").glob("*.ipynb"))


class Notebooks(unittest.TestCase):
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
