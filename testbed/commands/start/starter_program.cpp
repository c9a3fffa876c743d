#include <string>

#include "testbed/commands/start/starters.h"

namespace geoprior {
namespace {

// INSTANCE and PIECES stand for what a starter says, MAIN for kMain.

/// Of those that read .vtp.
constexpr const char* kHead = R"PY(#!/usr/bin/env python3
"""A method of your own. Edit `move`; scene.json says what the scene is, reference/ has the frames of the variant beside.

It is started in a folder of the run, and leaves its frames in out/ (docs/external-methods.md). Needs NumPy.
"""
import base64
import json
import re
import shutil
import struct
import zlib
from pathlib import Path

import numpy as np

SCENE = json.loads(Path("scene.json").read_text())
)PY";

constexpr const char* kMovesPoints = R"PY(

def move(part: str, parameter: float, points: np.ndarray) -> np.ndarray:
    """Where the points (n x 3, metres) of a part of the frame at this parameter go.

    For instance: return INSTANCE
    """
    return points
)PY";

constexpr const char* kMovesPieces = R"PY(TABLE, ARRAY, PLACE = PIECES


def move(piece: int, parameter: float, place: np.ndarray) -> np.ndarray:
    """Where a piece goes, a row of TABLE, that is at this place (metres) in the frame at this parameter.

    All that is drawn of it goes with it. For instance: return INSTANCE
    """
    return place
)PY";

constexpr const char* kHearsSound = R"PY(#!/usr/bin/env python3
"""A method of your own. Edit `heard`; scene.json says what the scene is, reference/ has what the variant beside made.

It is started in a folder of the run, and leaves its sound in out/ (docs/external-methods.md). Needs NumPy.
"""
import json
import shutil
import wave
from pathlib import Path

import numpy as np

SCENE = json.loads(Path("scene.json").read_text())


def heard(sound: np.ndarray, rate: int) -> np.ndarray:
    """What is heard in place of a sound (samples x channels, full scale is 1) of so many samples a second.

    For instance: return INSTANCE
    """
    return sound
MAIN
    file = out / "artifacts/sound.wav"
    with wave.open(str(file)) as wav:
        form, data = wav.getparams(), np.frombuffer(wav.readframes(wav.getnframes()), np.uint8)
    # Three bytes a sample: the upper ones of four.
    wide = np.zeros((len(data) // 3, 4), np.uint8)
    wide[:, 1:] = data.reshape(-1, 3)
    sound = heard(wide.view("<i4").reshape(-1, form.nchannels) / 2**31, form.framerate)
    wide = np.clip(np.rint(2**23 * sound), -(2**23), 2**23 - 1).astype("<i4").reshape(-1, 1).view(np.uint8)
    with wave.open(str(file), "wb") as wav:
        wav.setparams(form)
        wav.writeframes(wide[:, :3].tobytes())
)PY";

/// Numbers of a .vtp.
constexpr const char* kNumbers = R"PY(

def array(text: str, section: str, name: str) -> re.Match | None:
    """The numbers, packed, of an array of a .vtp; None where it is not."""
    inside = f'<{section}>(?:(?!</{section}>).)*?Name="{name}"'
    return re.search(inside + r"[^>]*>\s*([^\s<]+)\s*<(?:InformationKey|/DataArray)", text, re.DOTALL)


def unpacked(text: str, kind: str = "<f8") -> np.ndarray:
    """The numbers of an array: base64 of a head, then of blocks of zlib."""
    blocks = struct.unpack("<I", base64.b64decode(text[:8])[:4])[0]
    size = 4 * (3 + blocks)
    coded = 4 * -(-size // 3)
    head = struct.unpack(f"<{3 + blocks}I", base64.b64decode(text[:coded])[:size])
    data, at, numbers = base64.b64decode(text[coded:]), 0, b""
    for length in head[3:]:
        numbers += zlib.decompress(data[at : at + length])
        at += length
    return np.frombuffer(numbers, kind)


def packed(numbers: np.ndarray) -> str:
    data = np.ascontiguousarray(numbers, "<f8").tobytes()
    block = zlib.compress(data)
    head = struct.pack("<4I", 1, len(data), 0, len(block))
    return (base64.b64encode(head) + base64.b64encode(block)).decode()
)PY";

constexpr const char* kPointsMoved = R"PY(

def moved(text: str, part: str) -> str:
    """The text of a .vtp with other points."""
    found, time = array(text, "Points", "Points"), array(text, "FieldData", "TimeValue")
    points = unpacked(found[1]).reshape(-1, 3)
    if not len(points):
        return text
    points = move(part, unpacked(time[1])[0], points)
    return text[: found.start(1)] + packed(points) + text[found.end(1) :]
MAIN
    for file in sorted((out / "frames").glob("*.vtp")):
        file.write_text(moved(file.read_text(), file.stem.rsplit("_", 1)[0]))
)PY";

