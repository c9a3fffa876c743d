"""Numbers of pages that no run gives: what an experiment file sets, and what is quoted from elsewhere.

    key skinning/knee scene.motion.to_deg              a key of an experiment file, lists by place: `scene.items.0.size`
    key paper/bend variant.dense.options.triangles in mm   … in a unit of the page, of a key in metres, seconds or parts
    from thesis 3.2.1                                  quoted: what stands there is the author's, its source is named
    from clauset2009                                   … of an entry of docs/references.bib
"""

import re
import tomllib
from pathlib import Path

import citations
from expressions import SCALES, ExpressionError
from wording import number

QUOTED = "from "
KINDS = ("key ", QUOTED)
THESIS = re.compile(r"thesis \d+(\.\d+)*")


def named(items, name):
    """The one of a list of tables that has the name, or a place in it."""
    if name.isdigit() and int(name) < len(items):
        return items[int(name)]
    return next((item for item in items if isinstance(item, dict) and item.get("name") == name), None)


def value_at(experiment, path, root):
    file = Path(root) / "experiments" / f"{experiment}.toml"
    try:
        value = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise ExpressionError(f"no experiment file of '{experiment}': {error.strerror}") from error
    for name in path.split("."):
        value = value.get(name) if isinstance(value, dict) else named(value, name) if isinstance(value, list) else None
        if value is None:
            raise ExpressionError(f"'{experiment}' sets no '{path}' (there is no '{name}')")
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ExpressionError(f"'{path}' of '{experiment}' is no number")
    return value


def setting(source, root):
    """What a page shows for `key EXPERIMENT PATH [in UNIT]`. Raises ExpressionError."""
    match source.split():
        case ["key", experiment, path]:
            value = value_at(experiment, path, root)
            return f"{value:,}" if isinstance(value, int) else number(value)
        case ["key", experiment, path, "in", unit] if unit in SCALES:
            text = number(value_at(experiment, path, root) / SCALES[unit][1])
            return text + (unit if unit == "°" else f" {unit}")
        case ["key", _, _, "in", unit]:
            raise ExpressionError(f"unknown unit '{unit}' (there are {', '.join(SCALES)})")
    raise ExpressionError(f"'{source}': after 'key' an experiment, a dotted key, perhaps 'in UNIT'")


def require_source(source, root):
    """That of `from SOURCE` is a place in the thesis, or of the bibliography. Raises ExpressionError."""
    name = source.removeprefix(QUOTED)
    if THESIS.fullmatch(name):
        return
    entries, _ = citations.read_entries((Path(root) / citations.BIBLIOGRAPHY).read_text(encoding="utf-8"))
    if name not in {entry.key for entry in entries}:
        raise ExpressionError(f"'{name}' is neither 'thesis SECTION' nor a key of {citations.BIBLIOGRAPHY}")
