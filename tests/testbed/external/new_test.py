"""`geoprior new external <topic>`: the folder runs as it stands, and every number is that of the variant beside; with the
instance that its function names, a judged one is not.

    new_test.py PROGRAM
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
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


def variants_of(run):
    """Name of the variant beside, what was recorded of it, and of the method from outside."""
    with h5py.File(run / "run.h5") as file:
        (case,) = file["cases"].values()
        variants = {name: {kind: {number: values[()] for number, values in variant[kind].items()}
                           for kind in ("metrics", "summary")} | {"error": variant.attrs["error"]}
                    for name, variant in case["variants"].items()}
    mine = variants.pop("mine")
    ((name, beside),) = variants.items()
    assert mine["error"] == "", mine["error"]
    return name, beside, mine


def edit(script):
    """Makes the function return what it says that it may."""
    text = script.read_text()
    instance = re.search(r"For instance: (return .+)\n", text)[1]
    text, count = re.subn(r"\n    return (points|place|sound)\n", lambda _: f"\n    {instance}\n", text)
    assert count == 1, script
    script.write_text(text)


class NewExternal(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_ok(self, *words, **more):
        ended = program(*words, **more)
        self.assertIn(ended.returncode, (0, 1), ended.stderr[-2000:])

    def test_every_topic_runs_as_it_stands_and_as_edited(self):
        for topic in TOPICS:
            with self.subTest(topic):
                mine, run, edited = (self.folder / f"{topic}{of}" for of in ("", "-run", "-edited"))
                self.run_ok("new", "external", topic, "--out", mine)
                self.run_ok("run", mine / "experiment.toml", "--allow-commands", "--no-pictures", "--out", run)
                name, beside, external = variants_of(run)
                for kind in ("metrics", "summary"):
                    # Measured against its reference it has more.
                    self.assertLessEqual(set(beside[kind]), set(external[kind]))
                    for number in beside[kind]:
                        np.testing.assert_array_equal(external[kind][number], beside[kind][number], f"{topic} {number}")
                self.assert_is_drawn(mine, run)
                edit(mine / "my_method.py")
                self.run_ok("run", mine / "experiment.toml", "--allow-commands", "--no-pictures", "--out", edited)
                self.assertNotEqual(self.judged(edited, name), [])
                if topic == "skinning":  # a fifth longer along one axis
                    growth = variants_of(edited)[2]["metrics"]["volume_change_global"]
                    self.assertAlmostEqual(growth[0], 0.2, places=6)

    def assert_is_drawn(self, mine, run):
        """The part that is drawn, and what is drawn over it, is there; of some topics its picture is made, too."""
        view = tomllib.loads((mine / "experiment.toml").read_text())["figure_view"]
        for part in (view.get("part", "surface"), *view.get("overlays", ())):
            self.assertTrue(list((run / "frames/default/mine").glob(f"{part}_*.vtp")), f"{mine.name} {part}")
        pictures = {"grammar": ["figure.png"], "sound": ["figure.png", "spectrogram.png"]}.get(mine.name, [])
        if pictures:
            self.run_ok("render", run)
        for picture in pictures:
            self.assertTrue((run / picture).is_file(), f"{mine.name} {picture}")

    def judged(self, run, beside):
        """Metrics in which a run's method is worse or better than the variant beside."""
        ended = program("compare", run, run, "--variants", f"{beside}=mine", "--json")
        return [value["metric"] for value in json.loads(ended.stdout)["values"] if value["change"] in ("worse", "better")]

    def test_what_it_says_can_be_typed(self):
        mine = self.folder / "it's a \x1bb"
        said = program("new", "external", "skinning", "--out", mine).stderr
        self.assertNotIn("\x1b", said)
        (line,) = (line for line in said.splitlines() if line.startswith("next"))
        script = 'geoprior() { printf "%s" "$2"; }; ' + line.split(maxsplit=1)[1]
        typed = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout
        self.assertTrue(pathlib.Path(typed).samefile(mine / "experiment.toml"))

    def test_what_is_there_stays(self):
        (self.folder / "mine").mkdir()
        (self.folder / "mine/thesis.tex").write_text("years")
        for words, said in ((("skinning", "--out", self.folder / "mine"), "is there already"),
                            (("nowhere", "--out", self.folder / "other"), "nowhere not in {assembly,")):
            ended = program("new", "external", *words)
            self.assertEqual(ended.returncode, 2)
            self.assertIn(said, ended.stderr)
        self.assertEqual([path.name for path in self.folder.rglob("*")], ["mine", "thesis.tex"])


if __name__ == "__main__":
    unittest.main()
