"""The Python package against the program and against NumPy."""
import gc
import logging
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import zipfile

import numpy as np

import lightgrid_render as lg

root = pathlib.Path(__file__).resolve().parents[2]
size = (133, 71)
device = lg.Device(opengl="none")


def hall(**fields):
    return lg.Scene("hall", size=size, lights=40, seed=3, **fields)


def floor(**fields):
    """20 m x 20 m, as two triangles, seen from above."""
    mesh = dict(positions=[[-10, 0, -10], [-10, 0, 10], [10, 0, 10], [10, 0, -10]], indices=[[0, 1, 2], [0, 2, 3]],
                material=dict(metallic=0, base_color=(0.5, 0.5, 0.5)))
    fields = {"size": (64, 36), "camera": dict(eye=(0, 6, 12), target=(0, 0, 0)), **fields}
    return lg.Scene.from_arrays([mesh], **fields)


class FirstStart(unittest.TestCase):
    def test_reports_each_kernel_that_is_compiled(self):
        program = """
import lightgrid_render as lg
calls = []
lg.on_compiling(lambda *call: calls.extend(call))
lg.Device(opengl="none").render(lg.Scene("spheres", size=(32, 18)))
print(*calls)
"""
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "XDG_CACHE_HOME": folder, "LIGHTGRID_CL_CACHE": "", "LIGHTGRID_CL_QUICK_BUILD": "all"}
            first, second = ([int(word) for word in subprocess.run(
                [sys.executable, "-c", program], env=environment, check=True, capture_output=True, text=True).stdout.split()]
                for _ in range(2))
        numbers, totals = first[0::2], first[1::2]
        self.assertGreater(max(numbers), 3)
        self.assertEqual([number for number in numbers if number], list(range(1, max(numbers) + 1)))
        self.assertEqual(max(numbers), max(totals))
        self.assertEqual((numbers[-1], totals[-1]), (0, 0))
        self.assertEqual(second, [])


class PublicNames(unittest.TestCase):
    def test_have_words(self):
        without = []
        for name in set(lg.__all__) - {"light_dtype"}:  # data, with a comment
            value = getattr(lg, name)
            members = {f"{name}.{key}": member for key, member in vars(value).items()
                       if not key.startswith("_")} if isinstance(value, type) else {}
            without += [key for key, member in {name: value, **members}.items() if not getattr(member, "__doc__", None)]
        self.assertEqual(without, [])


