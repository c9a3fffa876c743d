"""Simulates the tank of a fluid scene with Blender's liquid (Mantaflow): one PLY of the surface a frame.

    blender -b --factory-startup --python-exit-code 1 -P dam.py -- [FOLDER]

It runs in the working folder of an external command, where scene.json is, writes frames.csv and
surface_0000.ply … into out, and the same into FOLDER where one is given. make.sh calls it.

A tank is a box with boxes of water in it, closed on all sides. Mantaflow's walls take the outer
layer of its cells; the domain is larger by these, so that cells and walls are those of the tank.

In Blender's first frame the water moves as after half a frame already, however many time steps it
is asked for. A frame of the scene is therefore many of Blender's, which makes that lead small.
"""
import json
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

STEPS = 16  # frames of Blender a frame of the scene
TRIANGLES = 6000  # of a surface, so that files stay small


def make_box(name: str, low: np.ndarray, high: np.ndarray) -> bpy.types.Object:
    bpy.ops.mesh.primitive_cube_add(size=1, location=(low + high) / 2)
    box = bpy.context.object
    box.name, box.dimensions = name, high - low
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    return box


def add_fluid(box: bpy.types.Object, kind: str) -> bpy.types.FluidModifier:
    modifier = box.modifiers.new("fluid", "FLUID")
    modifier.fluid_type = kind
    return modifier


def make_water(volume: dict) -> None:
    shape = volume["shape"]
    if shape["kind"] != "box" or any(volume["velocity"]):
        raise SystemExit("dam.py: water is boxes at rest here")
    centre, half = np.array(shape["centre"]), np.array(shape["size"]) / 2
    flow = add_fluid(make_box(volume["name"], centre - half, centre + half), "FLOW").flow_settings
    flow.flow_type, flow.flow_behavior = "LIQUID", "GEOMETRY"


def make_domain(tank: dict, frames: int, cache: str) -> bpy.types.Object:
    low, size, cell = np.array(tank["origin"]), np.array(tank["size"]), tank["cell"]
    domain = make_box("domain", low - cell, low + size + cell)
    settings = add_fluid(domain, "DOMAIN").domain_settings
    settings.domain_type = "LIQUID"
    settings.resolution_max = round(float(size.max()) / cell) + 2
    settings.use_mesh = True
    settings.mesh_scale, settings.mesh_particle_radius = 2, 1  # the tightest surface
    settings.cache_directory, settings.cache_type = cache, "ALL"
    settings.cache_frame_start, settings.cache_frame_end = 1, frames
    return domain


def simulate(scene: dict, frames: int, cache: str) -> bpy.types.Object:
    """The domain, whose mesh is the surface at each frame of Blender, from 1 on."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    options = scene["scene"]
    world = bpy.context.scene
    world.gravity = options["gravity"]
    world.render.fps, world.render.fps_base = STEPS, options["frame_interval"]
    for volume in options["tank"]["volumes"]:
        make_water(volume)
    domain = make_domain(options["tank"], STEPS * (frames - 1) + 1, cache)
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()
    domain.modifiers.new("fewer", "DECIMATE")
    return domain


def surface_at(domain: bpy.types.Object, frame: int) -> tuple[np.ndarray, np.ndarray]:
    domain.modifiers["fewer"].ratio = 1
    bpy.context.scene.frame_set(1 + STEPS * frame)
    whole = domain.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    whole.calc_loop_triangles()
    domain.modifiers["fewer"].ratio = min(1, TRIANGLES / len(whole.loop_triangles))
    evaluated = domain.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.data
    mesh.calc_loop_triangles()
    points = np.array([evaluated.matrix_world @ v.co for v in mesh.vertices])
    triangles = np.array([t.vertices for t in mesh.loop_triangles], dtype=np.int32)
    return points, triangles


def write_surface(file: Path, points: np.ndarray, triangles: np.ndarray) -> None:
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property float {axis}" for axis in "xyz"]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices"]
    header += ["end_header", ""]
    faces = np.empty(len(triangles), dtype=[("corners", "u1"), ("vertices", "<i4", 3)])
    faces["corners"], faces["vertices"] = 3, triangles
    file.write_bytes("\n".join(header).encode() + points.astype("<f4").tobytes() + faces.tobytes())


def main() -> None:
    folders = [Path(folder) for folder in ["out", *sys.argv[sys.argv.index("--") + 1 :]]]
    scene = json.loads(Path("scene.json").read_text())
    frames = int(scene["facts"]["frames"])
    interval = scene["scene"]["frame_interval"]
    with tempfile.TemporaryDirectory() as cache:
        domain = simulate(scene, frames, cache)
        surfaces = [surface_at(domain, frame) for frame in range(frames)]
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
        rows = [f"{frame},{frame * interval:.6g}\n" for frame in range(frames)]
        (folder / "frames.csv").write_text("frame,parameter\n" + "".join(rows))
        for frame, surface in enumerate(surfaces):
            write_surface(folder / f"surface_{frame:04d}.ply", *surface)


main()
