"""Writes a rig as a binary glTF 2.0, with numpy alone."""
import json
import struct

import numpy as np

FLOAT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5123, 5125
TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Document:
    """The JSON and the one binary chunk of a file."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [], "bufferViews": [],
                     "accessors": [], "meshes": [], "skins": []}
        self.binary = bytearray()

    def accessor(self, values, component):
        kind = {FLOAT: "<f4", UNSIGNED_SHORT: "<u2", UNSIGNED_INT: "<u4"}[component]
        rows = np.ascontiguousarray(values, dtype=kind)
        rows = rows.reshape(len(rows), -1)
        self.binary += bytes(-len(self.binary) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": rows.nbytes})
        self.binary += rows.tobytes()
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component, "count": len(rows),
                    "type": TYPES[rows.shape[1]]}
        if component == FLOAT:
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def node(self, **values):
        self.json["nodes"].append(values)
        return len(self.json["nodes"]) - 1

    def write(self, path):
        self.binary += bytes(-len(self.binary) % 4)
        document = {key: value for key, value in self.json.items() if value != []}
        document["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)


def write_rig(path, rig):
    """Joints stand along the axes of the mesh; the first node holds all of them and turns as the rig says."""
    out = Document()
    out.node(name="Armature", children=[], rotation=list(rig.turn))
    first = len(out.json["nodes"])
    number = {bone.name: first + i for i, bone in enumerate(rig.bones)}
    heads = {bone.name: bone.head for bone in rig.bones}
    for bone in rig.bones:
        above = np.zeros(3) if bone.parent is None else heads[bone.parent]
        out.node(name=bone.name, translation=(bone.head - above).tolist())
        parent = out.json["nodes"][0 if bone.parent is None else number[bone.parent]]
        parent.setdefault("children", []).append(number[bone.name])
    for part in rig.parts:
        add_part(out, part, rig.bones, number)
    if rig.clip:
        add_clip(out, rig.clip, number)
    out.write(path)


def add_part(out, part, bones, number):
    """A mesh with a skin of its own, on the same joints."""
    bind = np.tile(np.eye(4), (len(bones), 1, 1))
    for matrix, bone in zip(bind, bones):
        matrix[3, :3] = -bone.head  # columns of the matrix one after the other
    out.json["skins"].append({"joints": [number[bone.name] for bone in bones],
                              "inverseBindMatrices": out.accessor(bind.reshape(-1, 16), FLOAT)})
    order = np.argsort(-part.weights, axis=1)[:, :4]
    order = np.pad(order, ((0, 0), (0, 4 - order.shape[1])))
    weights = np.take_along_axis(part.weights, order, axis=1)
    weights[:, part.weights.shape[1]:] = 0
    weights /= weights.sum(axis=1, keepdims=True)
    out.json["meshes"].append({"name": part.name, "primitives": [{
        "attributes": {"POSITION": out.accessor(part.vertices, FLOAT), "JOINTS_0": out.accessor(order, UNSIGNED_SHORT),
                       "WEIGHTS_0": out.accessor(weights, FLOAT)},
        "indices": out.accessor(part.triangles.reshape(-1, 1), UNSIGNED_INT)}]})
    last = len(out.json["skins"]) - 1
    out.json["nodes"][0]["children"].append(out.node(name=part.name, mesh=last, skin=last))


def add_clip(out, clip, number):
    """A turn of one joint about an axis, by degrees at times in seconds."""
    half = np.radians(np.array(clip.degrees)) / 2
    turns = np.concatenate([np.sin(half)[:, None] * np.array(clip.axis), np.cos(half)[:, None]], axis=1)
    times = out.accessor(np.array(clip.times)[:, None], FLOAT)
    out.json["animations"] = [{"name": "clip", "channels": [
        {"sampler": 0, "target": {"node": number[clip.joint], "path": "rotation"}}],
        "samplers": [{"input": times, "output": out.accessor(turns, FLOAT), "interpolation": "LINEAR"}]}]
