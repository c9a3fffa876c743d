#!/usr/bin/env python3
"""A dam break by the shallow water equations of Saint-Venant, as a method from outside.

    geoprior run examples/external/shallow-water.toml --allow-commands

A depth h and a speed u for each column of water, under the pressure of water at rest:

    h_t + (h u)_x = 0,    (h u)_t + (h u^2 + g h^2 / 2)_x = 0,

by finite volumes, with the two waves of Harten, Lax and van Leer (1983) between cells. Water that falls is at the
bottom at once: the front leaves with twice the speed of a wave (Ritter 1892), where real water starts from rest.
"""
import json
from pathlib import Path

import numpy as np

FINER = 8       # cells along x in one of the tank's
COURANT = 0.9   # cells that the fastest wave passes in a step
DRY = 1e-9      # depth that is none, of the deepest at the start


def step(h: np.ndarray, hu: np.ndarray, g: float, dx: float, dry: float, longest: float):
    """Depth and discharge (m, m^2/s) after a step of at most that many seconds, and its length."""
    h, hu = np.pad(h, 1, "edge"), np.concatenate([-hu[:1], hu, -hu[-1:]])   # walls mirror
    wet = h > dry
    u, c = np.divide(hu, h, out=np.zeros_like(h), where=wet), np.sqrt(g * h)
    flux = np.array([h * u, h * u**2 + g * h**2 / 2])
    left, right = np.s_[..., :-1], np.s_[..., 1:]
    # The slowest wave and the fastest; onto dry ground goes Ritter's front.
    slow = np.minimum.reduce([0 * c[left], (u - c)[left], (u - c)[right], np.where(wet[left], 0, (u - 2 * c)[right])])
    fast = np.maximum.reduce([0 * c[left], (u + c)[left], (u + c)[right], np.where(wet[right], 0, (u + 2 * c)[left])])
    jump = np.diff(np.array([h, hu]))
    spread = np.maximum(fast - slow, 1e-300)
    between = (fast * flux[left] - slow * flux[right] + fast * slow * jump) / spread
    dt = min(longest, COURANT * dx / max(fast.max(), -slow.min()))
    change = dt / dx * np.diff(between)
    return h[1:-1] - change[0], hu[1:-1] - change[1], dt


def closed_surface(h: np.ndarray, dx: float, corner: np.ndarray, across: float, dry: float):
    """Of the water: its depth at the middle of each cell, level at both ends, encloses what the cells hold."""
    wet = np.flatnonzero(h > dry)
    h = h[wet[0] : wet[-1] + 1]
    n = len(h) + 2
    x = dx * (wet[0] + np.concatenate([[0], np.arange(n - 2) + 0.5, [n - 2]]))
    depth = np.concatenate([h[:1], h, h[-1:]])
    side = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, depth])])   # floor, then surface
    points = corner + np.vstack([np.insert(side, 1, y, axis=1) for y in (0, across)])
    k, last = np.arange(n - 1), np.array([n - 1])      # of the floor at y = 0
    surface, far = n, 2 * n                            # above it, and on the other side
    quads = [(k, k + 1, k + 1 + surface, k + surface),
             (k + far, k + far + surface, k + 1 + far + surface, k + 1 + far),
             (k, k + far, k + 1 + far, k + 1),
             (k + surface, k + 1 + surface, k + 1 + far + surface, k + far + surface),
             (k[:1], k[:1] + surface, k[:1] + far + surface, k[:1] + far),
             (last, last + far, last + far + surface, last + surface)]
    corners = np.concatenate([np.column_stack(quad) for quad in quads])
    return points, np.vstack([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])


def write_ply(file: Path, points: np.ndarray, triangles: np.ndarray) -> None:
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property double {axis}" for axis in "xyz"] + [f"element face {len(triangles)}"]
    header += ["property list uchar int vertex_indices", "end_header", ""]
    faces = np.empty(len(triangles), [("count", "u1"), ("vertices", "<i4", 3)])
    faces["count"], faces["vertices"] = 3, triangles
    file.write_bytes("\n".join(header).encode() + points.astype("<f8").tobytes() + faces.tobytes())


def vector(row: dict[str, float], name: str) -> np.ndarray:
    return np.array([row[name.format(axis)] for axis in "xyz"])


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    rows = {name: [dict(zip(table["columns"], row)) for row in np.load(table["rows"])]
            for name, table in scene["tables"].items()}
    if len(rows.get("tank", [])) != 1 or len(rows.get("volumes", [])) != 1 or rows.keys() & {"sources", "solids"}:
        raise SystemExit("the scene is no tank with one volume of water and nothing else")
    (tank,), (water,) = rows["tank"], rows["volumes"]
    corner, extent = vector(tank, "{} [m]"), tank["cell [m]"] * vector(tank, "cells_{}")
    centre, half = vector(water, "centre_{} [m]") - corner, vector(water, "half_{} [m]")
    low, high = np.maximum(centre - half, 0), np.minimum(centre + half, extent)
    if water["kind"] != 0 or np.abs([low[1], extent[1] - high[1], low[2]]).max() > 1e-9:
        raise SystemExit("the water is no box on the floor from side to side: its depth is not one of x alone")

    g, dx = -tank["gravity_z [m/s^2]"], tank["cell [m]"] / FINER
    cells = dx * np.arange(FINER * tank["cells_x"] + 1)
    h = high[2] * np.diff(np.clip(cells, low[0], high[0])) / dx
    hu, now, dry = h * water["velocity_x [m/s]"], 0.0, DRY * high[2]
    times = [row["time [s]"] for row in rows["frames"]]
    frames = Path(scene["frames"]["folder"]) / "frames"
    frames.mkdir()
    for frame, time in enumerate(times):
        while now < time:
            h, hu, dt = step(h, hu, g, dx, dry, time - now)
            now += dt
        write_ply(frames / f"surface_{frame:04d}.ply", *closed_surface(h, dx, corner, extent[1], dry))
    table = [f"{frame},{time}" for frame, time in enumerate(times)]
    (frames.parent / "frames.csv").write_text("\n".join(["frame,parameter", *table]) + "\n")


if __name__ == "__main__":
    main()
