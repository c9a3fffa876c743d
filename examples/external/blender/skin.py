"""Poses the character of a skinning scene in Blender: one PLY of vertices a frame.

    blender -b --factory-startup --python-exit-code 1 -P skin.py -- SKIN [FOLDER]

SKIN is what deforms the mesh:

    linear             armature modifier: linear blend
    dual-quaternion    armature modifier, "preserve volume": dual quaternions
    corrective-smooth  linear blend, then the corrective smooth modifier, Blender's delta mush

It runs in the working folder of an external command, where scene.json is, writes
out/frame_0000.ply …, and the same into FOLDER where one is given. make.sh calls it.

The axes stay as they are: Blender only calls the second one by another name. Vertices keep their
order. Numbers are single precision, as Blender has no other.
"""
import json
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

# The passes of the delta mush beside it: x += 0.5 (mean of the neighbours - x), twenty times.
SMOOTHING_PASSES, SMOOTHING_STEP = 20, 0.5


def load(scene: dict, part: str, array: str | None = None) -> np.ndarray:
    description = scene["parts"][part]
    return np.load(description["arrays"][array]["file"] if array else description["points"])


def make_mesh(scene: dict, joints: list[str]) -> bpy.types.Object:
    mesh = bpy.data.meshes.new("surface")
    triangles = np.load(scene["parts"]["surface"]["triangles"])
    mesh.from_pydata(load(scene, "surface").tolist(), [], triangles.tolist())
    surface = bpy.data.objects.new("surface", mesh)
    bpy.context.collection.objects.link(surface)
    weights = load(scene, "surface", "weights")
    for joint, name in enumerate(joints):
        group = surface.vertex_groups.new(name=name)
        for vertex in np.flatnonzero(weights[:, joint]):
            group.add([int(vertex)], weights[vertex, joint], "REPLACE")
    return surface


def make_armature(scene: dict, joints: list[str]) -> bpy.types.Object:
    """Bones without parents: each takes the whole transform of its joint."""
    armature = bpy.data.objects.new("armature", bpy.data.armatures.new("armature"))
    bpy.context.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    ends = load(scene, "bones").reshape(-1, 2, 3)
    for name, (head, tail) in zip(joints, ends):
        bone = armature.data.edit_bones.new(name)
        # Blender drops bones without length; skinning does not ask where a bone ends.
        long_enough = np.linalg.norm(tail - head) > 1e-3
        bone.head, bone.tail = head, tail if long_enough else head + (0, 0.01, 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def add_modifiers(surface: bpy.types.Object, armature: bpy.types.Object, skin: str) -> None:
    modifier = surface.modifiers.new("skin", "ARMATURE")
    modifier.object = armature
    modifier.use_deform_preserve_volume = skin == "dual-quaternion"
    if skin == "corrective-smooth":
        smooth = surface.modifiers.new("smooth", "CORRECTIVE_SMOOTH")
        smooth.iterations, smooth.factor = SMOOTHING_PASSES, SMOOTHING_STEP
        smooth.smooth_type = "SIMPLE"


def pose(armature: bpy.types.Object, joints: list[str], transforms: np.ndarray) -> None:
    for name, matrix in zip(joints, transforms):
        bone = armature.pose.bones[name]
        bone.rotation_mode = "QUATERNION"
        rest = bone.bone.matrix_local
        world = Matrix([*matrix.tolist(), (0, 0, 0, 1)])
        bone.matrix_basis = rest.inverted() @ world @ rest


def posed_vertices(surface: bpy.types.Object) -> np.ndarray:
    evaluated = surface.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = np.empty(3 * len(evaluated.data.vertices), dtype=np.float32)
    evaluated.data.vertices.foreach_get("co", points)
    return points.reshape(-1, 3)


def write_points(file: Path, points: np.ndarray) -> None:
    """A PLY of vertices; without faces the frame has those of the scene."""
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property float {axis}" for axis in "xyz"] + ["end_header", ""]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes("\n".join(header).encode() + points.astype("<f4").tobytes())


def main() -> None:
    skin, *folders = sys.argv[sys.argv.index("--") + 1 :]
    if skin not in ("linear", "dual-quaternion", "corrective-smooth"):
        raise SystemExit(f"skin.py: '{skin}' is no skin")
    scene = json.loads(Path("scene.json").read_text())
    joints = scene["parts"]["bones"]["arrays"]["joint"]["names"]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    surface, armature = make_mesh(scene, joints), make_armature(scene, joints)
    add_modifiers(surface, armature, skin)

    transforms = np.load(scene["tables"]["transforms"]["rows"])
    for frame, _ in enumerate(scene["parameter"]["values"]):
        of_frame = transforms[transforms[:, 0] == frame]
        pose(armature, joints, of_frame[:, 2:].reshape(-1, 3, 4))
        for folder in ["out", *folders]:
            write_points(Path(folder) / f"frame_{frame:04d}.ply", posed_vertices(surface))


main()
