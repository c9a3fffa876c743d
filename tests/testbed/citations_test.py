"""Citations and docs/references.bib fit each other: in the repository, and in a small one with planted mistakes.
Run with Debian's python3."""

import contextlib
import io
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import yaml
except ImportError:
    yaml = None

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path[:0] = [str(REPOSITORY / "results")]

import citations  # noqa: E402
import figures  # noqa: E402


def entry(key, author, title="Title", year=None, **fields):
    fields = {"author": author, "title": title, "year": year or key.rstrip("ab")[-4:]} | fields
    return f"@article{{{key},\n" + "".join(f"  {k} = {{{v}}},\n" for k, v in fields.items() if v) + "}\n"


def cited(text, pattern=citations.IN_TEXT):
    """(surnames, year with its letter) of all citations of a text."""
    return [(c.surnames, c.year + c.letter) for c in citations.citations_in("page.md", 1, text, pattern)]


class Repository(unittest.TestCase):
    def test_is_clean(self):
        self.assertEqual(citations.problems(REPOSITORY), [])

    def test_cites_in_every_kind_of_text(self):
        """So that a pattern that finds nothing does not pass."""
        kinds = {"README.md": 0, "docs": 0, ".h": 0, "methods.cpp": 0}
        for name, line, text in citations.citing_texts(REPOSITORY):
            for kind in kinds:
                if name.startswith(kind) or name.endswith(kind):
                    kinds[kind] += len(citations.citations_of(name, line, text))
        self.assertGreater(min(kinds.values()), 18, kinds)


class CitationFile(unittest.TestCase):
    """CITATION.cff, by which others cite the program."""

    TEXT = (REPOSITORY / "CITATION.cff").read_text(encoding="utf-8")

    def test_has_the_programs_version_and_licence(self):
        cmake = (REPOSITORY / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"^project\(geoprior VERSION (\S+)", cmake, re.MULTILINE)[1]
        self.assertIn(f"\nversion: {version}\n", self.TEXT)
        licence = (REPOSITORY / "LICENSE").read_text(encoding="utf-8").split("\n", 2)
        self.assertEqual([line.strip() for line in licence[:2]],
                         ["GNU GENERAL PUBLIC LICENSE", "Version 3, 29 June 2007"])
        self.assertIn("\nlicense: GPL-3.0-or-later\n", self.TEXT)

    @unittest.skipUnless(yaml, "no PyYAML")
    def test_has_what_the_format_requires(self):
        said = yaml.safe_load(self.TEXT)
        self.assertEqual((said["cff-version"], said["type"], said["title"]), ("1.2.0", "software", "geoprior"))
        self.assertTrue(all(isinstance(said[key], str) for key in ("message", "abstract", "version", "license")))
        self.assertTrue(all(isinstance(word, str) for word in said["keywords"]))
        for work in (said, *said["references"]):
            self.assertTrue(all("name" in author or "family-names" in author for author in work["authors"]))
            self.assertTrue(work["title"] and work["type"])


