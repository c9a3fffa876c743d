// Layouts of XTrackCAD: small ones written here, and those that its package installs.

#include "experiments/assembly/files/xtrackcad.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/angles.h"
#include "core/mesh.h"
#include "experiments/assembly/files/xtrackcad_paths.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

using geoprior::test::expect_error;
using geoprior::test::ScratchFolder;

const std::string kLayoutHeader =
    "#XTrackCAD Version: 4.0.3a, Date: Sat Mar 30 12:00:00 2013\n\nVERSION 10 3.0.0\n"
    "TITLE1 Small\nSCALE HO\n";

std::string xtc_layout(const std::string& records) { return kLayoutHeader + records + "END\n"; }

/// A record of two ends; each is "T 2 x y angle" or "E x y angle".
std::string xtc_track(const std::string& first, const std::string& a, const std::string& b) {
  return first + "\n\t" + a + "\n\t" + b + "\n\tEND\n";
}

const std::string kXtcTwoStraights =
    xtc_track("STRAIGHT 1 0 0 0 0 HO 2", "E 0.0 1.0 270.0", "T 2 3.61 1.0 90.0") +
    xtc_track("STRAIGHT 2 0 0 0 0 HO 2", "T 1 3.61 1.0 270.0", "E 10.0 1.0 90.0");

/// To the left of its way, with the frog at (6, .5): ends at (0, 0), (8, 0) and (8, 1).
const std::string kXtcTurnout =
    "TURNOUT 7 0 0 0 0 HO 2 20.0 5.0 0 90.0 \"Maker\tLeft  Turnout\t1.5\"\" No 6\"\n"
    "\tE 20.0 5.0 0.0\n"
    "\tE 20.0 -3.0 180.0\n"
    "\tE 21.0 -3.0 166.0\n"
    "\tD 0.0 0.0\n"
    "\tP \"Normal\" 1 2\n"
    "\tP \"Reverse\" 1 -3 4\n"
    "\tS 0 0.0 0.0 0.0 2.0 0.0\n"
    "\tS 0 0.0 2.0 0.0 8.0 0.0\n"
    "\tS 0 0.0 6.0 0.5 2.0 0.0\n"
    "\tS 0 0.0 6.0 0.5 8.0 1.0\n"
    "\tEND\n";

ReadAssemblies read_layout(const std::string& text) {
  ReadAssemblies result;
  read_xtrackcad_text(text, "shed/small.xtc", result);
  require_valid(result.set);
  return result;
}

