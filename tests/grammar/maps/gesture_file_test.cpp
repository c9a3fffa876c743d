// Recorded gestures: what a file says, what it refuses and where, and the gestures that come with
// the topic.

#include "experiments/grammar/files/gesture_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "tests/grammar/maps/sampled_map.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using geoprior::test::expect_error;

class GrammarGestureFile : public geoprior::test::ScratchFolder {};

/// Lines 1 to 6 of a file.
const std::string kGrabText =
    "[[stroke]]\n"
    "kind = 'grab'\n"
    "path_x = [0, 1]\n"
    "path_y = [2, 3]\n"
    "path_z = [4, 5]\n"
    "radius = 6\n";

const std::string kTetrahedron =
    "v -5 -5 -1\nv 7 -5 -1\nv 0 9 -1\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

TEST_F(GrammarGestureFile, ReadsStrokes) {
  const Gesture read = parse_gesture(
      kGrabText +
          "[[stroke]]\nkind = 'bend'\npath_x = [1]\npath_y = [2]\npath_z = [3]\nradius = 4\n"
          "axis = [1, 0, 0]\nalong = [0, 1, 0]\namount = -0.5\n",
      "g.toml");
  ASSERT_EQ(read.strokes.size(), 2u);
  EXPECT_EQ(read.strokes[0].kind, Stroke::Kind::grab);
  EXPECT_EQ(read.strokes[0].path, (std::vector<Vector3d>{{0, 2, 4}, {1, 3, 5}}));
  EXPECT_EQ(read.strokes[0].radius, 6);
  EXPECT_EQ(read.strokes[1].kind, Stroke::Kind::bend);
  EXPECT_EQ(read.strokes[1].axis, Vector3d(1, 0, 0));
  EXPECT_EQ(read.strokes[1].along, Vector3d(0, 1, 0));
  EXPECT_EQ(read.strokes[1].amount, -0.5);
}

TEST_F(GrammarGestureFile, ReadsALatticeWithXFastest) {
  const Gesture read = parse_gesture(
      "[lattice]\nlow = [0, 0, 0]\nhigh = [1, 2, 3]\npoints = [2, 2, 2]\n"
      "shifts = [1,0,0, 2,0,0, 3,0,0, 4,0,0, 5,0,0, 6,0,0, 7,0,0, 8,0,0]\n",
      "g.toml");
  ASSERT_TRUE(read.lattice);
  EXPECT_EQ(read.lattice->high, Vector3d(1, 2, 3));
  EXPECT_EQ(read.lattice->shifts.at(1), Vector3d(2, 0, 0));
  EXPECT_NEAR(map_of(read, 1)->at({1, 0, 0}).x(), 1 + 2, 1e-14);
  EXPECT_NEAR(map_of(read, 1)->at({0, 0, 3}).x(), 0 + 5, 1e-14);
}

