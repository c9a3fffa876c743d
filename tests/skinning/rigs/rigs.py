"""Rigs as they come from elsewhere, each with one trait that the program's own characters do not have."""
import dataclasses

import numpy as np

from glb import write_rig
from shapes import box, distances, open_edges, tubes, volume

SOFTNESS = 0.5  # width of the weights' transition, over the radius of the thinner bone


@dataclasses.dataclass
class Bone:
    """A joint at its head and what it carries; metres."""
    name: str
    parent: str | None
    head: np.ndarray
    tail: np.ndarray
    radii: tuple


@dataclasses.dataclass
class Part:
    """A mesh and its weights on all bones."""
    name: str
    vertices: np.ndarray
    triangles: np.ndarray
    weights: np.ndarray


@dataclasses.dataclass
class Clip:
    joint: str
    axis: tuple
    degrees: list
    times: list


@dataclasses.dataclass
class Rig:
    bones: list
    parts: list
    clip: Clip | None = None
    turn: tuple = (0, 0, 0, 1)  # quaternion x y z w of the node that holds all

    def write(self, path):
        write_rig(path, self)


def bone(name, parent, head, tail, thick, thin=None):
    return Bone(name, parent, np.array(head, dtype=float), np.array(tail, dtype=float), (thick, thin or thick))


def both_sides(bones):
    """Bones called …-left, and their mirror images across x."""
    result = []
    for one in bones:
        result.append(one)
        if not one.name.endswith("-left"):
            continue
        other = dataclasses.replace(one, name=one.name.replace("-left", "-right"), head=one.head * [-1, 1, 1],
                                    tail=one.tail * [-1, 1, 1])
        other.parent = one.parent.replace("-left", "-right")
        result.append(other)
    return result


def soft_weights(vertices, bones):
    """Of every bone by how near its tube is."""
    near = distances(vertices, bones)
    width = SOFTNESS * np.array([min(b.radii) for b in bones])
    weights = np.exp(-(near - near.min(axis=1, keepdims=True)) / width)
    weights[weights < 0.02] = 0
    return weights / weights.sum(axis=1, keepdims=True)


def skin(name, bones, cell, on=None):
    """The closed skin of bones, with weights on the bones of the whole rig."""
    vertices, triangles = tubes(bones, cell)
    assert not open_edges(triangles) and volume(vertices, triangles) > 0, f"the skin '{name}' is not closed"
    on = on or bones
    weights = np.zeros((len(vertices), len(on)))
    columns = [[b.name for b in on].index(b.name) for b in bones]
    weights[:, columns] = soft_weights(vertices, bones)
    return Part(name, vertices, triangles, weights)


def body_bones():
    """A body of 1.7 m, on +y, facing +z; the pelvis has three children."""
    return both_sides([
        bone("pelvis", None, (0, 0.95, 0), (0, 1.05, 0), 0.13),
        bone("spine", "pelvis", (0, 1.07, 0), (0, 1.22, 0.01), 0.12),
        bone("chest", "spine", (0, 1.24, 0.01), (0, 1.38, 0), 0.13, 0.11),
        bone("neck", "chest", (0, 1.45, 0), (0, 1.54, 0.01), 0.06),
        bone("head", "neck", (0, 1.56, 0.01), (0, 1.65, 0.02), 0.09),
        bone("shoulder-left", "chest", (0.18, 1.38, 0), (0.43, 1.22, 0), 0.065, 0.055),
        bone("elbow-left", "shoulder-left", (0.43, 1.22, 0), (0.63, 1.08, 0.03), 0.05, 0.042),
        bone("hand-left", "elbow-left", (0.63, 1.08, 0.03), (0.74, 0.99, 0.05), 0.045),
        bone("hip-left", "pelvis", (0.11, 0.9, 0), (0.12, 0.5, 0.015), 0.085, 0.07),
        bone("knee-left", "hip-left", (0.12, 0.5, 0.015), (0.12, 0.1, -0.02), 0.065, 0.055),
        bone("ankle-left", "knee-left", (0.12, 0.1, -0.02), (0.12, 0.05, 0.1), 0.05),
        bone("toe-left", "ankle-left", (0.12, 0.05, 0.1), (0.12, 0.05, 0.16), 0.048)])


def body(cell):
    bones = body_bones()
    return Rig(bones, [skin("body", bones, cell)])


def open_loop(cell):
    """A mouth: a loop of four open edges where two triangles are left out."""
    rig = body(cell)
    part = rig.parts[0]
    mouth = np.array([0, 1.58, 0.2])
    quads = part.vertices[part.triangles].reshape(-1, 6, 3).mean(axis=1)  # two triangles a quad
    nearest = int(np.argmin(np.linalg.norm(quads - mouth, axis=1)))
    part.triangles = np.delete(part.triangles, [2 * nearest, 2 * nearest + 1], axis=0)
    return rig


