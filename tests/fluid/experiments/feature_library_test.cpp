// Features on disk: the HDF5 library, pictures of maps, edit lists.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "experiments/fluid/scene/edit_list.h"
#include "experiments/fluid/scene/exr_maps.h"
#include "experiments/fluid/scene/feature_files.h"
#include "testbed/formats/hdf5/file.h"
#include "tests/testbed/formats/octahedron.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::fluid {
namespace {

using test::expect_error;

Eigen::Isometry3d placed(double angle) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  frame.translation() << 0.1, -0.2 * angle, 1 / 3.0;
  return frame;
}

/// A ripple of 3 frames and 8 x 8 texels; every value another one.
Feature ripple() {
  Feature f;
  f.id = 12;
  f.name = "boat/12";
  f.kind = RegionKind::differential;
  f.cell = 0.03;
  f.resolution = 8;
  f.extent = 0.7;
  for (int t = 0; t < 3; ++t) {
    f.times.push_back(0.1 + t / 24.0);
    f.placement.push_back(placed(0.3 * t));
    f.area.push_back(0.2 + 0.01 * t);
    f.volume.push_back(0);
    MapFrame map;
    map.displacement.resize(64, 3);
    map.alpha.resize(64);
    for (int i = 0; i < 64; ++i) {
      map.alpha(i) = static_cast<float>((i + t) % 64) / 63.0F;
      for (int c = 0; c < 3; ++c)
        map.displacement(i, c) = std::sin(0.1F * static_cast<float>(i + 70 * c + t));
    }
    f.maps.push_back(map);
  }
  return f;
}

/// A drop whose mesh changes.
Feature drop() {
  Feature f;
  f.id = 3;
  f.name = "drop/3";
  f.kind = RegionKind::isolated;
  f.cell = 0.01;
  for (int t = 0; t < 2; ++t) {
    f.times.push_back(0.04 * t);
    f.placement.push_back(placed(0));
    f.meshes.push_back(test::octahedron(0.1 + 0.01 * t));
  }
  f.meshes[1].V.conservativeResize(7, 3);  // a vertex more: topology may change
  f.meshes[1].V.row(6).setZero();
  return f;
}

void expect_equal(const Feature& a, const Feature& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.times, b.times);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.resolution, b.resolution);
  EXPECT_EQ(a.extent, b.extent);
  ASSERT_EQ(a.placement.size(), b.placement.size());
  ASSERT_EQ(a.maps.size(), b.maps.size());
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.placement.size(); ++i) {
    EXPECT_TRUE(a.placement[i].matrix() == b.placement[i].matrix());
  }
  for (std::size_t i = 0; i < a.maps.size(); ++i) {
    EXPECT_TRUE(a.maps[i].displacement == b.maps[i].displacement);
    EXPECT_TRUE(a.maps[i].alpha == b.maps[i].alpha);
  }
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_TRUE(a.meshes[i].V == b.meshes[i].V);
    EXPECT_TRUE(a.meshes[i].F == b.meshes[i].F);
  }
}

using FeatureLibrary = test::ScratchFolder;

TEST_F(FeatureLibrary, GivesFeaturesBackBitForBit) {
  const auto bytes = feature_library_bytes({ripple(), drop()});
  const auto features = read_feature_library(write("a.h5", test::text_of(bytes)));
  ASSERT_EQ(features.size(), 2U);  // by id
  expect_equal(features[0], drop());
  expect_equal(features[1], ripple());
}

TEST_F(FeatureLibrary, EqualFeaturesMakeEqualBytes) {
  EXPECT_EQ(feature_library_bytes({ripple()}), feature_library_bytes({ripple()}));
  EXPECT_TRUE(
      read_feature_library(write("empty.h5", test::text_of(feature_library_bytes({})))).empty());
}

