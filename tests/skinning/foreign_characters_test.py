"""Characters that come from elsewhere, through the program without an edit: geoprior rig, a motion, every method.

    foreign_characters_test.py PROGRAM

The rigs of tests/skinning/rigs are written by a script, each with one trait; two are those of installed packages. With
GEOPRIOR_LONG skins are finer, and six rigs are measured: their table is printed."""
import importlib.util
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
HOME = HERE.parents[1]
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE / "rigs"))
import rigs  # noqa: E402

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
AT_LENGTH = "GEOPRIOR_LONG" in os.environ
CELL = 0.025 if AT_LENGTH else 0.045  # m, of the skins

METHODS = ["linear-blend", "dual-quaternion", "centers-of-rotation", "delta-mush", "direct-delta-mush"]
COARSE = "grid = 16, sampling = { samples = 40 }"

# What a rig moves: a joint about its guessed flexion, or a clip of its own.
MOTIONS = {
    "open-loop": ("knee-left", 90), "centimetres": ("elbow-left", 90), "several-meshes": ("ankle-left", 25),
    "robot": ("knee-left", 80), "quadruped": ("stifle-left", 40), "bent-clip": None, "hand": ("index-2", 70),
    "flat": ("elbow-left", 60), "bcn_epileptic.glb": None, "animation_with_skeleton.glb": None}


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)


def experiment(scene, variants, more=""):
    text = f'title = "A foreign character"\ntopic = "skinning"\n{more}[scene]\n{scene}'
    for name, method, options in variants:
        text += f'[[variant]]\nname = "{name}"\nmethod = "{method}"\noptions = {{ {options} }}\n'
    return text


def moved(motion, frames):
    """A [scene] motion: the clip of the file, or a joint and the angle that it bends to."""
    if motion is None:
        return f'{{ kind = "clip", frames = {frames} }}'
    return f'{{ joint = "{motion[0]}", axis = "flexion", to_deg = {motion[1]}, frames = {frames} }}'


class Foreign(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, rig):
        file = self.folder / f"{name}.glb"
        rig.write(file)
        return file

    def character(self, name):
        """The file of a rig, or the name of an installed one."""
        return name if name.endswith(".glb") else self.write(name, rigs.ALL[name](CELL))

    def rig(self, file):
        """Skeleton file and warnings of `geoprior rig`."""
        done = program("rig", file)
        self.assertEqual(done.returncode, 0, done.stderr)
        skeleton = self.folder / f"{pathlib.Path(file).stem}.skeleton.toml"
        skeleton.write_text(done.stdout)
        return skeleton, done.stderr

    def run_experiment(self, text):
        """The cases of a run, and what the program said."""
        file, out = self.folder / "mine.toml", tempfile.mkdtemp(dir=self.folder)
        file.write_text(text)
        done = program("run", file, "--out", out, "--no-pictures", "--json", "--threads", 1)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return json.loads(done.stdout)["cases"], done.stderr


class ForeignCharacters(Foreign):
    def test_run_with_every_method(self):
        for name, motion in MOTIONS.items():
            with self.subTest(character=name):
                self.run_character(name, motion)

    def run_character(self, name, motion):
        file = self.character(name)
        skeleton, _ = self.rig(file)
        variants = [(method, method, "") for method in METHODS]
        variants.append(("implicit", "implicit", f'projection = "smooth", {COARSE}'))
        if motion is None:
            variants.append(("tracking", "implicit", f'projection = "tracking", {COARSE}'))
        scene = f'character = "{file}"\nskeleton = "{skeleton}"\nmotion = {moved(motion, 2)}\n'
        cases, said = self.run_experiment(experiment(scene, variants))
        came = {variant["name"]: variant for variant in cases[0]["variants"]}
        self.assertEqual(set(came), {variant[0] for variant in variants})
        for variant, result in came.items():
            self.assertEqual((result["status"], result["frames"]), ("done", 2), f"{variant}: {said}")
            self.assertIn("roughness_p95.max", result["summary"], variant)


    def test_a_clip_in_centimetres_is_the_same_motion(self):
        came = []
        for unit in (1, 100):
            rig = rigs.bent_clip(CELL)
            for bone in rig.bones:
                bone.head, bone.tail = unit * bone.head, unit * bone.tail
            rig.parts[0].vertices *= unit
            file = self.write("bent", rig)
            scene = f'character = "{file}"\nskeleton = "{self.rig(file)[0]}"\nmotion = {moved(None, 2)}\n'
            cases, _ = self.run_experiment(experiment(scene, [("linear-blend", "linear-blend", "")]))
            came.append(cases[0]["variants"][0]["summary"])
        for metric in ("roughness_p95.max", "lumps_max.max", "volume_change_global.min"):
            self.assertAlmostEqual(came[1][metric]["value"] / came[0][metric]["value"], 1, delta=1e-3, msg=metric)