def centimetres(cell):
    """In centimetres, z up, under a node that turns z to y."""
    rig = body(cell)
    up = 100 * np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    for one in rig.bones:
        one.head, one.tail = up @ one.head, up @ one.tail
    rig.parts[0].vertices = rig.parts[0].vertices @ up.T
    rig.turn = (-np.sqrt(0.5), 0, 0, np.sqrt(0.5))
    return rig


def several_meshes(cell):
    """Body, helmet and shoes, each a closed mesh with a skin of its own on one skeleton."""
    bones = body_bones()
    named = {b.name: b for b in bones}
    rig = Rig(bones, [skin("body", bones, cell)])
    helmet = dataclasses.replace(named["head"], head=named["head"].head + [0, 0.06, 0], radii=(0.12, 0.11))
    rig.parts.append(skin("helmet", [helmet], cell, bones))
    for side in ("left", "right"):
        shoe = [dataclasses.replace(named[f"{joint}-{side}"], radii=(0.062, 0.062)) for joint in ("ankle", "toe")]
        rig.parts.append(skin(f"shoe-{side}", shoe, cell, bones))
    return rig


def robot_bones():
    """59 links with their widths and depths; pelvis, chest, hands and feet have three children or more."""
    return both_sides([
        bone("pelvis", None, (0, 0.95, 0), (0, 1.03, 0), 0.24, 0.16),
        bone("waist", "pelvis", (0, 1.05, 0), (0, 1.15, 0), 0.2, 0.14),
        bone("chest", "waist", (0, 1.17, 0), (0, 1.42, 0), 0.3, 0.18),
        bone("neck", "chest", (0, 1.44, 0), (0, 1.5, 0), 0.08, 0.08),
        bone("head", "neck", (0, 1.52, 0), (0, 1.7, 0), 0.16, 0.18),
        bone("jaw", "head", (0, 1.53, 0.11), (0, 1.53, 0.16), 0.1, 0.03),
        bone("pack", "chest", (0, 1.25, -0.11), (0, 1.25, -0.2), 0.2, 0.25),
        bone("lamp", "pack", (0, 1.4, -0.15), (0, 1.46, -0.15), 0.05, 0.05),
        bone("plate", "pelvis", (0, 0.9, 0.1), (0, 0.8, 0.11), 0.12, 0.03),
        bone("hip-left", "pelvis", (0.13, 0.94, 0), (0.13, 0.87, 0), 0.1, 0.1),
        bone("thigh-left", "hip-left", (0.13, 0.85, 0), (0.13, 0.55, 0), 0.12, 0.12),
        bone("knee-left", "thigh-left", (0.13, 0.53, 0), (0.13, 0.46, 0), 0.09, 0.09),
        bone("shin-left", "knee-left", (0.13, 0.44, 0), (0.13, 0.13, 0), 0.1, 0.1),
        bone("ankle-left", "shin-left", (0.13, 0.11, 0), (0.13, 0.08, 0), 0.07, 0.07),
        bone("foot-left", "ankle-left", (0.13, 0.05, -0.03), (0.13, 0.05, 0.12), 0.12, 0.06),
        *[bone(f"toe-{k}-left", "foot-left", (0.09 + 0.04 * k, 0.05, 0.14), (0.09 + 0.04 * k, 0.05, 0.2), 0.04, 0.03)
          for k in range(3)],
        bone("shoulder-left", "chest", (0.18, 1.36, 0), (0.25, 1.36, 0), 0.1, 0.1),
        bone("upper-left", "shoulder-left", (0.27, 1.36, 0), (0.5, 1.36, 0), 0.09, 0.09),
        bone("elbow-left", "upper-left", (0.52, 1.36, 0), (0.58, 1.36, 0), 0.07, 0.07),
        bone("fore-left", "elbow-left", (0.6, 1.36, 0), (0.8, 1.36, 0), 0.08, 0.08),
        bone("hand-left", "fore-left", (0.82, 1.36, 0), (0.9, 1.36, 0), 0.1, 0.03),
        *[bone(f"finger-{k}-{i}-left", "hand-left" if i == 0 else f"finger-{k}-{i - 1}-left",
               (0.92 + 0.04 * i, 1.36, 0.04 - 0.04 * k), (0.955 + 0.04 * i, 1.36, 0.04 - 0.04 * k), 0.03, 0.025)
          for k in range(3) for i in range(3)],
        bone("antenna-left", "head", (0.1, 1.66, 0), (0.14, 1.78, 0), 0.02, 0.02),
        bone("ear-left", "head", (0.09, 1.6, 0), (0.13, 1.6, 0), 0.03, 0.03)])


def robot(_):
    """59 boxes, each on a joint of its own."""
    plates = robot_bones()
    rig = Rig(plates, [])
    vertices, triangles, weights = [], [], []
    for i, plate in enumerate(plates):
        places, faces = box(plate.head, plate.tail, plate.radii[0], plate.radii[1], 2)
        triangles.append(faces + sum(len(v) for v in vertices))
        vertices.append(places)
        weights.append(np.tile(np.eye(len(plates))[i], (len(places), 1)))
    rig.parts.append(Part("robot", np.concatenate(vertices), np.concatenate(triangles), np.concatenate(weights)))
    return rig