constexpr const char* kPiecesMoved = R"PY(

def moved(text: str, shifts: dict[int, np.ndarray]) -> str:
    """The text of a .vtp with other points, where its lines or triangles say of which piece they are."""
    found, pieces = array(text, "Points", "Points"), array(text, "CellData", ARRAY)
    if not pieces:
        return text
    rest = unpacked(found[1]).reshape(-1, 3)
    points = rest.copy()
    for kind in ("Lines", "Polys"):
        corners, ends = (unpacked(array(text, kind, name)[1], "<i8") for name in ("connectivity", "offsets"))
        if len(ends):
            piece_of_corner = np.repeat(unpacked(pieces[1]), np.diff(ends, prepend=0))
            for piece, shift in shifts.items():
                here = corners[piece_of_corner == piece]
                points[here] = rest[here] + shift
    return text[: found.start(1)] + packed(points) + text[found.end(1) :]


def shifts_of(file: Path, parameter: float) -> dict[int, np.ndarray]:
    """Moves the pieces of a table, and says how far each."""
    names = file.read_text().splitlines()[0]
    rows = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
    pieces = rows[:, 0].astype(int).tolist() if names.startswith(f'"{ARRAY} ') else range(len(rows))
    shifts = {}
    for piece, row in zip(pieces, rows):
        place = move(piece, parameter, row[PLACE].copy())
        shifts[piece] = place - row[PLACE]
        row[PLACE] = place
    np.savetxt(file, rows, fmt="%.17g", delimiter=",", header=names, comments="")
    return shifts
MAIN
    parameters = np.loadtxt(out / "frames.csv", delimiter=",", skiprows=1, ndmin=2)[:, 1]
    for frame, parameter in enumerate(parameters):
        shifts = shifts_of(out / f"frames/{TABLE}_{frame:04d}.csv", parameter)
        for file in sorted((out / "frames").glob(f"*_{frame:04d}.vtp")):
            file.write_text(moved(file.read_text(), shifts))
)PY";

/// Begins with the frames of the variant beside, as they are.
constexpr const char* kMain = R"PY(

def main() -> None:
    reference, out = Path(SCENE["reference"]["folder"]), Path(SCENE["frames"]["folder"])
    shutil.copytree(reference, out, dirs_exist_ok=True)
)PY";

constexpr const char* kEnd = R"PY(

if __name__ == "__main__":
    main()
)PY";

std::string with(std::string text, const std::string& word, const std::string& in_its_place) {
  return text.replace(text.find(word), word.size(), in_its_place);
}

}  // namespace

std::string starter_function(const Starter& starter) {
  return starter.changes == StarterChanges::sound ? "heard" : "move";
}

std::string starter_program(const Starter& starter) {
  std::string text = kHearsSound;
  if (starter.changes == StarterChanges::points) {
    text = std::string(kHead) + kMovesPoints + kNumbers + kPointsMoved;
  } else if (starter.changes == StarterChanges::pieces) {
    text =
        with(std::string(kHead) + kMovesPieces, "PIECES", starter.pieces) + kNumbers + kPiecesMoved;
  }
  return with(with(text, "MAIN\n", kMain), "INSTANCE", starter.instance) + kEnd;
}

}  // namespace geoprior
