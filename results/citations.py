"""Citations of sources, pages and README.md against docs/references.bib (docs/architecture.md, "Citations").

A citation is a surname and a year: `Vaillant et al. 2013`, `Narain, Pfaff and O'Brien 2013`, `Bridson (2015)`,
`Kavan et al. 2007/2008`, `Lévy, Petitjean, *Title*, 2002`; at a `Source:` comment the title may stand plain. An entry
with a `shorttitle` is cited by that text: `CGAL 5.5`. Names are compared without case and diacritics. Read are
comments of C++, texts of the tables of experiments/, and pages.
"""

import re
import unicodedata
from dataclasses import dataclass, field
from pathlib import Path

from prose import FENCED, blank

BIBLIOGRAPHY = "docs/references.bib"
ROOMS = ("core", "metrics", "models", "baselines", "solvers", "testbed", "experiments", "examples", "tests",
         "benchmarks")
REQUIRED = ("author", "title", "year")

# Words with a capital that stand before a year or in a list before a surname, and are no surnames. CIE 1976 names
# colours.
NO_SURNAMES = set("""January February March April May June July August September October November December
    Debian Ubuntu Windows Figure Table Section Chapter Equation Version Release Thesis Page Line Day Seed
    CIE About After Before By From In Of Since The Until""".split())

ENTRY = re.compile(r"@(\w+)\{([^\s,{}]+),")
FIELD = re.compile(r"  (\w+) = \{(.*)\},")
KEY = re.compile(r"([a-z][a-z0-9]*?)(\d{4})([a-z]?)")

GAP = r"(?:[^\S\n]+|[^\S\n]*\n[^\S\n]*)"  # of one line, or over the end of one
NAME = r"(?:(?:de|den|der|di|van|von) )*[^\W\d_a-zß-öø-ÿ][\w'’]+(?:-[\w'’]+)*"
AUTHORS = rf"(?P<authors>\b{NAME}(?:(?:,{GAP}(?:and{GAP})?|{GAP}and{GAP}){NAME})*)(?P<others>{GAP}et{GAP}al\.)?"
YEAR = r"(?P<year>(?:1[89]|20)\d\d)(?P<letter>[a-z]?)(?:/(?P<later>(?:1[89]|20)\d\d))?(?![\w-]|[.,]\d)"
IN_TEXT = re.compile(rf"{AUTHORS}(?:,{GAP}(?:\*[^*|;]+\*|\"[^\"|;]+\"),)?{GAP}\(?{YEAR}")
AT_SOURCE = re.compile(rf"{AUTHORS}(?:,{GAP}[^;()]+?)??,?{GAP}\(?{YEAR}")
LISTED = re.compile(r"^- (?P<authors>[A-Z]\.[^*\n]+)\. \*(?P<title>[^*\n]+?)\.?\* [^\n]*?(?P<year>\d{4})\.$",
                    re.MULTILINE)
COMMENT = re.compile(r"(?P<code>.*?)//(?:/<?)?(?![/<])\s*(?P<text>.*)")
SOURCE = re.compile(r"\bSources?\b[^:;.]{0,40}:")
STRING = re.compile(r'"((?:[^"\\\n]|\\.)+)"')


def plain(text):
    """Small letters and digits only: `Lévy` is `levy`, `Bærentzen` is `baerentzen`."""
    for special, letters in (("æ", "ae"), ("ø", "o"), ("ß", "ss"), ("ł", "l")):
        text = text.replace(special, letters).replace(special.upper(), letters)
    return re.sub(r"[^a-z0-9]", "", unicodedata.normalize("NFKD", text).lower())


def same_for(text):
    """Equal for two spellings of one name: `Öztireli` and `Oeztireli`."""
    return re.sub(r"([aou])e", r"\1", plain(text))