TEST_F(FeatureLibrary, RefusesFeaturesThatDoNotFit) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](Feature f, auto change, std::initializer_list<std::string> parts) {
    change(f);
    expect_error([&] { feature_library_bytes({f}); }, parts);
  };
  refused(ripple(), [](Feature& f) { f.id = 0; }, {"feature 0", "no id"});
  refused(ripple(), [](Feature& f) { f.cell = 0; }, {"feature 12", "cell"});
  refused(ripple(), [](Feature& f) { f.times.clear(); }, {"no frames"});
  refused(ripple(), [](Feature& f) { f.times[2] = f.times[1]; }, {"frame 2", "time"});
  refused(ripple(), [&](Feature& f) { f.times[0] = kNan; }, {"frame 0", "time"});
  refused(ripple(), [](Feature& f) { f.placement.pop_back(); }, {"2 placements", "3, one a frame"});
  refused(ripple(), [](Feature& f) { f.placement[1].linear() *= 2; }, {"frame 1", "not rigid"});
  refused(ripple(), [](Feature& f) { f.placement[1].linear() *= -1; }, {"frame 1", "not rigid"});
  refused(ripple(), [](Feature& f) { f.maps.pop_back(); }, {"2 maps"});
  refused(ripple(), [](Feature& f) { f.resolution = 9; }, {"frame 0", "another size", "81"});
  refused(ripple(), [](Feature& f) { f.resolution = 1; }, {"the resolution 1"});
  refused(ripple(), [](Feature& f) { f.extent = -1; }, {"extent"});
  refused(ripple(), [](Feature& f) { f.maps[1].alpha(5) = 1.5F; }, {"frame 1", "alpha"});
  refused(ripple(), [&](Feature& f) { f.maps[1].displacement(5, 1) = static_cast<float>(kNan); },
          {"frame 1", "not finite"});
  refused(ripple(), [](Feature& f) { f.area.pop_back(); }, {"2 area values"});
  refused(ripple(), [](Feature& f) { f.meshes.resize(3); }, {"has meshes"});
  refused(drop(), [](Feature& f) { f.maps.resize(2); }, {"has maps"});
  refused(drop(), [](Feature& f) { f.meshes[1].F(0, 0) = 7; }, {"frame 1", "vertex 7", "0 to 6"});
  refused(drop(), [](Feature& f) { f.meshes[0].F.resize(0, 3); }, {"frame 0", "empty mesh"});
  refused(drop(), [&](Feature& f) { f.meshes[0].V(2, 2) = kNan; }, {"frame 0", "not finite"});
  expect_error([] { feature_library_bytes({drop(), drop()}); }, {"two features of the id 3"});
}

TEST_F(FeatureLibrary, RefusesOtherFiles) {
  expect_error([&] { read_feature_library(folder() / "none.h5"); }, {"none.h5", "no file"});
  expect_error([&] { read_feature_library(write("a.h5", "nothing")); }, {"a.h5", "no HDF5 file"});
  H5File other = H5File::create();
  other.root().write_attribute("kind", std::string("run"));
  other.save(folder() / "other.h5");
  expect_error([&] { read_feature_library(folder() / "other.h5"); }, {"no feature library"});
  const auto bytes = feature_library_bytes({ripple()});
  const std::string_view whole = test::text_of(bytes);
  for (const std::size_t part : {2, 4, 8}) {
    EXPECT_THROW(read_feature_library(write("cut.h5", whole.substr(0, whole.size() / part))),
                 Error);
  }
}

