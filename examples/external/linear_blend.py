#!/usr/bin/env python3
"""Linear blend skinning as a method from outside: reads scene.json, writes out/frames/*.ply.

    geoprior run examples/external/linear-blend.toml --allow-commands
"""
import json
from pathlib import Path

import numpy as np


def write_points(file: Path, points: np.ndarray) -> None:
    """A PLY of vertices in double precision. Without faces the frame has those of the scene."""
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property double {axis}" for axis in "xyz"] + ["end_header", ""]
    file.write_bytes("\n".join(header).encode() + points.astype("<f8").tobytes())


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    surface = scene["parts"]["surface"]
    rest = np.load(surface["points"])                          # vertices x 3, metres
    weights = np.load(surface["arrays"]["weights"]["file"])    # vertices x joints
    transforms = np.load(scene["tables"]["transforms"]["rows"])  # frame, joint, 3 x 4 row by row

    frames = Path(scene["frames"]["folder"]) / "frames"
    frames.mkdir()
    for frame, _ in enumerate(scene["parameter"]["values"]):
        of_frame = transforms[transforms[:, 0] == frame]
        matrices = of_frame[:, 2:].reshape(-1, 3, 4)           # a joint
        posed = np.zeros_like(rest)
        for joint, matrix in enumerate(matrices):
            moved = rest @ matrix[:, :3].T + matrix[:, 3]
            posed += weights[:, joint : joint + 1] * moved
        write_points(frames / f"surface_{frame:04d}.ply", posed)


if __name__ == "__main__":
    main()