class Images(unittest.TestCase):
    def test_has_the_bytes_of_the_command_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            theirs, ours = f"{folder}/theirs.exr", f"{folder}/ours.exr"
            subprocess.run([os.environ["LIGHTGRID_PROGRAM"], "--quiet", "render", "hall", "--size", "133x71", "--lights", "40",
                            "--seed", "3", "-t", "visibility:tile=32", "-o", theirs], check=True)
            device.render(hall(), "visibility", tile=32).save(ours)
            self.assertEqual(pathlib.Path(ours).read_bytes(), pathlib.Path(theirs).read_bytes())

    def test_are_written_into_the_callers_memory(self):
        view = device.view(hall(), "visibility")
        image = view.render()
        self.assertEqual((image.shape, image.dtype), ((71, 133, 4), np.float32))
        memory = np.full((73, 133, 4), -1, np.float32)
        for out in (memory[1:-1], memory[1:-1][::-1]):
            memory[:] = -1
            self.assertTrue(np.shares_memory(view.render(out), memory))
            np.testing.assert_array_equal(out, image)
            self.assertTrue((memory[[0, -1]] == -1).all())

    def test_are_shown_where_the_library_has_them(self):
        scene = hall()
        view = device.view(scene, "visibility")
        image = view.render()
        shown = view.draw()
        self.assertIsInstance(shown, lg.Image)
        np.testing.assert_array_equal(shown, image)
        self.assertEqual(view.draw().ctypes.data, shown.ctypes.data)  # the same memory in each frame: OpenCL's own
        self.assertTrue(np.shares_memory(np.from_dlpack(shown), shown))
        view.look(dict(eye=(0, 2, 5), target=(0, 1, 0)))
        moved = view.render()
        self.assertGreater(abs(moved - image).max(), 0.1)
        np.testing.assert_array_equal(shown, moved)  # the view's next frame
        view.look(size=(64, 36))
        small = view.draw()
        scene.lights = lg.lights(3, radius_m=2)
        view.draw()
        del view, scene
        gc.collect()
        self.assertEqual(small.shape, (36, 64, 4))
        np.testing.assert_array_equal(shown, moved)  # memory lives as long as its array

    def test_are_bytes_where_wished(self):
        view = device.view(hall(exposure=1), "visibility", picture="bytes")
        expected = lg.srgb(view.render(), 1)
        shown = view.draw()
        self.assertEqual((shown.shape, shown.dtype), ((71, 133, 4), np.uint8))
        np.testing.assert_array_equal(shown[..., :3], expected)
        out = np.zeros((71, 133, 4), np.uint8)
        self.assertIs(view.render(out), out)
        np.testing.assert_array_equal(out, shown)
        self.assertTrue((out[..., 3] == 255).all())

    def test_are_exchanged_by_dlpack(self):
        class Tensor:
            """A tensor of another library."""

            def __init__(self, array):
                self.array = array

            def __dlpack__(self, **_):
                return self.array.__dlpack__()

            def __dlpack_device__(self):
                return self.array.__dlpack_device__()

        view = device.view(hall(), "visibility")
        memory = np.zeros((71, 133, 4), np.float32)
        view.render(out=Tensor(memory))
        image = view.render()
        np.testing.assert_array_equal(memory, image)
        self.assertTrue(np.shares_memory(np.from_dlpack(image), image))
        self.assertEqual(lg.measure(Tensor(memory), image, "max_abs"), 0)

    def test_begin_with_the_top_row(self):
        # Light from above the floor's far end, which is at the top of the picture; depth falls with distance.
        view = device.view(floor(lights=lg.lights(position=(0, 1, -8), intensity=10, radius_m=4)), "visibility")
        image, depth = view.render(), view.depth()
        lit = image[..., :3].sum((1, 2))
        self.assertLess(lit.argmax(), 18)
        self.assertEqual(depth[0].max(), 0)
        self.assertGreater(depth[-1].min(), 0)

    def test_are_pictures_in_notebooks(self):
        image = device.render(hall(), "visibility")
        self.assertTrue(image._repr_png_().startswith(b"\x89PNG"))
        self.assertIsNone(image[..., 0]._repr_png_())
        self.assertEqual(image.picture().shape, (71, 133, 3))
        with tempfile.TemporaryDirectory() as folder:
            image.save(f"{folder}/x.png", exposure=1)
            self.assertTrue(os.path.getsize(f"{folder}/x.png"))

    def test_measures_are_those_worked_out_by_hand(self):
        reference = np.ones((2, 4, 3), np.float32)
        reference[0, 1, 0] = 2
        image = reference.copy()
        image[1, 2, 1] = 1.5
        self.assertEqual(lg.measure(image, reference, "max_rel"), 0.25)
        self.assertAlmostEqual(lg.measure(image, reference, "rmse"), (0.25 / 24) ** 0.5, places=12)
        error = lg.flip(image, reference)
        self.assertEqual(np.unravel_index(error.argmax(), error.shape), (1, 2))
        self.assertAlmostEqual(error.mean(), lg.measure(image, reference, "flip_mean"), places=6)


