"""export, then external, of one experiment a topic: every metric to the last bit, in VTP and where PLY holds the parts.

    round_trip.py PROGRAM
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import h5py
import numpy as np

HOME = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()

# Cheap ones, of small versions.
OF_TOPIC = {
    "skinning": "options-scene", "paper": "options-scene", "sound": "options", "fluid": "options-extract",
    "details": "options-motion", "sketch": "options-flat", "torus": "against-integration", "assembly": "substructures",
    "grammar": "imported", "embryo": "cloaca"}

# Topics whose metrics read nothing but points, triangles and numbers on them.
PLY_HOLDS = {"skinning"}


def program(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)


def toml(value):
    """A value of a resolved experiment as TOML, tables inline."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def values_of(run):
    """{(case, variant, name): numbers} of all metrics and summaries of a run."""
    values = {}
    with h5py.File(run / "run.h5") as file:
        for case, of_case in file["cases"].items():
            for variant, record in of_case["variants"].items():
                if record.attrs["status"] != "done":
                    values[case, variant, "status"] = record.attrs["error"]
                for kind in ("metrics", "summary"):
                    for name, data in record[kind].items():
                        values[case, variant, f"{kind}/{name}"] = np.asarray(data[()])
    return values


def equal(a, b):
    return np.array_equal(a, b, equal_nan=True) if isinstance(a, np.ndarray) and isinstance(b, np.ndarray) else a == b


class RoundTrip(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *words):
        ended = program(*words)
        self.assertIn(ended.returncode, (0, 1), ended.stderr[-2000:])
        return ended

    def external_twin(self, topic, run, exported):
        """The experiment of a run, whose variants all read what was exported."""
        spec = tomllib.loads((run / "spec.toml").read_text())
        spec["variant"] = [
            {key: value for key, value in variant.items() if key in ("name", "role", "reference")}
            | {"method": "external", "options": {"frames": f"{exported}/{{case}}/{{variant}}"}}
            for variant in spec["variant"]]
        for key in ("claim", "study", "sweep", "check", "tolerance"):
            if key != "sweep":
                spec.pop(key, None)
        for entry in (HOME / "experiments" / topic).iterdir():
            link = self.folder / entry.name
            if not link.exists():
                link.symlink_to(entry)
        twin = self.folder / "twin-experiment.toml"
        twin.write_text("\n".join(f"{json.dumps(key)} = {toml(value)}" for key, value in spec.items()) + "\n")
        return twin

    def check(self, topic, experiment, form):
        run, exported, again = (self.folder / name for name in ("run", "exported", f"again-{form}"))
        if not run.exists():
            self.run_program("run", f"{topic}/{experiment}", "--quick", "--no-pictures", "--out", run)
        exported = exported.with_name(f"exported-{form}")
        self.run_program("export", run, "--format", form, "--out", exported)
        twin = self.external_twin(topic, run, exported)
        self.run_program("run", twin, "--no-pictures", "--out", again)
        before, after = values_of(run), values_of(again)
        self.assertEqual(set(before), set(after))
        for key, value in before.items():
            self.assertTrue(equal(value, after[key]), f"{topic}/{experiment} {key}: {value} became {after[key]}")


def add_tests():
    for topic, experiment in OF_TOPIC.items():
        def test(self, topic=topic, experiment=experiment):
            self.check(topic, experiment, "vtp")
            if topic in PLY_HOLDS:
                self.check(topic, experiment, "ply")
        setattr(RoundTrip, f"test_{topic}", test)


add_tests()

if __name__ == "__main__":
    unittest.main()
