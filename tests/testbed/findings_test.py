"""Numbers in what pages say was found are written from their sources: of the repository, and planted ones.
Run with Debian's python3."""

import shutil
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path[:0] = [str(REPOSITORY / "results")]

import figures  # noqa: E402
import findings  # noqa: E402
import pages  # noqa: E402
import settings  # noqa: E402
from expressions import ExpressionError  # noqa: E402


def bare(finding, before="# Page\n\n## What was found\n\n"):
    return [place.rpartition(" ")[2] for place in findings.bare_numbers("page.md", before + finding)]


class Repository(unittest.TestCase):
    def test_has_no_bare_number(self):
        self.assertEqual(findings.problems(figures.page_texts(REPOSITORY)), [])

    def test_has_findings(self):
        """So that a pattern that finds no section does not pass."""
        texts = figures.page_texts(REPOSITORY)
        self.assertGreaterEqual(sum(any(findings.sections(text)) for text in texts.values()), 10)

    def test_a_digit_planted_in_any_finding_is_named(self):
        for page, text in figures.page_texts(REPOSITORY).items():
            for start, _ in findings.sections(text):
                planted = text[:start] + "\n\nIt is 4711 times better.\n" + text[start:]
                places = findings.bare_numbers(page, planted)
                self.assertIn(f"{page}:{pages.line_of(text, start) + 2}: 4711", places)
                self.assertEqual(len(places), len(findings.bare_numbers(page, text)) + 1)


class Findings(unittest.TestCase):
    def test_without_bare_numbers(self):
        for finding in ("Twice as far (thesis 3.2.1, fig. 2.23, figures 3.4 and 3.5, equation (2.1)).",
                        "`geoprior run paper/bend --set seed=3`, `dense-32`, an A4 sheet, L2.",
                        "`20k,threads=2`, `./test.sh --long 3`, `2 F cos(θ/2) / e`, `[1, 2]`.",
                        "Much <!--= paper/bend hybrid isometry_rms.max -->1.3 %<!-- --> less (Clauset et al. 2009).",
                        "<!-- begin: claims paper/bend -->\n12 of 13\n<!-- end -->",
                        "<!-- begin: table\n| K3 | at 90 |\n| 3, all | {paper/bend hybrid x.max to 2} |\n-->\n12\n<!-- end -->",
                        "See [the table](../metrics.md#table-12).", "```\n12 lines\n```"):
            self.assertEqual(bare(finding), [], finding)

    def test_with_bare_numbers(self):
        for finding, numbers in (("It is 3.5 times, of 12,345, better.", ["3.5", "12,345"]),
                                 ("| a | b |\n|---|---|\n| x | 0.3 |", ["0.3"]), ("at 45°, 30% and ×9", ["45", "30", "9"]),
                                 ("`3.5` times, `12 mm`, `0.3 %`, `-1e-5` and `≤ 7`", ["3.5", "12", "0.3", "1", "5", "7"]),
                                 ("<!-- begin: table\n| a | b |\n| c | 12 |\n-->\n<!-- end -->", ["12"]),
                                 ("### Below\n\n7 of 8\n\n## Limits\n\n9", ["7", "8"])):
            self.assertEqual(bare(finding), numbers, finding)
        self.assertEqual(bare("12", before="# Page\n\n## Limits\n\n"), [])
        self.assertEqual(bare("12", before="# Page\n\n## Results\n\n"), ["12"])

    def test_of_quick_runs_are_refused(self):
        for finding in ("In quick runs it is less.", "`geoprior run paper/bend --quick`"):
            self.assertRegex(findings.problems({"page.md": f"## Results\n\n{finding}\n"})[0], "^page.md:3: .*quick")


class Settings(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "experiments/test").mkdir(parents=True)
        (self.root / "experiments/test/knee.toml").write_text(
            "[scene]\nangle = 120\nsizes = [0.25, 4]\nopen = true\n[[variant]]\nname = \"dense\"\n"
            "options = { triangles = 4096 }\n", encoding="utf-8")
        (self.root / "docs").mkdir()
        (self.root / "docs/references.bib").write_text(
            "@article{clauset2009,\n  author = {Clauset, A.},\n}\n", encoding="utf-8")

    def test_are_read_from_experiment_files(self):
        for path, shown in (("scene.angle", "120"), ("scene.sizes.1", "4"), ("scene.sizes.0 in mm", "250 mm"),
                            ("scene.sizes.0 in %", "25 %"), ("variant.dense.options.triangles", "4,096")):
            self.assertEqual(settings.setting(f"key test/knee {path}", self.root), shown)

    def test_that_are_none_say_so(self):
        for source, message in (("key test/elbow scene.angle", "no experiment file of 'test/elbow'"),
                                ("key test/knee scene.angel", "sets no 'scene.angel' .there is no 'angel'"),
                                ("key test/knee scene.sizes.7", "there is no '7'"),
                                ("key test/knee scene.open", "is no number"),
                                ("key test/knee scene.angle in furlongs", "unknown unit 'furlongs'"),
                                ("key test/knee", "a dotted key")):
            with self.assertRaisesRegex(ExpressionError, message):
                settings.setting(source, self.root)

    def test_what_is_quoted_names_its_source(self):
        text = "# P\n\nTen <!--= from {} -->to 100<!-- --> times.\n"
        sources = pages.Sources(self.root, {})
        for source in ("thesis 3.2.1", "clauset2009"):
            self.assertEqual(pages.differences("p.md", text.format(source), sources), [])
        with self.assertRaisesRegex(pages.PageError, "p.md:3: number 'from hearsay': 'hearsay' is neither"):
            pages.differences("p.md", text.format("hearsay"), sources)


if __name__ == "__main__":
    unittest.main()