bool has_layout_warning(const ReadAssemblies& result, const std::string& part) {
  return std::any_of(
      result.warnings.begin(), result.warnings.end(),
      [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
}

void expect_inches(const Eigen::Vector3d& x, double inches_x, double inches_y) {
  EXPECT_NEAR(x.x(), kInch * inches_x, 1e-9);
  EXPECT_NEAR(x.y(), kInch * inches_y, 1e-9);
  EXPECT_NEAR(x.z(), 0, 1e-12);
}

TEST(Xtrackcad, TwoStraightsShareAPointAndFaceEachOther) {
  const ReadAssemblies result = read_layout(xtc_layout(kXtcTwoStraights));
  ASSERT_EQ(result.set.models.size(), 1U);
  const Assembly& model = result.set.models[0];
  EXPECT_EQ(model.name, "small");
  ASSERT_EQ(model.parts.size(), 2U);
  EXPECT_EQ(result.set.types[model.parts[0].type].label, "straight 3.61 in");
  EXPECT_EQ(result.set.types[model.parts[1].type].label, "straight 6.39 in");
  ASSERT_EQ(model.connections.size(), 1U);
  EXPECT_EQ(model.connections[0].a, (PortRef{0, 1}));
  EXPECT_EQ(model.connections[0].b, (PortRef{1, 0}));
  const std::vector<Misfit> misfits = joint_misfits(model, result.set.types);
  EXPECT_NEAR(misfits[0].translation, 0, 1e-12);
  EXPECT_NEAR(misfits[0].angle, 0, 1e-7);
  EXPECT_TRUE(result.warnings.empty());
}

TEST(Xtrackcad, AFirstPortLooksOutOfThePartAgainstItsXAxis) {
  const ReadAssemblies result = read_layout(xtc_layout(kXtcTwoStraights));
  const Assembly& model = result.set.models[0];
  expect_inches(model.parts[1].pose.translation(), 3.61, 1);
  EXPECT_NEAR((model.parts[1].pose.linear() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
  const Pose first = port_pose(model, result.set.types, {1, 0});
  EXPECT_NEAR((first.linear().col(0) + Eigen::Vector3d::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((first.linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
}

TEST(Xtrackcad, ATurnoutsWaysFollowItsPathsFromPortToPort) {
  const ReadAssemblies result = read_layout(xtc_layout(kXtcTurnout));
  ASSERT_EQ(result.set.types.size(), 1U);
  const PartType& type = result.set.types[0];
  EXPECT_EQ(type.label, "Maker Left Turnout 1.5\" No 6");
  ASSERT_EQ(type.ports.size(), 3U);
  expect_inches(type.ports[1].frame.translation(), 8, 0);
  expect_inches(type.ports[2].frame.translation(), 8, 1);
  const Eigen::Vector3d out = type.ports[2].frame.linear().col(0);
  EXPECT_NEAR(std::atan2(out.y(), out.x()), 14 * kDegree, 1e-9);
  ASSERT_EQ(type.ways.size(), 2U);
  EXPECT_EQ(type.ways[0].to, 1);
  EXPECT_EQ(type.ways[1].from, 0);
  EXPECT_EQ(type.ways[1].to, 2);
  ASSERT_EQ(type.ways[1].points.size(), 4U);
  expect_inches(type.ways[1].points[1], 2, 0);
  expect_inches(type.ways[1].points[2], 6, .5);
  expect_inches(type.ways[1].points[3], 8, 1);
}

TEST(Xtrackcad, APathThatDoesNotMeetTheEndsGivesStraightWays) {
  std::string text = kXtcTurnout;
  text.replace(text.find("1 -3 4"), 6, "1 -3 9");
  const PartType type = read_layout(xtc_layout(text)).set.types[0];
  ASSERT_EQ(type.ways.size(), 2U);
  EXPECT_EQ(type.ways[1].to, 2);
  EXPECT_EQ(type.ways[1].points.size(), 2U);
}

/// A quarter of a circle of 18 inches about (0, 0), from the east to the north or back.
std::string xtc_quarter(int id, bool from_east) {
  const std::string east = "E 18.0 0.0 180.0", north = "E 0.0 18.0 270.0";
  return xtc_track("CURVE " + std::to_string(id) + " 0 0 0 0 HO 2 0.0 0.0 0 18.0 0 0.0 0.0",
                   from_east ? east : north, from_east ? north : east);
}

TEST(Xtrackcad, ACurveHasTheSamePortsWhicheverEndTheFileNamesFirst) {
  for (const bool from_east : {true, false}) {
    const ReadAssemblies result = read_layout(xtc_layout(xtc_quarter(1, from_east)));
    const PartType& type = result.set.types[0];
    EXPECT_EQ(type.label, "curve r 18.00 in 90.0 deg");
    expect_inches(type.ports[1].frame.translation(), 18, 18);
    const Eigen::Vector3d out = type.ports[1].frame.linear().col(0);
    EXPECT_NEAR((out - Eigen::Vector3d::UnitY()).norm(), 0, 1e-9) << "turns to the left";
    ASSERT_EQ(type.ways.size(), 1U);
    EXPECT_EQ(type.ways[0].points.size(), 19U) << "5 degrees a step";
    for (const Eigen::Vector3d& x : type.ways[0].points)
      EXPECT_NEAR((x - Eigen::Vector3d(0, 18 * kInch, 0)).norm(), 18 * kInch, 1e-9);
  }
}

TEST(Xtrackcad, ACurveOverHalfATurnIsNotTakenForItsComplement) {
  const ReadAssemblies result = read_layout(xtc_layout(xtc_track(
      "CURVE 1 0 0 0 0 HO 2 0.0 0.0 0 18.0 0 0.0 0.0", "E 18.0 0.0 180.0", "E 0.0 -18.0 270.0")));
  EXPECT_EQ(result.set.types[0].label, "curve r 18.00 in 270.0 deg");
  EXPECT_EQ(result.set.types[0].ways[0].points.size(), 55U);
}

TEST(Xtrackcad, AJointMeetsBothEndsInTheirDirections) {
  const ReadAssemblies result = read_layout(xtc_layout(xtc_track(
      "JOINT 1 0 0 0 0 HO 2 0 0 0 0 0 0 0 0 0 0 0", "E 0.0 0.0 270.0", "E 10.0 0.5 80.0")));
  const PartType& type = result.set.types[0];
  EXPECT_EQ(type.label, "joint 10.00 in offset 0.50 in");
  const std::vector<Eigen::Vector3d>& x = type.ways[0].points;
  EXPECT_LT(std::abs((x[1] - x[0]).y()), .05 * (x[1] - x[0]).x());
  const Eigen::Vector3d last = x[x.size() - 1] - x[x.size() - 2];
  EXPECT_NEAR(std::atan2(last.y(), last.x()), 10 * kDegree, 1.5 * kDegree);
}

TEST(Xtrackcad, ATurntablesWaysEndInItsMiddle) {
  const ReadAssemblies result = read_layout(xtc_layout(
      xtc_track("TURNTABLE 1 0 0 0 0 HO 2 5.0 5.0 0 4.5 0", "E 5.0 9.5 0.0", "E 9.5 5.0 90.0")));
  const PartType& type = result.set.types[0];
  EXPECT_EQ(type.label, "turntable r 4.50 in");
  ASSERT_EQ(type.ways.size(), 2U);
  for (const Way& way : type.ways) {
    EXPECT_EQ(way.to, Way::kInside);
    expect_inches(way.points.back(), 4.5, 0);
  }
}

TEST(Xtrackcad, BodiesAreClosedPrismsAsWideAsTheGauge) {
  const ReadAssemblies result = read_layout(xtc_layout(kXtcTwoStraights));
  const PartType& type = result.set.types[0];
  constexpr double kGauge = 16.5e-3;
  EXPECT_NEAR(signed_volume(type.mesh.V, type.mesh.F), 3.61 * kInch * kGauge * .3 * kGauge, 1e-12);
  ASSERT_EQ(type.boxes.size(), 1U);
  EXPECT_NEAR(type.boxes[0].half.x(), 3.61 * kInch / 2, 1e-9);
  EXPECT_NEAR(type.boxes[0].half.y(), kGauge, 1e-12);
  EXPECT_NEAR(type.boxes[0].half.z(), .15 * kGauge, 1e-12);
  const PartType curve = read_layout(xtc_layout(xtc_quarter(1, true))).set.types[0];
  EXPECT_EQ(curve.boxes.size(), 8U);
  // The prism's cross section swept along the arc; chords of 5 degrees are shorter by 3e-4.
  EXPECT_NEAR(signed_volume(curve.mesh.V, curve.mesh.F) /
                  (90 * kDegree * 18 * kInch * kGauge * .3 * kGauge),
              1, 2e-3);
}

TEST(Xtrackcad, PartsThatDifferUnderOneLabelAreOfFurtherTypes) {
  const std::string bent =
      xtc_track("STRAIGHT 1 0 0 0 0 HO 2", "E 0.0 0.0 270.0", "E 3.61 0.0 90.0") +
      xtc_track("STRAIGHT 2 0 0 0 0 HO 2", "E 0.0 1.0 270.0", "E 3.612 1.0 90.4") +
      xtc_track("STRAIGHT 3 0 0 0 0 HO 2", "E 0.0 2.0 270.0", "E 3.61 2.0 91.0") +
      xtc_track("STRAIGHT 4 0 0 0 0 N 2", "E 0.0 3.0 270.0", "E 3.61 3.0 90.0") +
      xtc_track("STRAIGHT 5 0 0 0 0 N 2", "E 0.0 4.0 270.0", "E 3.61 4.0 90.0");
  ReadAssemblies result = read_layout(xtc_layout(bent));
  // The same layout again finds all its types.
  read_xtrackcad_text(xtc_layout(bent), "again.xtc", result);
  ASSERT_EQ(result.set.types.size(), 3U);
  EXPECT_EQ(result.set.types[1].label, "straight 3.61 in (2)");
  EXPECT_EQ(result.set.types[2].label, "straight 3.61 in (3)");
  for (const Assembly& model : result.set.models) {
    std::vector<int> types;
    for (const PlacedPart& part : model.parts) types.push_back(part.type);
    EXPECT_EQ(types, (std::vector<int>{0, 0, 1, 2, 2}));
  }
}

TEST(Xtrackcad, EndsThatNameTwoJoinsAreJoinedByDistance) {
  const ReadAssemblies result = read_layout(
      xtc_layout(xtc_track("STRAIGHT 1 0 0 0 0 HO 2", "T 2 0.0 0.0 270.0", "T 2 5.0 0.0 90.0") +
                 xtc_track("CURVE 2 0 0 0 0 HO 2 2.5 5.0 0 5.59 0 0 0", "T 1 5.0 0.1 270.0",
                           "T 1 0.1 0.0 90.0")));
  const Assembly& model = result.set.models[0];
  ASSERT_EQ(model.connections.size(), 2U);
  for (const Misfit& misfit : joint_misfits(model, result.set.types))
    EXPECT_NEAR(misfit.translation, .1 * kInch, 1e-9);
}

TEST(Xtrackcad, EndsThatAreNotNamedBackStayOpenWithAWarning) {
  const ReadAssemblies result = read_layout(
      xtc_layout(xtc_track("STRAIGHT 1 0 0 0 0 HO 2", "T 99 0.0 0.0 270.0", "T 2 5.0 0.0 90.0") +
                 xtc_track("STRAIGHT 2 0 0 0 0 HO 2", "E 5.0 0.0 270.0", "E 9.0 0.0 90.0")));
  EXPECT_TRUE(result.set.models[0].connections.empty());
  EXPECT_TRUE(has_layout_warning(result, "layout 'small.xtc': ends left open"));
  EXPECT_TRUE(has_layout_warning(result, "name them back: 2"));
}

TEST(Xtrackcad, ATrackJoinedWithItselfIsWarnedOf) {
  const std::string first = "STRAIGHT 1 0 0 0 0 HO 2";
  const ReadAssemblies both =
      read_layout(xtc_layout(xtc_track(first, "T 1 0.0 0.0 270.0", "T 1 5.0 0.0 90.0")));
  EXPECT_EQ(both.set.models[0].connections.size(), 1U);
  EXPECT_TRUE(has_layout_warning(both, "joined with themselves: 1"));
  const ReadAssemblies one =
      read_layout(xtc_layout(xtc_track(first, "T 1 0.0 0.0 270.0", "E 5.0 0.0 90.0")));
  EXPECT_TRUE(one.set.models[0].connections.empty());
  EXPECT_TRUE(has_layout_warning(one, "joined with themselves: 1"));
  EXPECT_TRUE(has_layout_warning(one, "name them back: 1"));
}

TEST(Xtrackcad, TracksThatLieOnOneAnotherAreLiftedApart) {
  const ReadAssemblies result =
      read_layout(xtc_layout(xtc_quarter(1, true) + xtc_quarter(2, false)));
  EXPECT_TRUE(has_layout_warning(result, "lifted by .01 mm: 1"));
  EXPECT_EQ(result.set.types.size(), 1U);
}

TEST(Xtrackcad, WhatIsNoTrackIsCountedInOneWarning) {
  const ReadAssemblies result = read_layout(
      xtc_layout("LAYERS 0 1 0 1 255 0 0 0 0 \"Main\"\n"
                 "DRAW 3 0 0 0 0 0 0 0 0\n\tL3 0 0 1 2 0 3 4 0\n\tF3 0 0 1\n\t\t1 2 0\n\tEND\n"
                 "CAR 1 HO \"Maker\tBox car\" 3 10301 7 1 0 0\n\tE 1 2 270\n\tT 9 3 4 90\n\tEND\n"
                 "DRAW 4 0 0 0 0 0 0 0 0\n\tEND\nHELIPAD 5 0\n\tEND\n" +
                 kXtcTwoStraights));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0], "layout 'small.xtc': left out 2 DRAW, 1 CAR, 1 HELIPAD, 1 LAYERS");
}

TEST(Xtrackcad, TextOfNotesIsNoRecord) {
  const std::string note = "NOTE MAIN 0 0 0 0 60\nSTRAIGHT 1\nEND\n\tEND\nVERSION 99\n    END\n";
  const ReadAssemblies result = read_layout(xtc_layout(note + kXtcTwoStraights));
  EXPECT_EQ(result.set.models[0].parts.size(), 2U);
  EXPECT_TRUE(has_layout_warning(result, "left out 1 NOTE"));
}

TEST(Xtrackcad, TitlesInLatin1BecomeUtf8) {
  std::string text = kXtcTurnout;
  text.replace(text.find("Left"), 4, "30\xB0");
  EXPECT_EQ(read_layout(xtc_layout(text)).set.types[0].label,
            "Maker 30\xC2\xB0 Turnout 1.5\" No 6");
}

TEST(Xtrackcad, AnUnknownScaleIsWarnedOf) {
  std::string text = kXtcTurnout;
  text.replace(text.find("HO"), 2, "Q7");
  EXPECT_TRUE(has_layout_warning(read_layout(xtc_layout(text)), "unknown scale 'Q7'"));
}

TEST(Xtrackcad, ErrorsNameFileAndLine) {
  const auto expect = [](const std::string& text, std::initializer_list<std::string> parts) {
    ReadAssemblies result;
    expect_error([&] { read_xtrackcad_text(text, "small.xtc", result); }, parts);
  };
  expect("VERSION 12 5.2.0\nEND\n", {"small.xtc:1", "is of a newer version 12", "7 to 10"});
  expect("VERSION 2\nEND\n", {"small.xtc:1", "is of an older version 2"});
  expect("VERSION ten\nEND\n", {"small.xtc:1", "'ten'"});
  expect("", {"small.xtc:1", "has no VERSION"});
  expect("#XTrackCAD\n" + kXtcTwoStraights, {"small.xtc:2", "before any VERSION"});
  expect(xtc_layout(kXtcTwoStraights +
                    xtc_track("CURVE 2 0 0 0 0 HO 2 0 0 0 5 0 0 0", "E 0 0 0", "E 1 1 1")),
         {"small.xtc:14", "a second track of the number 2", "small.xtc:10"});
  expect(xtc_layout(xtc_track("STRAIGHT 1 0 0 0 0 HO 2", "E 0 nan 0", "E 1 1 1")),
         {"small.xtc:7", "'nan' is no finite number"});
  expect(xtc_layout(xtc_track("STRAIGHT 1 0 0 0 0 HO 2", "E 0 1e300 0", "E 1 1 1")),
         {"small.xtc:7", "1e300", "1e7"});
  expect(xtc_layout(xtc_track("STRAIGHT 1 0 0 0 0 HO 2", "E 0 0", "E 1 1 1")),
         {"small.xtc:7", "has 3 of 4 words"});
  expect(xtc_layout("STRAIGHT 1 0 0 0 0 HO 2\n\tE 0 0 0\n\tEND\n"), {"small.xtc:6", "has 1 ends"});
  expect(xtc_layout("TURNOUT 1 0 0 0 0 HO 2 0 0 0 0 \"Atlas\n\tE 0 0 0\n\tEND\n"),
         {"small.xtc:6", "without a title"});
}

TEST(Xtrackcad, AFileCutAnywhereIsAnError) {
  const std::string whole =
      xtc_layout(kXtcTwoStraights + "NOTE MAIN 0 0 0 0 9\nStations\n    END\n");
  // Without its last line end the text still has its last END.
  for (std::size_t size = 0; size + 1 < whole.size(); ++size) {
    ReadAssemblies result;
    EXPECT_THROW(read_xtrackcad_text(whole.substr(0, size), "small.xtc", result), Error) << size;
  }
  ReadAssemblies result;
  expect_error(
      [&] { read_xtrackcad_text(whole.substr(0, whole.find("\tT 1")), "small.xtc", result); },
      {"small.xtc:10", "within the track of small.xtc:10", "cut"});
}

class XtrackcadFiles : public ScratchFolder {};

TEST_F(XtrackcadFiles, LineEndsOfWindowsAreRead) {
  std::string text;
  for (const char c : xtc_layout(kXtcTwoStraights))
    text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const std::filesystem::path file = write("windows.xtc", text);
  const ReadAssemblies result = read_xtrackcad({file});
  EXPECT_EQ(result.set.models[0].name, "windows");
  EXPECT_EQ(result.set.models[0].connections.size(), 1U);
  EXPECT_EQ(result.files, std::vector<std::filesystem::path>{file});
  expect_error([&] { read_xtrackcad({folder() / "none.xtc"}); }, {"none.xtc"});
  expect_error([&] { read_xtrackcad({folder()}); }, {folder().string()});
}

/// The layouts that Debian's package xtrkcad-common installs, in the order of their names.
std::vector<std::filesystem::path> installed_layouts() {
  const std::filesystem::path folder = "/usr/share/xtrkcad/examples";
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".xtc") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Xtrackcad, ReadsTheInstalledLayoutsWithJointsThatMeet) {
  const std::vector<std::filesystem::path> files = installed_layouts();
  if (files.empty()) GTEST_SKIP() << "xtrkcad-common is not installed";
  const ReadAssemblies result = read_xtrackcad(files);
  require_valid(result.set);
  ASSERT_EQ(result.set.models.size(), files.size());
  std::size_t joints = 0, beyond_tenth = 0;
  for (const Assembly& model : result.set.models) {
    const std::string& name = model.name;
    std::set<int> types;
    for (const PlacedPart& part : model.parts) types.insert(part.type);
    if (name == "timesavr") {
      EXPECT_EQ(model.parts.size(), 20U);
    }
    if (name == "3oval8_mrklnhomde_v1_2013_03") {
      EXPECT_EQ(model.parts.size(), 202U);
      EXPECT_EQ(types.size(), 27U);
    }
    if (name == "cascade") {
      EXPECT_EQ(model.parts.size(), 894U);
    }
    for (const Misfit& misfit : joint_misfits(model, result.set.types)) {
      ++joints;
      if (misfit.translation > .1 * kInch) ++beyond_tenth;
      // What hobbyists left open in these layouts at the worst: .27 inch and 2.15 degrees.
      EXPECT_LT(misfit.translation, .3 * kInch) << name;
      EXPECT_LT(misfit.angle, 2.2 * kDegree) << name;
    }
  }
  EXPECT_LT(beyond_tenth, joints / 50);
}

}  // namespace
}  // namespace geoprior::assembly
