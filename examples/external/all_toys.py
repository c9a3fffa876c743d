#!/usr/bin/env python3
"""All assemblies without loops, from the smallest on, as a method from outside.

    geoprior run examples/external/all-toys.toml --allow-commands

A port holds what some model has at one of its class, or nothing if some model leaves one open: all ways to fill ports
with n parts are listed, port by port. Those stay where the rules hold: boxes of parts that are not joined do not meet,
and what is to be on the floor is. Nothing of the models is kept but which ports they join. With larger models there
are soon too many to list.
"""
import json
from fnmatch import fnmatch
from itertools import combinations
from pathlib import Path

import numpy as np

HALF_TURN = np.diag([-1.0, -1, 1, 1])  # from a port to the one that it is joined with
MOST_PARTS = 14                        # of a model

scene = json.loads(Path("scene.json").read_text())
rules, bodies = scene["scene"]["rules"], scene["parts"]["bodies"]
labels, kind_of_triangle = bodies["arrays"]["label"]["names"], np.load(bodies["arrays"]["label"]["file"])[:, 0]
rows = {name: np.load(table["rows"]) for name, table in scene["tables"].items()}
models = [rows["parts"][rows["parts"][:, 0] == m, 1].astype(int).tolist() for m in range(int(scene["facts"]["models"]))]


def of_kinds(name: str) -> list:
    """Rows of a table, a list for each kind of part, and the motions at their ends."""
    lists = [[row for row in rows[name] if row[0] == kind] for kind in range(len(labels))]
    return [[(row, np.vstack([row[-12:].reshape(3, 4), [0, 0, 0, 1]])) for row in of] for of in lists]


def body_of(kind: int):
    """Vertices and triangles of a kind of part."""
    used, corners = np.unique(np.load(bodies["triangles"])[kind_of_triangle == kind], return_inverse=True)
    return np.load(bodies["points"])[used], corners.reshape(-1, 3)


ports, boxes = of_kinds("ports"), of_kinds("boxes")
classes = [tuple(int(row[2]) for row, _ in of) for of in ports]
vertices, triangles = zip(*map(body_of, range(len(labels))))


def seen_choices() -> dict:
    """For each class of ports what the models have there: (kind, port), or None for nothing."""
    held = {(m, part, port): None for m, kinds in enumerate(models) for part, kind in enumerate(kinds)
            for port in range(len(classes[kind]))}
    for m, *ends in rows["connections"].astype(int).tolist():
        for part, port, other, at in (ends, ends[2:] + ends[:2]):
            held[m, part, port] = models[m][other], at
    seen = {(classes[models[m][part]][port], choice) for (m, part, port), choice in held.items()}
    return {of: sorted((choice for port, choice in seen if port == of), key=str) for of, _ in seen}


def fillings(open_ports: tuple, n: int, choices: dict):
    """All ways to fill ports, given by their classes, with n parts in all: for each port None, or a choice and what
    fills the other ports of that part."""
    if not open_ports:
        yield from [[]] if n == 0 else []
        return
    for choice in choices[open_ports[0]]:
        if choice is None:
            yield from ([None, *others] for others in fillings(open_ports[1:], n, choices))
            continue
        kind, port = choice
        beyond = classes[kind][:port] + classes[kind][port + 1:]
        for k in range(n):
            for filling in fillings(beyond, k, choices):
                yield from ([(choice, filling), *others] for others in fillings(open_ports[1:], n - 1 - k, choices))


def built(root: int, filled: list):
    """Kinds and poses of the parts, and their connections."""
    kinds, poses, connections, todo = [root], [np.eye(4)], [], [(0, None, filled)]
    for part, entered, filled in todo:
        free = [port for port in range(len(classes[kinds[part]])) if port != entered]
        for port, filling in zip(free, filled):
            if filling:
                (kind, at), further = filling
                connections.append((part, port, len(kinds), at))
                todo.append((len(kinds), at, further))
                poses.append(poses[part] @ ports[kinds[part]][port][1] @ HALF_TURN @ np.linalg.inv(ports[kind][at][1]))
                kinds.append(kind)
    return kinds, np.array(poses), connections


