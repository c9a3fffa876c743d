// What is drawn along the lips of tears: the line that they share, the band on one of them, fibres.

#include "models/paper/tear/lip_detail.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "baselines/paper/dense.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/tear/growth.h"
#include "solvers/paper/hybrid.h"
#include "testbed/runner/options/toml.h"
#include "tests/paper/sheets.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using test::Recording;

using Eigen::Vector2d;

/// An arc of radius 0.06 m and the given length, torn in steps of 2 mm from the lower side of a
/// sheet of 0.2 m by 0.2 m; sheared out of the plane.
Tears bent_tear(double length, double shear) {
  Tears tears(rectangle_pattern(0.2, 0.2), 1e-4);
  const Vector2d start(-0.03, -0.1);
  const int tear = tears.start(start, 0);
  constexpr double kStep = 2e-3, kRadius = 0.06;
  const int steps = static_cast<int>(std::lround(length / kStep));
  for (int i = 1; i <= steps; ++i) {
    const double angle = i * kStep / kRadius;
    tears.advance(tear, start + kRadius * Vector2d(1 - std::cos(angle), std::sin(angle)), i);
    tears.note_pull(tear, {0, 1}, kStep, shear);
  }
  return tears;
}

/// The sheet, flat and open along the tear.
ShellState open_sheet(const Tears& tears) {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  sheet.pattern = tears.torn();
  return resting_state(sheet, lattice_mesh(tears.torn(), 0.02, UniformLayout::equilateral, {}, 1),
                       1);
}

Frame detail_of(const Tears& tears, const LipDetailOptions& options, std::uint64_t seed = 1) {
  Frame frame;
  add_lip_detail(tears, options, seed, open_sheet(tears), frame);
  return frame;
}

const Eigen::MatrixXd& points_of(const Part& part, const char* name, int components) {
  return part.require_array(name, NamedArray::On::points, components).values;
}

/// Area in the pattern, of one lip, and of the band or of all else (m^2).
double strip_area(const Part& part, int lip, bool band) {
  const Eigen::MatrixXd& pattern = points_of(part, "pattern", 2);
  const Eigen::MatrixXd& lips = points_of(part, "lip", 1);
  const auto& bevel = part.require_array("bevel", NamedArray::On::cells, 1).values;
  double sum = 0;
  for (Eigen::Index f = 0; f < part.triangles.rows(); ++f) {
    const Eigen::RowVector3i t = part.triangles.row(f);
    if (lips(t[0], 0) != lip || (bevel(f, 0) != 0) != band) continue;
    const Vector2d a = pattern.row(t[0]), b = pattern.row(t[1]), c = pattern.row(t[2]);
    sum += cross(b - a, c - a) / 2;
  }
  return sum;
}

TEST(LipDetail, WhatOneLipGainsTheOtherLacks) {
  const Tears tears = bent_tear(0.08, 0);
  const LipDetailOptions options;
  const auto line = torn_line(tears.all()[0], options, lip_seed(1, 0));
  std::set<int> gaining;
  for (const TornPoint& p : line) {
    EXPECT_EQ(std::min(p.gain(0), p.gain(1)), 0);
    EXPECT_EQ(p.gain(1) - p.gain(0), p.displacement);
    if (p.displacement != 0) gaining.insert(p.displacement > 0 ? 1 : 0);
  }
  EXPECT_EQ(gaining.size(), 2U);
  // The strips of both lips have the area between the way of the tip and the torn line.
  double area = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d a = line[i - 1].place, b = line[i].place;
    const Vector2d c = b + line[i].displacement * line[i].left;
    const Vector2d d = a + line[i - 1].displacement * line[i - 1].left;
    area += std::abs(cross(b - a, c - a) + cross(c - a, d - a)) / 2;
  }
  const Frame frame = detail_of(tears, options);
  const Part& detail = frame.require_part("lip_detail", Part::Kind::triangles);
  const double left = strip_area(detail, 0, false), right = strip_area(detail, 1, false);
  EXPECT_GT(left, 0);
  EXPECT_GT(right, 0);
  EXPECT_NEAR(left + right, area, 1e-12);
}

TEST(LipDetail, TornLineStaysWithinTheNoiseAndIsNobodysOnTheMean) {
  const Tears tears = bent_tear(0.08, 0);
  const LipDetailOptions options;
  double sum = 0, squares = 0, most = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto line = torn_line(tears.all()[0], options, lip_seed(seed, 0));
    EXPECT_EQ(line.front().displacement, 0);  // where it began, and at the tip
    EXPECT_EQ(line.back().displacement, 0);
    for (const TornPoint& p : line) {
      sum += p.displacement;
      squares += p.displacement * p.displacement;
      most = std::max(most, std::abs(p.displacement));
      ++count;
    }
  }
  EXPECT_LE(most, options.noise);
  EXPECT_GT(most, 0.6 * options.noise);
  const double deviation = std::sqrt(squares / count);
  // Waves of 2 mm: 200 lines of 80 mm have some 8,000 numbers of their own; four standard errors.
  EXPECT_LT(std::abs(sum / count), 4 * deviation / std::sqrt(8000));
  EXPECT_GT(deviation, 0.15 * options.noise);
}