class ForeignSkeletons(Foreign):
    def joints(self, file):
        skeleton, said = self.rig(file)
        return tomllib.loads(skeleton.read_text())["joint"], skeleton.read_text(), said

    def test_centimetres_are_noticed_and_said(self):
        metres, _, silent = self.joints(self.write("metres", rigs.body(CELL)))
        joints, _, said = self.joints(self.write("centimetres", rigs.centimetres(CELL)))
        self.assertNotIn("unit_m", silent)
        self.assertRegex(said, "measures 17. m .* taken in centimetres, for 1.7. m; unit_m = 0.01")
        for name, joint in metres.items():
            np.testing.assert_allclose(joints[name]["head"], joint["head"], atol=1e-5)

    def test_axes_of_a_body_turn_with_it(self):
        # About x, y and z: it faces -z and the side, lies on its back, its face and its side, stands upside down.
        for turn in ((0, 1, 0, 0), (0, 0.5**0.5, 0, 0.5**0.5), (-(0.5**0.5), 0, 0, 0.5**0.5), (0.5**0.5, 0, 0, 0.5**0.5),
                     (0, 0, 0.5**0.5, 0.5**0.5), (1, 0, 0, 0)):
            rig = rigs.body(CELL)
            rig.turn = turn
            joints, text, said = self.joints(self.write("turned", rig))
            self.assertNotIn("doubtful:", text)
            self.assertNotIn("doubtful", said)
            is_upright = turn[0] == turn[2] == 0
            self.assertEqual("by its limbs the body stands along" in said, not is_upright, said)
            side = turned(turn, X)
            for name, sign in (("spine", 1), ("knee-left", 1), ("hip-right", -1), ("ankle-left", -1)):
                self.assertGreater(sign * np.dot(joints[name]["axes"]["flexion"], side), 0.95, f"{name}, {turn}")

    def test_without_feet_the_front_is_doubtful(self):
        rig = rigs.body(CELL)
        rig.bones = [bone for bone in rig.bones if not bone.name.startswith("toe")]
        rig.parts = [rigs.skin("body", rig.bones, CELL)]
        _, text, said = self.joints(self.write("no-feet", rig))
        self.assertRegex(said, r"flexion of \d+ of 17 joints is doubtful.*no feet show where the front is")
        self.assertRegex(text, r"# flexion: doubtful: no feet show where the front is; in the plane of symmetry")

    def test_only_hands_have_knuckles(self):
        _, text, _ = self.joints(self.character("robot"))
        self.assertEqual(text.count("[joint."), 59)
        for block in text.split("\n[joint.")[1:]:
            name = block.split("]")[0]
            self.assertEqual("knuckles" in block, name.split("-")[0] in ("hand", "finger", "toe"), block)

    def test_joints_that_are_siblings_are_doubtful_one_and_all(self):
        _, text, said = self.joints(self.character("flat"))
        self.assertIn("flexion of 19 of 19 joints is doubtful", said)
        self.assertEqual(text.count("# flexion: doubtful: no joint hangs on another but the root"), 19)


X = np.array([1.0, 0, 0])
TRUNK_AND_LEGS = {"spine": X, "neck": X, "hip-left": -X, "hip-right": -X, "knee-left": X, "knee-right": X, "ankle-left": -X}
DOG = {"spine": X, "head": X, "hip-left": -X, "stifle-left": X, "hock-right": -X, "elbow-left": -X, "carpus-right": X}
HAND = {"wrist": -X, "ring-0": -X, "middle-1": -X, "index-2": -X, "pinky-3": -X}
ROBOT = {"waist": X, "hip-left": -X, "thigh-right": -X, "knee-left": X, "shin-right": X, "ankle-left": -X, "foot-right": -X,
         "elbow-left": np.array([0, -1, 0]), "hand-left": np.array([0, 0, -1]), "finger-1-1-right": np.array([0, 0, 1])}


def held(arms):
    """The body with its arms stretched out along a direction (of the left one)."""
    bones = {bone.name: bone for bone in rigs.body_bones()}
    for side, sign in (("left", 1), ("right", -1)):
        place = np.array([0.18 * sign, 1.38, 0])
        for joint, length in (("shoulder", 0.3), ("elbow", 0.25), ("hand", 0.1)):
            bones[f"{joint}-{side}"].head = place
            place = place + length * np.array(arms) * [sign, 1, 1]
    return list(bones.values())


