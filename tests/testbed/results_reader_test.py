"""Runs as `import geoprior_results` reads them, on runs that are written here, and the recipes of examples/results.
Run with Debian's python3."""

import contextlib
import importlib.util
import io
import json
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path[:0] = [str(HERE), str(REPOSITORY / "results")]

import runfile  # noqa: E402
from geoprior_results import RunError, newest_run, open_run, open_runs, run_folders  # noqa: E402
from report_test import ANGLES, make_run, signed  # noqa: E402

HAS_PANDAS = importlib.util.find_spec("pandas") is not None
STAMPS = ("20260101T000000Z-0000000a", "20260102T000000Z-0000000b", "20260102T000000Z-0000000b-2")


def run_recipe(name, *arguments):
    """(exit code, stdout, stderr) of a script of examples/results."""
    out, err = io.StringIO(), io.StringIO()
    main = runpy.run_path(str(REPOSITORY / "examples/results" / f"{name}.py"))["main"]
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main([str(a) for a in arguments])
            code = 0
        except SystemExit as end:
            code = end.code
    return code, out.getvalue(), err.getvalue()


class Scratch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.run = self.root / "run"
        self.make(self.run)

    def make(self, folder):
        folder.mkdir(parents=True)
        make_run(folder)


class OpenRun(Scratch):
    def test_has_what_was_written(self):
        with signed(self.run, "a") as file:
            table = file.create_dataset("cases/default/variants/implicit/tables/folds", data=np.array([[0.0, 1.5]]))
            table.attrs["columns"] = ["frame", "length [m]"]
        run = open_run(self.run)
        case = run.case("default")
        variant = case.variant("implicit")
        self.assertEqual((run.experiment_id, run.topic, run.title), ("test/knee", "skinning", "Knee <flexion> & more"))
        self.assertEqual(run.provenance["git_commit"], "0123456789abcdef")
        self.assertEqual([v.name for v in case.variants], ["dual-quaternion", "implicit"], "in the experiment's order")
        np.testing.assert_array_equal(variant.parameter, ANGLES)
        overlap = variant.metrics["overlap_excess"]
        np.testing.assert_array_equal(overlap.values, [0, 1e-9, 2e-9])
        self.assertEqual((overlap.unit, overlap.definition, overlap.direction),
                         ("m^3", "What overlap_excess is.", "lower_is_better"))
        self.assertEqual(variant.summary["overlap_excess.max"].values, 2e-9)
        self.assertEqual((variant.timing["solve"].shape, variant.seconds_a_frame()), ((3, 4), 0.004))
        self.assertEqual([e["kind"] for e in variant.events], [b"hit", b"hit"])
        self.assertEqual(variant.tables["folds"].columns, ["frame", "length [m]"])
        self.assertEqual(variant.tables["folds"].values.tolist(), [[0.0, 1.5]])
        self.assertEqual(variant.frame_files, ["frames/x.vtp"])
        self.assertEqual(run.file(variant.frame_files[0]), self.run / "frames/x.vtp")
        self.assertIsNone(run.case("other"))

    def test_names_no_file_outside_of_the_run(self):
        run = open_run(self.run)
        for name in ("../run.h5", "/etc/passwd"):
            with self.assertRaisesRegex(RunError, f"{self.run}: a file of it leaves it"):
                run.file(name)

    def test_refuses_what_is_missing_cut_off_or_changed_and_names_the_file(self):
        path = self.run / "run.h5"
        whole = path.read_bytes()
        for content in (b"", whole[:100], whole[:-1], whole[:5000] + b"\xff" + whole[5001:]):
            path.write_bytes(content)
            with self.assertRaisesRegex(RunError, f"^{path}: is damaged or another file.* or force=True"):
                open_run(self.run)
        (self.run / "journal.jsonl").rename(self.run / "no journal")
        with self.assertRaisesRegex(RunError, "is not in the journal .* or force=True"):
            open_run(self.run)
        with self.assertRaisesRegex(RunError, "is not in the journal .* or --force"):  # an option of scripts
            runfile.read_run(self.run)
        path.write_bytes(whole[:len(whole) // 2])
        with self.assertRaisesRegex(RunError, f"^{path}: damaged or not a run file"):
            open_run(self.run, force=True)
        path.unlink()
        with self.assertRaisesRegex(RunError, f"^{path}: no such file"):
            open_run(self.run)

    def test_shows_no_text_that_a_terminal_obeys_and_reads_what_is_not_shown_as_it_is(self):
        turned = "\u202eknee\x1b[8m\x85"
        with signed(self.run, "a") as file:
            file.attrs["title"] = turned
            file.attrs["experiment"] = '[figure_view]\nmetrics = ["\u202emetric"]\n'
            options = json.dumps({"command": [turned]}, ensure_ascii=False)
            file["cases/default/variants/implicit"].attrs["options"] = options
        run = open_run(self.run)
        self.assertEqual(run.title, r"\xe2\x80\xaeknee\x1b[8m\xc2\x85")
        self.assertEqual(run.case("default").variant("implicit").options, {"command": [turned]})
        self.assertEqual(run.view, {"metrics": ["\u202emetric"]})

    def test_names_what_a_run_file_lacks(self):
        with signed(self.run, "a") as file:
            del file["cases/default/variants/implicit/metrics/overlap_excess"].attrs["unit"]
        with self.assertRaisesRegex(RunError, "run.h5: damaged or not a run file .*unit"):
            open_run(self.run)


class NewestRun(Scratch):
    def setUp(self):
        super().setUp()
        self.folders = [self.root / "test/knee" / stamp for stamp in STAMPS]
        for folder in self.folders:
            self.make(folder)

    def test_is_the_one_that_began_last_and_is_finished(self):
        (self.root / "test/knee/20260103T000000Z-0000000c").mkdir()
        (self.root / "test/knee/notes").mkdir()
        self.assertEqual(run_folders("test/knee", self.root), self.folders)
        self.assertEqual(newest_run("test/knee", self.root).folder, self.folders[-1])
        self.assertEqual(len(list(open_runs("test/knee", str(self.root)))), 3)

    def test_is_looked_for_below_geoprior_runs_where_nothing_else_is_said(self):
        with mock.patch.dict(os.environ, GEOPRIOR_RUNS=str(self.root)):
            self.assertEqual(newest_run("test/knee").folder, self.folders[-1])
            with self.assertRaisesRegex(RunError, f"^{self.root}: has no finished run of 'test/elbow'"):
                newest_run("test/elbow")
            self.assertEqual(run_folders("test/knee", self.root / "elsewhere"), [])
        with mock.patch.dict(os.environ, GEOPRIOR_RUNS=""):
            with self.assertRaisesRegex(RunError, "^results/runs: has no finished run of 'test/none'"):
                newest_run("test/none")

    def test_that_is_not_there_is_named(self):
        with self.assertRaisesRegex(RunError, f"^{self.root}: has no finished run of 'test/elbow'"):
            newest_run("test/elbow", self.root)
        for name in ("knee", "../test/knee", "a/b/c", ""):
            with self.assertRaisesRegex(RunError, "is no identifier of an experiment"):
                newest_run(name, self.root)


class Frames(Scratch):
    def test_without_pandas_say_what_to_install(self):
        run, hidden = open_run(self.run), sys.modules.get("pandas")
        sys.modules["pandas"] = None  # what an import finds then is nothing
        try:
            for table in (run.table, run.cases[0].variants[0].to_frame):
                with self.assertRaisesRegex(ImportError, "pip install pandas"):
                    table()
        finally:
            del sys.modules["pandas"]
            if hidden:
                sys.modules["pandas"] = hidden

    @unittest.skipUnless(HAS_PANDAS, "no pandas")
    def test_have_a_row_a_frame_and_a_row_a_variant(self):
        run = open_run(self.run)
        frames = run.cases[0].variant("implicit").to_frame()
        self.assertEqual((frames.index.name, list(frames.index)), ("angle", ANGLES.tolist()))
        self.assertEqual(frames["overlap_excess"].tolist(), [0, 1e-9, 2e-9])
        self.assertEqual(frames.attrs["units"]["diagnostic:work_done"], "J")
        table = run.table().set_index("variant")
        self.assertEqual(table.loc["implicit", ["case", "seconds_a_frame", "overlap_excess.max"]].tolist(),
                         ["default", 0.004, 2e-9])


class Package(Scratch):
    def test_needs_nothing_else_of_the_repository(self):
        shutil.copytree(REPOSITORY / "results/geoprior_results", self.root / "geoprior_results")
        code = f"import sys; sys.path.insert(0, {str(self.root)!r}); import geoprior_results as g; print(g.open_run('run'))"
        ran = subprocess.run([sys.executable, "-B", "-I", "-c", code], cwd=self.root, capture_output=True, text=True)
        self.assertEqual((ran.stdout, ran.stderr), (
            "<run of test/knee: 1 cases of dual-quaternion, implicit>\n", ""))

    def test_is_typed_and_has_the_programs_version(self):
        self.assertTrue((REPOSITORY / "results/geoprior_results/py.typed").is_file())
        cmake = (REPOSITORY / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"^project\(geoprior VERSION (\S+)", cmake, re.MULTILINE)[1]
        self.assertIn(f'\nversion = "{version}"\n', (REPOSITORY / "results/pyproject.toml").read_text(encoding="utf-8"))

    @unittest.skipUnless(importlib.util.find_spec("mypy") and os.environ.get("GEOPRIOR_LONG"), "no mypy, or not at length")
    def test_passes_mypy(self):
        ran = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(self.root)],
                             cwd=REPOSITORY / "results", capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stdout)


