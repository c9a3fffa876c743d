"""Files that other programs brought, put through the program and through a reader that is not its own.

    python3 tests/packages/foreign_files.py             fails where a file is read otherwise than it should be
    python3 tests/packages/foreign_files.py --write     also writes docs/foreign-files.md

The files are those of Debian packages: nothing of them is in the repository. What they hold is read by VTK (OBJ, PLY,
STL) and by the few lines below (OFF, SVG, glTF). A file is either read as they read it, or refused with a
reason; a difference without a word is an error. Run with Debian's python3 (python3-vtk9, python3-numpy)."""

import argparse
import json
import math
import multiprocessing
import re
import struct
import subprocess
import sys
import tarfile
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

HOME = Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build/release/geoprior"
PAGE = HOME / "docs/foreign-files.md"


class Unreadable(Exception):
    """What the other reader says of a file that it does not take either."""


# --- what files hold, by other readers -------------------------------------------------------------------------------


def measured(points, polygons):
    """Triangles and area; a polygon of n corners is n - 2 triangles, its area that of its vector area."""
    triangles, area = 0, 0.0
    for corners in polygons:
        places = points[np.asarray(corners)]
        ahead = np.roll(places, -1, axis=0)
        area += 0.5 * np.linalg.norm(np.cross(places - places[0], ahead - places[0]).sum(axis=0))
        triangles += len(corners) - 2
    return {"triangles": triangles, "area": area}


def vtk_mesh(reader, file):
    reader.SetFileName(str(file))
    reader.Update()
    mesh = reader.GetOutput()
    if mesh.GetNumberOfPoints() == 0:
        raise Unreadable("no points")
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    return measured(points, polygons_of(mesh))


def polygons_of(mesh):
    strips = [[s[i], s[i + 1], s[i + 2]] for s in lists_of(mesh.GetStrips()) for i in range(len(s) - 2)]
    return lists_of(mesh.GetPolys()) + strips


def lists_of(cells):
    data = vtk_to_numpy(cells.GetData()) if cells.GetNumberOfCells() else []
    found, i = [], 0
    while i < len(data):
        found.append(data[i + 1 : i + 1 + data[i]])
        i += 1 + data[i]
    return found


def off_mesh(file):
    """OFF of one vertex or face a line."""
    lines = [line.split("#")[0].split() for line in Path(file).read_text(errors="replace").splitlines()]
    lines = [line for line in lines if line]
    if not lines or not re.fullmatch(r"(ST)?C?N?OFF", lines[0][0]):
        raise Unreadable("no text OFF")
    head = 1 if len(lines[0]) > 1 else 2
    vertices, faces = (int(word) for word in (lines[0][1:] + lines[1])[:2])
    points = np.array([line[:3] for line in lines[head : head + vertices]], dtype=float)
    return measured(points, [[int(i) for i in line[1 : 1 + int(line[0])]] for line in lines[head + vertices :][:faces]])


def gltf_document(file):
    data = Path(file).read_bytes()
    if data[:4] == b"glTF":
        if struct.unpack("<I", data[4:8])[0] != 2:
            raise Unreadable("glTF 1")
        data = data[20 : 20 + struct.unpack("<I", data[12:16])[0]]
    document = json.loads(data)
    if str(document.get("asset", {}).get("version", "1")).startswith("1"):
        raise Unreadable("glTF 1")
    return document


def gltf_mesh(file):
    """Vertices under a skin by the JSON alone; what has no skin by VTK."""
    document = gltf_document(file)
    skinned = [n for n in document.get("nodes", []) if "skin" in n and "mesh" in n]
    if skinned:
        parts = [part for node in skinned for part in document["meshes"][node["mesh"]]["primitives"]]
        return {"vertices": sum(document["accessors"][part["attributes"]["POSITION"]]["count"] for part in parts)}
    reader = vtkGLTFReader()
    reader.SetFileName(str(file))
    reader.Update()
    found, todo = {"triangles": 0, "area": 0.0}, [reader.GetOutput()]
    while todo:
        block = todo.pop()
        if block is None:
            continue
        if block.IsA("vtkMultiBlockDataSet"):
            todo += [block.GetBlock(i) for i in range(block.GetNumberOfBlocks())]
        elif block.GetNumberOfPoints():
            part = measured(vtk_to_numpy(block.GetPoints().GetData()).astype(float), polygons_of(block))
            found = {key: found[key] + part[key] for key in found}
    if found["triangles"] == 0:
        raise Unreadable("no triangles")
    return found