TEST_F(GrammarGestureFile, ReadsACageAndNamesItsFiles) {
  write("rest.obj", kTetrahedron);
  write("moved.obj",
        "v -5 -5 -1\nv 7 -5 -1\nv 0 9 -1\nv 3 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const auto file = write("g.toml", "[cage]\nrest = 'rest.obj'\nmoved = 'moved.obj'\n");
  const ReadGesture read = read_gesture_file(file);
  ASSERT_TRUE(read.gesture.cage);
  EXPECT_EQ(read.gesture.cage->moved(3, 0), 3);
  EXPECT_EQ(read.files.size(), 3u);
  for (const auto& named : read.files) EXPECT_TRUE(std::filesystem::exists(named));
}

TEST_F(GrammarGestureFile, RefusesAndNamesTheLine) {
  const auto refuses = [](const std::string& text, std::initializer_list<std::string> parts) {
    expect_error([&] { parse_gesture(text, "g.toml"); }, parts);
  };
  refuses("", {"g.toml", "[[stroke]]"});
  refuses(kGrabText + "colour = 3\n", {"g.toml:7", "colour"});
  refuses(kGrabText + "axis = [1, 2]\n", {"g.toml:7", "axis"});
  refuses(kGrabText + "amount = nan\n", {"g.toml:7", "amount"});
  refuses("[[stroke]]\nkind = 'push'\n", {"g.toml:2", "kind", "grab"});
  refuses("[[stroke]]\nkind = 'grab'\npath_x = [0]\npath_y = [0]\npath_z = [0]\nradius = 1\n",
          {"g.toml:1", "path of 1 points"});
  refuses("[[stroke]]\nkind = 'grab'\npath_x = [0, 1]\npath_y = [0]\npath_z = [0]\nradius = 1\n",
          {"g.toml:1", "path_y"});
  refuses(
      "[[stroke]]\nkind = 'grab'\npath_x = [0, 1]\npath_y = [0, 1]\npath_z = [0, 1]\nradius = 0\n",
      {"g.toml:6", "radius"});
  refuses("[lattice]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\npoints = [2, 2, 2]\nshifts = [0, 0, 0]\n",
          {"g.toml:1", "1 shifts"});
  refuses("[lattice]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\npoints = [2, 2, 2]\nshifts = [0, 0]\n",
          {"g.toml", "shifts"});
}

TEST_F(GrammarGestureFile, RefusesAnOpenCageAndOneOfAnotherMesh) {
  write("rest.obj", kTetrahedron);
  write("open.obj", "v -5 -5 -1\nv 7 -5 -1\nv 0 9 -1\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  write("more.obj", kTetrahedron + "v 1 1 1\n");
  const auto refuses = [&](const std::string& rest, const std::string& moved,
                           std::initializer_list<std::string> parts) {
    const auto file = write("g.toml", "[cage]\nrest = '" + rest + "'\nmoved = '" + moved + "'\n");
    expect_error([&] { read_gesture_file(file); }, parts);
  };
  refuses("open.obj", "open.obj", {"g.toml:1", "edge"});
  refuses("rest.obj", "more.obj", {"g.toml:1", "5 moved"});
  refuses("rest.obj", "missing.obj", {"missing.obj"});
}

TEST_F(GrammarGestureFile, ListsItsKeys) {
  std::set<std::string> keys;
  for (const auto& row : gesture_keys().keys) keys.insert(row.key);
  for (const char* key : {"stroke[].kind", "stroke[].path_x", "stroke[].amount", "lattice.shifts",
                          "cage.rest", "cage.moved"})
    EXPECT_TRUE(keys.contains(key)) << key;
}

/// Each moves an object of 8 m on the origin by decimetres to metres, leaves its foot almost where
/// it is, and has an inverse.
TEST_F(GrammarGestureFile, RecordedGesturesAreInvertibleAndKeepTheFoot) {
  for (const char* name : {"lean.gesture.toml", "swirl.gesture.toml", "tug.gesture.toml",
                           "shear.lattice.toml", "squeeze.cage.toml"}) {
    const ReadGesture read = read_gesture_file(std::filesystem::path(GEOPRIOR_SOURCE_DIR) /
                                               "experiments/grammar/gestures" / name);
    for (const double fraction : {0.3, 0.7, 1.0}) {
      const auto map = map_of(read.gesture, fraction);
      EXPECT_GT(samples::least_determinant(*map, samples::points_in(samples::kSampledBox, 500, 1)),
                0.15)
          << name;
    }
    const auto map = map_of(read.gesture, 1);
    double largest = 0;
    for (const Vector3d& x : samples::points_in(samples::kSampledBox, 200, 2))
      largest = std::max(largest, (map->at(x) - x).norm());
    EXPECT_GT(largest, 0.5) << name;
    EXPECT_LT(largest, 6) << name;
    EXPECT_LT((map->at({0, 0, 0}) - Vector3d(0, 0, 0)).norm(), 0.25) << name;
  }
}

}  // namespace
}  // namespace geoprior::grammar
