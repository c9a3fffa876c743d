"""What results/*.py make of runs that a stranger wrote: texts are set as they stand, pages have
limits and say what they leave out, and whatever breaks is one line. Run with Debian's python3."""

import base64
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from unittest import mock

import numpy as np
from matplotlib import cbook

sys.path.insert(0, str(Path(__file__).resolve().parent))

import report_test  # noqa: E402
from report_test import Page, RESULTS, add_metric, make_processes, make_run, run_script, signed  # noqa: E402

import plots  # noqa: E402
import report  # noqa: E402
import report_html  # noqa: E402
import report_parts  # noqa: E402
import runfile  # noqa: E402
from geoprior_results.texts import printable  # noqa: E402

# What mathtext or a font cannot set, or a page or a terminal not show: a few of each kind, with GEOPRIOR_LONG all.
TEXTS = [r"$\frac{1$", "$$", "bell\x07 esc\x1b[2J", "漢字 🙂", "", "<b>&\n\t" + "x" * 5000]
if os.environ.get("GEOPRIOR_LONG"):
    TEXTS += [r"$\bad$", "a_$b^{$c", "^", "_", "\\", r"\$x$ and $", "{}%&#~", " ", "two\nlines\ttab"]


def rename(group, old, new):
    group.move(old, "renamed")
    group.move("renamed", new.replace("%", "%25").replace("/", "%2F") or "%20")


def rename_everything(folder, text):
    """Gives the text to all that has a name or a unit of its own."""
    with signed(folder, "a") as file:
        file.attrs.update(title=text, figure=text)
        del file.attrs["experiment"]
        file.attrs["experiment"] = "[figure_view]\n"
        case = file["cases/default"]
        case.attrs.update(parameter_name=text, parameter_unit=text)
        case.attrs["warnings"] = [text]
        variant = case["variants/implicit"]
        for metrics in (variant["metrics"], variant["summary"]):
            for metric in metrics.values():
                metric.attrs.update(unit=text, definition=text)
        rename(variant["metrics"], "volume_change", text or "none")
        rename(variant["timing"], "elastic", text or "none")
        rename(case["variants"], "implicit", text or "none")
        rename(file["study"], "growth", text or "none")
        rename(file["cases"], "default", text or "none")
        for study in file["study"].values():
            study.attrs["quantity"] = text


class StrangeTextTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="geoprior-report-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_any_text_is_drawn_as_it_stands(self):
        for text in TEXTS:
            with self.subTest(text=text[:40]):
                make_run(self.folder)
                make_processes(self.folder)
                rename_everything(self.folder, text)
                page = report.build([runfile.read_run(self.folder)])
                for uri in Page(page).loads:
                    if uri.startswith("data:image/svg"):
                        ElementTree.fromstring(base64.b64decode(uri.split(",")[1]))
                self.assertNotRegex(page, "[\x00-\x08\x0b-\x1f\x7f]")

    def test_a_character_that_the_font_lacks_costs_no_words(self):
        make_run(self.folder)
        with signed(self.folder, "a") as file:
            file["cases/default"].attrs["parameter_name"] = "漢字 🙂"
        done = run_script("plots", self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_dollars_begin_no_mathematics(self):
        for text in TEXTS:
            drawn = plots.plain(text)
            self.assertFalse(cbook.is_math_text(drawn), text)
            shown = drawn.replace(r"\$", "$")  # as matplotlib does with a text without mathematics
            if len(text) <= plots.MOST_CHARACTERS:
                self.assertEqual(shown, " ".join(text.split()))

    def test_bytes_that_are_no_utf8_are_escaped(self):
        self.assertEqual(printable(runfile.text(b"a\xff\xe9b")), r"a\xff\xe9b")
        self.assertEqual(printable("bell\x07, \x9b, 90°\n"), "bell\\x07, \\xc2\\x9b, 90°\n")
        self.assertEqual(report_html.escape("\udcff<"), r"\xff&lt;")

    def test_folders_that_are_no_utf8_are_folders_like_others(self):
        folder = Path(os.fsdecode(os.fsencode(self.folder) + b"/caf\xe9 \xff"))
        folder.mkdir()
        make_run(folder)
        for script in ("plots", "summary", "report"):
            done = subprocess.run([sys.executable, "-B", RESULTS / f"{script}.py", folder],
                                  capture_output=True, timeout=120, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, b""), script)
            done.stdout.decode("utf-8")
        (folder / "run.h5").write_bytes(b"damaged")
        done = subprocess.run([sys.executable, "-B", RESULTS / "report.py", folder],
                              capture_output=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn(rb"caf\xe9 \xff/run.h5: is damaged", done.stderr)


class BrokenScriptTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="geoprior-report-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        make_run(self.folder)

    def make_inconsistent(self):
        """Three parameters, two values: nothing that reading notices."""
        with signed(self.folder, "a") as file:
            metrics = file["cases/default/variants/implicit/metrics"]
            del metrics["overlap_excess"]
            add_metric(metrics, "overlap_excess", np.array([1.0, 2.0]), "m^3", "lower_is_better")

    def test_a_defect_is_one_line_with_file_and_place_and_no_traceback(self):
        self.make_inconsistent()
        for script in ("plots", "report"):
            done = run_script(script, self.folder)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertRegex(done.stderr, re.escape(str(self.folder)) + r": cannot be shown \(.*, at "
                             r"\w+\.py:\d+; GEOPRIOR_DEBUG=1")

    def test_who_mends_the_scripts_sees_the_trace(self):
        self.make_inconsistent()
        with mock.patch.dict(os.environ, GEOPRIOR_DEBUG="1"):
            self.assertIn("Traceback", run_script("plots", self.folder).stderr)

    def test_a_stop_leaves_no_half_file(self):
        target = self.folder / "page.html"
        with mock.patch.object(Path, "replace", side_effect=SystemExit(143)):
            with self.assertRaises(SystemExit):
                runfile.write_atomically(target, "half")
        self.assertEqual([p.name for p in self.folder.iterdir() if "page" in p.name], [])

    def test_sigterm_ends_a_script_without_words(self):
        with subprocess.Popen([sys.executable, "-B", "-c", "import sys, time, runfile\n"
                               "runfile.run_main(lambda a: (print('go', flush=True), time.sleep(60)))"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env={**os.environ, "PYTHONPATH": str(RESULTS)}) as script:
            script.stdout.readline()
            script.send_signal(signal.SIGTERM)
            self.assertEqual(script.communicate(timeout=20)[1], "")
        self.assertEqual(script.returncode, 128 + signal.SIGTERM)

    def test_a_picture_that_is_none_is_not_shown(self):
        (self.folder / "figure.png").write_text("<svg onload='alert(1)'/>")
        self.assertEqual(run_script("report", self.folder).returncode, 0)
        page = (self.folder / "report.html").read_text()
        self.assertIn("figure.png is no PNG", page)
        self.assertNotIn("image/png;base64,PHN2Z", page)

    def test_a_picture_that_is_a_pipe_is_refused(self):
        (self.folder / "figure.png").unlink()
        os.mkfifo(self.folder / "figure.png")
        done = run_script("report", self.folder)
        self.assertEqual((done.returncode, done.stderr),
                         (2, f"{self.folder}/figure.png: is no file (allowed: a file, or a link to one)\n"))


class LimitsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="geoprior-report-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        make_run(self.folder)

    def page(self):
        start = time.monotonic()
        text = report.build([runfile.read_run(self.folder)])
        self.assertLess(time.monotonic() - start, 60)
        Page(text)
        return text

    def test_long_texts_are_cut_with_a_word_of_it(self):
        with signed(self.folder, "a") as file:
            file["cases/default"].attrs["warnings"] = ["w" * 3000]
            file.attrs["title"] = "t" * 60_000
        text = self.page()
        self.assertIn("w" * 2000 + " … (1000 more characters in run.h5)", text)
        self.assertIn("… (58000 more characters in run.h5)", text)
        self.assertLess(len(text), 1_000_000)

    def test_many_claims_and_warnings_are_cut_with_a_word_of_it(self):
        with signed(self.folder, "a") as file:
            row = np.array(file["claims"])[:1]
            del file["claims"]
            file["claims"] = np.repeat(row, 5000)
            file["cases/default"].attrs["warnings"] = [f"warning {i}" for i in range(700)]
        text = self.page()
        self.assertIn("Claims: holds in 5000", text)
        self.assertIn("4500 more claims in run.h5.", text)
        self.assertIn("200 more warnings in run.h5.", text)

    def test_many_cases_are_cut_with_a_word_of_it(self):
        with signed(self.folder, "a") as file:
            for i in range(1, 40):
                file.copy("cases/default", f"cases/case-{i}")
        with mock.patch.object(report_parts, "MOST_CASES", 10):
            text = self.page()
        self.assertIn("30 more cases in run.h5.", text)
        self.assertIn(f"{40 - plots.MOST_CASES} further cases are in run.h5.", text)

    def test_many_variants_are_cut_with_a_word_of_it(self):
        with signed(self.folder, "a") as file:
            variants = file["cases/default/variants"]
            for i in range(60):
                variants.copy("implicit", f"variant-{i}")
        with mock.patch.object(report_html, "MOST_COLUMNS", 20):
            text = self.page()
        self.assertIn(f"{62 - plots.MOST_VARIANTS} further variants are in run.h5.", text)
        self.assertIn("43 more columns in run.h5.", text)

    def test_long_curves_are_thinned_with_a_word_of_it(self):
        count = 400_000
        with signed(self.folder, "a") as file:
            for variant in file["cases/default/variants"].values():
                del variant["parameter"]
                variant["parameter"] = np.arange(count, dtype=float)
                for name in list(variant["metrics"]):
                    del variant["metrics"][name]
                add_metric(variant["metrics"], "overlap_excess", np.random.default_rng(1).random(count),
                           "m^3", "lower_is_better")
        text = self.page()
        self.assertIn("Of longer curves at most 5000 points are drawn.", text)
        self.assertLess(len(text), 3_000_000)

    def test_many_runs_are_cut_with_a_word_of_it(self):
        out = self.folder / "all.html"
        with mock.patch.object(report, "MOST_RUNS", 2):
            report.main([str(self.folder)] * 5 + ["--out", str(out)])
        self.assertIn("3 more runs were asked for", out.read_text(encoding="utf-8"))


del report_test  # its tests are run by themselves

if __name__ == "__main__":
    unittest.main(warnings="ignore")