TEST(LipDetail, TornLineKeepsWhatItWasWhenTheTearGrows) {
  const LipDetailOptions options;
  Tears tears = bent_tear(0.04, 0.5);
  const auto before = torn_line(tears.all()[0], options, lip_seed(1, 0));
  for (int i = 1; i < 10; ++i) {  // on, sheared the other way
    tears.advance(0, tears.all()[0].tip() + Vector2d(1e-3, 1e-3), 100 + i);
    tears.note_pull(0, {1, 1}, 1.4e-3, -0.5);
  }
  const auto after = torn_line(tears.all()[0], options, lip_seed(1, 0));
  EXPECT_EQ(after.back().bevel_lip, 1);
  for (std::size_t i = 0; before[i].length < 0.04 - LipDetailOptions::kWave; ++i) {
    ASSERT_NEAR(before[i].length, after[i].length, 1e-15);
    EXPECT_NEAR(before[i].displacement, after[i].displacement, 1e-15);
    EXPECT_EQ(before[i].bevel_lip, after[i].bevel_lip);
  }
}

TEST(LipDetail, BandLiesOnTheLipThatWasPulledUp) {
  const LipDetailOptions options;
  for (const double shear : {-0.5, 0.5}) {
    const int lip = shear > 0 ? 0 : 1;
    const Frame frame = detail_of(bent_tear(0.08, shear), options);
    const Part& detail = frame.parts.at("lip_detail");
    EXPECT_EQ(strip_area(detail, 1 - lip, true), 0);
    EXPECT_GT(strip_area(detail, lip, true), 0.4 * 0.07 * options.bevel);
    EXPECT_LT(strip_area(detail, lip, true), 0.08 * (options.bevel + options.noise));
  }
  const Frame plane = detail_of(bent_tear(0.08, 0), options);
  for (const int lip : {0, 1}) EXPECT_EQ(strip_area(plane.parts.at("lip_detail"), lip, true), 0);
}

TEST(LipDetail, FibresLeaveTheirLipWithinTheConeAndTheLength) {
  const Tears tears = bent_tear(0.08, 0);
  const LipDetailOptions options;
  const auto fibres = lip_fibres(tears.all()[0], options, lip_seed(1, 0));
  EXPECT_NEAR(static_cast<double>(fibres.size()), 2 * 0.08 / LipDetailOptions::kFibreSpacing, 6);
  double most = 0;
  for (const Fibre& fibre : fibres) {
    const Vector2d out = fibre.lip == 0 ? Vector2d(-fibre.at.left) : fibre.at.left;
    const Vector2d strand = fibre.end - fibre.root;
    const double lean = std::abs(signed_angle(out, strand)) / kDegree;
    most = std::max(most, lean);
    EXPECT_LE(lean, LipDetailOptions::kFibreSpreadDeg + 1e-9);
    EXPECT_GE(strand.norm(), 0.3 * options.fibre_length - 1e-12);
    EXPECT_LE(strand.norm(), options.fibre_length + 1e-12);
    EXPECT_NEAR((fibre.root - fibre.at.place).dot(out), fibre.at.gain(fibre.lip), 1e-15);
  }
  EXPECT_GT(most, 20);
  // A flat sheet has them where the pattern has.
  const Frame frame = detail_of(tears, options);
  const Part& part = frame.require_part("fibres", Part::Kind::lines);
  ASSERT_EQ(part.lines.size(), fibres.size());
  for (std::size_t i = 0; i < fibres.size(); ++i) {
    const Eigen::RowVector3d end = part.points.row(part.lines[i][1]);
    EXPECT_NEAR((end.head<2>().transpose() - fibres[i].end).norm(), 0, 1e-12);
    EXPECT_NEAR(end.z(), 0, 1e-12);
  }
}

TEST(LipDetail, ATearWithoutLengthAndACutHaveNone) {
  Pattern pattern = rectangle_pattern(0.2, 0.2);
  pattern.cuts = {{{0, -0.1}, {0.01, -0.05}, {0, 0}}};
  Tears tears(pattern, 1e-4);
  tears.start({0.05, -0.1}, 0.1);
  for (const Tear& tear : tears.all()) {
    EXPECT_TRUE(torn_line(tear, {}, 1).empty());
    EXPECT_TRUE(lip_fibres(tear, {}, 1).empty());
  }
  const Frame frame = detail_of(tears, {});
  EXPECT_EQ(frame.parts.at("lip_detail").points.rows(), 0);
  EXPECT_EQ(frame.parts.at("fibres").lines.size(), 0U);
  // Where the cut goes on as a tear, the detail begins at its end.
  tears.advance(0, {0, 0.02}, 0.2);
  EXPECT_EQ(torn_line(tears.all()[0], {}, 1).front().place, Vector2d(0, 0));
}

