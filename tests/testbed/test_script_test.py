"""test.sh and scripts/changed_topics.sh on a repository of their own: what of it differs decides which tests run, and
where that cannot be known, everything does. Run with Debian's python3."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

HOME = Path(__file__).resolve().parents[2]
TOPICS = ["skinning", "paper", "fluid", "sound"]
FILES = {
    "CMakeLists.txt": "".join(f"geoprior_topic({topic} DEPS geoprior_cgal)\n" for topic in TOPICS),
    ".gitignore": "/build/\n",
    "README.md": "A testbed.\n",
    "core/mesh.h": "#pragma once\n",
    "testbed/report.cpp": "",
    "docs/methods/paper.md": "# Paper\n",
    "results/published/paper/bend.txt": "1\n",
    "results/reference/paper/bend.txt": "1\n",
    "benchmarks/kernels.cpp": "",
    "models/paper/shell.h": "#pragma once\n",
    "solvers/paper/folds.cpp": '#include "models/paper/shell.h"\n',
    "solvers/sound/crackle.cpp": '#include "solvers/paper/folds.h"\n',
    "solvers/skinning/implicit.cpp": '#include "core/mesh.h"\n',
    "experiments/fluid/wake.toml": 'input = "run:fluid/tank/flip"\n',
    "tests/skinning/projection/implicit_test.cpp": "",
    "tests/consumer/main.cpp": "",
}


class Repository(unittest.TestCase):
    """A scratch repository whose commit was tested."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name, text in FILES.items():
            self.write(name, text)
        for name in ("test.sh", "scripts/changed_topics.sh"):
            self.write(name, (HOME / name).read_text(), 0o755)
        self.git("init", "--quiet")
        self.commit()
        self.write("build/tested-commit", self.git("rev-parse", "HEAD"))

    def write(self, name, text, mode=0o644):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        file.chmod(mode)

    def git(self, *words):
        identity = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"]
        return subprocess.run(["git", *identity, *words], cwd=self.root, check=True, capture_output=True, text=True).stdout

    def commit(self):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "something", "--no-gpg-sign")


