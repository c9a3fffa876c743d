"""docs/replicability.md and Table 4.1 from records, and scripts/replicate.py with a program that only copies runs. Run
with Debian's python3."""

import dataclasses
import json
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path[:0] = [str(HERE), str(REPOSITORY / "results")]

import cost_control  # noqa: E402
import records  # noqa: E402
import replicability  # noqa: E402
from report_test import make_run  # noqa: E402

PUBLISHED = records.read_records(REPOSITORY)

# What stands in for the program: it lists three experiments, and does what the middle of their names says.
PROGRAM = """#!{python}
import json, pathlib, shutil, signal, sys, time
here = pathlib.Path(__file__).parent
def stopped(*_):
    (folder / "journal.jsonl").write_text("")
    sys.exit(2)
if sys.argv[1] == "list":
    names = [("2.10", "toy/breaks"), ("2.7", "toy/holds"), ("3.11 left", "toy/waits"), ("", "toy/study")]
    print(json.dumps({{"experiments": [{{"figure": f, "id": i}} for f, i in names]}}))
    sys.exit(0)
name, folder = sys.argv[2], pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
with open(here / "calls", "a") as calls:
    calls.write(" ".join(sys.argv[2:]).replace(str(folder), "DIR") + "\\n")
if name == "toy/breaks":
    sys.stderr.write("error: planted\\n")
    sys.exit(3)
if name == "toy/waits" and "--resume" not in sys.argv:
    folder.mkdir()
    signal.signal(signal.SIGINT, stopped)
    (here / "waiting").touch()
    while True:
        time.sleep(60)
shutil.copytree(here / "run", folder, dirs_exist_ok=True)
sys.exit(1)
"""


class Table(unittest.TestCase):
    def test_has_the_figures_in_the_order_of_the_thesis(self):
        self.assertEqual(sorted(["3.11 right", "3.2", "2.13", "3.11 left", "2.7"], key=replicability.figure_key),
                         ["2.7", "2.13", "3.2", "3.11 left", "3.11 right"])

    def test_has_a_row_of_every_record_of_a_figure_and_no_other(self):
        named = [re.search(r"`geoprior run (\S+)`", line)[1] for line in replicability.lines(PUBLISHED, REPOSITORY)[2:]]
        self.assertEqual(sorted(named), sorted(r.experiment_id for r in PUBLISHED.values() if r.figure))

    def test_names_the_runs_that_a_file_needs(self):
        self.assertEqual(replicability.runs_needed({"a": ["run:fluid/tank/flip", {"b": "run:paper/snap/hybrid"}], "c": 1}),
                         {"fluid/tank", "paper/snap"})

    def test_adds_up_what_was_recorded_and_nothing_else(self):
        record = dataclasses.replace(PUBLISHED["skinning/knee"], times={
            "a": {"x": {"prepare": 1, "whole": 2, "memory": 5}, "y": {"prepare": 3, "whole": 4}}})
        self.assertEqual((replicability.seconds_of_methods(record), replicability.peak_memory(record)), (10, 5))
        record.times["a"]["y"]["whole"] = None
        self.assertTrue(math.isnan(replicability.seconds_of_methods(record)))


class CostAndControl(unittest.TestCase):
    def test_names_runs_variants_and_studies_that_are_published(self):
        for system in cost_control.SYSTEMS:
            self.assertTrue(cost_control.times_of(system, PUBLISHED), system)
            self.assertEqual(cost_control.growth(system, PUBLISHED) == "–", system.growth == ("", ""), system)

    def test_names_what_a_user_can_set(self):
        """Each stands in the experiment's file, or between quotes in the sources of its topic."""
        for system in cost_control.SYSTEMS:
            file = replicability.claimed.file_of(REPOSITORY, system.experiment)
            rooms = [REPOSITORY / room / file.parent.name for room in ("models", "solvers", "experiments")]
            text = file.read_text(encoding="utf-8") + "".join(
                source.read_text(encoding="utf-8") for room in rooms for source in room.rglob("*.cpp"))
            for name in system.sets:
                found = re.search(rf'"{re.escape(name)}"|\b{re.escape(name)} *=', text)
                self.assertTrue(found, f"{system.section}: {name}")

    def test_leaves_open_what_is_not_recorded(self):
        row = cost_control.lines({})[2].split(" | ")
        self.assertEqual(row[4:10], ["–"] * 6)
        self.assertEqual(cost_control.problems(REPOSITORY, {}), [], "nothing to draw")

    def test_draws_anew_what_the_records_change(self):
        changed = dict(PUBLISHED)
        times = json.loads(json.dumps(PUBLISHED["sketch/boot"].times))
        times["default"]["several-views"]["median"] *= 2
        changed["sketch/boot"] = dataclasses.replace(PUBLISHED["sketch/boot"], times=times)
        self.assertEqual(len(cost_control.problems(REPOSITORY, changed)), 1)