def left_out(names, bones):
    return [bone for bone in bones if bone.name.split("-")[0] not in names]


def moved_joints(places, bones):
    """Joints of the left side put elsewhere, those of the right to their mirror images."""
    for bone in bones:
        joint, _, side = bone.name.rpartition("-")
        if joint in places:
            bone.head = np.array(places[joint]) * [1 if side == "left" else -1, 1, 1]
    return bones


def dog(with_claws, straight):
    bones = rigs.quadruped_bones()
    if with_claws:
        for paw, z in (("paw", 0.34), ("claw", -0.25)):
            bones += rigs.both_sides([rigs.bone(f"{paw}-end-left", f"{paw}-left", (0.12, 0.03, z), (0.12, 0.03, z), 0.03)])
    if straight:
        for bone in bones:
            joint = bone.name.split("-")[0]
            bone.head[2] = {"stifle": -0.35, "hock": -0.35, "elbow": 0.25, "carpus": 0.25}.get(joint, bone.head[2])
    return bones


# Skeletons whose front is +z, and what is known of their flexion.
KNOWN = {
    "arms aside": (held((1, 0, 0)), TRUNK_AND_LEGS | {"elbow-left": [0, -1, 0], "elbow-right": [0, 1, 0]}),
    "arms down": (held((0.05, -1, 0)), TRUNK_AND_LEGS | {"elbow-left": -X, "elbow-right": -X}),
    "arms forward": (held((0, 0, 1)), TRUNK_AND_LEGS | {"elbow-left": -X, "elbow-right": -X}),
    "arms up": (held((0.2, 1, 0)), TRUNK_AND_LEGS | {"elbow-left": X, "elbow-right": X}),
    "no feet": (left_out({"toe"}, rigs.body_bones()), TRUNK_AND_LEGS),
    "bust": (left_out({"hip", "knee", "ankle", "toe"}, held((1, 0, 0))), {"spine": X, "neck": X, "elbow-left": [0, -1, 0]}),
    "seated": (moved_joints({"knee": (0.12, 0.9, 0.42), "ankle": (0.12, 0.5, 0.4), "toe": (0.12, 0.45, 0.52)},
                            rigs.body_bones()), TRUNK_AND_LEGS),
    "one leg": ([b for b in rigs.body_bones() if b.name not in ("hip-right", "knee-right", "ankle-right", "toe-right")],
                TRUNK_AND_LEGS),
    "dog": (dog(True, False), DOG), "dog without claws": (dog(False, False), DOG),
    "dog with straight legs": (dog(True, True), DOG), "hand": (rigs.hand_bones(), HAND), "robot": (rigs.robot_bones(), ROBOT)}
SHOWS_LITTLE = {"no feet", "bust", "dog with straight legs"}  # where most of what is known has to be doubted
# +z and -z to the front, on its back, on its face, upside down, and y, z, x where x, y, z were.
TURNS = ((0, 0, 0, 1), (0, 1, 0, 0), (-(0.5**0.5), 0, 0, 0.5**0.5), (0.5**0.5, 0, 0, 0.5**0.5), (0, 0, 1, 0),
         (0.5, 0.5, 0.5, 0.5))


def turned(turn, x):
    """By a quaternion x y z w."""
    axis = np.array(turn[:3])
    return (turn[3] ** 2 - axis @ axis) * x + 2 * axis * (axis @ x) + 2 * turn[3] * np.cross(axis, x)


class GuessedAxes(Foreign):
    def test_none_is_wrong_and_sure(self):
        for (name, (bones, known)), turn in itertools.product(KNOWN.items(), TURNS):
            rig = rigs.stand_in(bones)
            rig.turn = turn
            skeleton, _ = self.rig(self.write("known", rig))
            text = skeleton.read_text()
            joints = tomllib.loads(text)["joint"]
            sure = 0
            for joint in joints.keys() & known.keys():
                block = text.split(f"[joint.{joint}]")[1].split("[joint.")[0]
                if "# flexion: doubtful" in block:
                    continue
                sure += 1
                cosine = np.dot(joints[joint]["axes"]["flexion"], turned(turn, np.array(known[joint])))
                self.assertGreater(cosine, 0.86, f"{name}, turned by {turn}: {joint}{block}")
            if name not in SHOWS_LITTLE:
                self.assertGreaterEqual(2 * sure, len(known) - 1, f"{name}, turned by {turn}: doubts most")


