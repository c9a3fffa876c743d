#!/usr/bin/env python3
"""Closes the skin of a character in a .glb whose parts almost meet: close_seams.py <in.glb> <out.glb> <distance>.

Boundary vertices of different parts that are nearer to each other than the distance take one position; a border
loop that is left (an eye, a mouth) is closed by a strip of triangles between its own vertices. Positions move in
place, triangles are appended, weights and everything else stay as they are.
"""
import collections
import json
import struct
import sys

FLOAT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5123, 5125
INDEX_FORMAT = {5121: "B", UNSIGNED_SHORT: "H", UNSIGNED_INT: "I"}


class Glb:
    """The JSON and the one binary chunk of a .glb."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        magic, version, _ = struct.unpack_from("<4sII", data)
        if magic != b"glTF" or version != 2:
            raise SystemExit(f"{path}: no glTF 2.0 binary")
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20 : 20 + length])
        self.binary = bytearray(data[20 + length + 8 :])

    def place(self, accessor):
        """First byte, stride and count of an accessor's elements."""
        a = self.json["accessors"][accessor]
        view = self.json["bufferViews"][a["bufferView"]]
        size = 12 if a["type"] == "VEC3" else struct.calcsize(INDEX_FORMAT[a["componentType"]])
        first = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        return first, view.get("byteStride", size), a["count"]

    def positions(self, accessor):
        first, stride, count = self.place(accessor)
        return [struct.unpack_from("<3f", self.binary, first + stride * i) for i in range(count)]

    def set_position(self, accessor, i, position):
        first, stride, _ = self.place(accessor)
        struct.pack_into("<3f", self.binary, first + stride * i, *position)

    def indices(self, accessor):
        first, stride, count = self.place(accessor)
        kind = "<" + INDEX_FORMAT[self.json["accessors"][accessor]["componentType"]]
        return [struct.unpack_from(kind, self.binary, first + stride * i)[0] for i in range(count)]

    def add_indices(self, indices):
        """A new accessor of 32-bit indices."""
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": 4 * len(indices), "target": 34963}
        self.binary += struct.pack(f"<{len(indices)}I", *indices)
        self.json["bufferViews"].append(view)
        self.json["accessors"].append({"bufferView": len(self.json["bufferViews"]) - 1, "componentType": UNSIGNED_INT,
                                       "count": len(indices), "type": "SCALAR"})
        return len(self.json["accessors"]) - 1

    def write(self, path):
        self.binary += bytes(-len(self.binary) % 4)
        self.json["buffers"][0]["byteLength"] = len(self.binary)
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)


class Skin:
    """The triangles of all parts on vertices that are one where their positions are."""

    def __init__(self, glb):
        self.glb = glb
        self.primitives = [p for mesh in glb.json["meshes"] for p in mesh["primitives"]]
        self.places = collections.defaultdict(list)  # position -> [(primitive, vertex)]
        self.triangles = []  # positions of the corners
        for number, primitive in enumerate(self.primitives):
            points = glb.positions(primitive["attributes"]["POSITION"])
            for i, point in enumerate(points):
                self.places[point].append((number, i))
            corners = [points[i] for i in glb.indices(primitive["indices"])]
            self.triangles += [corners[k : k + 3] for k in range(0, len(corners), 3)]

    def border(self):
        """Directed edges of triangles without a neighbour: start -> end."""
        edges = collections.Counter()
        for triangle in self.triangles:
            if len(set(triangle)) == 3:
                edges.update((triangle[k], triangle[(k + 1) % 3]) for k in range(3))
        return [edge for edge in edges if edge[::-1] not in edges]

    def move(self, point, target):
        for number, i in self.places[point]:
            self.glb.set_position(self.primitives[number]["attributes"]["POSITION"], i, target)

    def append(self, primitive, triangles):
        p = self.primitives[primitive]
        p["indices"] = self.glb.add_indices(self.glb.indices(p["indices"]) + [i for t in triangles for i in t])


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def snap(skin, reach):
    """Boundary vertices within reach of an earlier one take its position."""
    kept, moved = [], 0
    for point in dict.fromkeys(start for start, _ in skin.border()):
        near = [other for other in kept if distance(other, point) < reach]
        if near:
            skin.move(point, min(near, key=lambda other: distance(other, point)))
            moved += 1
        else:
            kept.append(point)
    return moved


def loops(edges):
    """Closed chains of border edges."""
    following = dict(edges)
    if len(following) != len(edges):
        raise SystemExit("border loops touch: a longer distance joins the parts")
    result = []
    while following:
        loop = [next(iter(following))]
        while following[loop[-1]] in following and following[loop[-1]] != loop[0]:
            loop.append(following[loop[-1]])
        for point in loop:
            del following[point]
        result.append(loop)
    return result


def strip(count):
    """Triangles of a polygon's corners 0 … count - 1 in order, to and fro between both sides."""
    low, high, triangles = 0, count - 1, []
    while high - low > 1:
        triangles.append((low, low + 1, high))
        low += 1
        if high - low > 1:
            triangles.append((low, high - 1, high))
            high -= 1
    return triangles


def fill(skin, loop):
    common = set.intersection(*({number for number, _ in skin.places[point]} for point in loop))
    if not common:
        raise SystemExit(f"a border of {len(loop)} vertices runs over several parts: a longer distance joins them")
    part = min(common)
    vertex = [next(i for number, i in skin.places[point] if number == part) for point in reversed(loop)]
    skin.append(part, [tuple(vertex[k] for k in triangle) for triangle in strip(len(vertex))])


def main(source, target, reach):
    glb = Glb(source)
    moved = snap(Skin(glb), float(reach))
    skin = Skin(glb)
    borders = loops(skin.border())
    for loop in borders:
        fill(skin, loop)
    left = len(Skin(glb).border())
    if left:
        raise SystemExit(f"{source}: {left} border edges are left")
    glb.write(target)
    print(f"close_seams: {moved} vertices of seams joined, {len(borders)} holes filled")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        raise SystemExit(__doc__.splitlines()[0])
    main(*sys.argv[1:])
