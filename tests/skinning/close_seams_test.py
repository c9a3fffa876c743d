"""scripts/close_seams.py on an open box and its lid: seams joined, holes filled outwards, what is too far refused."""
import importlib.util
import pathlib
import struct
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
SPEC = importlib.util.spec_from_file_location("close_seams", ROOT / "scripts" / "close_seams.py")
close_seams = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(close_seams)

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
WALLS = [(0, 2, 3, 1), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]  # all but the top
LID = [(0, 1, 3, 2)]


def triangles(quads):
    return [i for a, b, c, d in quads for i in (a, b, c, a, c, d)]


def write_glb(path, parts):
    """A .glb of parts (positions, indices)."""
    glb = close_seams.Glb.__new__(close_seams.Glb)
    glb.json = {"asset": {"version": "2.0"}, "buffers": [{}], "bufferViews": [], "accessors": [], "meshes": []}
    glb.binary = bytearray()
    for points, indices in parts:
        glb.json["bufferViews"].append({"buffer": 0, "byteOffset": len(glb.binary), "byteLength": 12 * len(points)})
        glb.json["accessors"].append({"bufferView": len(glb.json["bufferViews"]) - 1, "componentType": close_seams.FLOAT,
                                      "count": len(points), "type": "VEC3"})
        position = len(glb.json["accessors"]) - 1
        for point in points:
            glb.binary += struct.pack("<3f", *point)
        glb.json["meshes"].append(
            {"primitives": [{"attributes": {"POSITION": position}, "indices": glb.add_indices(indices)}]})
    glb.write(path)


def volume(triangles_):
    """Enclosed by closed triangles that face outwards."""
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
               for a, b, c in triangles_) / 6


class CloseSeams(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.open = pathlib.Path(self.folder.name) / "open.glb"
        self.closed = pathlib.Path(self.folder.name) / "closed.glb"

    def close(self, parts):
        write_glb(self.open, parts)
        close_seams.main(self.open, self.closed, 1e-4)
        return close_seams.Skin(close_seams.Glb(self.closed))

    def lid(self, gap):
        return ([(x, y, 1 + gap) for y in (0, 1) for x in (0, 1)], triangles(LID))

    def test_a_seam_within_the_distance_becomes_one(self):
        skin = self.close([(CORNERS, triangles(WALLS)), self.lid(5e-5)])
        self.assertEqual(skin.border(), [])
        self.assertEqual(len(skin.triangles), 12)
        self.assertEqual(len(skin.places), 8)
        self.assertAlmostEqual(volume(skin.triangles), 1, places=4)

    def test_a_hole_is_filled_outwards_between_its_own_vertices(self):
        skin = self.close([(CORNERS, triangles(WALLS))])
        self.assertEqual(skin.border(), [])
        self.assertEqual(len(skin.places), 8)
        self.assertAlmostEqual(volume(skin.triangles), 1, places=6)

    def test_strips_have_two_triangles_less_than_corners(self):
        for corners in range(3, 20):
            strip = close_seams.strip(corners)
            self.assertEqual(len(strip), corners - 2)
            self.assertTrue(all(len(set(triangle)) == 3 for triangle in strip))

    def test_what_is_no_glb_is_refused(self):
        self.open.write_bytes(b"glTF" + bytes(40))
        with self.assertRaisesRegex(SystemExit, "no glTF 2.0 binary"):
            close_seams.main(self.open, self.closed, 1e-4)


if __name__ == "__main__":
    unittest.main()