def quadruped_bones():
    """A dog of 1.1 m, on +y, facing +z, whose legs are bent as such legs are."""
    return both_sides([
        bone("pelvis", None, (0, 0.62, -0.35), (0, 0.64, -0.2), 0.1),
        bone("spine", "pelvis", (0, 0.64, -0.18), (0, 0.63, 0.05), 0.1, 0.12),
        bone("chest", "spine", (0, 0.63, 0.08), (0, 0.64, 0.26), 0.13, 0.11),
        bone("neck", "chest", (0, 0.7, 0.32), (0, 0.86, 0.46), 0.07, 0.06),
        bone("head", "neck", (0, 0.88, 0.48), (0, 0.85, 0.66), 0.075, 0.05),
        bone("tail-1", "pelvis", (0, 0.64, -0.44), (0, 0.6, -0.58), 0.035, 0.03),
        bone("tail-2", "tail-1", (0, 0.6, -0.6), (0, 0.52, -0.72), 0.03, 0.025),
        bone("shoulder-left", "chest", (0.11, 0.58, 0.26), (0.12, 0.42, 0.17), 0.06, 0.05),
        bone("elbow-left", "shoulder-left", (0.12, 0.42, 0.17), (0.12, 0.2, 0.21), 0.045, 0.037),
        bone("carpus-left", "elbow-left", (0.12, 0.2, 0.21), (0.12, 0.06, 0.22), 0.035),
        bone("paw-left", "carpus-left", (0.12, 0.06, 0.22), (0.12, 0.04, 0.3), 0.038),
        bone("hip-left", "pelvis", (0.1, 0.57, -0.34), (0.12, 0.4, -0.26), 0.08, 0.06),
        bone("stifle-left", "hip-left", (0.12, 0.4, -0.26), (0.12, 0.22, -0.42), 0.05, 0.038),
        bone("hock-left", "stifle-left", (0.12, 0.22, -0.42), (0.12, 0.06, -0.38), 0.034),
        bone("claw-left", "hock-left", (0.12, 0.06, -0.38), (0.12, 0.04, -0.3), 0.038)])


def quadruped(cell):
    bones = quadruped_bones()
    return Rig(bones, [skin("dog", bones, cell)])


def bent_clip(cell):
    """A clip whose first pose is bent by 50 degrees, and that goes on to 110."""
    rig = body(cell)
    rig.clip = Clip("elbow-left", (0.57, 0.82, 0), [50, 80, 110], [0, 0.5, 1])
    return rig


def hand_bones():
    """A right hand of 20 cm, fingers down, palm forward, slightly closed."""
    bones = [bone("wrist", None, (0, 0.2, 0), (0, 0.14, 0), 0.024, 0.026)]
    for k, (name, length) in enumerate((("index", 0.085), ("middle", 0.095), ("ring", 0.088), ("pinky", 0.07))):
        x, y = -0.036 + 0.024 * k, 0.115 - 0.006 * abs(k - 1)
        bones.append(bone(f"{name}-0", "wrist", (0.7 * x, 0.16, 0), (x, y, 0), 0.014, 0.011))
        place, above = np.array([x, y, 0]), f"{name}-0"
        for i, (share, angle) in enumerate(((0.45, 6), (0.3, 14), (0.25, 22))):
            end = place + share * length * np.array([0, -np.cos(np.radians(angle)), np.sin(np.radians(angle))])
            bones.append(bone(f"{name}-{i + 1}", above, place, end, 0.0095, 0.0085))
            place, above = end, f"{name}-{i + 1}"
    bones.append(bone("thumb-0", "wrist", (-0.025, 0.165, 0.008), (-0.052, 0.14, 0.02), 0.013, 0.012))
    bones.append(bone("thumb-1", "thumb-0", (-0.052, 0.14, 0.02), (-0.07, 0.112, 0.028), 0.011, 0.01))
    bones.append(bone("thumb-2", "thumb-1", (-0.07, 0.112, 0.028), (-0.08, 0.09, 0.034), 0.01, 0.009))
    return bones


def hand(cell):
    bones = hand_bones()
    return Rig(bones, [skin("hand", bones, 0.12 * cell)])


def flat(cell):
    """All joints are siblings."""
    rig = body(cell)
    for one in rig.bones:
        one.parent = None
    return rig


def stand_in(bones):
    """A triangle at each joint: enough for a skeleton."""
    corners = np.concatenate([b.head + 0.01 * np.eye(3) for b in bones])
    weights = np.repeat(np.eye(len(bones)), 3, axis=0)
    return Rig(bones, [Part("stand-in", corners, np.arange(len(corners)).reshape(-1, 3), weights)])


ALL = {"open-loop": open_loop, "centimetres": centimetres, "several-meshes": several_meshes, "robot": robot,
       "quadruped": quadruped, "bent-clip": bent_clip, "hand": hand, "flat": flat}
