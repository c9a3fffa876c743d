"""The examples of methods from outside (examples/external): they run, are measured, and say what they miss.

    examples_test.py PROGRAM
"""
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

EXAMPLES = pathlib.Path(__file__).resolve().parents[3] / "examples" / "external"
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()


needs_scipy = unittest.skipUnless(importlib.util.find_spec("scipy"), "python3-scipy is not installed")


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "run"

    def run_program(self, experiment, *words):
        environment = os.environ | {"PATH": "/usr/bin:/bin", "PYTHONDONTWRITEBYTECODE": "1"}
        return subprocess.run(
            [PROGRAM, "run", experiment, "--allow-commands", "--no-pictures", "--out", self.out, *words],
            env=environment, capture_output=True, text=True, check=False)

    def done(self, name, *words, codes=(0,)):
        """{variant: {metric or summary: numbers}} of the only case, none of which failed."""
        ended = self.run_program(EXAMPLES / f"{name}.toml", *words)
        self.assertIn(ended.returncode, codes, ended.stderr)
        found = {}
        with h5py.File(self.out / "run.h5") as file:
            for variant, record in file["cases/default/variants"].items():
                self.assertEqual(record.attrs["status"], "done", variant)
                found[variant] = {metric: np.asarray(data[()]) for kind in ("metrics", "summary") if kind in record
                                  for metric, data in record[kind].items()}
        return found

    def test_linear_blend_in_numpy_is_linear_blend(self):
        numbers = self.done("linear-blend")
        mine, theirs = numbers["numpy"], numbers["linear-blend"]
        self.assertEqual(set(mine), set(theirs))
        self.assertGreater(len(mine), 5)
        for metric, value in theirs.items():
            # A root of round-off is larger.
            near = 1e-8 if metric.startswith("singular_value_max") else 1e-9
            np.testing.assert_allclose(mine[metric], value, rtol=near, atol=near, equal_nan=True, err_msg=metric)

    @needs_scipy
    def test_poisson_scatter_keeps_density_and_distance(self):
        numbers = self.done("poisson-scatter")
        mine, naive = numbers["scipy"], numbers["naive-stretch"]
        # It starts where all start: its triangulation of the plane is that of the program.
        self.assertEqual(mine["visible_edge_change"][0], 0)
        self.assertEqual(mine["edge_variation"][0], naive["edge_variation"][0])
        # 200 details at rest: rounding, and at the end the few places that are left for darts.
        np.testing.assert_allclose(mine["density_ratio"], 1, atol=0.02)
        np.testing.assert_allclose(naive["density_ratio"][-1], 0.5, atol=1e-9)
        self.assertLess(np.abs(mine["visible_edge_change"]).max(), 0.03)
        # No two are nearer than at rest, when the surface is stretched.
        self.assertGreaterEqual(mine["smallest_edge"].min(), naive["smallest_edge"][0] * (1 - 1e-5))
        self.assertEqual(mine["removed_total"], 0)

    def test_silhouette_hull_has_the_silhouettes_and_is_closed(self):
        numbers = self.done("silhouette-hull")
        mine, theirs = numbers["numpy"], numbers["visual-hull"]
        self.assertGreater(mine["silhouette_iou"][-1], 0.99)
        self.assertLess(mine["silhouette_hausdorff"][-1], 2)
        # Gauss and Bonnet: at least 4 pi, without a border.
        self.assertGreaterEqual(mine["angle_defect_sum"][-1], 4 * np.pi)
        # Both are boxes about the mitten; the program's is open at the cuff.
        self.assertLess(abs(mine["surface_area_error"][-1] - theirs["surface_area_error"][-1]), 0.1)

    @needs_scipy
    def test_a_surface_that_is_not_flat_is_refused(self):
        bent = 'scene.motion.deform=[{kind="bend", keys=[{t=0, value=0}, {t=1, value=60}]}]'
        ended = self.run_program(EXAMPLES / "poisson-scatter.toml", "--variant", "scipy", "--set", bent)
        self.assertEqual(ended.returncode, 2)
        self.assertIn("frame 1: the surface is not flat in z", ended.stderr)

    def test_a_drawing_without_silhouettes_is_refused(self):
        experiment = self.out.with_name("one-view.toml")
        experiment.write_text(
            'title = "One view"\ntopic = "sketch"\n[scene]\nsynthetic = {}\n[[variant]]\nname = "numpy"\n'
            f'method = "external"\noptions = {{ command = ["python3", "{EXAMPLES / "silhouette_hull.py"}"] }}\n')
        ended = self.run_program(experiment)
        self.assertEqual(ended.returncode, 2)
        self.assertIn("the scene has 0 silhouettes", ended.stderr)

    def test_water_of_blender_falls_as_ours(self):
        fronts = {name: numbers["dam_front_error"] for name, numbers in self.done("blender-dam", "--quick").items()}
        self.assertLess(np.nanmax(fronts["blender"]), 0.1)

    def test_preserved_volume_of_blender_is_that_of_dual_quaternions(self):
        # A claim about variants that are left out is not decided.
        words = ("--variant", "dual-quaternion", "blender-dual-quaternion")
        numbers = self.done("blender-knee", *words, codes=(0, 1))
        theirs, ours = (numbers[name]["volume_change"] for name in words[:0:-1])
        self.assertGreater(np.nanmax(ours), 0.05)
        np.testing.assert_allclose(theirs, ours, atol=5e-3)


if __name__ == "__main__":
    unittest.main()
