"""What experiment files claim (docs/experiments.md), held against the published records: sentences, nulls, excepted
cases, and the cases of sweeps, which are named here as the runner names them (testbed/runner/spec/sweeps.cpp)."""

import itertools
import math
import re
import tomllib
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from runfile import RunFileError

NO_CHARACTER_OF_A_NAME = re.compile(r"[^\w.+=,-]", re.ASCII)
OVER_SEEDS = re.compile(r"^\d+ of \d+ seeds?; worst: ")
AGAINST = re.compile(r" against [\w-]+")  # a claim about two variants
MEASURED = re.compile(r"(?P<metric>study:.+(?=: )|\S+)(?: of (?P<variant>[\w-]+))?")  # how the detail of a claim begins


# Experiment files


def parsed(path):
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RunFileError(f"{path}: is no experiment file ({error})") from error


def file_of(root, experiment):
    """The experiment file at the identifier's place, or the one whose `id` it is. Raises RunFileError."""
    folder = Path(root) / "experiments"
    placed = folder / f"{experiment}.toml"
    if placed.is_file():
        return placed
    for path in sorted(folder.glob("*/*.toml")):
        if parsed(path).get("id") == experiment:
            return path
    raise RunFileError(f"{placed}: no such file, and no experiment file has the id '{experiment}'")


def read_spec(root, experiment):
    return parsed(file_of(root, experiment))


def standing(data, root):
    """The record (a JSON object) without the claims whose sentences its experiment file no longer has."""
    sentences = {claim["text"] for claim in read_spec(root, data["experiment"]).get("claim", [])}
    return data | {"claims": [claim for claim in data["claims"] if claim["text"] in sentences]}


# Cases of the sweeps


@dataclass
class Case:
    name: str
    swept: dict  # key: value
    claims_only: bool = False  # there for claims: no case of the record

    def without_seed(self):
        return {key: value for key, value in self.swept.items() if key != "seed"}


def number_text(value):
    """The shortest text of a number, as std::to_chars writes it."""
    exact = Decimal(repr(value)).normalize()
    plain = f"{exact:f}"
    digits, _, exponent = f"{exact:e}".partition("e")
    scientific = f"{digits}e{int(exponent):+03d}"
    return scientific if len(scientific) < len(plain) else plain


def value_text(value, index):
    match value:
        case bool():
            return "true" if value else "false"
        case float():
            return number_text(value)
        case list():
            return "-".join(value_text(item, i) for i, item in enumerate(value))
        case dict():
            return str(index)
    return str(value)


def value_names(sweep, label):
    """One a value: its own, or `label=value`."""
    if "names" in sweep:
        return [name.replace(" ", "-") for name in sweep["names"]]
    texts = [value_text(value, i) for i, value in enumerate(sweep["values"])]
    return [NO_CHARACTER_OF_A_NAME.sub("-", f"{label}={text}") for text in texts]


def names_of_sweeps(sweeps):
    """The names of the values of each; where two keys end alike, they have the whole key."""
    short = [value_names(sweep, sweep["key"].rpartition(".")[2]) for sweep in sweeps]
    keys = {}
    for sweep, names in zip(sweeps, short):
        for name in names:
            keys.setdefault(name, set()).add(sweep["key"])
    return [names if all(len(keys[name]) == 1 for name in names) else value_names(sweep, sweep["key"])
            for sweep, names in zip(sweeps, short)]


def combined(cases):
    """The case of a grid in which one case of each sweep meets."""
    swept = {key: value for case in cases for key, value in case.swept.items()}
    return Case(",".join(case.name for case in cases), swept, any(case.claims_only for case in cases))


def cases_of(spec):
    """name: case of all that a full run has, in its order."""
    sweeps = spec.get("sweep", [])
    made = [[Case(name, {sweep["key"]: value}, sweep.get("claims_only", False))
             for name, value in zip(names, sweep["values"])] for sweep, names in zip(sweeps, names_of_sweeps(sweeps))]
    base = [Case("default", {})] if all(sweep.get("base", True) for sweep in sweeps) else []
    alone = [case for sweep, cases in zip(sweeps, made) if not sweep.get("grid") for case in cases]
    grid = [cases for sweep, cases in zip(sweeps, made) if sweep.get("grid")]
    product = [combined(cases) for cases in itertools.product(*grid)] if grid else []
    return {case.name: case for case in [*base, *alone, *product]}