# --- outlines of SVG ---------------------------------------------------------------------------------------------------


def curve(corners):
    """Points of a Bezier curve of any degree."""
    t = np.linspace(0, 1, 65)[1:, None]
    level = [np.asarray(c, float) for c in corners]
    while len(level) > 1:
        level = [a * (1 - t) + b * t for a, b in zip(level, level[1:])]
    return [tuple(p) for p in level[0]]


def arc(start, radii, turn, large, sweep, end):
    """Points of an elliptical arc (SVG 1.1, F.6)."""
    rx, ry = abs(radii[0]), abs(radii[1])
    if start == end or rx == 0 or ry == 0:
        return [end]
    c, s = math.cos(turn), math.sin(turn)
    half = ((start[0] - end[0]) / 2, (start[1] - end[1]) / 2)
    x, y = c * half[0] + s * half[1], -s * half[0] + c * half[1]
    grow = max(1.0, math.sqrt((x / rx) ** 2 + (y / ry) ** 2))
    rx, ry = rx * grow, ry * grow
    below = (rx * y) ** 2 + (ry * x) ** 2
    root = math.sqrt(max(0.0, (rx * ry) ** 2 / below - 1)) * (-1 if large == sweep else 1)
    cx, cy = root * rx * y / ry, -root * ry * x / rx
    first = math.atan2((y - cy) / ry, (x - cx) / rx)
    last = math.atan2((-y - cy) / ry, (-x - cx) / rx)
    if sweep and last < first:
        last += 2 * math.pi
    if not sweep and last > first:
        last -= 2 * math.pi
    middle = (c * cx - s * cy + (start[0] + end[0]) / 2, s * cx + c * cy + (start[1] + end[1]) / 2)
    angles = np.linspace(first, last, 129)[1:]
    return [(middle[0] + c * rx * math.cos(a) - s * ry * math.sin(a),
             middle[1] + s * rx * math.cos(a) + c * ry * math.sin(a)) for a in angles]


NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def outline(d):
    """Closed lines of the data of a path."""
    loops, loop, at, begin, last, handle = [], [], (0.0, 0.0), (0.0, 0.0), "", None
    for command, text in re.findall(r"([MmLlHhVvCcSsQqTtAaZz])([^MmLlHhVvCcSsQqTtAaZz]*)", d):
        kind = command.upper()
        if kind == "A":
            values = [float(v) for group in re.findall(
                rf"({NUMBER})[\s,]*({NUMBER})[\s,]*({NUMBER})[\s,]*([01])[\s,]*([01])[\s,]*({NUMBER})[\s,]*({NUMBER})", text)
                for v in group]
        else:
            values = [float(v) for v in re.findall(NUMBER, text)]
        size = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}[kind]
        if kind == "Z":
            loops.append(loop)
            loop, at, last = [begin], begin, "Z"
            continue
        for i in range(0, len(values) - size + 1, size):
            v, base = values[i : i + size], at if command.islower() else (0.0, 0.0)
            pairs = [(base[0] + v[j], base[1] + v[j + 1]) for j in range(0, size - 1, 2)] if kind != "A" else []
            mirrored = (2 * at[0] - handle[0], 2 * at[1] - handle[1]) if handle else at
            if kind == "M" and i == 0:
                loops.append(loop)
                begin, loop, new = pairs[0], [], [pairs[0]]
            elif kind in "ML":
                new = [pairs[0]]
            elif kind == "H":
                new = [(base[0] + v[0], at[1])]
            elif kind == "V":
                new = [(at[0], base[1] + v[0])]
            elif kind == "C":
                new = curve([at, *pairs])
            elif kind == "S":
                new = curve([at, mirrored if last in "CS" else at, *pairs])
            elif kind == "Q":
                new = curve([at, *pairs])
            elif kind == "T":
                pairs = [mirrored if last in "QT" else at, pairs[0]]
                new = curve([at, *pairs])
            else:
                new = arc(at, v[:2], math.radians(v[2]), v[3] == 1, v[4] == 1, (base[0] + v[5], base[1] + v[6]))
            handle = pairs[-2] if kind in "CSQT" else None
            loop, at, last = loop + new, new[-1], kind
    return [l for l in [*loops, loop] if len(l) > 2]