class Replicate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.out = Path(folder.name), Path(folder.name) / "out"
        (self.root / "run").mkdir()
        make_run(self.root / "run")
        self.program = self.root / "geoprior"
        self.program.write_text(PROGRAM.format(python=sys.executable), encoding="utf-8")
        self.program.chmod(0o755)

    def start(self, *arguments):
        command = [sys.executable, "-B", REPOSITORY / "scripts/replicate.py", "--geoprior", self.program, *arguments]
        return subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def call(self, *arguments):
        """(exit code, stdout, stderr)"""
        script = self.start(*arguments)
        out, err = script.communicate()
        return script.returncode, out, err

    def entries(self):
        log = json.loads((self.out / "replicate.json").read_text(encoding="utf-8"))
        return {entry["experiment"]: entry for entry in log["runs"]}

    def test_writes_down_what_held_goes_on_after_a_failure_and_leaves_what_is_done(self):
        code, _, err = self.call("2.7", "2.10", "--quick", "--out", self.out)
        self.assertEqual((code, err), (3, ""))
        self.assertEqual((self.root / "calls").read_text(), "toy/holds --quick --out DIR\ntoy/breaks --quick --out DIR\n")
        holds, breaks = self.entries()["toy/holds"], self.entries()["toy/breaks"]
        self.assertEqual((holds["exit_code"], holds["content_sha256"], holds["claims"], holds["not_held"], holds["as_published"]),
                         (1, "b" * 64, "holds in 1, falls short in 1", ["bulge stays"], False))
        self.assertTrue(all(holds[key] > 0 for key in ("wall_s", "processor_s", "peak_memory_bytes")))
        self.assertEqual((breaks["exit_code"], breaks["problem"]), (3, f"failed: {self.out}/toy/breaks.txt has its words"))
        self.assertIn("- `toy/holds`: bulge stays", (self.out / "replicate.md").read_text(encoding="utf-8"))
        self.assertEqual((self.out / "toy/breaks.txt").read_text(), "error: planted\n")
        self.assertEqual(self.call("toy/holds", "--quick", "--out", self.out)[0], 1)
        self.assertEqual((self.root / "calls").read_text().count("toy/holds"), 1)

    def test_that_is_stopped_goes_on(self):
        script = self.start("3.11", "--out", self.out)
        while not (self.root / "waiting").exists():
            self.assertIsNone(script.poll(), "it ends before it is stopped")
            time.sleep(0.01)
        os.kill(script.pid, signal.SIGINT)
        _, err = script.communicate()
        self.assertEqual((script.returncode, err), (2, "stopped: the same command goes on\n"))
        self.assertEqual(self.entries()["toy/waits"]["problem"], "stopped")
        self.assertEqual(self.call("3.11", "--out", self.out)[0], 1)
        self.assertTrue((self.root / "calls").read_text().endswith("toy/waits --out DIR --resume\n"))
        self.assertEqual(self.entries()["toy/waits"]["claims"], "holds in 1, falls short in 1")

    def test_refuses_in_one_line(self):
        (self.root / "file").touch()
        for arguments, message in ((["9.9", "--out", self.out], "^'9.9' is no figure .*2.7, 2.10, 3.11 left"),
                                   (["2.7", "--out", self.root / "file"], f"^{self.root}/file: cannot be written into"),
                                   (["2.7", "--out", "/proc/nowhere"], "^/proc/nowhere: cannot be written into"),
                                   (["--geoprior", self.root / "nothing"], "nothing: does not list its experiments")):
            code, out, err = self.call(*arguments)
            self.assertEqual((code, out, err.count("\n")), (2, "", 1), err)
            self.assertRegex(err, message)
        self.assertFalse(self.out.exists())

    def test_refuses_a_log_of_the_other_size_or_of_something_else(self):
        self.call("2.7", "--quick", "--out", self.out)
        self.assertRegex(self.call("2.7", "--out", self.out)[2], "replicate.json: is of quick runs .*\n$")
        (self.out / "replicate.json").write_text("[]")
        self.assertRegex(self.call("2.7", "--out", self.out)[2], "replicate.json: is no log of replicate.py .*\n$")


if __name__ == "__main__":
    unittest.main()