class Recipes(Scratch):
    """The two variants of the run: 0.001 s and 4e-6 m^3 of overlap, 0.004 s and 2e-9 m^3."""

    def require_refused(self, message, name, *arguments):
        code, out, err = run_recipe(name, *arguments)
        self.assertEqual((code, out, err.count("\n")), (2, "", 1))
        self.assertRegex(err, message)

    def test_significance_of_three_seeds_is_one_in_four_at_best(self):
        with signed(self.run, "a") as file:
            for seed in (2, 3):
                file.copy("cases/default", f"cases/seed={seed}")
                case = file[f"cases/seed={seed}"]
                case.attrs.update(index=seed, claims_only=1)
                case["swept"].attrs["seed"] = str(seed)
                case["variants/implicit/summary/overlap_excess.max"][...] = seed * 1e-6
        code, out, _ = run_recipe("significance", self.run, "overlap_excess.max", "implicit", "dual-quaternion")
        lines = [line.split() for line in out.splitlines()]
        self.assertEqual((code, lines[0]), (0, ["overlap_excess.max,", "3", "seeds"]))
        self.assertEqual([lines[1][-1], lines[2][-1], lines[4][-1]], ["1.6673e-06", "4e-06", "0.25"])
        self.assertEqual(lines[3][3:], ["-2.3327e-06", "[-3.998e-06,", "-1e-06]"])

    def test_significance_needs_seeds(self):
        self.require_refused(f"{self.run}: 1 cases that differ by their seed alone", "significance", self.run,
                             "overlap_excess.max", "implicit", "dual-quaternion")

    def test_front_has_the_fast_one_and_the_good_one(self):
        code, out, _ = run_recipe("front", self.run, "overlap_excess.max", "--plot", self.root / "front.svg")
        self.assertEqual((code, [line.split()[-1] for line in out.splitlines()]), (0, ["front", "front"]))
        self.assertIn("<svg", (self.root / "front.svg").read_text(encoding="utf-8"))
        code, out, _ = run_recipe("front", self.run, "volume_change.min", "--target", 0)
        self.assertIn("dominated by dual-quaternion", out.splitlines()[1], "slower, and twice as far from 0")

    def make_fail(self, folder, name):
        with signed(folder, "a") as file:
            file[f"cases/default/variants/{name}"].attrs.update(status="failed", error="does not converge")

    def test_front_leaves_out_what_failed(self):
        self.make_fail(self.run, "dual-quaternion")
        code, out, err = run_recipe("front", self.run, "volume_change.min", "--target", 0)
        self.assertEqual((code, err), (0, "left out: dual-quaternion is failed\n"))
        self.assertRegex(out, r"^implicit .*front\n$")

    def test_significance_has_no_pair_of_what_failed(self):
        with signed(self.run, "a") as file:
            for seed in (2, 3):
                file.copy("cases/default", f"cases/seed={seed}")
                file[f"cases/seed={seed}"].attrs["index"] = seed
        arguments = "significance", self.run, "overlap_excess.max", "implicit", "dual-quaternion"
        self.assertEqual(run_recipe(*arguments)[0], 0)
        self.make_fail(self.run, "implicit")
        self.require_refused(f"{self.run}: 2 cases that differ by their seed alone", *arguments)

    def test_front_refuses_what_has_no_better(self):
        self.require_refused("has direction closer_to_target", "front", self.run, "volume_change.min")
        self.require_refused("no variant of the case has a time and 'nothing'", "front", self.run, "nothing")
        self.require_refused("no such file", "front", self.root / "elsewhere", "overlap_excess.max")
        self.require_refused("nowhere", "front", self.run, "overlap_excess.max", "--plot", self.root / "nowhere/a.svg")

    def test_trend_has_a_line_a_run_and_names_what_it_leaves_out(self):
        for stamp, commit in zip(STAMPS, "abc"):
            folder = self.root / "test/knee" / stamp
            self.make(folder)
            with signed(folder, "a") as file:
                file.attrs.update(git_commit=commit * 40, git_dirty="true" if commit == "b" else "false")
        (self.root / "test/knee" / STAMPS[2] / "run.h5").write_bytes(b"damaged")
        arguments = ("trend", "test/knee", "overlap_excess.max", "implicit", "--root", self.root)
        code, out, err = run_recipe(*arguments, "--quick", "--plot", self.root / "trend.png")
        self.assertEqual((code, [line.split()[1:] for line in out.splitlines()]),
                         (0, [["a" * 12, "2e-09", "m^3"], ["b" * 12 + "+", "2e-09", "m^3"]]))
        self.assertRegex(err, f"^left out: .*{STAMPS[2]}/run.h5: is damaged")
        self.assertEqual((self.root / "trend.png").read_bytes()[1:4], b"PNG")

    def test_trend_is_of_geoprior_runs_and_leaves_out_what_failed(self):
        for stamp in STAMPS[:2]:
            self.make(self.root / "test/knee" / stamp)
        self.make_fail(self.root / "test/knee" / STAMPS[0], "implicit")
        arguments = "trend", "test/knee", "overlap_excess.max", "implicit"
        with mock.patch.dict(os.environ, GEOPRIOR_RUNS=str(self.root)):
            code, out, err = run_recipe(*arguments, "--quick")
            self.assertEqual((code, out.count("\n")), (0, 1))
            self.assertRegex(err, f"^left out: .*{STAMPS[0]}: implicit is failed\n$")
            self.require_refused(f"^{self.root}: no full run of 'test/knee' has it", *arguments)
            self.require_refused("^elsewhere: no full run", *arguments, "--root", "elsewhere")

    def test_trend_refuses_what_has_no_run(self):
        self.require_refused("no full run of 'test/elbow' has it", "trend", "test/elbow", "overlap_excess.max",
                             "implicit", "--root", self.root)


if __name__ == "__main__":
    unittest.main()