# Two motions of each: a joint about its guessed (of the human body authored) flexion, or the clip of the file.
SIX = {"human": (("knee-left", 120), ("elbow-left", 120)), "bcn_epileptic.glb": (None, ("B_Knee_Left", 90)),
       "hand": (("index-2", 100), ("middle-1", 85)), "quadruped": (("stifle-left", 60), ("elbow-left", 90)),
       "robot": (("shin-left", 80), ("fore-left", 80)), "swollen": (("knee-left", 120), ("elbow-left", 120))}
SIX_METHODS = [(name, name, "") for name in ("linear-blend", "dual-quaternion", "direct-delta-mush")]
SIX_METHODS.append(("implicit-smooth", "implicit", 'projection = "smooth"'))
METRICS = (("overlap_excess_body", 1e6, "cm³"), ("roughness_p95", 1, "°"), ("lumps_max", 1e3, "mm"),
           ("volume_change", 100, "%"), ("volume_change_global", 100, "%"))
SWELLING = 0.035  # m


def close_seams():
    spec = importlib.util.spec_from_file_location("close_seams", HOME / "scripts" / "close_seams.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def swell(source, target, distance):
    """Every vertex moved along its normal, the mean over the triangles of all vertices at its place."""
    glb = close_seams().Glb(source)
    for mesh in glb.json["meshes"]:
        for part in mesh["primitives"]:
            accessor = part["attributes"]["POSITION"]
            places = np.array(glb.positions(accessor))
            triangles = np.array(glb.indices(part["indices"])).reshape(-1, 3)
            _, welded = np.unique(places.round(6), axis=0, return_inverse=True)
            a, b, c = (places[triangles[:, k]] for k in range(3))
            normals = np.zeros((welded.max() + 1, 3))
            for k in range(3):
                np.add.at(normals, welded.reshape(-1)[triangles[:, k]], np.cross(b - a, c - a))
            normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
            for i, place in enumerate(places + distance * normals[welded.reshape(-1)]):
                glb.set_position(accessor, i, place)
    glb.write(target)


@unittest.skipUnless(AT_LENGTH, "GEOPRIOR_LONG")
class SixRigs(Foreign):
    """Two bodies, a hand, an animal, a robot of parts and a swollen body: what four methods come to."""

    def scene(self, name):
        if name == "human":
            return 'character = "human"\n'
        if name == "swollen":
            file = self.folder / "swollen.glb"
            swell(HOME / "data/human.glb", file, SWELLING)
            return f'character = "{file}"\nmesh = "human-baseMesh"\nskeleton = "human.skeleton.toml"\n'
        file = self.character(name)
        return f'character = "{file}"\nskeleton = "{self.rig(file)[0]}"\n'

    def test_measure_every_method(self):
        print("\n| rig | motion | method |", " | ".join(f"{m} ({unit}): median, worst" for m, _, unit in METRICS), "|")
        print("|---|---|---|" + "---|" * len(METRICS))
        for name, motions in SIX.items():
            with self.subTest(rig=name):
                values = ", ".join(f"{{ motion = {moved(motion, 7)} }}" for motion in motions)
                more = f'[[sweep]]\nkey = "scene"\nbase = false\nnames = ["first", "second"]\nvalues = [{values}]\n'
                cases, said = self.run_experiment(experiment(self.scene(name), SIX_METHODS, more))
                self.assertEqual(len(cases), 2)
                for case, motion in zip(cases, motions):
                    self.tell(name, "clip" if motion is None else motion[0], case, said)

    def median_and_worst(self, summary, metric, factor):
        """A dash where the metric has no place: no joint bends, or none with skin of its own."""
        if f"{metric}.median" not in summary:
            return "–"
        worst = max(abs(summary[f"{metric}.{end}"]["value"]) for end in ("max", "min"))
        return f"{factor * summary[f'{metric}.median']['value']:.3g}, {factor * worst:.3g}"

    def tell(self, name, motion, case, said):
        """A row of the table for each method."""
        for variant in case["variants"]:
            self.assertEqual((variant["status"], variant["frames"]), ("done", 7), f"{variant['name']}: {said}")
            row = [self.median_and_worst(variant["summary"], metric, factor) for metric, factor, _ in METRICS]
            print(f"| {name} | {motion} | {variant['name']} |", " | ".join(row), "|", flush=True)


if __name__ == "__main__":
    unittest.main()