@dataclass
class Entry:
    key: str
    line: int
    fields: dict[str, str] = field(default_factory=dict)

    def surnames(self):
        """As in `same_for`; of a body in braces the first word."""
        authors = [a for a in self.fields.get("author", "").split(" and ") if a and a != "others"]
        return [same_for(a.split()[0] if a.startswith("{") else a.split(",")[0]) for a in authors]

    def open_ended(self):
        return self.fields.get("author", "").endswith(" and others")

    def work(self):
        """(surname of the first author, year)"""
        return (*self.surnames()[:1], self.fields.get("year"))


@dataclass
class Citation:
    where: str  # file:line
    text: str
    surnames: list[str]
    year: str
    letter: str = ""
    title: str = ""


# The bibliography


def read_entries(text):
    """(entries, mistakes of the form): one field a line."""
    entries, mistakes, inside = [], [], False
    for number, line in enumerate(text.splitlines(), 1):
        entry, pair = ENTRY.fullmatch(line), FIELD.fullmatch(line)
        if entry and not inside:
            entries.append(Entry(entry[2], number))
            inside = True
        elif pair and inside and pair[2].count("{") == pair[2].count("}"):
            if pair[1] in entries[-1].fields:
                mistakes.append(f"{BIBLIOGRAPHY}:{number}: a second {pair[1]}")
            entries[-1].fields[pair[1]] = pair[2]
        elif line == "}" and inside:
            inside = False
        elif inside or (line.strip() and not line.startswith("%")):
            mistakes.append(f"{BIBLIOGRAPHY}:{number}: cannot be read: '{line}'")
    if inside:
        mistakes.append(f"{BIBLIOGRAPHY}:{entries[-1].line}: entry '{entries[-1].key}' is not closed")
    return entries, mistakes


def mistakes_of(entry, letters):
    """What is wrong with an entry; `letters` are those of all entries of the same author and year."""
    for name in REQUIRED:
        if not entry.fields.get(name, "").strip("{} "):
            yield f"entry '{entry.key}' has no {name}"
    key = KEY.fullmatch(entry.key)
    if not key or not entry.surnames() or (same_for(key[1]), key[2]) != entry.work():
        yield f"key '{entry.key}' is not surname and year of its first author"
    elif sorted(letters) != ([""] if len(letters) == 1 else [chr(ord("a") + i) for i in range(len(letters))]):
        yield f"key '{entry.key}': a letter where works share author and year (a, b, …), and only there"


def entry_mistakes(entries):
    out = []
    for before, entry in zip([None, *entries], entries):
        letters = [e.key[-1] if e.key[-1].isalpha() else "" for e in entries if e.work() == entry.work()]
        found = list(mistakes_of(entry, letters))
        if before and before.key == entry.key:
            found.append(f"key '{entry.key}' is repeated")
        elif before and before.key > entry.key:
            found.append(f"key '{entry.key}' stands after '{before.key}': entries are sorted by key")
        out += [f"{BIBLIOGRAPHY}:{entry.line}: {text}" for text in found]
    return out


# Texts that cite


def comments(text):
    """(line, comment) of all comments of a C++ file, without their marks. Empty lines, code, `@param` and `Source:`
    begin another one."""
    out, open_ = [], False
    for number, line in enumerate(text.split("\n"), 1):
        comment = COMMENT.fullmatch(line)
        words = comment["text"] if comment else ""
        source = SOURCE.search(words)
        before, after = (words[:source.start()], words[source.start():]) if source else (words, "")
        if before.strip():
            if open_ and not comment["code"].strip() and not before.startswith("@"):
                out[-1] = (out[-1][0], f"{out[-1][1]}\n{before}")
            else:
                out.append((number, before))
        if after:
            out.append((number, after))
        open_ = bool(words)
    return out


def listed_citation(where, match):
    surnames = [same_for(re.sub(r"^(?:\S*\.\s*)+", "", name)) for name in match["authors"].split(", ")]
    return Citation(where, match["title"], surnames, match["year"], title=match["title"])


