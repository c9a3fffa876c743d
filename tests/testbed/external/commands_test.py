"""Programs that a variant starts: what they are given, and what becomes of those that fail.

    commands_test.py PROGRAM
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from schema import faults  # noqa: E402

HOME = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
PYTHON = "/usr/bin/python3"

SCENE = """title = "Programs from outside"
topic = "skinning"
[scene]
character = "cylinder"
cylinder = { segments = 12, rings_per_half = 6 }
motion = { joint = "upper", axis = "flexion", to_deg = 60, frames = 3 }
[[variant]]
name = "linear-blend"
method = "linear-blend"
role = "baseline"
"""

# What a variant's program does, by the word that it is called with.
BEHAVIOUR = r'''
import json, os, struct, subprocess, sys, time

def frames(count=3, lost=0, spoil=None):
    """The rest pose, as often as is wanted."""
    surface = json.load(open("scene.json"))["parts"]["surface"]
    data = open(surface["points"], "rb").read()
    points = data[10 + struct.unpack("<H", data[8:10])[0]:]
    points = points[:len(points) - 24 * lost]
    os.makedirs("out/frames")
    for i in range(count):
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points) // 24}\n"
        head += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
        text = head.encode() + (spoil(i, points) if spoil else points)
        open(f"out/frames/surface_{i:04d}.ply", "wb").write(text)

def not_a_number(i, points):
    return points if i != 1 else struct.pack("<d", float("nan")) + points[8:]

def crash():
    print("first words", file=sys.stderr)
    print("last \x1b[31mwords", file=sys.stderr, flush=True)
    os.abort()

def leave_daemon():
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.execvp("sleep", ["sleep", "98765"])
        os.execvp("sleep", ["sleep", "98765"])
    frames()

def hang_with_daemon():
    subprocess.Popen(["sleep", "98765"], start_new_session=True)
    time.sleep(98765)

def write_much(files):
    for i in range(files):
        with open(f"out/{i}", "wb") as file:
            for _ in range(10000 // files):
                file.write(bytes(1_000_000))

def print_much():
    for _ in range(200):
        print("y" * 1_000_000)
        sys.stderr.write("z" * 100_000)
    frames()

def parameters(rows):
    frames()
    open("out/frames.csv", "w").write("frame,parameter\n" + rows)

def table(name, rows):
    frames()
    open(f"out/{name}.csv", "w").write(rows)

def own_time():
    frames()
    open("out/diagnostics.csv", "w").write("frame,process_wall,process_peak_memory,steps\n0,1e9,1e9,7\n2,1e9,1e9,8\n")

def broken_sound():
    frames()
    os.mkdir("out/artifacts")
    open("out/artifacts/sound.wav", "w").write("no sound")

def link_folder():
    os.rmdir("out")
    os.symlink("reference", "out")

def rename_folder():
    os.rename(os.getcwd(), os.getcwd() + "-renamed")

def stop_the_run():
    os.kill(os.getppid(), 2)
    time.sleep(98765)

def look_about():
    """Fails where something of the run is open to it."""
    open_here = {os.path.realpath(f"/proc/self/fd/{fd}") for fd in os.listdir("/proc/self/fd")}
    open_here = {name for name in open_here if "/pipe:" not in name and not name.startswith("/proc/")}
    if open_here != {"/dev/null"}:
        sys.exit(f"open: {open_here}")
    frames()

def link_out():
    frames()
    os.symlink("/etc/passwd", "out/frames/other_0000.csv")

{
    "good": frames,
    "crash": crash,
    "hang": lambda: time.sleep(98765),
    "leave-daemon": leave_daemon,
    "hang-with-daemon": hang_with_daemon,
    "nan": lambda: frames(spoil=not_a_number),
    "half": lambda: frames(spoil=lambda i, points: points[:len(points) // 2] if i == 2 else points),
    "one-large-file": lambda: write_much(1),
    "many-files": lambda: write_much(1000),
    "other-vertices": lambda: frames(lost=1),
    "fewer-frames": lambda: frames(count=2),
    "nothing": lambda: None,
    "print": print_much,
    "input": lambda: input(),
    "gap": lambda: parameters("0,0\n1,30\n3,60\n"),
    "double": lambda: parameters("0,0\n1,30\n1,60\n"),
    "other-case": lambda: parameters("0,0\n1,45\n2,90\n"),
    "diagnostic-twice": lambda: table("diagnostics", "frame,work\n1,2\n1,3\n"),
    "diagnostic-beyond": lambda: table("diagnostics", "frame,work\n0,\n9,3\n"),
    "events": lambda: table("events", "time_s,kind,x,y,z,energy_J,duration_s,area_m2\n0,flap,0,0,0,1,0.5,\n"),
    "event-without": lambda: table("events", "time_s,kind,x,y,z,energy_J,duration_s\n0,flap,0,0,0,1,\n"),
    "link": link_out,
    "link-folder": link_folder,
    "dangling": lambda: (frames(), os.symlink("nowhere", "out/events.csv")),
    "rename-folder": rename_folder,
    "broken-sound": broken_sound,
    "own-time": own_time,
    "stop": stop_the_run,
    "look-about": look_about,
}[sys.argv[1]]()
'''

# What is said of each; None: it runs.
SAID = {
    "good": None,
    "crash": r"ended by signal 6 .*first words \| last  ?\[31mwords",
    "hang": r"ended after 1\.5 s \(time_limit_s\)",
    "leave-daemon": None,
    "hang-with-daemon": r"ended after 1\.5 s \(time_limit_s\)",
    "nan": r"^failed after 1 frame: out/frames/surface_0001\.ply.*vertex 0 is not finite",
    "half": r"^failed after 2 frames: out/frames/surface_0002\.ply.*is truncated",
    "one-large-file": r"more than 50 MB \(output_limit_MB\)",
    "many-files": r"more than 50 MB \(output_limit_MB\)",
    "other-vertices": r"has 205 vertices, the scene 206 .*correspondence",
    "fewer-frames": r"2 frames, but the scene has 3 \(angle 0 to 60 deg\)",
    "nothing": r"out: has no frames",
    "print": None,
    "input": r"EOF when reading a line",
    "gap": r"frames\.csv:4: frame 3 in a list of 3",
    "double": r"frames\.csv:4: frame 1 is there twice",
    "other-case": r"frame 1 is at angle 45, that of the scene at 30 deg: are these frames of another case\?",
    "diagnostic-twice": r"diagnostics\.csv:3: frame 1 is there twice",
    "diagnostic-beyond": r"diagnostics\.csv:3: there is no frame 9 \(allowed: 0 to 2\)",
    "events": None,
    "event-without": r"events\.csv:2: has no duration_s \(allowed: no empty cell in this column\)",
    "link": r"link",
    "link-folder": r"link",
    "dangling": r"events\.csv.*link",
    "rename-folder": r"out: there is no such folder",
    "broken-sound": r"^failed after 3 frames: out/artifacts/sound\.wav",
    "own-time": None,
    "look-about": None,
}


def variant(name, options):
    return f'[[variant]]\nname = "{name}"\nmethod = "external"\noptions = {{ {options} }}\n'


def command(*words, more=""):
    return f"command = {json.dumps(words)}{more}"


def sleepers():
    found = subprocess.run(["pgrep", "-f", "sleep 98765"], capture_output=True, text=True, check=False)
    return found.stdout.split()


class Commands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "behaviour.py").write_text(BEHAVIOUR)
        self.count = 0

    def run_variants(self, variants, *words):
        experiment = self.folder / "experiment.toml"
        experiment.write_text(SCENE + "".join(variant(name, options) for name, options in variants.items()))
        return subprocess.run([PROGRAM, "run", experiment, "--no-pictures", "--out", self.folder / "run", *words],
                              capture_output=True, text=True, check=False)

    def statuses(self):
        with h5py.File(self.folder / "run" / "run.h5") as file:
            variants = file["cases/default/variants"]
            return {name: (record.attrs["status"], len(record["parameter"]), record.attrs["error"])
                    for name, record in variants.items()}

    def test_nothing_is_started_without_leave(self):
        ended = self.run_variants({"made": command("touch", str(self.folder / "touched"))})
        self.assertEqual(ended.returncode, 2)
        self.assertIn(f"variant 'made' would start: touch {self.folder}/touched", ended.stderr)
        self.assertIn("--allow-commands", ended.stderr)
        self.assertFalse((self.folder / "touched").exists())
        ended = self.run_variants({"one": command("./first"), "two": command("./second", "a b", "")})
        self.assertIn("variant 'one' would start: ./first; variant 'two' would start: ./second 'a b' ''", ended.stderr)
        self.assertFalse((self.folder / "run").exists())

    def test_each_failure_is_that_of_its_variant(self):
        # A machine that is busy makes none of the others late.
        limits = {name: 1.5 if "hang" in name else 600 for name in SAID}
        variants = {name: command(PYTHON, "behaviour.py", name,
                                  more=f", time_limit_s = {limits[name]}, output_limit_MB = 50") for name in SAID}
        variants["missing"] = command("/nowhere/program")
        variants["folder"] = command("/tmp")
        (self.folder / "script").write_text("#!/nowhere/interpreter\n")
        (self.folder / "script").chmod(0o755)
        variants["script"] = command("./script")
        ended = self.run_variants(variants, "--allow-commands")
        self.assertEqual(ended.returncode, 1, ended.stderr)
        statuses = self.statuses()
        for name, said in (SAID | {"missing": "cannot be started: No such file", "folder": "is a folder",
                              "script": "No such file or directory .the interpreter"}).items():
            status, frames, error = statuses[name]
            with self.subTest(name):
                if said is None:
                    self.assertEqual((status, frames, error), ("done", 3, ""))
                    continue
                told = f"failed after {frames} frame{'s' * (frames != 1)}: {error}" if frames else error
                self.assertEqual(status, "failed")
                self.assertRegex(told, said)
                self.assertNotRegex(told, r"[\n\x00-\x1f]")
        self.assertFalse((self.folder / "run" / "external").exists())
        self.assertEqual(sleepers(), [])
        recorded = {path.parent.name for path in (self.folder / "run/frames/default").rglob("*.vtp")}
        self.assertEqual(recorded, {name for name, (_, frames, _) in statuses.items() if frames})

    def test_the_time_of_a_program_is_that_of_its_run(self):
        variants = {"made": command(PYTHON, "behaviour.py", "own-time"), "read": 'frames = "run/frames/default/made"'}
        self.assertEqual(self.run_variants(variants, "--allow-commands").returncode, 0)
        with h5py.File(self.folder / "run" / "run.h5") as file:
            made, read = (file[f"cases/default/variants/{name}"] for name in variants)
            whole = made["timing/process"][()]
            self.assertEqual(whole.shape[0], 1)
            self.assertNotIn("run", made["timing"])
            diagnostics = {name: column[()].tolist() for name, column in made["diagnostics"].items()}
            # What the program says of itself does not count; what else it says does.
            self.assertLess(diagnostics["process_wall"][0], 1e8)
            self.assertEqual(diagnostics["steps"][::2], [7, 8])
            self.assertTrue(all(value != value for value in diagnostics["process_wall"][1:]))
            self.assertEqual(made.attrs["memory_peak"], int(1e6 * diagnostics["process_peak_memory"][0]))
            self.assertFalse({"run", "process"} & set(read["timing"]))
            self.assertNotIn("memory_peak", read.attrs)
        compared = subprocess.run([PROGRAM, "compare", self.folder / "run", self.folder / "run", "--variants",
                                   "linear-blend=made", "--json", "--out", self.folder / "compared"],
                                  capture_output=True, text=True, check=False)
        self.assertEqual([time["phase"] for time in json.loads(compared.stdout)["times"]], ["whole run"], compared.stderr)

    def test_a_stopped_run_says_how_it_is_gone_on_with(self):
        ended = self.run_variants({"stopped": command(PYTHON, "behaviour.py", "stop")}, "--allow-commands")
        self.assertEqual(ended.returncode, 2)
        self.assertRegex(ended.stderr, r"go on with: .* --allow-commands .*--resume")

    def test_resume_runs_what_failed_and_nothing_else(self):
        (self.folder / "flaky.py").write_text(BEHAVIOUR.replace("sys.argv[1]", "sys.argv[1] if os.path.exists("
                                                                f"{str(self.folder / 'mended')!r}) else 'half'"))
        variants = {"sound": command(PYTHON, "behaviour.py", "good"), "flaky": command(PYTHON, "flaky.py", "good")}
        self.run_variants(variants, "--allow-commands")
        self.assertEqual([self.statuses()[name][:2] for name in variants], [("done", 3), ("failed", 2)])
        (self.folder / "mended").touch()
        ended = self.run_variants(variants, "--allow-commands", "--resume")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual([self.statuses()[name] for name in variants], [("done", 3, "")] * 2)
        lines = [json.loads(line) for line in (self.folder / "run/journal.jsonl").read_text().splitlines()]
        begun = [line["variant"] for line in lines if line["kind"] == "begin"]
        self.assertEqual(sorted(begun), ["flaky", "flaky", "linear-blend", "sound"])
        self.assertIn("nothing to do", self.run_variants(variants, "--allow-commands", "--resume").stderr)

    def test_the_scene_is_as_its_schema_says(self):
        given = self.folder / "given"
        options = command("cp", "-r", ".", str(given)) + ' }\nreference = "linear-blend"\n#{'
        self.run_variants({"copy": options}, "--allow-commands")
        scene = json.loads((given / "scene.json").read_text())
        schema = json.loads((HOME / "docs/scene.schema.json").read_text())
        self.assertEqual(list(faults(scene, schema)), [])
        self.assertEqual(scene["parameter"], {"name": "angle", "unit": "deg", "values": [0, 30, 60]})
        for name in re.findall(r'"((?:scene|inputs)/[^"]+)"', json.dumps(scene)):
            self.assertTrue((given / name).is_file(), name)
        self.assertTrue((given / "reference/frames/surface_0002.vtp").is_file())
        self.assertNotEqual(list(faults(scene | {"seed": "one"}, schema)), [])

    def test_what_a_program_is_given_is_not_what_it_wrote(self):
        # Scene and reference are larger than the limit; its frames are not.
        options = command(PYTHON, "behaviour.py", "good", more=", output_limit_MB = 0.03")
        self.run_variants({"small": options + ' }\nreference = "linear-blend"\n#{'}, "--allow-commands")
        self.assertEqual(self.statuses()["small"], ("done", 3, ""))

    def test_a_correspondence_puts_vertices_in_order(self):
        (self.folder / "turned.py").write_text(BEHAVIOUR.replace("text = head.encode() + (spoil(i, points) if spoil "
                                                                 "else points)",
                                                                 "rows = [points[k:k + 24] for k in "
                                                                 "range(0, len(points), 24)][::-1]\n"
                                                                 "        text = head.encode() + b''.join(rows)"))
        (self.folder / "map.csv").write_text("vertex\n" + "\n".join(map(str, range(205, -1, -1))) + "\n")
        variants = {"plain": command(PYTHON, "behaviour.py", "good"),
                    "turned": command(PYTHON, "turned.py", "good", more=', correspondence = "map.csv"')}
        self.assertEqual(self.run_variants(variants, "--allow-commands").returncode, 0)
        frames = self.folder / "run/frames/default"
        for name in ("surface_0000.vtp", "surface_0002.vtp"):
            self.assertEqual((frames / "plain" / name).read_bytes(), (frames / "turned" / name).read_bytes())

    def test_a_check_sees_that_files_came_or_changed(self):
        frames, runs = self.folder / "theirs", self.folder / "runs"

        def checked():
            """Variants that the check ran, and what the newest of so many runs says of the files."""
            ended = subprocess.run([PROGRAM, "check", self.folder / "experiment.toml"], capture_output=True, text=True,
                                   check=False, env=os.environ | {"GEOPRIOR_RUNS": str(runs)})
            files = sorted(runs.rglob("run.h5"))
            with h5py.File(files[-1]) as file:
                status = file["cases/default/variants/theirs"].attrs["status"]
            return sorted(re.findall(r"default/([\w-]+):", ended.stderr)), len(files), status

        self.run_variants({"theirs": f'frames = "{frames}"'})  # of another folder: no check sees it
        self.assertEqual(checked(), (["linear-blend", "theirs"], 1, "failed"))
        shutil.copytree(self.folder / "run/frames/default/linear-blend", frames)
        self.assertEqual(checked(), (["theirs"], 1, "done"))
        self.assertEqual(checked(), ([], 1, "done"))
        rest, bent = (frames / f"surface_000{i}.vtp" for i in (0, 2))
        bent.write_bytes(rest.read_bytes())
        self.assertEqual(checked(), (["linear-blend", "theirs"], 2, "failed"))  # its time is another's

    def test_files_are_read_as_they_lie(self):
        self.run_variants({"made": command(PYTHON, "behaviour.py", "good")}, "--allow-commands")
        exported = self.folder / "exported"
        done = subprocess.run([PROGRAM, "export", self.folder / "run", "--format", "obj", "--out", exported],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        os.rename(self.folder / "run", self.folder / "made")
        pattern = f"{exported}/default/made/frames/surface_%04d.obj"
        variants = {"folder": f'frames = "{exported}/default/made"', "files": f'frames = "{pattern}"',
                    "said": f'frames = "{pattern}", part = "surface", parameters = [0, 30, 60]',
                    "wrong": f'frames = "{pattern}", parameters = [0, 30]', "absent": 'frames = "nowhere"'}
        self.assertEqual(self.run_variants(variants).returncode, 1)
        statuses = self.statuses()
        for name in ("folder", "files", "said"):
            self.assertEqual(statuses[name], ("done", 3, ""))
        self.assertIn("3 frames, but 2 parameters", statuses["wrong"][2])
        self.assertIn("there is no such folder", statuses["absent"][2])

    def test_numbered_files_are_even_and_of_a_kind(self):
        given = self.folder / "given"
        self.run_variants({"copy": command("cp", "-r", ".", str(given))}, "--allow-commands")
        os.rename(self.folder / "run", self.folder / "made")
        for folder, numbers in {"tens": (10, 20, 30), "gap": (1, 2, 4), "four": (0, 1, 2, 3)}.items():
            (self.folder / folder).mkdir()
            for number in numbers:
                shutil.copy(given / "scene/surface.glb", self.folder / folder / f"f_{number:04d}.glb")
        os.symlink(self.folder / "four/f_0001.glb", self.folder / "tens/g_0001.glb")
        variants = {name: f'frames = "{pattern}"' for name, pattern in {
            "tens": "tens/f_%04d.glb", "gap": "gap/f_%04d.glb", "four": "four/f_%04d.glb", "link": "tens/g_%04d.glb",
            "other": "tens/f_%04d.off", "letter": "tens/f_%s.obj", "two": "tens/f_%04d_%04d.obj"}.items()}
        ended = self.run_variants(variants)
        self.assertEqual(ended.returncode, 1, ended.stderr)
        statuses = self.statuses()
        self.assertEqual(statuses["tens"], ("done", 3, ""))
        for name, said in {"gap": "f_0004.glb: follows f_0002.glb: files are missing", "four": "4 frames, but the scene",
                           "link": "link", "other": "unknown extension '.off'", "letter": "without 'd'",
                           "two": "not one number"}.items():
            self.assertEqual(statuses[name][:2], ("failed", 0))
            self.assertIn(said, statuses[name][2])


if __name__ == "__main__":
    unittest.main()
