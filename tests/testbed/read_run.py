"""Reads a run as docs/file-formats.md describes it, with nothing of geoprior: run.h5 by h5py, frames by
Python's standard library.

    read_run.py PROGRAM     runs a small pendulum with that program and checks what it wrote
"""

import base64
import hashlib
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import h5py
import numpy as np
import numpy.lib.recfunctions

EXPERIMENT = """
title = "A pendulum"
topic = "toy-pendulum"
seed = 1
[scene]
length_m = 1
initial_angle_deg = 5
duration_s = 2
frames = 8
[[variant]]
name = "exact"
method = "closed-form"
[[variant]]
name = "euler"
method = "explicit-euler"
role = "baseline"
reference = "exact"
"""

FIELDS = ("time_s", "kind", "position", "energy_J", "duration_s")  # of every event

TYPES = {"Float64": "<d", "Float32": "<f", "Int64": "<q", "Int32": "<i", "UInt8": "<B", "Int8": "<b"}


def vtk_array(element):
    """Values of a DataArray with format="binary" and vtkZLibDataCompressor, header type UInt32."""
    assert element.get("format") == "binary"
    text = "".join(element.text.split())
    count = struct.unpack("<I", base64.b64decode(text[:8])[:4])[0]
    header_bytes = 4 * (3 + count)
    header_chars = 4 * math.ceil(header_bytes / 3)
    header = struct.unpack(f"<{3 + count}I", base64.b64decode(text[:header_chars])[:header_bytes])
    packed = base64.b64decode(text[header_chars:])
    data = b""
    for size in header[3:]:
        data += zlib.decompress(packed[:size])
        packed = packed[size:]
    kind = TYPES[element.get("type")]
    return np.array([value for (value,) in struct.iter_unpack(kind, data)])


def unit(element):
    key = element.find("InformationKey[@name='UNITS_LABEL']")
    return None if key is None else key.text.strip()


def field(root, name):
    return vtk_array(root.find(f".//FieldData/DataArray[@Name='{name}']"))


def check_frame(folder, run):
    """The bob of the last frame: on the closed form, with its speed in m/s."""
    root = ElementTree.parse(folder / "frames/default/exact/bob_0008.vtp").getroot()
    assert root.get("compressor") == "vtkZLibDataCompressor" and root.get("header_type") == "UInt32"
    assert field(root, "TimeValue") == [2.0]
    assert field(root, "PartKind") == [2]
    x, y, z = vtk_array(root.find(".//Points/DataArray"))
    assert z == 0 and abs(math.hypot(x, y) - 1) < 1e-14
    damping, frequency = 0.2, math.sqrt(9.81)
    damped = math.sqrt(frequency**2 - damping**2)
    angle = math.radians(5) * math.exp(-damping * 2) * (
        math.cos(damped * 2) + damping / damped * math.sin(damped * 2))
    assert abs(math.atan2(x, -y) - angle) < 1e-12
    speed = root.find(".//PointData/DataArray[@Name='speed']")
    assert unit(speed) == "m/s" and vtk_array(speed).shape == (1,)

    grid = ElementTree.parse(folder / "frames/default/exact/warmth_0000.vti").getroot()
    assert grid.find("ImageData").get("WholeExtent") == "0 8 0 4 0 0"
    assert vtk_array(grid.find(".//PointData/DataArray[@Name='warmth']")).shape == (45,)

    rod = ElementTree.parse(folder / "frames/default/exact/rod_0000.vtp").getroot()
    assert list(vtk_array(rod.find(".//Lines/DataArray[@Name='connectivity']"))) == [0, 1]

    table = (folder / "frames/default/exact/state_0008.csv").read_text().splitlines()
    assert table[0] == '"angle [rad]","velocity [rad/s]"'
    assert abs(float(table[1].split(",")[0]) - angle) < 1e-12

    pvd = ElementTree.parse(folder / "frames/default/exact.pvd").getroot()
    sets = pvd.findall("Collection/DataSet")
    assert len(sets) == 27 and float(sets[-1].get("timestep")) == 2.0
    assert all((folder / "frames/default" / s.get("file")).is_file() for s in sets)
    assert run["cases/default/variants/exact/frames"].shape == (36,)


def check_numbers(folder, run):
    assert run.attrs["schema_version"] == 4 and run.attrs["quick"] == 0
    assert isinstance(run.attrs["experiment"], str) and "toy-pendulum" in run.attrs["experiment"]
    for name in ["git_commit", "compiler", "flags", "instruction_set", "cpu", "start", "library_VTK"]:
        assert isinstance(run.attrs[name], str), name
    case = run["cases/default"]
    assert case.attrs["seed"] == 1 and case.attrs["parameter_unit"] == "s"
    assert json.loads(case.attrs["scene"])["frames"] == 8
    assert case["facts"].attrs["frames"] == 9
    euler = case["variants/euler"]
    assert euler.attrs["method"] == "explicit-euler" and euler.attrs["reference"] == "exact"
    assert euler["parameter"].attrs["unit"] == "s" and euler["parameter"][-1] == 2.0
    error = euler["metrics/angle_error"]
    assert error.shape == (9,) and error.attrs["unit"] == "rad" and error[-1] > 0
    assert error.attrs["direction"] == "lower_is_better" and error.attrs["definition"]
    assert euler["summary/angle_error.max"][()] == error[:].max()
    assert "distance_to_reference" in euler["metrics"]
    assert euler["timing/run"].shape == (9, 1) and euler["timing/run"].attrs["unit"] == "s"
    assert euler["timing/finish"].shape == (1, 1) and euler["timing/prepare"].shape == (1, 1)
    assert euler.attrs["status"] == "done" and euler.attrs["error"] == ""
    events = euler["events"]
    assert events.dtype["position"].shape == (3,) and events[0]["kind"] == b"crossing"
    assert events.dtype.names == (*FIELDS, "speed_m_s")
    assert np.allclose(events["energy_J"], 0.5 * events["speed_m_s"] ** 2, rtol=1e-15)
    states = euler["tables/state"]
    assert list(states.attrs["columns"]) == ["frame", "angle [rad]", "velocity [rad/s]"]
    assert states.compression == "gzip" and list(states[:, 0]) == list(range(9))
    for i, row in enumerate(states):
        line = (folder / f"frames/default/euler/state_{i:04d}.csv").read_text().splitlines()[1]
        assert list(row[1:]) == [float(text) for text in line.split(",")], i
    for table in ["frames", "artifacts"]:
        for row in euler[table]:
            name = row["name"].decode()
            data = (folder / name).read_bytes()
            assert hashlib.sha256(data).hexdigest().encode() == row["sha256"], name