def filled_area(loops, rule):
    """Area inside, by lines across: what even-odd or non-zero winding fills."""
    ends = np.array([(*p, *q) for loop in loops for p, q in zip(loop, loop[1:] + loop[:1])])
    low, high, lines = min(ends[:, 1].min(), ends[:, 3].min()), max(ends[:, 1].max(), ends[:, 3].max()), 8192
    step, total = (high - low) / lines, 0.0
    for y in low + (np.arange(lines) + 0.5) * step:
        cut = ends[(ends[:, 1] <= y) != (ends[:, 3] <= y)]
        x = cut[:, 0] + (y - cut[:, 1]) / (cut[:, 3] - cut[:, 1]) * (cut[:, 2] - cut[:, 0])
        order = np.argsort(x)
        turns = np.cumsum(np.where(cut[order, 3] > cut[order, 1], 1, -1))
        inside = turns % 2 != 0 if rule == "evenodd" else turns != 0
        total += step * float((np.diff(x[order]) * inside[:-1]).sum())
    return total


def svg_shape(file):
    """Area in squares of the outermost viewBox of the only shape that has an area."""
    root = ElementTree.parse(file).getroot()
    if any("transform" in e.attrib for e in root.iter()):
        raise Unreadable("transforms")
    shapes = []
    for element in root.iter():
        name = element.tag.split("}")[-1]
        style = dict(part.split(":", 1) for part in element.get("style", "").replace(" ", "").split(";") if ":" in part)
        rule = style.get("fill-rule", element.get("fill-rule", "nonzero"))
        number = lambda key: float(re.match(NUMBER, element.get(key, "0"))[0])
        if name == "path":
            shapes.append((outline(element.get("d", "")), rule))
        elif name in ("polygon", "polyline"):
            values = [float(v) for v in re.findall(NUMBER, element.get("points", ""))]
            shapes.append(([list(zip(values[::2], values[1::2]))], rule))
        elif name == "circle":
            x, y, r = number("cx"), number("cy"), number("r")
            shapes.append(([[(x + r * math.cos(a), y + r * math.sin(a)) for a in np.linspace(0, 2 * math.pi, 2049)[1:]]], rule))
        elif name == "rect" and not element.get("rx"):
            x, y, w, h = number("x"), number("y"), number("width"), number("height")
            shapes.append(([[(x, y), (x + w, y), (x + w, y + h), (x, y + h)]], rule))
        elif name in ("ellipse", "use", "rect"):
            raise Unreadable(name)
    shapes = [(loops, rule) for loops, rule in shapes if loops]
    if len(shapes) != 1:
        raise Unreadable(f"{len(shapes)} shapes")
    return {"area": filled_area(*shapes[0])}


# --- what the program makes of them ------------------------------------------------------------------------------------

SKETCH = """title = "A mesh"
topic = "sketch"
[scene]
surface = {file}
[[variant]]
name = "v"
method = "angle-defect-flow"
options = {{ iterations = 1 }}
"""
PAPER = """title = "An outline"
topic = "paper"
[scene]
pattern = {{ kind = "svg", file = {file}, unit = "viewbox", unit_m = 0.01, tolerance = 1e-5 }}
gravity = [0, 0, 0]
imperfection = 0
duration = 0.04
[[variant]]
name = "v"
method = "dense"
options = {{ triangles = 500 }}
"""
SKINNING = """title = "A skin"
topic = "skinning"
[scene]
character = {file}
weights = "{weights}"
{more}
motion = {{ joint = "{joint}", axis = "+x", from_deg = 0, to_deg = 1, frames = 2 }}
[[variant]]
name = "v"
method = "linear-blend"
"""
SKELETON = """[joint.first]
head = [0, 0, 0]
tail = [0, 1, 0]
[joint.second]
parent = "first"
head = [0, 1, 0]
tail = [0, 2, 0]
"""