class Planted(unittest.TestCase):
    """A small repository whose citations are right: each test plants one mistake."""

    ENTRIES = {
        "batty2007": entry("batty2007", "Batty, C. and Bertails, F. and Bridson, R."),
        "botsch2004a": entry("botsch2004a", "Botsch, M. and Kobbelt, L."),
        "botsch2004b": entry("botsch2004b", "Botsch, M. and Kobbelt, L."),
        "cgal2022": entry("cgal2022", "{CGAL Project}", shorttitle="CGAL 5.5"),
        "deberg2008": entry("deberg2008", "de Berg, M. and others"),
        "levy2002": entry("levy2002", "Lévy, B. and Petitjean, S.", "Least squares {Conformal} maps"),
    }
    HEADER = ("#pragma once\n\n/// What it does (Batty et al. 2007).\n///\n/// Source: CGAL 5.5, Meshes; Batty,\n"
              "/// Bertails and Bridson 2007; Botsch and Kobbelt 2004a.\nint Nobody = 1999;\n")
    PAGE = "# Page\n\nRemeshing (de Berg et al. 2008), after\nBotsch and Kobbelt (2004b).\n\n```\nNobody 1999\n```\n"
    README = "# Name\n\n## Citing\n\n- B. Lévy, S. Petitjean. *Least Squares Conformal Maps.* SIGGRAPH, 2002.\n"

    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        for folder in ("docs", "solvers/sketch"):
            (self.root / folder).mkdir(parents=True)

    def problems(self, entries=None, header=HEADER, page=PAGE, readme=README):
        texts = {"docs/references.bib": "\n".join(entries if entries is not None else self.ENTRIES.values()),
                 "solvers/sketch/f.h": header, "docs/page.md": page, "README.md": readme}
        for name, text in texts.items():
            (self.root / name).write_text(text, encoding="utf-8")
        return citations.problems(self.root)

    def with_entry(self, key, text):
        return [*(self.ENTRIES | {key: text}).values()]

    def test_nothing_is_clean(self):
        self.assertEqual(self.problems(), [])

    def test_unknown_citation_in_a_header(self):
        self.assertEqual(self.problems(header=self.HEADER.replace("Botsch and", "Nemo 2001; Botsch and")),
                         ["solvers/sketch/f.h:6: no entry of docs/references.bib for 'Nemo 2001'"])

    def test_unknown_citation_in_a_comment_without_source(self):
        self.assertEqual(self.problems(header=self.HEADER + "int y;  ///< as Nemo\n///< and Body 2001\n"),
                         ["solvers/sketch/f.h:8: no entry of docs/references.bib for 'Nemo 2001'"])

    def test_unknown_citation_in_a_table_of_methods(self):
        (self.root / "experiments/sketch").mkdir(parents=True)
        table = self.root / "experiments/sketch/methods.cpp"
        table.write_text('entry(\n"name", "Nemo 2001; CGAL 5.5");\n', encoding="utf-8")
        self.assertEqual(self.problems(),
                         ["experiments/sketch/methods.cpp:2: no entry of docs/references.bib for 'Nemo 2001'"])

    def test_unknown_citation_in_a_page(self):
        self.assertEqual(self.problems(page=self.PAGE + "Nemo et al. 2001\n"),
                         ["docs/page.md:9: no entry of docs/references.bib for 'Nemo et al. 2001'"])

    def test_unknown_work_in_the_readme(self):
        self.assertEqual(self.problems(readme=self.README + "- A. Nemo, B. C. Body. *Sea.* Journal 1(2), 2001.\n"),
                         ["README.md:6: no entry of docs/references.bib for 'Sea'"])

    def test_another_title_in_the_readme(self):
        self.assertEqual(self.problems(readme=self.README + "- B. Lévy. *Other Maps.* Journal 1(2), 2002.\n"),
                         ["README.md:6: no entry of docs/references.bib has the title 'Other Maps'"])

    def test_a_year_that_the_work_has_not(self):
        found = self.problems(page=self.PAGE.replace("2008", "2009"))
        self.assertEqual(found, ["docs/page.md:3: no entry of docs/references.bib for 'de Berg et al. 2009'",
                                 "docs/references.bib:26: nothing cites 'deberg2008'"])

    def test_somebody_who_is_no_author(self):
        self.assertIn("solvers/sketch/f.h:5: 'Batty 2007': 'bertils' is no author of batty2007",
                      self.problems(header=self.HEADER.replace("Bertails", "Bertils")))

        self.assertIn("README.md:5: 'Least Squares Conformal Maps': 'pettijean' is no author of levy2002",
                      self.problems(readme=self.README.replace("Petitjean", "Pettijean")))

    def test_one_of_two_works_without_its_letter(self):
        self.assertIn("docs/page.md:4: 'Botsch 2004' may be botsch2004a, botsch2004b",
                      self.problems(page=self.PAGE.replace("2004b", "2004")))

    def test_an_entry_that_nothing_cites(self):
        self.assertEqual(self.problems([*self.ENTRIES.values(), entry("nemo2001", "Nemo, A.")]),
                         ["docs/references.bib:38: nothing cites 'nemo2001'"])

    def test_a_short_title_that_nothing_names(self):
        self.assertEqual(self.problems(header=self.HEADER.replace("CGAL 5.5", "CGAL 5.6")),
                         ["docs/references.bib:19: nothing cites 'cgal2022'"])

    def test_unsorted_and_repeated_keys(self):
        entries = [*self.ENTRIES.values()]
        self.assertEqual(self.problems([entries[1], entries[0], *entries[2:]]), [
            "docs/references.bib:7: key 'batty2007' stands after 'botsch2004a': entries are sorted by key"])
        self.assertIn("docs/references.bib:7: key 'batty2007' is repeated", self.problems([entries[0], *entries]))

    def test_missing_fields(self):
        for missing in ("author", "title", "year"):
            text = "\n".join(line for line in self.ENTRIES["deberg2008"].splitlines() if f" {missing} =" not in line)
            self.assertIn(f"docs/references.bib:26: entry 'deberg2008' has no {missing}",
                          self.problems(self.with_entry("deberg2008", text + "\n")))

    def test_keys_of_another_form(self):
        for key in ("berg2008", "deberg08", "deBerg2008", "deberg2007", "deberg-2008"):
            self.assertIn(f"docs/references.bib:26: key '{key}' is not surname and year of its first author",
                          self.problems(self.with_entry("deberg2008", entry(key, "de Berg, M.", year="2008"))), key)

    def test_letters_where_none_belong_and_none_where_they_do(self):
        for key, author, line in (("deberg2008a", "de Berg, M.", 26), ("botsch2004", "Botsch, M.", 7)):
            old = "deberg2008" if line == 26 else "botsch2004a"
            self.assertIn(f"docs/references.bib:{line}: key '{key}': a letter where works share author and year "
                          "(a, b, …), and only there", self.problems(self.with_entry(old, entry(key, author))))

    def test_a_broken_file(self):
        whole = self.ENTRIES["levy2002"]
        for broken, line, message in (
                (whole.replace("{Conformal}", "{Conformal"), 34, "cannot be read: '  title = "),
                (whole.replace("@article{levy2002,", "@article levy2002"), 32, "cannot be read: '@article levy2002'"),
                (whole.replace("  year", " year"), 35, "cannot be read: ' year = {2002},'"),
                (whole + "  title = {Again},\n", 37, "cannot be read: '  title = {Again},'"),
                (whole.replace("  year", "  title = {Again},\n  year"), 35, "a second title"),
                (whole.removesuffix("}\n"), 32, "entry 'levy2002' is not closed"),
                (whole.removesuffix("}\n") + "@misc{x2000,\n}\n", 36, "cannot be read: '@misc{x2000,'")):
            found = self.problems(self.with_entry("levy2002", broken))
            self.assertTrue(any(f"references.bib:{line}: {message}" in text for text in found), (broken, found))

    def test_a_file_that_is_gone(self):
        self.assertEqual(citations.problems(self.root), ["docs/references.bib: is not there"])

    def test_is_seen_by_the_check_of_figures(self):
        self.problems(page=self.PAGE + "<!-- begin: overview -->\n<!-- end -->\nNemo 2001\n")
        (self.root / "results").mkdir()
        shutil.copytree(REPOSITORY / "results/published", self.root / "results/published")
        err = io.StringIO()
        with contextlib.redirect_stderr(err):
            self.assertEqual(figures.main(["--root", str(self.root), "--check"]), 1)
        self.assertIn("docs/page.md:11: no entry of docs/references.bib for 'Nemo 2001'\n", err.getvalue())


