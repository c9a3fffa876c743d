"""The numbers of the pages are those of the published records: the committed pages, every marker edited, markers
that say nothing, and records made from a run. Run with Debian's python3."""

import contextlib
import html
import io
import json
import os
import re
import shutil
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np
from PIL import Image

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path[:0] = [str(HERE), str(REPOSITORY / "results")]

import expressions  # noqa: E402
import figures  # noqa: E402
import pages  # noqa: E402
import pictures  # noqa: E402
import published  # noqa: E402
import records  # noqa: E402
from report_test import make_run, signed  # noqa: E402
from runfile import RunFileError  # noqa: E402
from wording import beside, interval, number, with_unit  # noqa: E402


def run_figures(*arguments):
    """(exit code, stdout, stderr) of results/figures.py."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = figures.main([str(a) for a in arguments])
    return code, out.getvalue(), err.getvalue()


class CommittedPages(unittest.TestCase):
    def setUp(self):
        self.texts = figures.page_texts(REPOSITORY)
        self.sources = pages.read_sources(REPOSITORY)

    def test_equal_their_sources(self):
        code, _, err = run_figures("--check")
        self.assertEqual((code, err), (0, ""))

    def test_every_edited_marker_is_found_and_named(self):
        """In a copy whose pages are wrong between all markers, --check names each of them, but for what is quoted: its
        source is no file of ours."""
        with tempfile.TemporaryDirectory() as scratch:
            root = Path(scratch)
            for folder in ("docs", "experiments", "results/published"):
                shutil.copytree(REPOSITORY / folder, root / folder)
            expected = []
            for page, text in self.texts.items():
                made = [m for m in pages.markers_of(page, text) if not m.source.startswith("from ")]
                for marker in reversed(made):
                    text = text[:marker.start] + "7" + text[marker.start:]
                    expected.append(f"{page}:{marker.line}: {marker.name()} shows")
                (root / page).write_text(text, encoding="utf-8")
            code, _, err = run_figures("--root", root, "--check")
        self.assertEqual(code, 1)
        named = [line.partition(" '7")[0] for line in err.splitlines() if "references.bib" not in line]
        self.assertEqual(sorted(named), sorted(expected))

    def test_a_rewritten_page_differs_nowhere(self):
        for page, text in self.texts.items():
            again = pages.rewritten(page, text, self.sources)
            self.assertEqual(pages.differences(page, again, self.sources), [])

    def test_gallery_and_numbers_have_every_figure_of_the_thesis(self):
        for page, block in (("docs/gallery.md", "figure"), ("docs/figures.md", "headline")):
            shown = {" ".join(marker.source.split(" ")[:2]) for marker in pages.markers_of(page, self.texts[page])}
            for record in self.sources.records.values():
                if record.figure:
                    self.assertIn(f"{block} {record.experiment_id}", shown)

    def test_link_to_headings_that_are_there(self):
        """`figures.md#figure-32` and the like, in all pages, after the rule by which GitHub names headings."""
        anchors = {page: {re.sub(r"[^\w\- ]", "", heading).lower().replace(" ", "-")
                          for heading in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}
                   for page, text in self.texts.items()}
        for page, text in self.texts.items():
            for target, anchor in re.findall(r"\]\(([^)#\s:]*)#([^)\s]+)\)", text):
                other = Path(page).parent / target if target else Path(page)
                name = os.path.normpath(other)
                self.assertIn(anchor, anchors.get(name, {anchor}), f"{page} links to {target}#{anchor}")

    def test_pictures_that_pages_show_are_there(self):
        for page, text in self.texts.items():
            for target in pages.pictures_of(text):
                self.assertTrue(((REPOSITORY / page).parent / target).is_file(), f"{page} shows {target}")


class Scratch(unittest.TestCase):
    """A small repository: one run published, one page that quotes it."""

    PAGE = ("# Page\n\nOverlap <!--= test/knee implicit overlap_excess.max in mm³ --><!-- -->.\n\n"
            "<!-- begin: headline test/knee -->\n<!-- end -->\n\n<!-- begin: times test/knee -->\n<!-- end -->\n")

    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "docs").mkdir()
        (self.root / "docs/references.bib").touch()
        self.page = self.root / "docs" / "page.md"
        self.page.write_text(self.PAGE, encoding="utf-8")
        self.run = self.root / "run"
        self.run.mkdir()
        make_run(self.run)
        with signed(self.run, "a") as file:
            file.attrs["quick"] = 0

    def publish(self):
        return run_figures("--root", self.root, "--publish", self.run)

    def answer_to(self, text):
        """What --check says of a page with that text in its third line."""
        self.page.write_text(self.PAGE, encoding="utf-8")
        self.publish()
        self.page.write_text("# Page\n\n" + text + "\n", encoding="utf-8")
        with self.assertRaises(RunFileError) as caught:
            run_figures("--root", self.root, "--check")
        return str(caught.exception)


class Publishing(Scratch):
    def test_a_run_becomes_a_record_and_its_quoted_values_a_page(self):
        self.assertEqual(self.publish()[0], 0)
        record = records.read_records(self.root)["test/knee"]
        self.assertEqual(record.values, {"default": {"implicit": {"overlap_excess.max": 2e-9}}})
        self.assertEqual(record.units, {"overlap_excess.max": "m^3"})
        self.assertEqual(record.processor, "A CPU")
        self.assertEqual(record.times["default"]["implicit"]["median"], 0.004)
        self.assertIn("-->2.00 mm³<!-- -->", self.page.read_text(encoding="utf-8"))
        self.assertEqual(run_figures("--root", self.root, "--check"), (0, "", ""))

    def test_a_record_lies_where_its_identifier_says(self):
        for name in ("../../x", "/tmp/x", "x", "a/..", "a/b/c", "../x", ".a/b", "a/b\n"):
            with self.assertRaisesRegex(RunFileError, "two names"):
                records.record_path(self.root, name)

    def test_publishing_twice_gives_the_same_bytes(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        first = path.read_bytes()
        self.publish()
        self.assertEqual(path.read_bytes(), first)

    def test_quick_runs_are_refused(self):
        with signed(self.run, "a") as file:
            file.attrs["quick"] = 1
        with self.assertRaisesRegex(RunFileError, "a quick run is not published"):
            self.publish()

    def test_quantities_of_a_run(self):
        run = figures.runfile.read_run(self.run)
        implicit = run.cases[0].variant("implicit")
        for quantity, value in (("overlap_excess@45", 1e-9), ("overlap_excess.median", 1e-9),
                                ("timing:solve.p99", 0.004), ("timing:solve.mean", 0.004),
                                ("diagnostic:work_done.last", 2.0), ("diagnostic:iterations.max", 7.0),
                                ("rest_identity", 1e-16)):
            self.assertAlmostEqual(records.measured(implicit, quantity)[0], value, delta=1e-9 * value, msg=quantity)
        for quantity in ("timing:relax.mean", "timing:solve.mode", "overlap_excess", "overlap_excess@44",
                         "overlap_excess.mode", "nothing.max"):
            self.assertIsNone(records.measured(implicit, quantity), quantity)


class Checking(Scratch):
    def test_an_edited_number_is_named(self):
        self.publish()
        self.page.write_text(self.page.read_text(encoding="utf-8").replace("2.00 mm³", "1.00 mm³"), encoding="utf-8")
        code, _, err = run_figures("--root", self.root, "--check")
        self.assertEqual(code, 1)
        self.assertEqual(err, "docs/page.md:3: number 'test/knee implicit overlap_excess.max in mm³' shows "
                              "'1.00 mm³', its source gives '2.00 mm³'\n")

    def test_an_edited_block_is_named(self):
        self.publish()
        self.page.write_text(self.page.read_text(encoding="utf-8").replace("4.00 ms", "3.00 ms", 1), encoding="utf-8")
        code, _, err = run_figures("--root", self.root, "--check")
        self.assertEqual(code, 1)
        self.assertRegex(err, r"^docs/page.md:16: block 'times test/knee' shows '.*3.00 ms.*4.00 ms")

    def test_an_edited_record_is_found(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        path.write_text(path.read_text(encoding="utf-8").replace("2e-09", "3e-09"), encoding="utf-8")
        self.assertEqual(run_figures("--root", self.root, "--check")[0], 1)

    def test_a_record_that_no_page_shows_is_named(self):
        self.publish()
        self.page.write_text("# Page\n", encoding="utf-8")
        code, _, err = run_figures("--root", self.root, "--check")
        self.assertEqual((code, err), (1, "test/knee: published, but no page has an overview or a block of it\n"))


class PageOfAllRecords(Scratch):
    def test_has_every_claim_time_study_and_value(self):
        text = html.unescape(published.build(REPOSITORY))
        for record in records.read_records(REPOSITORY).values():
            shown = text[text.index(f'id="{record.experiment_id}"'):]
            shown = shown[:shown.index("</section>")]
            wanted = [record.content_sha256, record.title, record.processor, *record.failures]
            wanted += [words for c in record.claims for words in (c.text, c.detail, *beside(c))]
            wanted += [interval(s.value, s.low, s.high) for s in record.studies]
            wanted += [with_unit(getattr(row.times, name), "s") for case in record.cases
                       for row in record.timing_rows(case) for name in ("median", "low", "high", "p95")]
            wanted += [number(value, 4) for variants in record.values.values() for values in variants.values()
                       for value in values.values()]
            for words in wanted:
                self.assertIn(words, shown, record.experiment_id)

    def test_names_the_record_that_is_damaged(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        whole = path.read_text(encoding="utf-8")
        for damaged in ("", whole[:-200], "[" * 100_000, "[]", whole.replace('"processor"', '"cpu"'),
                        whole.replace('"low"', '"lower"'), whole.replace('"m^3"', '"m^3", "x": "'),
                        re.sub(r'"times": \{.*?\n  \}', '"times": []', whole, flags=re.DOTALL),
                        re.sub(r'"units": \{.*?\n  \}', '"units": {}', whole, flags=re.DOTALL)):
            path.write_text(damaged, encoding="utf-8")
            with self.assertRaisesRegex(RunFileError, f"^{path}: not a published record \\(.*\\)$", msg=damaged):
                published.build(self.root)

    def test_names_a_record_that_is_gone_or_in_anothers_place(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        elsewhere = path.rename(path.with_name("elbow.json"))
        with self.assertRaisesRegex(RunFileError, "elbow.json: is the record of 'test/knee'"):
            published.build(self.root)
        elsewhere.unlink()
        path.symlink_to("nowhere.json")
        with self.assertRaisesRegex(RunFileError, f"^{path}: No such file or directory$"):
            published.build(self.root)
        path.unlink()
        with self.assertRaisesRegex(RunFileError, f"^{path.parents[1]}: no published records$"):
            published.build(self.root)


class Headlines(Scratch):
    def test_show_what_falls_short_then_what_discriminates(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        data = json.loads(path.read_text(encoding="utf-8"))
        data["claims"] = [{"holds": i != 6, "case": "default", "text": f"claim {i}", "detail": f"x of y: {i} <= 5 m",
                           "null_verdict": "exempt" if i < 2 else "discriminates"} for i in range(8)]
        data["claims"] += [{"holds": False, "case": "other", "text": "claim 7", "detail": "9 of 10 seeds; worst: x: 9 <= 5"}]
        path.write_text(json.dumps(data), encoding="utf-8")
        lines = pages.headline(records.read_record(path))
        self.assertIn("holds in 7, falls short in 2, cases listed by hand.", lines[1])
        self.assertEqual(lines[5:-1], ["| claim 2 | `2 <= 5 m` | holds |", "| claim 3 | `3 <= 5 m` | holds |",
                                       "| claim 6 | `6 <= 5 m` | **falls short** |",
                                       "| claim 7 | `9 <= 5` (9 of 10 seeds) | **holds in 1, falls short in 1** |"])

    def test_never_say_that_all_hold_where_a_null_passes_or_cases_were_chosen(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        data = json.loads(path.read_text(encoding="utf-8"))
        claim = {"holds": True, "case": "a", "text": "small", "detail": "x: 1 <= 5", "null": "n",
                 "null_verdict": "discriminates", "input": "nothing", "graded": "frames", "least": 0.9}
        data["claims"] = [claim, claim | {"case": "b", "null_verdict": "void"},
                          claim | {"case": "c", "holds": False, "excepted": "too coarse"},
                          claim | {"case": "d", "least": 0.55}]
        data["every_case"] = True
        path.write_text(json.dumps(data), encoding="utf-8")
        record = records.read_record(path)
        words = "holds in 2, falls short in 1 (1 excepted), not told apart in 1; 1 soft"
        self.assertEqual(record.claim_words(), words)
        text = "\n".join(pages.claim_list(record))
        self.assertIn("excepted: too coarse", text)
        self.assertIn("soft: holds from s = 0.55 on of nothing + s (its variant − nothing), graded by frames", text)
        data["every_case"] = False
        path.write_text(json.dumps(data), encoding="utf-8")
        self.assertEqual(records.read_record(path).claim_words(), words + ", cases listed by hand")


class Pictures(Scratch):
    """A page shows the picture of the published run, under its caption."""

    PAGE = "# Page\n\n![A knee](knee.png)\n\n<!-- begin: figure test/knee -->\n<!-- end -->\n"
    ONE_PIXEL = pictures.png_of([(b"IHDR", bytes([0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0])),
                                 (b"IDAT", zlib.compress(b"\0\x80")), (b"IEND", b"")])

    def setUp(self):
        super().setUp()
        (self.run / "figure.png").write_bytes(self.ONE_PIXEL)
        self.picture = self.root / "docs" / "knee.png"
        self.publish()
        self.record = records.record_path(self.root, "test/knee")
        data = json.loads(self.record.read_text(encoding="utf-8"))
        self.record.write_text(json.dumps(data | {"every_case": True}), encoding="utf-8")
        run_figures("--root", self.root)

    def problem(self):
        code, _, err = run_figures("--root", self.root, "--check")
        self.assertEqual(code, 1)
        return err

    def test_are_published_with_the_hash_of_their_run(self):
        content = self.picture.read_bytes()
        data = json.loads(self.record.read_text(encoding="utf-8"))
        self.assertEqual(pictures.stamp_of(content, "knee.png"), data["content_sha256"])
        self.assertEqual(len(pictures.chunks(content, "knee.png")), 4)
        again = pictures.stamped(content, "knee.png", data["content_sha256"])
        self.assertEqual(again, content, "a second stamp takes the place of the first")
        self.assertEqual(run_figures("--root", self.root, "--check")[0], 0)

    def test_several_above_one_caption_belong_to_it_in_their_order(self):
        text = ("![a](a.png)\n\n![b](b.png)\n\n![c](c.png)\n\n<!-- begin: figure test/knee one.png two.png -->\n"
                "<!-- end -->\n\n![d](d.png)\n\n<!-- begin: figure test/elbow -->\n<!-- end -->\n"
                "<!-- begin: figure test/hip -->\n<!-- end -->\n")
        found = {path.name: owner for path, owner in pictures.owners({"page.md": text}, self.root).items()}
        self.assertEqual(found, {"b.png": ("test/knee", "one.png"), "c.png": ("test/knee", "two.png"),
                                 "d.png": ("test/elbow", "figure.png")})

    def test_of_more_than_a_mebibyte_are_reduced_to_the_width_of_a_page(self):
        noise = np.random.default_rng(1).integers(0, 256, (600, 2800, 3), np.uint8)
        Image.fromarray(noise).save(self.run / "figure.png")
        self.publish()
        data = json.loads(self.record.read_text(encoding="utf-8"))
        content = self.picture.read_bytes()
        self.assertEqual(Image.open(self.picture).size, (1200, 257))
        self.assertEqual(pictures.stamp_of(content, "knee.png"), data["content_sha256"])

    def test_that_are_tall_are_reduced_further(self):
        noise = np.random.default_rng(1).integers(0, 256, (900, 1600, 3), np.uint8)
        Image.fromarray(noise).save(self.run / "figure.png")
        self.publish()
        self.assertEqual(Image.open(self.picture).size, (600, 338))

    def test_of_another_run_or_of_none_are_named(self):
        self.picture.write_bytes(pictures.stamped(self.ONE_PIXEL, "knee.png", "f" * 64))
        self.assertRegex(self.problem(), "docs/knee.png: is a picture of run f{12}, the record of test/knee is of ")
        self.picture.write_bytes(self.ONE_PIXEL)
        self.assertIn("docs/knee.png: is a picture of no run that it names", self.problem())

    def test_that_are_no_png_are_an_error_with_their_name(self):
        for content, message in ((b"GIF89a", "is no PNG"), (self.ONE_PIXEL[:-3], "is cut off")):
            self.picture.write_bytes(content)
            with self.assertRaisesRegex(RunFileError, f"knee.png: {message}"):
                run_figures("--root", self.root, "--check")

    def test_of_records_from_before_need_no_hash(self):
        self.picture.write_bytes(self.ONE_PIXEL)
        data = json.loads(self.record.read_text(encoding="utf-8"))
        self.record.write_text(json.dumps(data | {"every_case": False}), encoding="utf-8")
        run_figures("--root", self.root)
        self.assertEqual(run_figures("--root", self.root, "--check")[0], 0)


class Markers(Scratch):
    def test_that_say_nothing_name_page_and_line(self):
        for source, message in (
                ("test/elbow implicit time.median", "experiment 'test/elbow' has no published record"),
                ("test/knee@seed=2 implicit time.median", "has no case 'seed=2'"),
                ("test/knee dense overlap_excess.max", "has no values of variant 'dense'"),
                ("test/knee implicit overlap.max", "has no value 'overlap.max'"),
                ("test/knee implicit time.mode", "unknown time 'mode'"),
                ("test/knee implicit ratio:linear-blend", "has no ratio of times"),
                ("test/knee implicit time.median in furlongs", "unknown unit 'furlongs'"),
                ("test/knee implicit time.median in mm", "a quantity in 's' has no 'mm'"),
                ("test/knee implicit time.median to 12", "significant digits are 1 to 9"),
                ("test/knee implicit time.median / test/elbow implicit time.median", "only quantities of one run"),
                ("test/knee implicit time.median / test/knee implicit overlap_excess.max", "a quotient of 's'"),
                ("test/knee study decay", "has no study 'decay'"),
                ("test/knee implicit", "after 'test/knee'"),
                ("knee implicit time.median", "'knee' is no experiment")):
            answer = self.answer_to(f"a <!--= {source} -->1<!-- -->")
            self.assertRegex(answer, r"^docs/page\.md:3: number '")
            self.assertIn(message, answer)

    def test_blocks_that_say_nothing_name_page_and_line(self):
        for source, message in (("picture test/knee", "unknown block 'picture test/knee'"),
                                ("claims test/elbow", "has no published record"),
                                ("headline test/elbow", "has no published record"),
                                ("options nothing", "no experiment of topic 'nothing'"),
                                ("options", "unknown block 'options'"),
                                ("table\n| a | b |\n| {test/knee implicit time.median} |", "rows of as many cells"),
                                ("table\n| a |\n| {test/knee implicit time.mode} |", "unknown time 'mode'")):
            answer = self.answer_to(f"<!-- begin: {source} -->\n<!-- end -->")
            self.assertRegex(answer, r"^docs/page\.md:3: block '")
            self.assertIn(message, answer)

    def test_that_are_not_closed_name_page_and_line(self):
        for text in ("a <!--= test/knee claims -->1 of 1", "<!-- begin: overview -->\n| a |", "1<!-- -->",
                     "| a |\n<!-- end -->"):
            self.assertRegex(self.answer_to(text), r"^docs/page\.md:[34]: a (closing )?marker")

    def test_begin_no_line(self):
        self.assertEqual(self.answer_to("<!--= test/knee claims -->1 of 2<!-- --> hold"),
                         "docs/page.md:3: a number may not begin a line")

    def test_in_code_are_none(self):
        self.publish()
        text = "```\n<!--= nothing -->1<!-- -->\n```\nOf it <!--= test/knee claims -->1 of 2<!-- -->\n"
        self.assertEqual([m.line for m in pages.markers_of("page.md", text)], [4])

    def test_show_values_quotients_and_texts(self):
        self.publish()
        published = records.read_records(self.root)
        for source, shown in (("test/knee implicit time.median in ms to 2", "4.0 ms"),
                              ("test/knee implicit time.median / test/knee dual-quaternion time.median to 2", "4.0"),
                              ("test/knee implicit ratio:dual-quaternion", "4.00"),
                              ("test/knee implicit ratio:dual-quaternion.high", "4.10"),
                              ("test/knee implicit speedup:dual-quaternion.high", "0.256"),
                              ("test/knee@median(*) implicit overlap_excess.max in mm³", "2.00 mm³"),
                              ("test/knee processor", "A CPU"), ("test/knee command", "geoprior run test/knee")):
            self.assertEqual(expressions.evaluate(source, published), shown, source)


if __name__ == "__main__":
    unittest.main()