class Refused(Exception):
    pass


class Run:
    """A run in a folder of its own: its first frame, its facts and what was said."""

    def __init__(self, folder, text):
        out = Path(folder) / "out"
        spec = Path(folder) / "spec.toml"
        spec.write_text(text)
        done = subprocess.run([PROGRAM, "run", spec, "--no-pictures", "--out", out], capture_output=True, text=True, timeout=600)
        said = (done.stdout + done.stderr).splitlines()
        if done.returncode == 2:
            raise Refused(next(line for line in said if line.startswith("error: "))[7:])
        if done.returncode != 0:
            raise RuntimeError(f"{spec}: exit code {done.returncode}\n" + "\n".join(said))
        self.warnings = [line[9:] for line in said if line.startswith("warning: ")]
        self.out = out

    def surface(self, name):
        return vtk_mesh(vtkXMLPolyDataReader(), self.out / f"frames/default/v/{name}_0000.vtp")


def program_mesh(folder, file):
    run = Run(folder, SKETCH.format(file=json.dumps(str(file))))
    return run.surface("surface"), run.warnings


def program_outline(folder, file):
    run = Run(folder, PAPER.format(file=json.dumps(str(file))))
    mesh = run.surface("surface")
    return {"area": mesh["area"] / 1e-4}, run.warnings


def program_skin(folder, file):
    """Of a skin its vertices; what has none gets two bones, and its shape before they turn."""

    def run(**parts):
        return Run(folder, SKINNING.format(file=json.dumps(str(file)), **parts))

    try:
        run(joint="?", weights="file-or-heat", more="")
    except Refused as refusal:
        if joint := re.search(r"no joint '\?' \(allowed: ([^,)]+)", str(refusal)):
            done = run(joint=joint[1], weights="file-or-heat", more="")
            with h5py.File(done.out / "run.h5") as record:
                return {"vertices": int(record["cases/default/facts"].attrs["vertices"])}, done.warnings
        if "no skin" not in str(refusal):
            raise
    (Path(folder) / "two.skeleton.toml").write_text(SKELETON)
    done = run(joint="second", weights="heat", more='skeleton = "two.skeleton.toml"')
    return done.surface("surface"), done.warnings


KINDS = {
    ".obj": (lambda f: vtk_mesh(vtkOBJReader(), f), program_mesh),
    ".ply": (lambda f: vtk_mesh(vtkPLYReader(), f), program_mesh),
    ".stl": (lambda f: vtk_mesh(vtkSTLReader(), f), program_mesh),
    ".off": (off_mesh, program_mesh),
    ".svg": (svg_shape, program_outline),
    ".gltf": (gltf_mesh, program_skin),
    ".glb": (gltf_mesh, program_skin),
}


# --- the files ---------------------------------------------------------------------------------------------------------


def files_of(package, pattern, every=1, largest=400_000):
    """Files of a Debian package, each `every`-th in the order of their names."""
    listed = subprocess.run(["dpkg", "-L", package], capture_output=True, text=True)
    if listed.returncode != 0:
        print(f"{package} is not installed: its files are left out", file=sys.stderr)
    names = sorted(n for n in listed.stdout.splitlines() if re.search(pattern, n, re.I) and Path(n).is_file())
    return [(package, Path(n)) for n in names if Path(n).stat().st_size <= largest][::every]


def archived(package, archive, folder, pattern, largest):
    if not Path(archive).exists():
        return []
    with tarfile.open(archive) as tar:
        members = [m for m in tar.getmembers() if m.isfile() and m.size <= largest and re.search(pattern, m.name)]
        tar.extractall(folder, members)
    return [(package, Path(folder) / m.name) for m in sorted(members, key=lambda m: m.name)]


