#!/usr/bin/env python3
"""The visual hull of drawn silhouettes in NumPy, as a method from outside.

    geoprior run examples/external/silhouette-hull.toml --allow-commands

What every view sees inside of its silhouette is where the largest of the signed distances in the views is negative
(Rivers, Durand and Igarashi 2010). Its zero set is taken by marching tetrahedra: closed, its sharp edges cut off.
"""
import json
from pathlib import Path

import numpy as np

CELLS = 56  # along the longest side of the box about the silhouettes


def signed_distance(points: np.ndarray, loop: np.ndarray) -> np.ndarray:
    """Of points of a plane from a closed polygon, negative inside."""
    a, b = loop, np.roll(loop, -1, axis=0)
    way, to = b - a, points[:, None] - a                                   # segments x 2, points x segments x 2
    along = np.clip((to * way).sum(2) / (way**2).sum(1), 0, 1)
    distance = np.linalg.norm(to - along[..., None] * way, axis=2).min(1)
    over = (a[:, 1] > points[:, 1:]) != (b[:, 1] > points[:, 1:])          # segments that a ray along x may cross
    ahead = (to[..., 0] * way[:, 1] < to[..., 1] * way[:, 0]) == (way[:, 1] > 0)
    return np.where((over & ahead).sum(1) % 2 == 1, -distance, distance)


def marching_tetrahedra(value: np.ndarray, points: np.ndarray, tetrahedra: np.ndarray):
    """Zero set of values at points: vertices, and triangles that look to where the values are positive."""
    inside = value[tetrahedra] < 0
    crossed = inside.any(1) & ~inside.all(1)
    tetrahedra, inside = tetrahedra[crossed], inside[crossed]
    order = np.argsort(~inside, axis=1, kind="stable")                     # corners inside come first
    tetrahedra, count = np.take_along_axis(tetrahedra, order, 1), inside.sum(1)
    fans = [(1, [(0, 1), (0, 2), (0, 3)]), (2, [(0, 2), (0, 3), (1, 3)]), (2, [(0, 2), (1, 3), (1, 2)]),
            (3, [(0, 3), (1, 3), (2, 3)])]                                 # by corners inside: edges that are cut
    edges = np.concatenate([tetrahedra[count == inside][:, fan] for inside, fan in fans])   # triangles x 3 x 2
    ends, number = np.unique(np.sort(edges.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    low, high = value[ends].T
    vertices = points[ends[:, 0]] + (low / (low - high))[:, None] * (points[ends[:, 1]] - points[ends[:, 0]])
    triangles = number.reshape(-1, 3)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    outward = (points[edges[..., 1]] - points[edges[..., 0]]).sum(1)
    turned = (np.cross(b - a, c - a) * outward).sum(1) < 0
    triangles[turned] = triangles[turned][:, ::-1]
    return vertices, triangles


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    files = {kind: scene["parts"].get(f"silhouette_{view}") for kind, view in enumerate(("front", "side", "top"))}
    drawn = {kind: np.load(file["points"]) for kind, file in files.items() if file}
    if len(drawn) < 2:
        raise SystemExit(f"the scene has {len(drawn)} silhouettes, a hull takes those of two views or three")
    views = {int(row[0]): row[1:7].reshape(2, 3) for row in np.load(scene["tables"]["views"]["rows"])}   # right, up
    lines = np.concatenate(list(drawn.values()))                           # each in the plane of its view
    low, high = lines.min(0), lines.max(0)
    cell = (high - low).max() / CELLS
    axes = [np.arange(low[k] - 1.5 * cell, high[k] + 2 * cell, cell) for k in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    value = np.full(len(points), -np.inf)
    for kind, line in drawn.items():
        plane, number = np.unique((points @ views[kind].T).round(12), axis=0, return_inverse=True)
        blocks = np.array_split(plane, 1 + len(plane) // 256)
        distance = np.concatenate([signed_distance(block, line @ views[kind].T) for block in blocks])
        value = np.maximum(value, distance[number.reshape(-1)])
    value[abs(value) < 1e-2 * cell] = 1e-2 * cell                          # no vertex of the grid is on the surface
    # Each box is cut into the six tetrahedra of the ways from its lowest to its highest corner.
    index = np.arange(len(points)).reshape([len(axis) for axis in axes])
    strides = np.array([index.strides[k] // index.itemsize for k in range(3)])
    first = index[:-1, :-1, :-1].reshape(-1, 1)
    ways = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]
    tetrahedra = np.concatenate([first + np.append(0, strides[way].cumsum()) for way in ways])
    vertices, triangles = marching_tetrahedra(value, points, tetrahedra)

    folder = Path(scene["frames"]["folder"]) / "frames"
    folder.mkdir()
    # "seam" and "fold" mark vertices of drawn seams and folds: there are none here.
    header = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}",
              *(f"property double {name}" for name in ("x", "y", "z", "seam", "fold")),
              f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    rows = [f"{x!r} {y!r} {z!r} 0 0" for x, y, z in vertices.tolist()] + [f"3 {a} {b} {c}" for a, b, c in triangles]
    (folder / "surface_0000.ply").write_text("\n".join(header + rows) + "\n")
    (folder.parent / "frames.csv").write_text("frame,parameter\n0,0\n")


if __name__ == "__main__":
    main()