# Records against files


def decided_with(claim, name, cases):
    """The names of the cases that are decided together with one: itself, or all of its seeds."""
    if claim.get("over") != "seed" or name not in cases:
        return [name]
    return [other.name for other in cases.values() if other.without_seed() == cases[name].without_seed()]


def reasons_of(claim):
    """case: why the claim need not hold there."""
    return {name: entry["reason"] for entry in claim.get("except", []) for name in entry["cases"]}


def of_a_claim(published, claim, record, cases):
    """What a decided claim says otherwise than its file: case, null, exception."""
    known = not published.case if claim["metric"].startswith("study:") else \
        published.case in cases and (cases[published.case].claims_only or published.case in record.cases)
    own, null = published.case, claim.get("null", "")
    if not known:
        yield f"is claimed in case '{own}', which is none of the record"
    if published.null != null:
        yield f"names the null '{published.null}', the file '{null}'"
    reasons = reasons_of(claim)
    reason = next((reasons[name] for name in decided_with(claim, own, cases) if name in reasons), "")
    if published.excepted != reason:
        yield f"is excepted in case '{own}' because '{published.excepted}', in the file because '{reason}'"


def of_a_sentence(claim, record, cases):
    """What the record says otherwise than a claim of its file, in all cases."""
    decided = [published for published in record.claims if published.text == claim["text"]]
    if not decided:
        return ["is claimed by the file only"]
    found = [line for published in decided for line in of_a_claim(published, claim, record, cases)]
    together = {name for published in decided for name in decided_with(claim, published.case, cases)}
    # A quick run may have a value where a full one has none.
    found += [f"is excepted by the file in case '{name}', in which the record does not decide it"
              for name in reasons_of(claim) if name not in together and name not in record.cases]
    return list(dict.fromkeys(found))


def mismatches(record, spec):
    """One line for each place in which a record does not say what its file claims."""
    cases, claims = cases_of(spec), {claim["text"]: claim for claim in spec.get("claim", [])}
    swept = [case.name for case in cases.values() if not case.claims_only]
    found = [f"case '{name}' is swept by the file only" for name in swept if name not in record.cases]
    found += [f"case '{name}' is swept by the record only" for name in record.cases if name not in swept]
    found += [f"'{text}' is claimed by the record only" for text in dict.fromkeys(c.text for c in record.claims)
              if text not in claims]
    found += [f"'{text}' {line}" for text, claim in claims.items() for line in of_a_sentence(claim, record, cases)]
    return [f"{record.experiment_id}: {line}" for line in found]


# Records against each other


def measured(claim):
    """(what is measured, value) of a claim: `bulge of implicit`, `bulge of implicit against union`, or a study."""
    detail = OVER_SEEDS.sub("", claim.detail)
    begins, against = MEASURED.match(detail), AGAINST.search(detail.partition(": ")[0])
    variant = claim.variant or begins["variant"]
    what = begins["metric"] + (f" of {variant}" if variant else "") + (against[0] if against else "")
    return what, claim.left


def shared_numbers(published):
    """One line for each number that claims of several records have, to all digits: it was measured once. Whole numbers
    are counts, which may be equal; held against two variants a number says two things."""
    owners = {}
    for record in published.values():
        for claim in record.claims:
            if math.isfinite(claim.left) and not float(claim.left).is_integer():
                owners.setdefault(measured(claim), {}).setdefault(record.experiment_id, claim.text)
    shared = [(what, left, texts) for (what, left), texts in owners.items() if len(texts) > 1]
    return [f"{what}: {left:g} is claimed by " + " and by ".join(f"{name} ('{text}')" for name, text in texts.items())
            for what, left, texts in shared]
