"""Error against time of comparisons at equal error: what is drawn, and that a stale picture is found. Run with Debian's
python3."""

import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(REPOSITORY / "results")]

import error_time  # noqa: E402
from runfile import Study  # noqa: E402


def record(value=1.5, kind="matched", quantity="timing:run", match="hausdorff_ratio"):
    """Of a method beside three meshes and a fourth that is a family of its own."""
    study = Study("time at equal error", kind, quantity, value, value - 0.1, value + 0.1,
                  np.array([0.02, 0.05, 0.01, 0.03]), np.array([0.004, 0.002, 0.02, 0.003]), np.array([]),
                  [["hybrid"], ["uniform", "uniform-512"], ["adaptive"]], match)
    return SimpleNamespace(studies=[study])


class ErrorAgainstTime(unittest.TestCase):
    def test_has_the_errors_and_costs_of_each_family(self):
        families = list(error_time.families_of(record().studies[0]))
        self.assertEqual([names for names, _, _ in families], [["hybrid"], ["uniform", "uniform-512"], ["adaptive"]])
        self.assertEqual([list(errors) for _, errors, _ in families], [[0.02], [0.05, 0.01], [0.03]])
        self.assertEqual([list(costs) for _, _, costs in families], [[0.004], [0.002, 0.02], [0.003]])

    def test_is_drawn_of_times_of_the_topic_alone(self):
        published = {"paper/star": record(), "fluid/tank": record(), "paper/bend": record(kind="spread"),
                     "paper/leaf": record(quantity="fold_energy"), "paper/snap": record(match="fold_energy")}
        self.assertEqual(list(error_time.matched_of(published, "paper")), ["paper/star"])

    def test_is_drawn_anew_where_a_record_changed(self):
        with tempfile.TemporaryDirectory() as scratch:
            old, new = {"paper/star": record()}, {"paper/star": record(1.6)}
            self.assertEqual(len(error_time.problems(scratch, old)), 1)
            error_time.write(scratch, old)
            path = Path(scratch) / error_time.PICTURES["paper"]
            first = path.read_bytes()
            self.assertEqual(error_time.problems(scratch, old), [])
            self.assertEqual(error_time.write(scratch, old), [])
            self.assertIn("other numbers", error_time.problems(scratch, new)[0])
            error_time.write(scratch, new)
            self.assertNotEqual(path.read_bytes(), first)
            path.unlink()
            error_time.write(scratch, old)
            self.assertEqual(path.read_bytes(), first)

    def test_is_no_picture_where_nothing_was_compared(self):
        with tempfile.TemporaryDirectory() as scratch:
            self.assertEqual(error_time.write(scratch, {}), [])
            self.assertEqual(error_time.problems(scratch, {}), [])


if __name__ == "__main__":
    unittest.main()
