"""`geoprior new external <topic>`: the folder runs as it stands, and every number is that of the variant beside.

    new_test.py PROGRAM
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
TOPICS = ["skinning", "paper", "sound", "fluid", "details", "sketch", "torus", "assembly", "grammar", "embryo"]


def program(*words, **more):
    # The Python that has NumPy is Debian's own.
    environment = os.environ | {"PATH": "/usr/bin:/bin"}
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False, env=environment,
                          **more)


class NewExternal(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_ok(self, *words, **more):
        ended = program(*words, **more)
        self.assertIn(ended.returncode, (0, 1), ended.stderr[-2000:])

    def test_every_topic_runs_as_it_stands(self):
        for topic in TOPICS:
            with self.subTest(topic):
                mine, run = self.folder / topic, self.folder / f"{topic}-run"
                self.run_ok("new", "external", topic, "--out", mine)
                self.run_ok("run", mine / "experiment.toml", "--allow-commands", "--no-pictures", "--out", run)
                with h5py.File(run / "run.h5") as file:
                    for case in file["cases"].values():
                        variants = dict(case["variants"])
                        external = variants.pop("mine")
                        self.assertEqual(external.attrs["error"], "")
                        (beside,) = variants.values()
                        for kind in ("metrics", "summary"):
                            # Measured against its reference it has more.
                            self.assertLessEqual(set(beside[kind]), set(external[kind]))
                            for name in beside[kind]:
                                self.assertTrue(np.array_equal(external[kind][name][()], beside[kind][name][()],
                                                               equal_nan=True), f"{topic} {name}")

    def test_one_edited_function_and_the_numbers_differ(self):
        self.run_ok("new", "external", "skinning", cwd=self.folder)
        mine = self.folder / "my-skinning-method"
        script = mine / "my_method.py"
        script.write_text(script.read_text().replace("    return points\n", "    return 1.01 * points\n"))
        self.run_ok("run", mine / "experiment.toml", "--allow-commands", "--no-pictures", "--out", self.folder / "run")
        with h5py.File(self.folder / "run/run.h5") as file:
            mine = file["cases/default/variants/mine/metrics/volume_change_global"][:]
            np.testing.assert_allclose(mine[0], 1.01**3 - 1, rtol=1e-6)

    def test_what_is_there_stays(self):
        (self.folder / "mine").mkdir()
        (self.folder / "mine/thesis.tex").write_text("years")
        for words, said in ((("skinning", "--out", self.folder / "mine"), "is there already"),
                            (("nowhere", "--out", self.folder / "other"), "unknown topic 'nowhere'")):
            ended = program("new", "external", *words)
            self.assertEqual(ended.returncode, 2)
            self.assertIn(said, ended.stderr)
        self.assertEqual([path.name for path in self.folder.rglob("*")], ["mine", "thesis.tex"])


if __name__ == "__main__":
    unittest.main()
