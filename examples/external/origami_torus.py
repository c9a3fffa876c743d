#!/usr/bin/env python3
"""A flat torus folded from 56 triangles, as a method from outside: isometric but for its creases.

    geoprior run examples/external/origami-torus.toml --allow-commands

Two regular polygons, one above the other and turned against it, are joined by a ring of triangles outside and by one
inside, whose edges skip corners. The triangles of a ring are congruent, and each of their three angles meets once at
every corner: a ring unrolls to a straight strip, and 2 pi meet at a corner, whatever the height and the turn. These are
chosen so that both strips unroll to the unit square, with the polygons along its diagonal; there are such surfaces for
every flat torus (Tsuboi 2020). Nothing is corrugated: every frame is the same surface.
"""
import json
import shutil
from pathlib import Path

import numpy as np

CORNERS, SKIPPED = 14, 4                     # the fewest corners with which this torus does not meet itself
AROUND, ACROSS = np.sqrt(2), np.sqrt(1 / 2)  # lengths of the square, cut open along its diagonal
SIDE, CELLS = AROUND / CORNERS, 20           # of the polygons; cells of the mesh along each side


def strips() -> list[tuple[np.ndarray, np.ndarray, float, float]]:
    """Corners on both sides of each strip, how far its triangles lean along it, and its width."""
    radius, angle = SIDE / 2 / np.sin(np.pi / CORNERS), 2 * np.pi * np.arange(CORNERS) / CORNERS
    # Who has crossed both strips has come half of the way around.
    turn = np.arccos((SKIPPED - CORNERS / 2) * SIDE / 2 / radius / np.sin(angle[SKIPPED] / 2))
    apex = turn + np.array([-1, 1]) * angle[SKIPPED] / 2  # of each ring's triangles, from the middle of their bases
    inward = radius * (np.cos(np.pi / CORNERS) - np.cos(apex))
    # The widths, sqrt(rise^2 + inward^2), add up to what the square is across.
    rise = np.sqrt((ACROSS**2 - (inward**2).sum()) ** 2 / 4 - (inward**2).prod()) / ACROSS
    low = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(CORNERS, -rise / 2)], axis=1)
    turned = angle + apex[0] + np.pi / CORNERS
    high = np.stack([radius * np.cos(turned), radius * np.sin(turned), np.full(CORNERS, rise / 2)], axis=1)
    found = []
    for base, top in ((low, high), (high, np.roll(low, SKIPPED - 1, axis=0))):
        lean = (top[0] - base[0]) @ (base[1] - base[0]) / SIDE
        found.append((base, top, lean, np.sqrt(((top[0] - base[0]) ** 2).sum() - lean**2)))
    return found


def points_at(parameters: np.ndarray) -> np.ndarray:
    """Points of the torus, which is linear on each triangle."""
    x, y = parameters.T
    along, across = (x + y) / np.sqrt(2), (y - x) / np.sqrt(2)
    turns = np.floor(across / ACROSS)
    along, across = along - turns * AROUND / 2, across - turns * ACROSS
    points = np.empty((len(parameters), 3))
    for base, top, lean, width in strips():
        here = across >= 0  # or in the next strip, which writes over it
        up = across[here, None] / width
        corner, right = np.divmod((along[here, None] - up * lean) / SIDE, 1)
        first, second = corner[:, 0].astype(int) % CORNERS, (corner[:, 0].astype(int) + 1) % CORNERS
        standing = (1 - up - right) * base[first] + right * base[second] + up * top[first]
        hanging = (1 - up) * base[second] + (1 - right) * top[first] + (up + right - 1) * top[second]
        points[here] = np.where(up + right <= 1, standing, hanging)
        along, across = along - lean, across - width
    return points


def mesh() -> tuple[np.ndarray, np.ndarray]:
    """Parameters and triangles of a closed mesh that has edges along all creases."""
    rows, along, across = [], SIDE * np.arange(CORNERS * CELLS) / CELLS, 0
    for _, _, lean, width in strips():
        for _ in range(CELLS):
            rows.append(np.stack([along - across, along + across], axis=1) / np.sqrt(2) % 1)
            along, across = along + lean / CELLS, across + width / CELLS
    a = np.arange(len(rows) * len(along)).reshape(len(rows), -1)
    c = np.vstack([a[1:], np.roll(a[0], (SKIPPED - 1) * CELLS)])
    b, d = np.roll(a, -1, axis=1), np.roll(c, -1, axis=1)
    return np.concatenate(rows), np.stack([a, b, c, c, b, d], axis=-1).reshape(-1, 3)


def write_ply(file: Path, points: np.ndarray, parameters: np.ndarray, triangles=()) -> None:
    names = ["x", "y", "z", "parameters_0", "parameters_1"]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
              *(f"property double {name}" for name in names), f"element face {len(triangles)}",
              "property list uchar int vertex_indices", "end_header", ""]
    faces = np.array([(3, row) for row in np.asarray(triangles).tolist()], [("count", "u1"), ("corners", "<i4", 3)])
    file.write_bytes("\n".join(header).encode() + np.hstack([points, parameters]).tobytes() + faces.tobytes())


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    parts, tables = scene["parts"], scene["tables"]
    if "surface" not in parts:
        raise SystemExit("the scene asks for nearer and nearer views: of triangles they have nothing to show")
    if "corrugations" not in tables:
        raise SystemExit("the scene asks for no corrugations: there is nothing to fold beside")
    names, *corrugations = Path(tables["corrugations"]["file"]).read_text().splitlines(keepends=True)
    folder = Path(scene["frames"]["folder"]) / "frames"
    folder.mkdir()
    for name, part in parts.items():  # windows and curves of all frames
        if part["kind"] == "triangles":
            continue
        at = np.load(part["arrays"]["parameters"]["file"])
        write_ply(folder / f"{name}.ply", points_at(at), at)
        if name in tables:
            shutil.copy(tables[name]["file"], folder)
    at, triangles = mesh()
    for frame in range(len(corrugations) + 1):
        write_ply(folder / f"surface_{frame:04d}.ply", points_at(at), at, triangles)
        if frame > 0:
            (folder / f"corrugations_{frame:04d}.csv").write_text("".join([names, *corrugations[:frame]]))
            for before in ("before", "base"):
                shutil.copy(folder / f"windows_{frame:04d}.ply", folder / f"windows_{before}_{frame:04d}.ply")
    rows = "".join(f"{frame},{frame}\n" for frame in range(len(corrugations) + 1))
    (folder.parent / "frames.csv").write_text("frame,parameter\n" + rows)


if __name__ == "__main__":
    main()
