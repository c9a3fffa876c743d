"""The numbers of the pages are those of the published records: the committed pages, every marker edited, markers
that say nothing, records made from a run, and their claims against the experiment files. Run with Debian's python3."""

import contextlib
import html
import io
import json
import math
import os
import re
import shutil
import sys
import tempfile
import tomllib
import unittest
import zlib
from pathlib import Path

import numpy as np
from PIL import Image

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path[:0] = [str(HERE), str(REPOSITORY / "results")]

import claimed  # noqa: E402
import expressions  # noqa: E402
import figures  # noqa: E402
import pages  # noqa: E402
import pictures  # noqa: E402
import published  # noqa: E402
import records  # noqa: E402
from report_test import make_run, signed  # noqa: E402
from runfile import Claim, RunFileError  # noqa: E402
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
    FILE = "[[claim]]\ntext = \"contact goes\"\n\n[[claim]]\ntext = \"bulge stays\"\n"

    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "docs").mkdir()
        (self.root / "docs/references.bib").touch()
        self.page = self.root / "docs" / "page.md"
        self.page.write_text(self.PAGE, encoding="utf-8")
        (self.root / "experiments/test").mkdir(parents=True)
        self.file = self.root / "experiments/test/knee.toml"
        self.file.write_text(self.FILE, encoding="utf-8")
        self.run = self.root / "run"
        self.run.mkdir()
        make_run(self.run)
        with signed(self.run, "a") as file:
            file.attrs["quick"] = 0
            file.attrs["schema_version"] = records.SINCE_EVERY_CASE

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

    def test_a_struck_claim_is_not_published(self):
        self.file.write_text("[[claim]]\ntext = \"bulge stays\"\n", encoding="utf-8")
        self.assertEqual(self.publish()[0], 0)
        record = records.read_records(self.root)["test/knee"]
        self.assertEqual([claim.text for claim in record.claims], ["bulge stays"])

    def test_without_an_experiment_file_is_an_error(self):
        self.file.write_text("[[claim]\n", encoding="utf-8")
        with self.assertRaisesRegex(RunFileError, "knee.toml: is no experiment file"):
            self.publish()
        self.file.unlink()
        with self.assertRaisesRegex(RunFileError, "knee.toml: no such file, and no experiment file has the id"):
            self.publish()
        self.file.with_name("other.toml").write_text(f"id = \"test/knee\"\n{self.FILE}", encoding="utf-8")
        self.assertEqual(self.publish()[0], 0)

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