def citations_in(name, line, text, pattern=IN_TEXT):
    """Citations of one text, which begins at a line of a file."""
    out = []
    for match in pattern.finditer(text):
        names = re.split(rf",?{GAP}and{GAP}|,{GAP}", match["authors"])
        while names and names[0] in NO_SURNAMES:
            del names[0]
        if names:
            where = f"{name}:{line + text.count(chr(10), 0, match.start())}"
            shown = " ".join(f"{names[0]} {match['others'] or ''} {match['year']}{match['letter']}".split())
            years = [(match["year"], match["letter"])] + ([(match["later"], "")] if match["later"] else [])
            out += [Citation(where, shown, [same_for(n) for n in names], *year) for year in years]
    return out


def page_citations(name, text):
    """Of a page: those of its lists of works (`- A. Surname. *Title.* …, 2013.`), and those of the rest."""
    out = [listed_citation(f"{name}:{text.count(chr(10), 0, m.start()) + 1}", m) for m in LISTED.finditer(text)]
    for pattern in (FENCED, LISTED):
        text = blank(text, pattern)
    return out + citations_in(name, 1, text)


def citing_texts(root):
    """(file, line, text) of comments, of the texts of the experiments' tables, and of pages."""
    sources = [p for room in ROOMS for ending in ("h", "cpp") for p in (root / room).rglob(f"*.{ending}")]
    for path in sorted(sources):
        name, text = str(path.relative_to(root)), path.read_text(encoding="utf-8")
        for line, comment in comments(text):
            yield name, line, comment
        for literal in STRING.finditer(text) if name.startswith("experiments/") else ():
            yield name, text.count("\n", 0, literal.start()) + 1, literal[1]
    for path in sorted([*root.glob("README.md"), *root.glob("docs/**/*.md")]):
        yield str(path.relative_to(root)), 1, path.read_text(encoding="utf-8")


def citations_of(name, line, text):
    """Citations of one of the `citing_texts`."""
    if name.endswith(".md"):
        return page_citations(name, text)
    return citations_in(name, line, text, AT_SOURCE if SOURCE.match(text) else IN_TEXT)


# One against the other


def cited_entry(citation, entries):
    """(the entry that a citation means, None), or (None, what is wrong)."""
    found = [e for e in entries if e.work() == (citation.surnames[0], citation.year)]
    if not found:
        return None, f"no entry of {BIBLIOGRAPHY} for '{citation.text}'"
    if citation.title:
        named = [e for e in found if plain(e.fields.get("title", "")) == plain(citation.title)]
        mistake = f"no entry of {BIBLIOGRAPHY} has the title '{citation.title}'"
    else:
        named = [e for e in found if e.key.endswith(citation.year + citation.letter)]
        mistake = f"'{citation.text}' may be {', '.join(e.key for e in found)}"
    if not named:
        return None, mistake
    missing = [n for n in citation.surnames if n not in named[0].surnames()]
    if missing and not named[0].open_ended():
        return None, f"'{citation.text}': '{missing[0]}' is no author of {named[0].key}"
    return named[0], None


def problems(root):
    """One line for every mistake of the bibliography and of the citations, with file and line."""
    path = Path(root) / BIBLIOGRAPHY
    if not path.is_file():
        return [f"{BIBLIOGRAPHY}: is not there"]
    entries, out = read_entries(path.read_text(encoding="utf-8"))
    out += entry_mistakes(entries)
    cited = set()
    for name, line, text in citing_texts(Path(root)):
        for citation in citations_of(name, line, text):
            entry, mistake = cited_entry(citation, entries)
            cited.add(entry.key if entry else None)
            out += [f"{citation.where}: {mistake}"] if mistake else []
        words = " ".join(text.split())
        cited |= {e.key for e in entries if "shorttitle" in e.fields and e.fields["shorttitle"] in words}
    return out + [f"{BIBLIOGRAPHY}:{e.line}: nothing cites '{e.key}'" for e in entries if e.key not in cited]