class ListsOfLights(unittest.TestCase):
    def test_hold_every_light_that_reaches_a_surface(self):
        scene = hall()
        view = device.view(scene, "visibility")
        view.render()
        depth, lights, projection = view.depth(), scene.lights, scene.projection(size)
        lists = device.cull(projection, depth, lights, cull_test="exact")

        # NumPy's own: the point that each pixel shows, and the lights whose ranges hold it with a margin for float.
        rows, columns = np.mgrid[0:71, 0:133]
        clip = np.stack([(columns + 0.5) / 133 * 2 - 1, 1 - (rows + 0.5) / 71 * 2, depth, np.ones_like(depth)], -1)
        view_space = clip.astype(np.float64) @ np.linalg.inv(projection.clip_from_view).T
        points = view_space[..., :3] / view_space[..., 3:] @ projection.view_from_world[:3, :3] + projection.eye
        distance = np.linalg.norm(points[:, :, None] - lights["position"], axis=-1)
        reached = (distance < lights["radius_m"] * (1 - 1e-5)) & (depth > 0)[..., None] & (lights["type"] == 0)  # no spots
        listed = np.zeros_like(reached)
        for y in range(71):
            for x in range(133):
                listed[y, x, lists.at(x, y)] = True
        self.assertGreater(reached.sum(), 10000)
        self.assertEqual((reached & ~listed).sum(), 0)
        self.assertLess(listed.sum(), 6 * reached.sum())
        np.testing.assert_array_equal(lists.counts(), listed.sum(-1))

        # Rasterising gives the depth that the frame had.
        triangles, drawn = device.rasterize(scene, projection)
        np.testing.assert_array_equal(drawn, depth)
        np.testing.assert_array_equal(triangles == 0xFFFFFFFF, depth == 0)

    def test_hold_a_light_under_a_matrix_that_is_not_quite_rigid(self):
        """One light reaches pixel (31, 31) by less than 1e-9 m; the others, 2^20 m away, make its position round."""
        near, radius, depth = 0.001, 2.0**-10, np.full((64, 64), 0.1, np.float32)
        distance = near / float(depth[0, 0])
        for stretch in (0, 2.4e-6, 3.5e-6, 4.9e-6):
            clip = [[100, 0, 0, 0], [0, 100, 0, 0], [0, 0, 0, near], [0, 0, -1, 0]]
            projection = lg.Projection(clip, np.diag([1 + stretch] * 3 + [1]), (0, 0, 0), (64, 64))
            side = -1 / 64 / 100 * distance / (1 + stretch)
            z = -np.floor((distance + radius) / (1 + stretch) * 2**32 - 1) / 2**32
            lights = lg.lights(position=[(side, -side, z)] + [(side, -side, z + 2**20 + 0.1875)] * 127,
                               radius_m=[radius] + [1] * 127)
            for test in ("sphere", "planes", "aabb", "planes+aabb", "exact"):
                self.assertIn(0, device.cull(projection, depth, lights, cull_test=test).at(31, 31), (test, stretch))

    def test_live_as_long_as_their_arrays(self):
        def indices():
            projection = hall().projection(size)
            return device.cull(projection, None, lg.lights(20, radius_m=3), depth_bounds="none").indices

        kept = indices()
        gc.collect()
        self.assertTrue((kept < 20).all())
        self.assertTrue(np.shares_memory(np.from_dlpack(kept), kept))


class Scenes(unittest.TestCase):
    def test_are_made_of_arrays_and_dictionaries(self):
        place = np.array([[-2, 1, 0], [2, 1, 0]])
        above = dict(eye=(0, 5, 0), target=(0, 0, 0))
        by_columns = floor(camera=above,
                           lights=lg.lights(position=place, color=(1, 0.5, 0.2), intensity=[3, 5], radius_m=4))
        by_rows = floor(camera=above,
                        lights=[dict(position=(-2, 1, 0), color=(1, 0.5, 0.2), intensity=3, radius_m=4),
                                dict(position=(2, 1, 0), color=(1, 0.5, 0.2), intensity=5, radius_m=4, type="point")])
        np.testing.assert_array_equal(by_columns.lights, by_rows.lights)
        image = device.render(by_columns, "visibility")
        np.testing.assert_array_equal(device.render(by_rows, "visibility"), image)
        # By hand: 1 m below a light of intensity i a surface of albedo a sends a / pi * i * window, less the 4 % that the
        # dielectric reflects; a fiftieth of that besides is its highlight and ambient light.
        window = 1 - (1 / 4) ** 4
        self.assertAlmostEqual(image[..., 0].max(), 0.96 * 0.5 / np.pi * 5 * window, delta=0.03)

    def test_follow_lights_that_move(self):
        scene = floor(lights=lg.lights(position=[[-4, 1, 0], [4, 1, 0]], intensity=5, radius_m=4))
        view = device.view(scene, "visibility")
        before = view.render()
        lights = scene.lights
        lights["position"][:, 2] += 3
        scene.lights = lights
        after = view.render()
        self.assertGreater(abs(after - before).max(), 0.1)
        np.testing.assert_array_equal(after, device.render(scene, "visibility"))
        scene.set_light_properties(1, groups=["none"])
        self.assertEqual(scene.light_properties(1), {"groups": [0]})
        scene.set_light_properties(1, groups=list(range(32)))
        self.assertEqual(scene.light_properties(1), {})
        view.look(dict(eye=(0, 12, 1), target=(0, 0, 0)), (40, 30))
        self.assertEqual(view.render().shape, (30, 40, 4))