def all_files(folder):
    return [
        *files_of("assimp-testmodels", r"\.(obj|ply|stl|off|glb|gltf)$"),
        *archived("libcgal-demo", "/usr/share/doc/libcgal-dev/data.tar.gz", folder, r"\.(off|ply|stl)$", 60_000),
        *files_of("adwaita-icon-theme", r"symbolic.*\.svg$", every=16),
        *files_of("libwacom-common", r"\.svg$", every=16),
        *files_of("python-matplotlib-data", r"\.svg$"),
        *files_of("nodejs", r"\.svg$"),
        *files_of("libtomlplusplus-dev", r"\.svg$"),
    ]


def text_of(values):
    return ", ".join(f"{key} {value:.6g}" for key, value in values.items())


def nearly(expected, got):
    return all(abs(got[key] - value) <= 2e-3 * abs(value) for key, value in expected.items())


def in_child(read, file):
    """What the other reader says: a file that ends its process is one that it does not take."""
    ours, theirs = multiprocessing.Pipe(False)

    def work():
        try:
            theirs.send(read(file))
        except (Unreadable, ArithmeticError, LookupError, SyntaxError, TypeError, ValueError) as error:
            theirs.send(str(error) or type(error).__name__)

    child = multiprocessing.Process(target=work)
    child.start()
    theirs.close()
    try:
        return ours.recv()
    except EOFError:
        return "the other reader crashes"
    finally:
        child.join()


def row_of(file, folder):
    """What was expected, what came, and whether a difference is said: `equal`, `said`, `refused`, `unknown` or `SILENT`."""
    ours, theirs = KINDS[file.suffix.lower()][1], KINDS[file.suffix.lower()][0]
    expected = in_child(theirs, file)
    try:
        got, warnings = ours(folder, file)
    except Refused as refusal:
        reason = str(refusal).replace(folder + "/", "")
        return expected, "refused: " + reason.split(file.name + ": ", 1)[-1].split(file.name, 1)[-1], "refused"
    said = f" ({'; '.join(w.split(file.name + ': ', 1)[-1] for w in warnings)})" if warnings else ""
    if isinstance(expected, str):
        return expected, text_of(got) + said, "unknown"
    verdict = "equal" if nearly(expected, got) else "said" if warnings else "SILENT"
    return text_of(expected), text_of(got) + said, verdict


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ").replace("<", "&lt;")[:240]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--write", action="store_true", help=f"writes {PAGE.name}")
    write = arguments.parse_args().write
    vtkObject.GlobalWarningDisplayOff()
    rows, verdicts = [], Counter()
    with tempfile.TemporaryDirectory() as place:
        for package, file in all_files(place):
            with tempfile.TemporaryDirectory() as folder:
                expected, got, verdict = row_of(file, folder)
            verdicts[verdict] += 1
            rows.append((package, file.name, expected if isinstance(expected, str) else text_of(expected), got, verdict))
            print(*rows[-1], sep=" | ", flush=True)
    print(dict(verdicts))
    if write:
        lines = [HEAD.format(files=len(rows), packages=len({r[0] for r in rows}), **{k: verdicts[k] for k in ("equal", "said", "refused", "unknown", "SILENT")})]
        lines += [f"| {r[0]} | `{r[1]}` | {cell(r[2])} | {cell(r[3])} | {r[4]} |" for r in rows]
        PAGE.write_text("\n".join(lines) + "\n")
    return 1 if verdicts["SILENT"] else 0


HEAD = """# Files of other programs

`python3 tests/packages/foreign_files.py --write` made this page: {files} files of {packages} Debian packages that nobody here made, put through the program
(`geoprior run`; meshes as `surface` of the sketch topic, outlines as `pattern` of a sheet, skins as `character`). *Expected* is what another reader says: VTK for OBJ, PLY and STL, a few
lines of Python for OFF, SVG and glTF, which know only a part of their format and say what they do not know. {equal} are read alike, {said} otherwise with a warning that names the
difference, {refused} are refused with the reason; of {unknown} the other reader knows no value; {SILENT} differ without a word.

| package | file | expected | got | |
|---|---|---|---|---|"""

if __name__ == "__main__":
    sys.exit(main())
