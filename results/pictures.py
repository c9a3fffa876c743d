"""Pictures of the pages as artefacts of runs: each holds the hash of the run that drew it (PNG text), which is that of
its experiment's record. A picture belongs to the experiment whose caption (`figure ID`, docs/file-formats.md) is the
next block below it; a caption that names several files has as many pictures above it, in their order. Any other
picture is drawn by hand, and is named here."""

import io
import re
import struct
import zlib
from pathlib import Path

from PIL import Image

import pages
from prose import without_code
from runfile import PNG_SIGNATURE, RunFileError, require_regular_file, write_atomically

KEYWORD = b"geoprior content_sha256"
MOST_BYTES = 1 << 20  # of a picture as it was drawn; a larger one is reduced to the width that pages show, or less
WIDTHS = (1200, 900, 600)
SHOWN = re.compile(r"!\[[^]]*\]\(([^)]+\.png)\)")
BY_HAND = ("docs/images/sketch-annotate-photo.png", "docs/images/sketch-annotate-views.png")  # drawings with labels


def chunks(content, name):
    """(kind, data) of each chunk of a PNG. Raises RunFileError naming the file."""
    if not content.startswith(PNG_SIGNATURE):
        raise RunFileError(f"{name}: is no PNG")
    out, at = [], len(PNG_SIGNATURE)
    while at < len(content):
        if at + 8 > len(content):
            raise RunFileError(f"{name}: is cut off")
        size, kind = struct.unpack(">I4s", content[at:at + 8])
        if at + 12 + size > len(content):
            raise RunFileError(f"{name}: is cut off")
        out.append((kind, content[at + 8:at + 8 + size]))
        at += 12 + size
    return out


def png_of(parts):
    """The bytes of a PNG of these chunks."""
    return PNG_SIGNATURE + b"".join(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
                                for kind, data in parts)


def is_stamp(kind, data):
    return kind == b"tEXt" and data.startswith(KEYWORD + b"\0")


def stamp_of(content, name):
    """The hash of the run that drew the picture; empty where it holds none."""
    return next((data[len(KEYWORD) + 1:].decode("latin-1") for kind, data in chunks(content, name)
                 if is_stamp(kind, data)), "")


def stamped(content, name, content_sha256):
    """The picture with the hash behind its header, in place of one that it holds."""
    header, *rest = [(kind, data) for kind, data in chunks(content, name) if not is_stamp(kind, data)]
    return png_of([header, (b"tEXt", KEYWORD + b"\0" + content_sha256.encode("latin-1")), *rest])


def shown_in(text):
    """(position, target) of each picture of a page."""
    return [(m.start(), m[1]) for m in SHOWN.finditer(without_code(text))]


def place_of(page, target, root):
    return (root / page).parent.joinpath(target).resolve()


def owners(texts, root):
    """path of a picture: (experiment, file of the run that it is) by the captions of all pages."""
    found = {}
    for page, text in texts.items():
        shown = shown_in(text)
        above = 0  # where the block before ends
        for marker in (m for m in pages.markers_of(page, text) if m.block):
            targets = [target for at, target in shown if above <= at < marker.start]
            above = marker.start
            kind, *words = marker.source.split()
            if kind != "figure" or not targets:
                continue
            experiment, *files = words
            for target, file in zip(targets[::-1], (files or ["figure.png"])[::-1]):
                found[place_of(page, target, root)] = (experiment, file)
    return found


def unowned(texts, owned, root):
    """One line for every picture of a page that is of no run, and is not drawn by hand."""
    by_hand = {root / name for name in BY_HAND}
    return [f"{page}: shows {target}, which is above no caption ('figure ID'), and not one of those drawn by hand"
            for page, text in texts.items() for _, target in shown_in(text)
            if place_of(page, target, root) not in owned.keys() | by_hand]


def reduced(content):
    """The picture as it was drawn, or narrower where it is too large for a repository."""
    if len(content) <= MOST_BYTES:
        return content
    image = Image.open(io.BytesIO(content)).convert("RGB")
    for width in WIDTHS:
        out = io.BytesIO()
        image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS).save(
            out, "PNG", optimize=True)
        if out.tell() <= MOST_BYTES:
            break
    return out.getvalue()


def read_picture(path):
    require_regular_file(path)
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise RunFileError(f"{path}: cannot be read ({error.strerror})") from error


def publish(run, texts, root):
    """Writes the run's pictures that pages show; returns their paths."""
    written = []
    for path, (experiment, file) in owners(texts, Path(root).resolve()).items():
        if experiment == run.experiment_id:
            drawn = run.folder / file
            write_atomically(path, stamped(reduced(read_picture(drawn)), drawn, run.content_sha256))
            written.append(path)
    return written


def problems(texts, published, root):
    """One line for every picture that is of no run, or not of the one that its experiment's record is of."""
    root = Path(root).resolve()
    owned = owners(texts, root)
    out = unowned(texts, owned, root)
    for path, (experiment, _) in owned.items():
        record = published.get(experiment)
        if record is None:
            continue
        stamp = stamp_of(read_picture(path), path)
        if stamp != record.content_sha256:
            says = f"of run {stamp[:12]}" if stamp else "of no run that it names"
            out.append(f"{path.relative_to(root)}: is a picture {says}, the record of {experiment} is of "
                       f"{record.content_sha256[:12]}")
    return out