class Errors(unittest.TestCase):
    def check(self, field, words, call):
        with self.assertRaises(lg.InputError) as caught:
            call()
        self.assertIsInstance(caught.exception, ValueError)
        self.assertEqual(caught.exception.field, field, caught.exception)
        self.assertIn(words, str(caught.exception))

    def test_are_the_programs_own(self):
        scene = hall()
        self.check("tile", 'set tile=7: "7" is not a value of tile', lambda: device.view(scene, "visibility", tile=7))
        self.check("cull-tests", "did you mean cull-test?", lambda: device.view(scene, "visibility", cull_tests="exact"))
        self.check("technique", "did you mean visibility?", lambda: device.view(scene, "visibilty"))
        self.check("size", "size 0x5", lambda: lg.Scene("hall", size=(0, 5)))
        self.check("scene", "did you mean hall?", lambda: lg.Scene("hal"))
        self.check("light-radius", "light-radius 3,2", lambda: hall(light_radius=(3, 2)))
        self.check("lights[1].radius_m", "nan", lambda: setattr(scene, "lights", lg.lights(2, radius_m=[1, np.nan])))
        with self.assertRaises(lg.MachineError):
            device.view(scene, "forward_plus")

    def test_refuse_complex_numbers(self):
        scene = hall()
        positions, indices = np.zeros((3, 3), complex), [[0, 1, 2]]
        self.check("positions", "complex", lambda: lg.Scene.from_arrays([{"positions": positions, "indices": indices}]))
        self.check("position", "complex", lambda: lg.lights(1, position=[[1j, 0, 0]]))
        self.check("world_from_object", "complex", lambda: scene.move_instance(0, np.eye(4) * 1j))
        self.check("ambient", "complex", lambda: scene.set_ambient([1j, 0, 0]))

    def test_name_the_argument(self):
        scene = hall()
        view = device.view(scene, "visibility")
        self.check("out", "is not float32", lambda: view.render(np.zeros((71, 133, 4))))
        self.check("out", "(71, 132) is not (71, 133)", lambda: view.render(np.zeros((71, 132, 4), np.float32)))
        self.check("out", "gaps", lambda: view.render(np.zeros((71, 133, 8), np.float32)[..., ::2]))
        self.check("out", "read-only", lambda: view.render([1, 2]))
        self.check("scene", "'hall' is no Scene", lambda: device.render("hall", "visibility"))
        self.check("size", "size 640", lambda: lg.Scene("hall", size=640))
        self.check("lights", "nor dictionaries", lambda: setattr(scene, "lights", np.zeros((3, 4))))
        self.check("technique", "did you mean visibility?", lambda: device.compare(scene, "visibilty"))
        self.check("intensities", "is no column", lambda: lg.lights(intensities=3))
        self.check("type", "lamp is not", lambda: lg.lights(type="lamp"))
        self.check("roughnes", "is nothing of a material", lambda: floor().add_material(roughnes=1))
        self.check("indices", "whole numbers", lambda: floor().add_mesh(np.eye(3), [[0, 1, -2]]))
        self.check("mesh.indices", "index 2 is 9", lambda: floor().add_mesh(np.eye(3), [[0, 1, 9]]))
        self.check("uv", "shape (2, 2)", lambda: floor().add_mesh(np.eye(3), [[0, 1, 2]], uv=np.eye(2)))

    def test_are_no_lines_on_stderr(self):
        with self.assertLogs("lightgrid_render", logging.INFO) as log:
            lg.Scene("particles", size=size, time=1)
        self.assertIn("time 1: ", log.output[0])