def c_hex(x):
    """C's %a of glibc: no trailing zeros, unlike float.hex()."""
    if math.isnan(x):
        return "nan"
    text = float(x).hex()
    if "p" not in text:
        return text
    mantissa, exponent = text.split("p")
    if "." in mantissa:
        mantissa = mantissa.rstrip("0").rstrip(".")
    return f"{mantissa}p{exponent}"


HALVES = {"frames": ("frames",), "metrics": ("metrics",), "content": ("frames", "metrics")}


def content_text(run, what="content"):
    """The text whose SHA-256 is `<what>_sha256`."""
    lines = [f"geoprior {what} 1"]
    for case_name in sorted(run["cases"]):
        lines.append(f"case {case_name}")
        variants = run["cases"][case_name]["variants"]
        for name in sorted(variants):
            lines.append(f"variant {name}")
            for half in HALVES[what]:
                lines += (frame_lines if half == "frames" else metric_lines)(variants[name])
    return "".join(line + "\n" for line in lines)


def frame_lines(v):
    lines = []
    files = v["frames"][:]
    for i, parameter in enumerate(v["parameter"]):
        lines.append(f"frame {i} {c_hex(parameter)}")
        lines += [f"file {f['name'].decode()} {f['sha256'].decode()}" for f in files if f["frame"] == i]
    for e in v["events"]:
        numbers = [*e["position"], e["energy_J"], e["duration_s"]]
        further = [f"{n}={c_hex(e[n])}" for n in sorted(e.dtype.names) if n not in FIELDS and e[n] == e[n]]
        lines.append(" ".join(["event", c_hex(e["time_s"]), e["kind"].decode(), *map(c_hex, numbers), *further]))
    return lines + [f"artifact {a['name'].decode()} {a['sha256'].decode()}" for a in v["artifacts"]]


def metric_lines(v):
    lines = [" ".join(["metric", m, *map(c_hex, v["metrics"][m][:])]) for m in sorted(v["metrics"])]
    return lines + [f"summary {s} {c_hex(v['summary'][s][()])}" for s in sorted(v["summary"])]


def make_schema_1(file):
    """What run.h5 was before processes were timed by frames."""
    with h5py.File(file, "a") as run:
        run.attrs["schema_version"] = 1
        for half in ("frames_sha256", "metrics_sha256"):
            del run.attrs[half]
        for case in run["cases"].values():
            rows = case["ratios"][:][["variant", "of", "median_ratio", "low", "high"]]
            del case["ratios"]
            case["ratios"] = np.lib.recfunctions.repack_fields(rows)
            for variant in case["variants"].values():
                del variant.attrs["error"]
                whole = variant["timing/run"][:].sum(axis=0, keepdims=True)
                for phase in list(variant["timing"]):
                    if phase not in ("load", "prepare"):
                        del variant["timing"][phase]
                variant["timing/run"] = whole
        for study in run["study"].values():
            del study["y_of"]
        rows = run["claims"][:][["text", "case", "detail", "left", "right", "holds"]]
        del run["claims"]
        run["claims"] = np.lib.recfunctions.repack_fields(rows)


def check_older_schema(program, folder, environment):
    make_schema_1(folder / "run.h5")
    export = [program, "export", str(folder), "--format", "obj", "--out", str(folder / "obj")]
    assert subprocess.run(export, env=environment).returncode == 2, "it is not what was recorded"
    subprocess.run([*export, "--force"], check=True, env=environment)
    assert list((folder / "obj").rglob("*.obj"))


def main():
    with tempfile.TemporaryDirectory() as temporary:
        experiment = Path(temporary) / "experiments/toy-pendulum/swing.toml"
        experiment.parent.mkdir(parents=True)
        experiment.write_text(EXPERIMENT)
        folder = Path(temporary) / "run"
        environment = {**os.environ, "GEOPRIOR_RUNS": temporary + "/runs"}
        subprocess.run([sys.argv[1], "run", str(experiment), "--no-pictures", "--out", str(folder)],
                       check=True, env=environment)
        with h5py.File(folder / "run.h5") as run:
            check_numbers(folder, run)
            check_frame(folder, run)
            for what in HALVES:
                computed = hashlib.sha256(content_text(run, what).encode()).hexdigest()
                assert computed == run.attrs[what + "_sha256"], what
            assert float(run.attrs["processor_s"]) > 0
        for line in (folder / "journal.jsonl").read_text().splitlines():
            assert "kind" in json.loads(line)
        check_older_schema(sys.argv[1], folder, environment)
    print("run.h5, .vtp, .vti, .csv, .pvd and journal.jsonl are as described")


if __name__ == "__main__":
    main()
