#!/usr/bin/env python3
"""Organs whose shape is a function of the body's length alone, as a method from outside.

    geoprior run examples/external/allometric-kidney.toml --allow-commands

A size is a power of the crown-rump length (Huxley 1932, Problems of Relative Growth): least squares through what an
atlas shows of it, the healthy body in the middle of each stage. Places, as ratios of that length, directions, eggs and
branchings are straight lines over its logarithm. So two numbers stand for all stages of a value, and nothing happens on
a day. Ducts hang on others and are left out.
"""
import json
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

OVOID, DUCT = 3, 5  # of the column "primitive"
SUBDIVISIONS = 4


def sphere():
    """Vertices on the unit sphere and triangles: an octahedron whose triangles are quartered."""
    points = np.vstack([np.eye(3), -np.eye(3)])
    triangles = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])
    for _ in range(SUBDIVISIONS):
        sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        edges, middle = np.unique(sides, axis=0, return_inverse=True)
        (a, b, c), (ab, bc, ca) = triangles.T, middle.reshape(-1, 3).T + len(points)
        points = np.vstack([points, points[edges].sum(1)])
        points /= np.linalg.norm(points, axis=1)[:, None]
        triangles = np.vstack([np.column_stack(t) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return points, triangles


class Allometry:
    """What an atlas has of a structure, as a function of the logarithm of the body's length."""

    def __init__(self, atlas: np.ndarray, log_length: np.ndarray):
        turns, sizes = Rotation.from_quat(np.roll(atlas[:, 6:10], -1, axis=1)).as_matrix(), atlas[:, 10:13]
        self.primitive, self.middle, self.has_size = int(atlas[0, 2]), log_length.mean(), (sizes > 0).all(0)
        ratios = atlas[:, 3:6] / np.exp(log_length)[:, None]
        logarithms = np.log(np.where(self.has_size, sizes, 1))
        values = np.hstack([logarithms, ratios, turns[:, :, 2], turns[:, :, 0], atlas[:, 13:15]])
        over = np.column_stack([np.ones(len(atlas)), log_length - self.middle])
        self.line = np.linalg.lstsq(over, values, rcond=None)[0]

    def at(self, length: float):
        """Centre (m), axes as columns, sizes (m), egg and branchings."""
        values = np.array([1, np.log(length) - self.middle]) @ self.line
        (size, place, axis, up), (egg, branchings) = values[:12].reshape(4, 3), values[12:]
        axis /= np.linalg.norm(axis)
        up -= (up @ axis) * axis
        up /= np.linalg.norm(up)
        axes = np.column_stack([up, np.cross(axis, up), axis])
        return length * place, axes, np.exp(size) * self.has_size, np.clip(egg, -0.5, 0.5), branchings


def write_table(file: Path, columns: list, rows: list) -> None:
    names = ",".join(f'"{name}"' for name in columns)
    file.write_text("\n".join([names, *(",".join(repr(float(x)) for x in row) for row in rows)]) + "\n")


def write_surface(file: Path, ovoids: list) -> None:
    """Ovoids, each after the numbers of its structure and kind: a and b are scaled by 1 + egg z / c."""
    unit, triangles = sphere()
    points, faces = [], []
    for number, (codes, (centre, axes, size, egg, _)) in enumerate(ovoids):
        wide = np.column_stack([1 + egg * unit[:, 2]] * 2 + [np.ones(len(unit))])
        points += (centre + (unit * wide * size) @ axes.T).tolist()
        faces += [f"3 {a} {b} {c} {codes}" for a, b, c in (triangles + number * len(unit)).tolist()]
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}", "property double x", "property double y",
              "property double z", f"element face {len(faces)}", "property list uchar int vertex_indices",
              "property int structure", "property int kind", "end_header"]
    file.write_text("\n".join(header + [" ".join(map(repr, point)) for point in points] + faces) + "\n")


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    rows = {name: np.load(table["rows"]) for name, table in scene["tables"].items()}
    atlas, stages = rows["structures"], rows["stages"]
    atlas = atlas[atlas[:, 2] != DUCT]

    def log_length(days):
        return np.interp(days, rows["body"][:, 0], np.log(rows["body"][:, 1]))

    organs = {}
    for structure in np.unique(atlas[:, 1]):
        own = atlas[atlas[:, 1] == structure]
        organs[structure] = Allometry(own, log_length(own[:, 0]))
    codes = {structure: f"{structure:.0f} {kind:.0f}" for structure, kind, surface, *_ in rows["catalogue"] if surface}
    columns = scene["tables"]["structures"]["columns"][1:]
    frames = Path(scene["frames"]["folder"]) / "frames"
    frames.mkdir()
    for frame, day in enumerate(scene["parameter"]["values"]):
        length = float(np.exp(log_length(day)))
        stage = stages[stages[:, 1] <= day][-1]            # what exists in its middle does on all of its days
        states = {structure: organs[structure].at(length) for structure in atlas[atlas[:, 0] == stage[2], 1]}
        write_table(frames / f"body_{frame:04d}.csv", ["crown_rump_length [m]"], [[length]])
        turns = {structure: np.roll(Rotation.from_matrix(state[1]).as_quat(), 1) for structure, state in states.items()}
        write_table(frames / f"structures_{frame:04d}.csv", columns, [
            [structure, organs[structure].primitive, *centre, *turns[structure], *size, *others]
            for structure, (centre, _, size, *others) in states.items()])
        ovoids = [(codes[structure], state) for structure, state in states.items()
                  if structure in codes and organs[structure].primitive == OVOID]
        write_surface(frames / f"surface_{frame:04d}.ply", ovoids)


if __name__ == "__main__":
    main()