def moved(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    return points @ pose[:3, :3].T + pose[:3, 3]


def stands(kinds: list, poses: np.ndarray, connections: list) -> bool:
    """Puts an assembly on the floor; whether the rules hold there."""
    on_floor = [i for i, kind in enumerate(kinds) if any(fnmatch(labels[kind], name) for name in rules["grounded"])]
    lowest = np.array([moved(vertices[kinds[i]], poses[i])[:, 2].min() for i in on_floor] or [0])
    poses[:, 2, 3] -= lowest.min()
    around = []  # of each part, middles and half sides of boxes in the world
    for kind, pose in zip(kinds, poses):
        placed = [(pose @ at, row[1:4] - rules["clearance"]) for row, at in boxes[kind]]
        around.append([(at[:3, 3], abs(at[:3, :3]) @ half) for at, half in placed])
    joined = {(a, b) for a, _, b, _ in connections}
    apart = all((abs(x - y) > half + other).any() for i, j in combinations(range(len(kinds)), 2) if (i, j) not in joined
                for x, half in around[i] for y, other in around[j])
    return (apart or not rules["collisions"]) and np.ptp(lowest) <= rules["ground_tolerance"]


def write_table(file: Path, columns: list, lines: list) -> None:
    names = ",".join(f'"{name}"' for name in columns)
    file.write_text("\n".join([names, *(",".join(repr(float(x)) for x in line) for line in lines)]) + "\n")


def write_frame(folder: Path, number: int, kinds: list, poses: np.ndarray, connections: list) -> None:
    # "origin": the model that a part was copied from, here any of them.
    columns = ["type", "origin", *(f"rotation_{i}" for i in range(9)), *(f"translation_{i}" for i in range(3))]
    parts = [[kind, 0, *pose[:3, :3].flat, *pose[:3, 3]] for kind, pose in zip(kinds, poses)]
    write_table(folder / f"parts_{number:04d}.csv", columns, parts)
    write_table(folder / f"connections_{number:04d}.csv", ["part_a", "port_a", "part_b", "port_b"], connections)
    points = np.vstack([moved(vertices[kind], pose) for kind, pose in zip(kinds, poses)])
    first = np.cumsum([0] + [len(vertices[kind]) for kind in kinds])
    part = np.repeat(np.arange(len(kinds)), [len(triangles[kind]) for kind in kinds])
    faces = np.empty(len(part), [("count", "u1"), ("corners", "<i4", 3), ("part", "<i4"), ("label", "<i4")])
    faces["count"], faces["part"], faces["label"] = 3, part, np.array(kinds)[part]
    faces["corners"] = np.vstack([triangles[kind] for kind in kinds]) + first[part, None]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}", "property double x",
              "property double y", "property double z", f"element face {len(faces)}",
              "property list uchar int vertex_indices", "property int part", "property int label", "end_header", ""]
    surface = "\n".join(header).encode() + points.astype("<f8").tobytes() + faces.tobytes()
    (folder / f"surface_{number:04d}.ply").write_bytes(surface)


def main() -> None:
    if (most := max(map(len, models))) > MOST_PARTS:
        raise SystemExit(f"a model has {most} parts, all assemblies are listed of up to {MOST_PARTS}")
    folder = Path(scene["frames"]["folder"]) / "frames"
    folder.mkdir()
    roots, choices = sorted({kinds[0] for kinds in models}), seen_choices()  # begun with what models begin with
    toys = (built(root, filled) for n in range(1, min(rules["parts"], most) + 1) for root in roots
            for filled in fillings(classes[root], n - 1, choices))
    kept = [toy for toy in toys if stands(*toy)]
    for number, toy in enumerate(kept):
        write_frame(folder, number, *toy)
    write_table(folder.parent / "frames.csv", ["frame", "parameter"], [(i, i + 1) for i in range(len(kept))])


if __name__ == "__main__":
    main()
