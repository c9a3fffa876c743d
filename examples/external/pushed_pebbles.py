#!/usr/bin/env python3
"""Pebbles that go where a gesture takes them and push each other apart, as a method from outside.

    geoprior run examples/external/pushed-pebbles.toml --allow-commands

Every pebble starts where the gesture asks it to be. Two that are nearer than their radii allow are moved apart along
the line between them, all pairs at once, each pebble by the mean of what its pairs ask for, until none are (position
based dynamics, Müller et al. 2007; mean and factor as Macklin et al. 2014 have them). None shrinks, is lost or comes:
what is pressed together swells.
"""
import json
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

ROUNDS, FACTOR, MARGIN = 5000, 1.5, 1e-3  # a little more room than is needed, so that an end is reached


def pushed_apart(places: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Places at distances of at least the sums of their radii."""
    places = places.copy()
    for _ in range(ROUNDS):
        pairs = cKDTree(places).query_pairs(2 * (1 + MARGIN) * radius.max(), output_type="ndarray")
        way = places[pairs[:, 1]] - places[pairs[:, 0]]
        way[~way.any(axis=1)] = [1e-9, 0, 0]  # asked to one place: pushed along x
        distance, room = np.linalg.norm(way, axis=1), radius[pairs].sum(1)
        if (distance >= room).all():
            return places
        overlap = np.maximum((1 + MARGIN) * room - distance, 0)
        push = (overlap / 2 / distance)[:, None] * way
        shift, count = np.zeros_like(places), np.zeros(len(places))
        for side, sign in ((0, -1), (1, 1)):
            np.add.at(shift, pairs[:, side], sign * push)
            np.add.at(count, pairs[:, side], overlap > 0)
        places += FACTOR * shift / np.maximum(count, 1)[:, None]
    raise SystemExit(f"pebbles still meet after {ROUNDS} rounds")


def write_ply(file: Path, points: np.ndarray, arrays: dict, triangles=None) -> None:
    """Points with arrays (columns name_0, name_1 … are one), or triangles whose arrays these are."""
    columns = {name if values.shape[1] == 1 else f"{name}_{k}": values[:, k]
               for name, values in arrays.items() for k in range(values.shape[1])}
    at_points = {axis: points[:, k] for k, axis in enumerate("xyz")} | (columns if triangles is None else {})
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    header += [f"property double {name}" for name in at_points]
    lines = [" ".join(map(repr, row)) for row in np.column_stack(list(at_points.values())).tolist()]
    if triangles is not None:
        header += [f"element face {len(triangles)}", "property list uchar int vertex_indices",
                   *(f"property double {name}" for name in columns)]
        lines += [f"3 {a} {b} {c} " + " ".join(map(repr, row)) for (a, b, c), row
                  in zip(triangles.tolist(), np.column_stack(list(columns.values())).tolist())]
    file.write_text("\n".join([*header, "end_header", *lines]) + "\n")


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    parts = scene["parts"]
    points = {name: np.load(part["points"]) for name, part in parts.items()}
    arrays = {name: {array: np.load(file["file"]) for array, file in part["arrays"].items()}
              for name, part in parts.items()}
    types = parts["elements"]["arrays"]["type"]["names"]
    if "grain" not in types:
        raise SystemExit(f"the scene has elements of the types {', '.join(types)}, no grains to push apart")
    rest, number = points["elements"], arrays["elements"]["element"][:, 0].astype(int)
    is_grain = arrays["elements"]["type"][:, 0] == types.index("grain")
    radius = arrays["elements"]["parameters"][is_grain, 1]   # as type_0001.csv calls its columns
    owner = np.searchsorted(number, arrays["keys"]["element"][:, 0])        # rows of elements
    triangles = np.load(parts["surface"]["triangles"])
    of_vertex = np.zeros(len(points["surface"]), int)
    of_vertex[triangles] = np.searchsorted(number, arrays["surface"]["element"])

    frames = Path(scene["frames"]["folder"]) / "frames"
    frames.mkdir()
    for frame, _ in enumerate(steps := np.load(scene["tables"]["steps"]["rows"])):
        places = rest.copy()
        places[owner] = points[f"asked_{frame:04d}"]         # a key point is where its element is
        places[is_grain] = pushed_apart(places[is_grain], radius)
        write_ply(frames / f"elements_{frame:04d}.ply", places, arrays["elements"])
        write_ply(frames / f"keys_{frame:04d}.ply", places[owner], arrays["keys"])
        moved = points["surface"] + (places - rest)[of_vertex]
        write_ply(frames / f"surface_{frame:04d}.ply", moved, arrays["surface"], triangles)
    rows = [f"{frame},{frame}" for frame in range(len(steps))]
    (frames.parent / "frames.csv").write_text("\n".join(['"frame","parameter"', *rows]) + "\n")


if __name__ == "__main__":
    main()