/// A library whose one feature has another set of data.
std::filesystem::path forged(const std::filesystem::path& file, std::int64_t schema,
                             std::int64_t frames, const std::vector<std::size_t>& map_extents) {
  H5File library = H5File::create();
  {
    H5Group root = library.root();
    root.write_attribute("kind", std::string("geoprior feature library"));
    root.write_attribute("schema_version", schema);
    H5Group feature = root.create_group("features").create_group("1");
    feature.write_attribute("name", std::string("forged"));
    feature.write_attribute("kind", std::string("differential"));
    feature.write_attribute("cell", 0.1);
    feature.write_attribute("frames", frames);
    feature.write_attribute("resolution", std::int64_t{2});
    feature.write_attribute("extent", 1.0);
    const std::vector<double> times{0}, none;
    feature.write_block<double>("times", {1}, times);
    feature.write_block<double>("area", {0}, none);
    feature.write_block<double>("volume", {0}, none);
    feature.write_block<double>(
        "placement", {1, 4, 4},
        std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    std::size_t count = 1;
    for (const std::size_t n : map_extents) count *= n;
    feature.write_block<float>("displacement", map_extents, std::vector<float>(count));
    feature.write_block<float>("alpha", {1, 2, 2}, std::vector<float>(4));
  }
  library.save(file);
  return file;
}

TEST_F(FeatureLibrary, RefusesForgedData) {
  const auto file = folder() / "forged.h5";
  EXPECT_EQ(read_feature_library(forged(file, 1, 1, {1, 2, 2, 3})).size(), 1U);
  expect_error([&] { read_feature_library(forged(file, 2, 1, {1, 2, 2, 3})); }, {"version 2"});
  expect_error(
      [&] {
        read_feature_library(forged(file, 1, 5, {1, 2, 2, 3}));
      },
      {"/features/1", "1 times", "5"});
  expect_error(
      [&] {
        read_feature_library(forged(file, 1, 1, {1, 2, 3, 3}));
      },
      {"displacement", "another size", "1 x 2 x 2 x 3"});
  expect_error(
      [&] {
        read_feature_library(forged(file, 1, 1, {2, 6}));
      },
      {"displacement", "2 extents", "4"});
}

using ExrMaps = test::ScratchFolder;

TEST_F(ExrMaps, GiveTheFeatureBackBitForBit) {
  const auto pictures = exr_maps(ripple(), "wake");
  ASSERT_EQ(pictures.size(), 3U);
  EXPECT_EQ(pictures[2].name, "wake_0002.exr");
  std::vector<std::filesystem::path> files;
  for (const Artifact& picture : pictures)
    files.push_back(write(picture.name, test::text_of(picture.bytes)));
  expect_equal(read_exr_maps(files), ripple());
  EXPECT_EQ(exr_maps(ripple(), "wake")[1].bytes, pictures[1].bytes);
  // Not the time of day, which would make each export another file.
  EXPECT_NE(test::text_of(pictures[0].bytes).find("1970:01:01 00:00:00"), std::string_view::npos);
}

TEST_F(ExrMaps, RefuseWhatIsNoMap) {
  expect_error([] { exr_maps(drop(), "drop"); }, {"feature 3", "isolated"});
  expect_error([] { read_exr_maps({}); }, {"no pictures"});
  expect_error([&] { read_exr_maps({write("a.exr", "nothing")}); },
               {"a.exr", "no readable picture"});
  const auto pipe = write("pipe.exr", "");
  std::filesystem::remove(pipe);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_error([&] { read_exr_maps({pipe}); }, {"pipe.exr", "is a pipe"});
  const auto pictures = exr_maps(ripple(), "a");
  const auto first = write("a_0000.exr", test::text_of(pictures[0].bytes));
  expect_error([&] { read_exr_maps({first, first}); }, {"frame 1", "times that increase"});
  Feature other = ripple();
  other.resolution = 4;
  for (MapFrame& map : other.maps) {
    map.displacement.conservativeResize(16, 3);
    map.alpha.conservativeResize(16);
  }
  const auto small = write("b.exr", test::text_of(exr_maps(other, "b")[1].bytes));
  expect_error([&] { read_exr_maps({first, small}); }, {"b.exr", "4 texels", "8, as the first"});
}

TEST(EditList, ReadsEditsInTheirOrder) {
  const auto edits = parse_edit_list(R"(
[[edit]]
name = "twice"
source = "boat"
ids = [3, 4]
move = [4, 0, 0]
scale = [2, 1, 1]
start = 1.5
trajectory = [{ t = 0, position = [0, 0, 0] }, { t = 1, position = [1, 0, 0] }]
[[edit]]
fade_in = 0.2
volume_lock = true
)",
                                     "edits.toml");
  ASSERT_EQ(edits.size(), 2U);
  EXPECT_EQ(edits[0].ids, (std::vector<double>{3, 4}));
  EXPECT_EQ(edits[0].scale[0], 2);
  EXPECT_EQ(edits[0].start, 1.5);
  ASSERT_EQ(edits[0].trajectory.size(), 2U);
  EXPECT_EQ(edits[0].trajectory[1].position[0], 1);
  EXPECT_FALSE(edits[1].start);
  EXPECT_TRUE(edits[1].volume_lock);
}

TEST(EditList, NamesFileAndLineOfAMistake) {
  const auto refused = [](const std::string& text, std::initializer_list<std::string> parts) {
    expect_error([&] { parse_edit_list(text, "edits.toml"); }, parts);
  };
  refused("[[edit]]\nmovee = [1, 0, 0]\n", {"edits.toml:2", "movee", "move"});
  refused("[[edit]]\n\nspeed = \"fast\"\n", {"edits.toml:3", "speed"});
  refused("[[edit]]\nmove = [1, 0]\n", {"edits.toml:2", "move"});
  refused("[[edit]]\nfade_in = -1\n", {"edits.toml:2", "fade_in", "between 0"});
  refused("[[edits]]\n", {"edits.toml:1", "edits", "edit"});
  refused("[[edit]\n", {"edits.toml:1"});
  refused("", {"edits.toml", "without edits"});
  refused("[[edit]]\n[[edit]]\nbox = [0, 0, 0]\n", {"edits.toml:2", "box"});
}

using EditListFiles = test::ScratchFolder;

TEST_F(EditListFiles, AreReadFromDisk) {
  EXPECT_EQ(read_edit_list(write("e.toml", "[[edit]]\nname = \"a\"\n")).at(0).name, "a");
  expect_error([&] { read_edit_list(folder() / "none.toml"); }, {"none.toml"});
}

}  // namespace
}  // namespace geoprior::fluid
