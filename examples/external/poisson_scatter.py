#!/usr/bin/env python3
"""Poisson-disk scattering on a flat surface that is stretched, as a method from outside.

    geoprior run examples/external/poisson-scatter.toml --allow-commands

Details go with the surface. In every frame those stay that are no nearer to an older one than the nearest two at
rest, then darts are thrown that keep this distance, until there are as many to the area as at rest. Weights are 0
or 1: who comes pops up, which the topic's own method does not do. Meshes of details are Delaunay in the plane.
"""
import json
from pathlib import Path

import numpy as np
from scipy.spatial import Delaunay, cKDTree


def write_ply(file: Path, points: np.ndarray, triangles=(), **numbers) -> None:
    """Vertices, further numbers of them (name_0, name_1 … are one array) and triangles."""
    columns = {axis: points[:, i] for i, axis in enumerate("xyz")} | numbers
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    header += [f"property double {name}" for name in columns]
    if len(triangles):
        header += [f"element face {len(triangles)}", "property list uchar int vertex_indices"]
    rows = [" ".join(repr(float(x)) for x in row) for row in zip(*columns.values())]
    rows += [f"3 {a} {b} {c}" for a, b, c in triangles]
    file.write_text("\n".join(header + ["end_header"] + rows) + "\n")


def far_apart(points: np.ndarray, radius: float) -> np.ndarray:
    """Indices of points that are no nearer than the radius to one kept before, in their order."""
    keep = np.ones(len(points), bool)
    for i, near in enumerate(cKDTree(points).query_ball_point(points, radius)):
        if keep[i]:
            keep[[k for k in near if k > i]] = False
    return np.flatnonzero(keep)


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    parts, random = scene["parts"], np.random.default_rng(scene["seed"])
    triangles = np.load(parts["surface"]["triangles"])
    edges, uses = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)), axis=0, return_counts=True)
    border = np.unique(edges[uses == 1])  # ghosts of the meshes: edges beside them are not measured
    given = {name: np.load(array["file"]) for name, array in parts["details"]["arrays"].items()}
    face, barycentric = given["face"][:, 0].astype(int), given["barycentric"]
    birth, births = np.arange(len(face)), len(face)
    places = np.load(parts["details"]["points"])
    radius = 0.999999 * cKDTree(places).query(places, k=2)[0][:, 1].min()

    frames = Path(scene["frames"]["folder"]) / "frames"
    frames.mkdir()
    for frame, _ in enumerate(times := np.load(scene["tables"]["frames"]["rows"])[:, 1]):
        surface = np.load(parts[f"motion_{frame:04d}"]["points"])
        if np.ptp(surface[:, 2]) > 1e-9:
            raise SystemExit(f"frame {frame}: the surface is not flat in z, its details cannot be triangulated")
        a, b, c = (surface[triangles[:, k]] for k in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        density = len(face) / area.sum() if frame == 0 else density
        wanted = round(density * area.sum())
        darts = random.choice(len(area), 20 * wanted, p=area / area.sum())
        face, birth = np.append(face, darts), np.append(birth, births + np.arange(len(darts)))
        barycentric = np.vstack([barycentric, random.dirichlet([1, 1, 1], len(darts))])
        births += len(darts)
        places = np.einsum("nk,nkd->nd", barycentric, surface[triangles[face]])
        kept = far_apart(places, radius)[:wanted]
        face, barycentric, birth, places = face[kept], barycentric[kept], birth[kept], places[kept]

        corners = {f"barycentric_{k}": barycentric[:, k] for k in range(3)}
        write_ply(frames / f"surface_{frame:04d}.ply", surface)
        write_ply(frames / f"details_{frame:04d}.ply", places, **corners, face=face, birth=birth,
                  weight=np.ones(len(kept)), target_weight=np.ones(len(kept)))
        points, ghost = np.vstack([places, surface[border]]), np.repeat([0, 1], [len(kept), len(border)])
        for mesh in ("detail_mesh", "visible_mesh"):
            write_ply(frames / f"{mesh}_{frame:04d}.ply", points, Delaunay(points[:, :2]).simplices, ghost=ghost)
    rows = [f"{frame},{time!r}" for frame, time in enumerate(times.tolist())]
    (frames.parent / "frames.csv").write_text("\n".join(["frame,parameter", *rows]) + "\n")


if __name__ == "__main__":
    main()
