#!/usr/bin/env python3
"""Snaps of an animated sheet as bursts of filtered noise, as a method from outside.

    geoprior run examples/external/noise-bursts.toml --allow-commands

A vertex flips when its curvature goes from beyond THRESHOLD on one side to beyond it on the other within SUDDEN; flips
of one frame that edges join are a snap. It sounds as noise, of all bands from the bending of a strip as wide as the
snap on, that dies away as paper of one loss factor does, the high bands first. No modes, no bank, nothing slides.
"""
import json
import wave
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.csgraph import connected_components

THRESHOLD, SUDDEN, LEAST_AREA = 5, 0.04, 5e-5                                    # 1/m, s, m^2
LOSS, SLOPE, HIGHEST, ONSET = 0.03, -12, 16000, 2e-3                             # factor, dB an octave, Hz, s
RATE, FULL_SCALE, TAIL, PAUSE, LISTENER = 48000, 0.2, 0.5, 0.1, (0, -0.6, 0.4)   # Hz, Pa, s, s, m
AIR, SOUND_SPEED = 1.204 * 343, 343                                              # Pa s/m, m/s


class Mesh:
    """What of a mesh of the sheet does not move. Paper keeps its lengths: the Laplacian of the surface is that of the
    pattern, and makes curvature times normal of places."""

    def __init__(self, part: dict):
        self.triangles = np.load(part["triangles"])
        self.pattern, handle = (np.load(part["arrays"][name]["file"]) for name in ("pattern", "handle"))
        self.held = handle[:, 0] >= 0
        i, j, k = np.concatenate([np.roll(self.triangles, turn, axis=1) for turn in range(3)]).T
        a, b = self.pattern[i] - self.pattern[k], self.pattern[j] - self.pattern[k]
        cotangent = (a * b).sum(1) / np.cross(a, b) / 2
        sides, weights, cells = (coo_matrix((values, (i, j)), [len(handle)] * 2).tocsr()
                                 for values in (np.ones(len(i)), cotangent, cotangent * ((a - b) ** 2).sum(1) / 4))
        self.joined, weights, cells = sides + sides.T, weights + weights.T, cells + cells.T
        self.laplacian, self.area = weights - diags(np.ravel(weights.sum(1))), np.ravel(cells.sum(1))
        self.border = np.stack((sides > sides.T).nonzero(), axis=1)
        # Curvature is a mean over the vertices within two edges, but for those of borders, beyond which nothing is.
        inside = np.bincount(self.border.ravel(), minlength=len(handle)) == 0
        self.near = (self.joined + self.joined @ self.joined) @ diags(inside.astype(float))

    def curvature(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of the vertices (1/m), and their normals."""
        a, b, c = (x[self.triangles[:, k]] for k in range(3))
        areas = np.cross(b - a, c - a).repeat(3, axis=0)
        normals = np.stack([np.bincount(self.triangles.ravel(), along, len(x)) for along in areas.T], axis=1)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        return self.near @ ((self.laplacian @ x) * normals).sum(1) / (self.near @ self.area), normals

    def lengths(self, members: np.ndarray, normals: np.ndarray) -> dict:
        """Of the vertices that snap together."""
        i, j = members[np.array(self.joined[members][:, members].nonzero())]
        # Along rulings normals do not turn.
        turning = np.linalg.lstsq(self.pattern[j] - self.pattern[i], normals[j] - normals[i], rcond=None)[0]
        along, area = np.linalg.svd(turning)[0][:, 1], self.area[members].sum()
        ruling = max(np.ptp(self.pattern[members] @ along), np.sqrt(area) / 4)  # a few vertices do not tell
        free = self.border[np.isin(self.border, members).all(1) & ~self.held[self.border].all(1)]
        border = np.linalg.norm(self.pattern[free[:, 1]] - self.pattern[free[:, 0]], axis=1).sum()
        return {"area_m2": area, "ruling_length_m": ruling, "free_border_m": border, "width_m": area / ruling}


def find_snaps(scene: dict, times: np.ndarray, folder: Path) -> list[dict]:
    """In order of time. Frames show what has snapped last."""
    snaps = []
    for frame, time in enumerate(times):
        part = scene["parts"][f"sheet_{frame:04d}"]
        x = np.load(part["points"])
        if "triangles" in part:  # another mesh, on which nothing has had a side yet
            mesh, before, seen, shown = Mesh(part), np.zeros(len(x)), np.zeros(len(x)), []
        k, normals = mesh.curvature(x)
        bent = abs(k) >= THRESHOLD
        flipped = np.flatnonzero(bent & (before * k < 0) & (time - seen <= SUDDEN))
        labels = connected_components(mesh.joined[flipped][:, flipped])[1]
        together = [flipped[labels == label] for label in np.unique(labels)]
        together = [members for members in together if mesh.area[members].sum() >= LEAST_AREA]
        for members in together:
            energy = scene["facts"]["bending_stiffness"] / 2 * (before[members] ** 2 * mesh.area[members]).sum()
            since = seen[members].min()
            snaps.append({"time_s": (since + time) / 2, "kind": "flap", **dict(zip("xyz", x[members].mean(axis=0))),
                          "energy_J": energy, "duration_s": time - since, "latency_s": (time - since) / 2,
                          **mesh.lengths(members, normals)})
        before, seen = np.where(bent, k, before), np.where(bent, time, seen)
        write_ply(folder / f"surface_{frame:04d}.ply", x, mesh.triangles)
        shown = np.hstack(together) if together else shown
        write_ply(folder / f"resonators_{frame:04d}.ply", x, mesh.triangles[np.isin(mesh.triangles, shown).all(1)])
    return sorted(snaps, key=lambda snap: snap["time_s"])


def burst(snap: dict, speed: float, random: np.random.Generator) -> np.ndarray:
    """Pressure 1 m away (Pa); `speed` is the root of bending stiffness over mass."""
    bending = 22.4 / (2 * np.pi) * speed / snap["width_m"] ** 2  # of a free beam, the second of a clamped one
    lowest = np.clip(bending, 20, HIGHEST / 8)
    time = np.arange(2 ** int(np.log2(RATE * 14 / (np.pi * LOSS * lowest)))) / RATE  # until its thousandth at least
    spectrum, frequency = np.fft.rfft(random.standard_normal(len(time))), np.fft.rfftfreq(len(time), 1 / RATE)
    sound, onset = np.zeros(len(time)), np.minimum(1, time / ONSET)
    for middle in lowest * 2 ** np.arange(1 / 6, np.log2(HIGHEST / lowest), 1 / 3):
        band = abs(np.log2(np.maximum(frequency, 1) / middle)) <= 1 / 6
        fall = (middle / lowest) ** (SLOPE / 6.02) * np.exp(-np.pi * LOSS * middle * time)
        sound += onset * fall * np.fft.irfft(spectrum * band, len(time))
    # Of the energy a share of 1e-3 for each metre of free border is radiated, as the topic's methods have it.
    heard = AIR / (4 * np.pi) * 1e-3 * snap["free_border_m"] * snap["energy_J"]
    return sound * np.sqrt(heard * RATE / (sound**2).sum())


def write_ply(file: Path, points: np.ndarray, triangles: np.ndarray) -> None:
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}", *(f"property double {a}" for a in "xyz"),
              f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    rows = [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()] + [f"3 {a} {b} {c}" for a, b, c in triangles.tolist()]
    file.write_text("\n".join(header + rows) + "\n")


def write_wav(file: Path, samples: np.ndarray) -> None:
    with wave.open(str(file), "wb") as out:
        out.setparams((1, 4, RATE, 0, "NONE", ""))
        out.writeframes((samples * (2**31 - 1)).astype("<i4").tobytes())


def write_csv(file: Path, columns, rows) -> None:
    file.write_text("".join(",".join(map(str, row)) + "\n" for row in (columns, *rows)))


def main() -> None:
    scene = json.loads(Path("scene.json").read_text())
    if not scene["parts"]:
        raise SystemExit("the animation is so large that its sheets are not given")
    times = np.load(scene["tables"]["frames"]["rows"])[:, 1]
    out, random = Path(scene["frames"]["folder"]), np.random.default_rng(scene["seed"])
    for folder in ("frames", "artifacts"):
        (out / folder).mkdir()
    speed = np.sqrt(scene["facts"]["bending_stiffness"] / scene["scene"]["material"]["area_density"])
    snaps, start = find_snaps(scene, times, out / "frames"), min(0, times[0])
    mix, voices = np.zeros(int((times[-1] - start + TAIL) * RATE)), [np.zeros(int(PAUSE * RATE))]
    for snap in snaps:
        sound = burst(snap, speed, random)
        way = np.linalg.norm(np.subtract(LISTENER, [snap[axis] for axis in "xyz"]))
        first = int((snap["time_s"] - start + way / SOUND_SPEED) * RATE)
        mix[first : first + len(sound)] += (sound / way / FULL_SCALE)[: max(0, len(mix) - first)]
        snap |= {"voice_start_s": sum(map(len, voices)) / RATE, "voice_length_s": len(sound) / RATE}
        voices += [0.9 * sound / max(abs(sound).max(), 1e-12), np.zeros(int(PAUSE * RATE))]
    write_wav(out / "artifacts" / "sound.wav", mix / max(1, abs(mix).max() / 0.8))
    write_wav(out / "artifacts" / "voices.wav", np.concatenate(voices))
    write_csv(out / "frames.csv", ["frame", "parameter"], enumerate(times))
    if snaps:
        write_csv(out / "events.csv", snaps[0].keys(), (snap.values() for snap in snaps))


if __name__ == "__main__":
    main()