class Pruning(Scratch):
    def test_takes_a_struck_claim_out_and_changes_nothing_else(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        before = path.read_text(encoding="utf-8").splitlines()
        self.file.write_text("[[claim]]\ntext = \"bulge stays\"\n", encoding="utf-8")
        code, out, _ = run_figures("--root", self.root, "--prune")
        self.assertEqual((code, out), (0, f"{path}\ndocs/page.md\n"))
        self.assertEqual(path.read_text(encoding="utf-8").splitlines(), [x for x in before if "contact goes" not in x])
        self.assertEqual(run_figures("--root", self.root, "--prune", "--check"), (0, "", ""))

    def test_leaves_the_committed_records_as_they_are_but_for_struck_claims(self):
        for path in records.published_folder(REPOSITORY).glob("*/*.json"):
            text = path.read_text(encoding="utf-8")
            self.assertEqual(records.json_text(json.loads(text)) + "\n", text, path)


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


class Numbers(unittest.TestCase):
    def test_of_records_may_be_infinite_or_none(self):
        kept = json.loads(json.dumps([records.rounded(x, 3) for x in (math.inf, -math.inf, math.nan, 1.23456)]))
        self.assertEqual([repr(records.present(x)) for x in kept], ["inf", "-inf", "nan", "1.23"])


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
        self.assertIn("holds in 7, falls short in 2.", lines[1])
        self.assertEqual(lines[5:-1], ["| claim 2 | `2 <= 5 m` | holds |", "| claim 3 | `3 <= 5 m` | holds |",
                                       "| claim 6 | `6 <= 5 m` | **falls short** |",
                                       "| claim 7 | `9 <= 5` (9 of 10 seeds) | **holds in 1, falls short in 1** |"])

    def test_show_times_with_their_interval_and_processor(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        data = json.loads(path.read_text(encoding="utf-8"))
        data["claims"] = [{"holds": False, "case": "a", "text": "fast", "detail": "timing:run of x (median): 7 <= 5 s",
                           "null_verdict": "exempt", "null_detail": "margin -2 s, 95 % interval [-3, -1] s"}]
        path.write_text(json.dumps(data), encoding="utf-8")
        record = records.read_record(path)
        words = "margin -2 s, 95 % interval [-3, -1] s, on A CPU"
        self.assertIn(f"| fast | `7 <= 5 s` | **falls short**: {words} |", pages.headline(record))
        self.assertIn(f"Falls short: fast: {words}.", pages.caption(record)[1])

    def test_never_say_that_all_hold_where_a_null_passes(self):
        self.publish()
        path = records.record_path(self.root, "test/knee")
        data = json.loads(path.read_text(encoding="utf-8"))
        claim = {"holds": True, "case": "a", "text": "small", "detail": "x: 1 <= 5", "null": "n",
                 "null_verdict": "discriminates", "input": "nothing", "graded": "frames", "least": 0.9}
        data["claims"] = [claim, claim | {"case": "b", "null_verdict": "void"},
                          claim | {"case": "c", "holds": False, "excepted": "too coarse"},
                          claim | {"case": "d", "least": 0.55}]
        path.write_text(json.dumps(data), encoding="utf-8")
        record = records.read_record(path)
        words = "holds in 2, falls short in 1 (1 excepted), not told apart in 1; 1 soft"
        self.assertEqual(record.claim_words(), words)
        text = "\n".join(pages.claim_list(record))
        self.assertIn("excepted: too coarse", text)
        self.assertIn("soft: holds from s = 0.55 on of nothing + s (its variant − nothing), graded by frames", text)


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

    def test_of_runs_of_cases_listed_by_hand_are_refused(self):
        with signed(self.run, "a") as file:
            file.attrs["schema_version"] = records.SINCE_EVERY_CASE - 1
        with self.assertRaisesRegex(RunFileError, "listed by hand"):
            self.publish()

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

    def test_of_no_run_are_named_but_for_those_drawn_by_hand(self):
        (self.root / "docs/other.md").write_text(
            "".join(f"![drawn](../{name})\n" for name in (*pictures.BY_HAND, "docs/odd.png")), encoding="utf-8")
        self.assertEqual(self.problem(), "docs/other.md: shows ../docs/odd.png, which is above no caption ('figure ID'), "
                                         "and not one of those drawn by hand\n")


class CommittedClaims(unittest.TestCase):
    maxDiff = None

    def test_of_records_are_those_of_their_files(self):
        self.assertEqual([], [line for record in records.read_records(REPOSITORY).values() for line in claimed.mismatches(
            record, claimed.read_spec(REPOSITORY, record.experiment_id))])

    def test_of_records_are_soft_in_one_sentence_of_ten_at_most(self):
        soft = {}
        for record in records.read_records(REPOSITORY).values():
            for claim in record.claims:
                sentence = (record.experiment_id, claim.text)
                soft[sentence] = soft.get(sentence, False) or (claim.outcome == "holds" and claim.soft)
        self.assertLessEqual(sum(soft.values()), 0.1 * len(soft), [sentence for sentence in soft if soft[sentence]])

    def test_of_two_records_have_no_number_in_common(self):
        self.assertEqual(claimed.shared_numbers(records.read_records(REPOSITORY)), [])


class MutatedClaims(unittest.TestCase):
    """In a copy of files and records, what one says otherwise than the other is named."""

    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        shutil.copytree(REPOSITORY / "results/published", self.root / "results/published")
        shutil.copytree(REPOSITORY / "experiments", self.root / "experiments",
                        ignore=lambda folder, names: [n for n in names if Path(n).suffix not in ("", ".toml")])
        self.records = list(records.read_records(self.root).values())

    def mismatches(self, record):
        return claimed.mismatches(record, claimed.read_spec(self.root, record.experiment_id))

    def require_named(self, mutate):
        """Every claim of every file, which `mutate(block, claim, record)` makes another TOML text of, with what is to
        be named then; None: the claim is left as it is."""
        count = 0
        for record in self.records:
            path = claimed.file_of(self.root, record.experiment_id)
            whole, known = path.read_text(encoding="utf-8"), claimed.mismatches(record, claimed.parsed(path))
            for block in re.findall(r"^\[\[claim\]\]\n(?:(?!\[).*\n?)*", whole, re.MULTILINE):
                made = mutate(block, tomllib.loads(block)["claim"][0], record)
                if made is None:
                    continue
                path.write_text(whole.replace(block, made[0]), encoding="utf-8")
                found = claimed.mismatches(record, claimed.parsed(path))
                self.assertIn(f"{record.experiment_id}: {made[1]}", set(found) - set(known))
                count += 1
            path.write_text(whole, encoding="utf-8")
        self.assertGreater(count, 20)

    def test_a_struck_sentence_is_named(self):
        self.require_named(lambda block, claim, record: None if not decided(record, claim) else (
            "", f"'{claim['text']}' is claimed by the record only"))

    def test_an_added_sentence_is_named(self):
        added = "[[claim]]\ntext = \"added\"\nmetric = \"timing:run\"\n"
        self.require_named(lambda block, claim, record: (block + added, "'added' is claimed by the file only"))

    def test_a_swapped_null_is_named(self):
        def swapped(block, claim, record):
            if "null" not in claim or not decided(record, claim):
                return None
            text = re.sub(r"^null( *)=.*$", "null = \"nobody\"", block, flags=re.MULTILINE)
            return text, f"'{claim['text']}' names the null '{claim['null']}', the file 'nobody'"
        self.require_named(swapped)

    def test_an_added_exception_is_named(self):
        def excepted(block, claim, record):
            cases = [published.case for published in decided(record, claim)]
            if "except" in claim or not any(cases):
                return None
            text = f"{block.rstrip()}\nexcept = [{{ cases = [\"{cases[-1]}\"], reason = \"planted\" }}]\n\n"
            return text, f"'{claim['text']}' is excepted in case '{cases[-1]}' because '', in the file because 'planted'"
        self.require_named(excepted)

    def test_an_exception_of_a_case_that_is_not_decided_is_named(self):
        def excepted(block, claim, record):
            if "except" in claim or not decided(record, claim):
                return None
            text = f"{block.rstrip()}\nexcept = [{{ cases = [\"nowhere\"], reason = \"planted\" }}]\n\n"
            return text, (f"'{claim['text']}' is excepted by the file in case 'nowhere', in which the record does not "
                          "decide it")
        self.require_named(excepted)

    def test_a_dropped_case_is_named(self):
        for record in self.records:
            claims = claimed.read_spec(self.root, record.experiment_id).get("claim", [])
            case = record.cases.pop()
            found = self.mismatches(record)
            self.assertIn(f"{record.experiment_id}: case '{case}' is swept by the file only", found)
            for claim in claims:
                if case in [published.case for published in decided(record, claim)]:
                    self.assertIn(f"{record.experiment_id}: '{claim['text']}' is claimed in case '{case}', which is none "
                                  "of the record", found)

    def test_a_case_too_many_is_named(self):
        record = self.records[0]
        record.cases.append("seed=99")
        self.assertIn(f"{record.experiment_id}: case 'seed=99' is swept by the record only", self.mismatches(record))


def decided(record, claim):
    return [published for published in record.claims if published.text == claim["text"]]


class Claims(unittest.TestCase):
    def test_of_sweeps_are_in_cases_named_as_the_runner_names_them(self):
        spec = tomllib.loads("""
            sweep = [{ key = "scene.size", values = [1e-5, 0.0001, 0.25, 2.0] },
                     { key = "variant.a.options.on", values = [true] }, { key = "variant.b.options.on", values = [true] },
                     { key = "scene.path", values = ["run:a/b", [1, 2]] },
                     { key = "scene", values = [{}], names = ["a b"] },
                     { key = "threads", grid = true, values = [1, 2] },
                     { key = "seed", grid = true, claims_only = true, values = [3], base = false }]""")
        cases = claimed.cases_of(spec)
        self.assertEqual(list(cases), [
            "size=1e-05", "size=1e-04", "size=0.25", "size=2", "variant.a.options.on=true", "variant.b.options.on=true",
            "path=run-a-b", "path=1-2", "a-b", "threads=1,seed=3", "threads=2,seed=3"])
        self.assertEqual([name for name, case in cases.items() if case.claims_only], list(cases)[-2:])
        self.assertEqual(list(claimed.cases_of({})), ["default"])

    def test_with_a_number_of_another_record_are_named(self):
        def of(experiment, *claims):
            values = [Claim(f"says {d}", "default", d, left, 1.0, True, variant=v) for d, left, v in claims]
            return type("Record", (), {"experiment_id": experiment, "claims": values})
        first = of("a/a", ("9 of 10 seeds; worst: bulge of implicit (max): 0.0383 <= 0.04", 0.0383121, "implicit"),
                   ("study:rate of it: 1.5 <= 2", 1.5, ""), ("lost of implicit (max): 0 <= 0", 0.0, "implicit"))
        for number, shared in ((("bulge of implicit (at 90): 0.0383 <= 0.05", 0.0383121, ""),
                                "bulge of implicit: 0.0383121"),
                               (("study:rate of it: 1.5 >= 1", 1.5, ""), "study:rate of it: 1.5"),
                               (("bulge of implicit: 0.0383 <= 0.05", 0.0383122, ""), None),
                               (("bulge of linear: 0.0383 <= 0.05", 0.0383121, "linear"), None),
                               (("bulge of implicit against linear: 0.0383 <= 0.5 * 0.1", 0.0383121, ""), None),
                               (("lost of implicit (max): 0 <= 1", 0.0, "implicit"), None)):
            found = claimed.shared_numbers({"a/a": first, "b/b": of("b/b", number)})
            if shared is None:
                self.assertEqual(found, [])
            else:
                self.assertRegex(found[0], f"^{shared} is claimed by a/a .* and by b/b ")


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