class Comparisons(unittest.TestCase):
    def test_are_tables_and_pages(self):
        seen = []
        report = device.compare(hall(), ["visibility:lights=all", "visibility"], frames=1, compare={"tile": [16, 32]},
                                progress=lambda done, step: seen.append((done, step)) and None)
        self.assertEqual([row["technique"] for row in report.rows], ["visibility"] * 4)
        self.assertEqual(report.rows[2]["pairs"]["lost"], 0)
        self.assertEqual(seen[-1][0], 1)
        self.assertEqual(len(report.table()), 4)
        page = report._repr_html_()
        self.assertIn("srcdoc", page)
        self.assertNotIn("<script", page)  # escaped: it is the frame's
        np.testing.assert_array_equal(report.image(2), device.render(hall(), "visibility"))

    def test_end_where_progress_wants(self):
        with self.assertRaises(lg.Cancelled):
            device.compare(hall(), ["visibility"], progress=lambda done, step: True)

        def fail(done, step):
            device.view(hall(), "visibility")  # and lets go of it
            gc.collect()
            raise KeyError(step)

        with self.assertRaises(KeyError):
            device.compare(hall(), ["visibility"], progress=fail)


class Threads(unittest.TestCase):
    def test_have_a_device_each(self):
        images = [None, None]

        def draw(i):
            own = lg.Device(opengl="none")
            images[i] = own.render(hall(), "visibility")

        threads = [threading.Thread(target=draw, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_array_equal(images[0], images[1])


class Wheel(unittest.TestCase):
    def test_holds_the_library_and_serves_every_python(self):
        try:
            import setuptools
            import wheel  # noqa: F401
        except ImportError:
            self.skipTest("there is no setuptools or wheel")
        if int(setuptools.__version__.split(".")[0]) < 61:
            self.skipTest("setuptools is older than 61")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-c", "import setuptools.build_meta as b, sys; b.build_wheel(sys.argv[1])", folder],
                           cwd=copied(root, folder), check=True, capture_output=True)
            found = list(pathlib.Path(folder).glob("*.whl"))
            self.assertEqual(len(found), 1)
            self.assertRegex(found[0].name, r"^lightgrid_render-[0-9.]+-py3-none-linux_\w+\.whl$")
            with zipfile.ZipFile(found[0]) as archive:
                archive.extractall(f"{folder}/site")
            environment = {**os.environ, "PYTHONPATH": f"{folder}/site"}
            del environment["LIGHTGRID_LIBRARY"]
            out = subprocess.run([sys.executable, "-c", "import lightgrid_render as lg; print(lg.__file__, lg.version())"],
                                 env=environment, cwd=folder, capture_output=True, text=True)
            self.assertEqual(out.returncode, 0, out.stderr)
            self.assertIn(f"{folder}/site", out.stdout)
            self.assertIn("commit", out.stdout)


def copied(source, folder):
    """The package's folder, without what a build leaves in it, beside the files of the checkout that it reads."""
    shutil.copytree(source / "python", f"{folder}/tree/python")
    os.makedirs(f"{folder}/tree/src/apps/c_api")
    for name in ("CMakeLists.txt", "src/apps/c_api/lightgrid.h"):
        shutil.copyfile(source / name, f"{folder}/tree/{name}")
    return f"{folder}/tree/python"


if __name__ == "__main__":
    unittest.main()
