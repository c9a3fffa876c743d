"""Characters that come from elsewhere, through the program without an edit: geoprior rig, a motion, every method.

    foreign_characters_test.py PROGRAM

The rigs of tests/skinning/rigs are written by a script, each with one trait; two are those of installed packages. With
GEOPRIOR_LONG their skins are as fine as the real ones, and six rigs are measured."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
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

# Implicit skinning may refuse these, with a reason; whatever else is refused fails the test.
MAY_REFUSE = {("open-loop", "implicit")}


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)


def experiment(character, skeleton, motion, variants):
    scene = f'character = "{character}"\nskeleton = "{skeleton}"\n'
    if motion is None:
        scene += 'motion = { kind = "clip", frames = 2 }\n'
    else:
        scene += f'motion = {{ joint = "{motion[0]}", axis = "flexion", to_deg = {motion[1]}, frames = 2 }}\n'
    text = f'title = "A foreign character"\ntopic = "skinning"\n[scene]\n{scene}'
    for name, method, options in variants:
        text += f'[[variant]]\nname = "{name}"\nmethod = "{method}"\noptions = {{ {options} }}\n'
    return text


class Foreign(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write_rig(self, name):
        """The character's file, or the name of an installed one."""
        if name.endswith(".glb"):
            return name
        file = self.folder / f"{name}.glb"
        rigs.ALL[name](CELL).write(file)
        return file

    def rig(self, file, *arguments):
        """Skeleton file and warnings of `geoprior rig`."""
        done = program("rig", file, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        skeleton = self.folder / f"{pathlib.Path(file).stem}.skeleton.toml"
        skeleton.write_text(done.stdout)
        return skeleton, done.stderr

    def run_experiment(self, text):
        """What each variant came to, and what the program said."""
        file, out = self.folder / "mine.toml", tempfile.mkdtemp(dir=self.folder)
        file.write_text(text)
        done = program("run", file, "--out", out, "--no-pictures", "--json", "--threads", 1)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        cases = json.loads(done.stdout)["cases"]
        return {variant["name"]: variant for variant in cases[0]["variants"]}, done.stderr


class EightAndTwoCharacters(Foreign):
    def test_run_with_every_method(self):
        for name, motion in MOTIONS.items():
            with self.subTest(character=name):
                file = self.write_rig(name)
                skeleton, _ = self.rig(file)
                variants = [(method, method, "") for method in METHODS]
                variants.append(("implicit", "implicit", f'projection = "smooth", {COARSE}'))
                if motion is None:
                    variants.append(("tracking", "implicit", f'projection = "tracking", {COARSE}'))
                ran, said = self.run_experiment(experiment(file, skeleton, motion, variants))
                self.assertEqual(set(ran), {variant[0] for variant in variants})
                for variant, came in ran.items():
                    print(name, variant, came["status"], flush=True)
                    if (name, variant) not in MAY_REFUSE:
                        self.assertEqual((came["status"], came["frames"]), ("done", 2), f"{variant}: {said}")


if __name__ == "__main__":
    unittest.main()