class ChangedTopics(Repository):
    def expect(self, *topics, why=""):
        done = subprocess.run(["scripts/changed_topics.sh"], cwd=self.root, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        verdicts = [("differs " if topic in topics else "same ") + topic for topic in TOPICS]
        self.assertEqual(done.stdout.splitlines(), verdicts)
        self.assertIn(why, done.stderr)

    def test_nothing_differs_from_what_was_tested(self):
        self.expect()

    def test_a_topic_differs_by_its_folders_however_far_a_change_is_on_its_way(self):
        for name in ("solvers/skinning/implicit.cpp", "tests/skinning/projection/implicit_test.cpp"):
            self.write(name, "int changed;\n")
            self.expect("skinning", why=name)
            self.git("add", name)
            self.expect("skinning", why=name)
            self.commit()
            self.expect("skinning", why=name)
            self.git("reset", "--quiet", "--hard", "HEAD~")
            self.expect()

    def test_a_new_file_is_a_change_before_git_has_it_and_one_that_git_ignores_is_none(self):
        self.write("build/release/paper/new.cpp", "")
        self.expect()
        self.write("baselines/fluid/new file.cpp", "")
        self.expect("fluid", why="new file.cpp")

    def test_a_file_that_is_gone_or_went_to_another_topic_is_a_change(self):
        (self.root / "experiments/fluid/wake.toml").unlink()
        self.expect("fluid")
        self.git("reset", "--quiet", "--hard")
        self.git("mv", "tests/skinning/projection/implicit_test.cpp", "experiments/fluid/")
        self.expect("skinning", "fluid")

    def test_what_uses_a_topic_that_differs_differs_too(self):
        self.write("results/reference/paper/bend.txt", "2\n")
        self.expect("paper", "sound", why="sound: uses paper")
        self.write("experiments/skinning/arm.toml", 'input = "run:sound/tear/hybrid"\n')
        self.commit()
        self.write("build/tested-commit", self.git("rev-parse", "HEAD"))
        self.write("models/paper/shell.h", "")
        self.expect("skinning", "paper", "sound", why="skinning: uses sound")

    def test_what_all_topics_share_is_a_change_of_all(self):
        for name in ("core/mesh.h", "testbed/report.cpp", "CMakeLists.txt", "scripts/new.sh", "tests/consumer/main.cpp",
                     "solvers/unknown/new.cpp", "data.bin"):
            self.write(name, FILES.get(name, "") + "# changed\n")
            self.expect(*TOPICS, why=f"all topics: {name} differs")
            self.git("reset", "--quiet", "--hard")
            self.git("clean", "--quiet", "--force", "-d")

    def test_documents_benchmarks_and_published_records_are_no_change(self):
        for name in ("README.md", "docs/methods/paper.md", "results/published/paper/bend.txt", "benchmarks/kernels.cpp"):
            self.write(name, "changed\n")
        self.expect()

    def test_all_differ_where_nothing_is_known_of_what_was_tested(self):
        for text in ("", "0" * 40, "no commit", "-h", "HEAD:core"):
            self.write("build/tested-commit", text)
            self.expect(*TOPICS, why="all topics:")
        (self.root / "build/tested-commit").unlink()
        self.expect(*TOPICS, why="there is no build/tested-commit")
        shutil.rmtree(self.root / ".git")
        self.write("build/tested-commit", "0" * 40)
        self.expect(*TOPICS, why="git does not know")

    def test_a_commit_that_a_rebase_left_behind_is_compared_by_what_it_held(self):
        self.write("README.md", "Another text.\n")
        self.git("commit", "--quiet", "--all", "--amend", "--message", "rebased", "--no-gpg-sign")
        self.expect()


class TestScript(Repository):
    """test.sh with programs in the place of ctest and geoprior that say what they were asked for."""

    def setUp(self):
        super().setUp()
        (self.root / "build/tested-commit").unlink()
        for name in ("clang-format", "ctest"):
            self.write(f"build/bin/{name}", f'#!/bin/sh\n[ {name} != ctest ] || echo "ctest $*"\n', 0o755)
        for name in ("setup.sh", "build.sh"):
            self.write(f"scripts/{name}", "#!/bin/sh\n", 0o755)
        self.program("exit 0")
        self.write("build/release/CMakeCache.txt", "GEOPRIOR_TOPICS:STRING=\n")
        self.write("build/release/Testing/Temporary/LastTest.log",
                   "[  PASSED  ] 1 test.\nTest Passed.\n[  PASSED  ] 12 tests.\nTest Passed.\nTest Passed.\n")
        for name, text in {
                "experiments/paper/bend.toml": "", "experiments/paper/bend.data.toml": "", "experiments/paper/twist.toml": "",
                "experiments/skinning/arm.toml": "", "experiments/skinning/knee.toml": "", "experiments/sound/tear.toml": "",
                "results/reference/skinning/arm.txt": "set full\ncost 1 s\nset quick\ncost 3 s\n",
                "results/reference/skinning/knee.txt": "set full\ncost 9 s\nset quick\ncost 2 s\n",
        }.items():
            self.write(name, text)
        self.commit()

    def program(self, last):
        self.write("build/release/geoprior", f'#!/bin/sh\necho "geoprior $*"\n{last}\n', 0o755)

    def run_script(self, *words, code=0):
        environment = dict(os.environ, PATH=f"{self.root}/build/bin:{os.environ['PATH']}")
        done = subprocess.run(["./test.sh", *words], cwd=self.root, env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout

    def tested(self):
        file = self.root / "build/tested-commit"
        return file.read_text() if file.exists() else None

    def expect_everything(self, output):
        self.assertIn("--output-on-failure -j 2 --timeout 1200\n", output)
        self.assertIn("geoprior check --quick --mutations --jobs 2 --threads 1\n", output)
        self.assertNotIn("left out", output)
        self.assertTrue(output.endswith("test: 13 tests in 3 entries passed, 0 failed\n"))

    def test_all_is_everything_and_remembers_a_commit_that_passed_as_it_stands(self):
        self.expect_everything(self.run_script("--all"))
        self.assertEqual(self.tested(), self.git("rev-parse", "HEAD"))

    def test_what_was_not_committed_fell_short_or_was_not_built_is_not_remembered(self):
        self.write("models/paper/new.h", "")
        self.assertIn("is not written: files differ", self.run_script("--all"))
        (self.root / "models/paper/new.h").unlink()
        self.program("exit 1")
        self.run_script("--all", code=1)
        self.program("touch solvers/paper/meanwhile.cpp")
        self.assertIn("is not written: files differ", self.run_script("--all"))
        (self.root / "solvers/paper/meanwhile.cpp").unlink()
        self.program("exit 0")
        self.write("build/release/CMakeCache.txt", "GEOPRIOR_TOPICS:STRING=paper\n")
        self.assertIn("is not written: not all topics", self.run_script("--all"))
        self.assertIsNone(self.tested())

    def test_without_a_tested_commit_or_where_shared_files_differ_everything_runs(self):
        self.expect_everything(self.run_script())
        self.assertEqual(self.tested(), self.git("rev-parse", "HEAD"))
        self.write("core/mesh.h", "// changed\n")
        self.expect_everything(self.run_script())

    def test_a_change_of_a_topic_runs_its_tests_and_an_experiment_of_each_other(self):
        self.run_script("--all")
        self.write("solvers/paper/folds.cpp", "// changed\n")
        output = self.run_script()
        self.assertIn(" -L ^(core|metrics|testbed|topics|fuzz|paper|sound)$\n", output)
        self.assertIn(" --threads 1 paper/bend paper/twist sound/tear skinning/knee fluid/wake\n", output)
        self.assertRegex(output, "left out.*: skinning fluid ")

    def test_without_a_change_shared_tests_run_and_an_experiment_of_each_topic(self):
        self.run_script("--all")
        output = self.run_script()
        self.assertIn(" -L ^(core|metrics|testbed|topics|fuzz)$\n", output)
        self.assertIn(" --threads 1 skinning/knee paper/bend fluid/wake sound/tear\n", output)

    def test_an_argument_that_is_none_is_refused(self):
        self.run_script("--al", code=2)


if __name__ == "__main__":
    unittest.main()