class Citations(unittest.TestCase):
    def test_of_the_usual_forms(self):
        for text, names, year in (
                ("as Vaillant 2013 has it", ["vaillant"], "2013"),
                ("(Cazals and Pouget 2005)", ["cazals", "pouget"], "2005"),
                ("Narain, Pfaff and O'Brien 2013:", ["narain", "pfaff", "obrien"], "2013"),
                ("Batty, Bertails, Bridson 2007;", ["batty", "bertails", "bridson"], "2007"),
                ("Dey, Guha, and\nNekhayev 1999", ["dey", "guha", "nekhayev"], "1999"),
                ("Smith, de Goes, Kim 2019", ["smith", citations.same_for("de Goes"), "kim"], "2019"),
                ("of Jacobson et al. (2011): the", ["jacobson"], "2011"),
                ("Enright\n  et al. 2003", ["enright"], "2003"),
                ("Botsch and Kobbelt 2004b", ["botsch", "kobbelt"], "2004b"),
                ("Jung, Cani, *Sketching folds: a title*, 2015 (TOG)", ["jung", "cani"], "2015"),
                ("Jung, Cani, \"Sketching folds\", 2015", ["jung", "cani"], "2015")):
            self.assertEqual(cited(text), [(names, year)], text)

    def test_of_two_years(self):
        self.assertEqual(cited("Kavan, Žára 2007/2008"), [(["kavan", "zara"], "2007"), (["kavan", "zara"], "2008")])

    def test_with_plain_titles_at_a_source(self):
        for text in ("Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.",
                     "Source: thesis 2.1; Ericson, Real-Time Collision\nDetection (2005), section 5.1.5."):
            self.assertEqual(cited(text, citations.AT_SOURCE), [(["ericson"], "2005")])
        self.assertEqual(cited("Ericson, Real-Time Collision Detection, 2005"), [])

    def test_are_no_days_versions_and_numbers(self):
        for text in ("day 2013", "January 2024", "On March 2019", "Debian 12", "Debian 2024", "thesis 2.1.3",
                     "Thesis 2013", "Figure 2005", "Carnegie 2013.5", "ISO 1999-2", "version 2013", "n = 2000",
                     "Seed 1999", "Lévy\n\n2002", "Lévy, 2002 points"):
            self.assertEqual(cited(text), [], text)

    def test_of_one_name_in_several_spellings(self):
        for first, second in (("Bærentzen", "Baerentzen"), ("Žára", "Zara"), ("Öztireli", "Oeztireli"),
                              ("Weiß", "Weiss"), ("Öztireli", "Oztireli"), ("Oñate", "Onate"),
                              ("Søndergård", "Sondergard")):
            self.assertEqual(citations.same_for(first), citations.same_for(second))

    def test_end_with_their_comment(self):
        text = ("/// Lévy,\n///\n/// Nemo 2001 and\n/// Ray. Source: Ju,\n/// Title, 2002\n"
                "int x;  ///< Source of x: Lévy\n///< and Ray 2002\nint y;  // Lévy,\nint z;  // Ray 2002\n"
                "\n/// Lévy,\n/// @param y  Nemo 2001\n")
        self.assertEqual(citations.comments(text),
                         [(1, "Lévy,"), (3, "Nemo 2001 and\nRay. "), (4, "Source: Ju,\nTitle, 2002"),
                          (6, "Source of x: Lévy\nand Ray 2002"), (8, "Lévy,"), (9, "Ray 2002"),
                          (11, "Lévy,"), (12, "@param y  Nemo 2001")])


if __name__ == "__main__":
    unittest.main()
