#!/usr/bin/env python3
"""A sheet of paper by extended position-based dynamics, as a method from outside.

    geoprior run examples/external/position-based-sheet.toml --allow-commands

Small steps of one iteration each (Macklin et al. 2019): vertices fly on, then one constraint after the other puts its
own right, as far as its compliance asks (Macklin, Mueller and Chentanez 2016). Those of a colour share no vertex and
go at once. Edges are springs (Van Gelder 1998), hinges bend by the quadratic form of Bergou et al. (2006), both as
stiff as the paper, which stays elastic. One iteration does not carry a push across the sheet: therefore it stretches.
"""
import json
from pathlib import Path

import numpy as np

STEPS = 100   # a frame
DRAG = 10.0   # 1/s; of the air: without it the free edges flutter


def coloured(corners: np.ndarray) -> list[np.ndarray]:
    """Rows in groups that name no vertex twice: each in the first group that has none of its vertices."""
    taken = [set() for _ in range(corners.max() + 1)]
    groups: list[list[int]] = []
    for row, vertices in enumerate(corners.tolist()):
        near = set().union(*(taken[v] for v in vertices))
        colour = next(c for c in range(len(near) + 1) if c not in near)
        if colour == len(groups):
            groups.append([])
        groups[colour].append(row)
        for v in vertices:
            taken[v].add(colour)
    return [np.array(group) for group in groups]


def bending_weights(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Weights of the corners of hinges, flat: their sum w x is 0 there, and the angle times |ab| where it is bent."""
    def cot(at, p, q):
        u, v = p - at, q - at
        return (u * v).sum(1) / np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])

    ac, ad, bc, bd = cot(a, b, c), cot(a, b, d), cot(b, a, c), cot(b, a, d)
    return np.column_stack([bc + bd, ac + ad, -ac - bc, -ad - bd])


def constraints(flat: np.ndarray, triangles: np.ndarray, membrane: float, bending: float):
    """Springs (corners, length, compliance) and hinges (corners, weights, compliance), a tuple a colour; areas."""
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    u, v = flat[triangles[:, 1]] - flat[triangles[:, 0]], flat[triangles[:, 2]] - flat[triangles[:, 0]]
    areas = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    edges, edge, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    edge, inner = edge.reshape(-1), count == 2
    beside = np.bincount(edge, np.repeat(areas, 3))
    by_edge = triangles[:, [2, 0, 1]].reshape(-1)[np.argsort(edge, kind="stable")]       # corners opposite
    first = (count.cumsum() - count)[inner]
    hinges = np.column_stack([edges[inner], by_edge[first], by_edge[first + 1]])

    length = np.linalg.norm(flat[edges[:, 0]] - flat[edges[:, 1]], axis=1)
    give = length**2 / (membrane * beside)
    weights = bending_weights(*(flat[hinges[:, k]] for k in range(4)))
    bend = beside[inner] / bending                                # the energy of a cylinder is that of the plate
    return ([(edges[g], length[g], give[g]) for g in coloured(edges)],
            [(hinges[g], weights[g], bend[g]) for g in coloured(hinges)], areas)


def project(x: np.ndarray, inverse_mass: np.ndarray, springs, hinges, dt: float) -> None:
    for corners, length, compliance in springs:
        (a, b), w = corners.T, inverse_mass[corners]
        way = x[a] - x[b]
        now = np.linalg.norm(way, axis=1)
        pull = way * ((now - length) / (now * (w.sum(1) + compliance / dt**2)))[:, None]
        x[a] -= w[:, :1] * pull
        x[b] += w[:, 1:] * pull
    for corners, weights, compliance in hinges:
        w = inverse_mass[corners]
        bent = np.einsum("nk,nkd->nd", weights, x[corners])
        push = bent / ((w * weights**2).sum(1) + compliance / dt**2)[:, None]
        x[corners] -= (w * weights)[:, :, None] * push[:, None]


def write_ply(file: Path, points: np.ndarray, triangles: np.ndarray, **arrays: np.ndarray) -> None:
    """Arrays of the vertices beside them: name_0, name_1 … are one."""
    names = [*"xyz", *(f"{name}_{k}" for name, array in arrays.items() for k in range(array.shape[1]))]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property double {name}" for name in names] + [f"element face {len(triangles)}"]
    header += ["property list uchar int vertex_indices", "end_header", ""]
    faces = np.empty(len(triangles), [("count", "u1"), ("vertices", "<i4", 3)])
    faces["count"], faces["vertices"] = 3, triangles
    rows = np.hstack([points, *arrays.values()]).astype("<f8")
    file.write_bytes("\n".join(header).encode() + rows.tobytes() + faces.tobytes())


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    options, facts, sheet = scene["scene"], scene["facts"], scene["parts"]["sheet"]
    hands = options["handles"]
    if facts["obstacles"] or options["toughness"]["energy"] or any(hand["stiffness"] for hand in hands):
        raise SystemExit("obstacles, tears and hands that give way are not done here")
    rest, triangles = np.load(sheet["points"]), np.load(sheet["triangles"])
    flat, handle = (np.load(sheet["arrays"][name]["file"]) for name in ("pattern", "handle"))
    springs, hinges, areas = constraints(flat, triangles, facts["membrane_stiffness"], facts["bending_stiffness"])
    mass = options["material"]["area_density"] * np.bincount(triangles.ravel(), np.repeat(areas / 3, 3))
    moved = np.load(scene["tables"]["handle_transforms"]["rows"])
    ways = [moved[moved[:, 1] == k, 3:].reshape(-1, 3, 4) for k in range(len(hands))]   # a frame
    times = np.load(scene["tables"]["frames"]["rows"])[:, 1]

    x, v = rest.copy(), np.zeros_like(rest)
    frames = Path(scene["frames"]["folder"]) / "frames"
    frames.mkdir()
    write_ply(frames / "surface_0000.ply", x, triangles, pattern=flat, velocity=v)
    for frame, time in enumerate(times[1:], 1):
        dt = (time - times[frame - 1]) / STEPS
        for part in np.arange(1, STEPS + 1) / STEPS:
            before, inverse_mass, now = x.copy(), 1 / mass, time - (1 - part) * STEPS * dt
            v += dt * np.array(options["gravity"])
            for k, hand in enumerate(hands):
                of_hand = handle[:, 0] == k
                if hand["active"] and not any(span["from"] <= now <= span["to"] for span in hand["active"]):
                    continue
                if hand["force"]:
                    v[of_hand] += dt * np.array(hand["force"]) / mass[of_hand].sum()
                else:
                    way = (1 - part) * ways[k][frame - 1] + part * ways[k][frame]
                    v[of_hand] = (rest[of_hand] @ way[:, :3].T + way[:, 3] - x[of_hand]) / dt
                    inverse_mass[of_hand] = 0
            x += dt * v
            project(x, inverse_mass, springs, hinges, dt)
            v = (x - before) / dt * np.exp(-DRAG * dt)
        write_ply(frames / f"surface_{frame:04d}.ply", x, triangles, pattern=flat, velocity=v)
    rows = [f"{frame},{time!r}" for frame, time in enumerate(times.tolist())]
    (frames.parent / "frames.csv").write_text("\n".join(["frame,parameter", *rows]) + "\n")


if __name__ == "__main__":
    main()