TEST(LipDetail, SameSeedSameBytes) {
  const Tears tears = bent_tear(0.08, 0.5);
  const Frame once = detail_of(tears, {}, 7), again = detail_of(tears, {}, 7);
  const Frame other = detail_of(tears, {}, 8);
  for (const char* name : {"lip_detail", "fibres"}) {
    EXPECT_EQ(once.parts.at(name).points, again.parts.at(name).points);
    EXPECT_EQ(once.parts.at(name).triangles, again.parts.at(name).triangles);
    EXPECT_NE(points_of(once.parts.at(name), "pattern", 2).topRows(6),
              points_of(other.parts.at(name), "pattern", 2).topRows(6));
  }
  EXPECT_NE(lip_seed(7, 0), lip_seed(7, 1));
}

TEST(LipDetail, RefusesOptionsOutOfRange) {
  for (const char* key : {"noise", "fibre_length", "bevel"}) {
    for (const char* value : {"nan", "-0.001", "inf"}) {
      const std::string toml = std::string("detail = { ") + key + " = " + value + " }\n";
      TearOptions options;
      EXPECT_THAT([&] { read_options(parse_toml_text(toml, "file.toml"), "tearing", options); },
                  testing::ThrowsMessage<Error>(testing::HasSubstr(key)))
          << toml;
    }
  }
  LipDetailOptions none;
  none.noise = none.fibre_length = none.bevel = 0;
  const Frame frame = detail_of(bent_tear(0.08, 0.5), none);
  EXPECT_EQ(frame.parts.at("lip_detail").triangles.rows(), 0);
  EXPECT_EQ(frame.parts.at("fibres").lines.size(), 0U);
}

/// The legs of a small trouser pulled up and down: a tear sheared out of the plane.
Sheet trouser_sheet() {
  Sheet sheet = sheets::free_sheet(0.06, 0.12);
  sheet.pattern.cuts = {{{0, -0.06}, {0, 0}}};
  sheet.imperfection = 1e-5;
  sheet.toughness.energy = 1e4;
  sheet.duration = 1;
  sheet.handle_step = 5e-4;
  sheet.substeps = 4;
  for (const double side : {-1.0, 1.0}) {
    Keyframe start, end;
    end.time = 1;
    end.shift = Eigen::Vector3d(0, 0.045, -side * 0.07);
    sheet.handles.push_back(sheets::point_handle(
        side < 0 ? "left" : "right", {{side * 0.025, -0.06}, {side * 0.005, -0.06}}, {start, end}));
  }
  return sheet;
}

class LipDetailOf : public testing::TestWithParam<const char*> {
 protected:
  static Recording run(bool on) {
    static const Sheet sheet = trouser_sheet();
    Recording recording;
    RunContext context(1);
    if (std::string(GetParam()) == "dense") {
      DenseOptions options;
      options.triangles = 200;
      options.tearing.detail.on = on;
      make_dense_sheet(sheet, options)->run(recording, context, {});
    } else {
      HybridOptions options;
      options.tearing.detail.on = on;
      make_hybrid_sheet(sheet, options)->run(recording, context, {});
    }
    return recording;
  }
};

TEST_P(LipDetailOf, LeavesTheSheetAsItIs) {
  const Recording with = run(true), without = run(false);
  ASSERT_EQ(with.frames.size(), without.frames.size());
  for (std::size_t i = 0; i < with.frames.size(); ++i) {
    const Frame &a = with.frames[i], &b = without.frames[i];
    EXPECT_EQ(a.parts.at("surface").points, b.parts.at("surface").points);
    EXPECT_EQ(a.parts.at("surface").triangles, b.parts.at("surface").triangles);
    EXPECT_EQ(a.diagnostics, b.diagnostics);
    EXPECT_EQ(a.parts.count("lip_detail") + a.parts.count("fibres"), 2U);
    EXPECT_EQ(b.parts.count("lip_detail") + b.parts.count("fibres"), 0U);
    EXPECT_EQ(with.checkpoints[i], without.checkpoints[i]);
  }
  // The left leg goes up: the band is on the left lip, and nowhere on the right one.
  const Frame& last = with.frames.back();
  ASSERT_GT(last.diagnostics.at("tear_length"), 0.07);
  const Part& detail = last.parts.at("lip_detail");
  EXPECT_TRUE(detail.points.allFinite());
  EXPECT_GT(strip_area(detail, 0, true), 0);
  EXPECT_EQ(strip_area(detail, 1, true), 0);
  // Nothing is far from the tear.
  const Part& tears = last.parts.at("tears");
  for (const char* name : {"lip_detail", "fibres"}) {
    const Eigen::MatrixX3d& points = last.parts.at(name).points;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      EXPECT_LT((tears.points.rowwise() - points.row(i)).rowwise().norm().minCoeff(), 4e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, LipDetailOf, testing::Values("dense", "hybrid"),
                         [](const auto& of) { return std::string(of.param); });

}  // namespace
}  // namespace geoprior::paper
