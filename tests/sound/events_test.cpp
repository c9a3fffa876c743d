#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "core/error.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/sound/events/detector.h"
#include "tests/paper/meshes.h"
#include "tests/sound/all_events.h"

namespace geoprior::sound {
namespace {

constexpr double kWidth = 0.2, kHeight = 0.3;

Sheet a_sheet() {
  Sheet sheet;
  sheet.pattern = paper::rectangle_pattern(kWidth, kHeight);
  return sheet;
}

/// The sheet rolled to a curvature about an axis that is turned by `angle` from the v axis.
SheetSnapshot rolled_at(const ShellMesh& mesh, double time, double curvature, double angle = 0) {
  SheetSnapshot frame;
  frame.time = time;
  frame.mesh = mesh;
  frame.x =
      paper::meshes::rolled(mesh.pattern, std::abs(curvature) < 1e-9 ? 1e-9 : curvature, angle);
  return frame;
}

ShellMesh a_mesh(const Sheet& sheet, int triangles = 1500) {
  return paper::uniform_mesh(sheet.pattern, triangles, paper::UniformLayout::delaunay, {}, 1);
}

/// A sheet whose curvature is a function of time.
std::vector<SheetSnapshot> motion(const ShellMesh& mesh, double until, double interval,
                                  const std::function<double(double)>& curvature) {
  std::vector<SheetSnapshot> frames;
  for (int i = 0; i * interval <= until + 1e-9; ++i) {
    frames.push_back(rolled_at(mesh, i * interval, curvature(i * interval)));
  }
  return frames;
}

TEST(SoundGrid, CoversThePatternWithCells) {
  const SoundGrid grid = sound_grid(paper::rectangle_pattern(0.21, 0.297), 3.3e-3);
  EXPECT_EQ(grid.columns, 64);
  EXPECT_EQ(grid.rows, 90);
  EXPECT_EQ(grid.at(grid.centre(1234)), 1234);
  EXPECT_THROW(sound_grid(paper::rectangle_pattern(0.21, 0.297), 0.5), Error);
  EXPECT_THROW(sound_grid(paper::rectangle_pattern(0.21, 0.297), 0), Error);
}

TEST(SoundGrid, SeesTheCurvatureAndRulingsOfACylinderOnEveryMesh) {
  const Sheet sheet = a_sheet();
  const double angle = 0.4, curvature = -8;
  for (const int triangles : {400, 3000}) {
    const ShellMesh mesh = a_mesh(sheet, triangles);
    SheetSampler sampler(sound_grid(sheet.pattern, 5e-3), 4e-3);
    const SheetField field = sampler.sample(rolled_at(mesh, 0, curvature, angle));
    const Eigen::Vector2d along(-std::sin(angle), std::cos(angle));
    for (int c = 0; c < sampler.grid().count(); ++c) {
      EXPECT_NEAR(field.curvature[c], curvature, 0.15 * std::abs(curvature));
      EXPECT_GT(std::abs(field.ruling.row(c).dot(along)), std::cos(0.15));
    }
  }
}

TEST(SoundGrid, BorderIsAsLongAsThePatterns) {
  const Sheet sheet = a_sheet();
  SheetSampler sampler(sound_grid(sheet.pattern, 5e-3), 0);
  const SheetField field = sampler.sample(rolled_at(a_mesh(sheet), 0, 5));
  double length = 0;
  for (const BorderStretch& stretch : field.border) length += stretch.length;
  EXPECT_NEAR(length, 2 * (kWidth + kHeight), 1e-12);
}

TEST(SoundGrid, LipsSeparateCells) {
  Sheet sheet = a_sheet();
  sheet.pattern.cuts = {{{0.0012, -kHeight / 2}, {0.0012, 0}}};
  const ShellMesh mesh =
      paper::uniform_mesh(sheet.pattern, 1500, paper::UniformLayout::delaunay, {}, 1);
  SheetSampler sampler(sound_grid(sheet.pattern, 5e-3), 4e-3);
  const SheetField field = sampler.sample(rolled_at(mesh, 0, 5));
  const SoundGrid& grid = sampler.grid();
  const int left = grid.at({-0.0025, -0.1}), right = grid.at({0.0035, -0.1});
  ASSERT_EQ(right, left + 1);
  EXPECT_FALSE(field.holds(grid, left, 0));
  EXPECT_FALSE(field.holds(grid, right, 2));
  EXPECT_TRUE(field.holds(grid, grid.at({-0.0025, 0.1}), 0));
  double length = 0;
  for (const BorderStretch& stretch : field.border) length += stretch.length;
  EXPECT_NEAR(length, 2 * (kWidth + kHeight) + 2 * kHeight / 2, 1e-9);
}

TEST(SoundEvents, ASnapOfTheWholeSheetIsOneFlapWhenItPassesZero) {
  const Sheet sheet = a_sheet();
  const ShellMesh mesh = a_mesh(sheet);
  // Straight from 20 to -20 1/m within 20 ms about t = 0.103 s.
  const auto snap = [](double t) { return 20 * std::clamp((0.103 - t) / 0.01, -1.0, 1.0); };
  for (const double interval : {0.01, 0.005}) {
    const auto events = all_events(sheet, {}, motion(mesh, 0.3, interval, snap));
    ASSERT_EQ(events.size(), 1u) << interval;
    const SoundEvent& e = events.front();
    EXPECT_EQ(e.kind, SoundKind::flap);
    EXPECT_NEAR(e.time, 0.103, interval);
    EXPECT_NEAR(e.flipped_area, kWidth * kHeight, 0.05 * kWidth * kHeight);
    EXPECT_NEAR(e.area, kWidth * kHeight, 0.05 * kWidth * kHeight);
    EXPECT_NEAR(e.ruling_length, kHeight, 0.05 * kHeight);
    EXPECT_NEAR(e.free_border, 2 * (kWidth + kHeight), 0.02);
  }
}

TEST(SoundEvents, SlowChangesOfSignAreSilent) {
  const Sheet sheet = a_sheet();
  const auto slow = [](double t) { return 20 - 40 * t; };
  EXPECT_TRUE(all_events(sheet, {}, motion(a_mesh(sheet), 1, 0.01, slow)).empty());
}

TEST(SoundEvents, BendingWithoutChangeOfSignIsSilent) {
  const Sheet sheet = a_sheet();
  const auto swing = [](double t) { return 15 + 9 * std::sin(200 * t); };
  EXPECT_TRUE(all_events(sheet, {}, motion(a_mesh(sheet), 0.4, 0.005, swing)).empty());
}

TEST(SoundEvents, AnOscillationIsHeardAtEverySecondSwingOnly) {
  const Sheet sheet = a_sheet();
  DetectionOptions options;
  options.flips.refractory = 0.06;
  // Passes zero every 50 ms.
  const auto swing = [](double t) { return 30 * std::cos(2 * std::numbers::pi * 10 * t); };
  const ShellMesh mesh = a_mesh(sheet, 400);
  EXPECT_EQ(all_events(sheet, options, motion(mesh, 0.4, 0.004, swing)).size(), 4u);
  options.flips.refractory = 0.02;
  EXPECT_EQ(all_events(sheet, options, motion(mesh, 0.4, 0.004, swing)).size(), 8u);
}

TEST(SoundEvents, EnergyIsWhatBendingHeld) {
  const Sheet sheet = a_sheet();
  std::vector<SheetSnapshot> frames;
  const ShellMesh mesh = a_mesh(sheet);
  for (const auto& [time, curvature] :
       {std::pair{0.0, 30.0}, {0.01, 30.0}, {0.02, -10.0}, {0.03, -10.0}, {0.3, -10.0}}) {
    frames.push_back(rolled_at(mesh, time, curvature));
    frames.back().v = Eigen::MatrixX3d::Zero(mesh.vertex_count(), 3);
  }
  const auto events = all_events(sheet, {}, frames);
  ASSERT_EQ(events.size(), 1u);
  const double area = kWidth * kHeight, D = sheet.material.bending_stiffness();
  // It leaves 5 1/m at 16.25 ms; the peak is forgotten by exp(-6.25 ms / 40 ms) until then.
  const double peak = 30 * std::exp(-0.15625);
  EXPECT_NEAR(events.front().energy, D / 2 * peak * peak * area, 0.03 * D / 2 * 658 * area);
}

TEST(SoundEvents, EnergyDoesNotDependOnTheFrames) {
  const Sheet sheet = a_sheet();
  const ShellMesh mesh = a_mesh(sheet, 400);
  const auto snaps = [](double t) { return -25 * std::tanh((t - 0.1013) / 0.008); };
  const auto energy = [&](double interval) {
    const auto events = all_events(sheet, {}, motion(mesh, 0.3, interval, snaps));
    EXPECT_EQ(events.size(), 1u);
    return events.front().energy;
  };
  const double fine = energy(0.00125);
  for (const double interval : {0.01, 0.005, 0.0025}) {
    EXPECT_NEAR(energy(interval), fine, 0.1 * fine) << interval;
  }
}

TEST(SoundEvents, ResonatorOfManyFacetsHasTheOneThatFlipsMost) {
  const Sheet sheet = a_sheet();
  SheetSampler sampler(sound_grid(sheet.pattern, 5e-3), 0);
  SheetField field = sampler.sample(rolled_at(a_mesh(sheet), 0, 10));
  const SoundGrid& grid = sampler.grid();
  // Seven strips across the sheet; a column of seeds, the third strip has one more.
  std::vector<int> parts(grid.count(), -1), seeds;
  for (int c = 0; c < grid.count(); ++c) {
    const int row = c / grid.columns;
    if (row % 4 != 0) parts[c] = row / 4;
    if (c % grid.columns == 3 && row < 28 && row % 4 == 2) seeds.push_back(c);
  }
  seeds.push_back(grid.cell(3, 9));
  const auto free = [](const Eigen::Vector2d&) { return false; };
  const Resonator one = find_resonator(grid, field, parts, seeds, free);
  ASSERT_EQ(one.cells.size(), static_cast<std::size_t>(3 * grid.columns));
  EXPECT_EQ(one.cells.front() / grid.columns, 9);
  // On a crease alone: the strips on both sides of it.
  const Resonator both = find_resonator(grid, field, parts, {grid.cell(3, 8)}, free);
  EXPECT_EQ(both.cells.size(), static_cast<std::size_t>(6 * grid.columns + 1));
}

TEST(SoundEvents, ResonatorEndsAtAFold) {
  const Sheet sheet = a_sheet();
  SheetSampler sampler(sound_grid(sheet.pattern, 5e-3), 0);
  SheetField field = sampler.sample(rolled_at(a_mesh(sheet), 0, 10));
  const SoundGrid& grid = sampler.grid();
  // A fold along u at v = 0.05: bent far more than the rest.
  for (int c = 0; c < grid.count(); ++c) {
    if (std::abs(grid.centre(c).y() - 0.0525) < 3e-3) field.curvature[c] = 300;
  }
  const std::vector<int> parts = cut_at_creases(grid, field, {});
  const auto free = [](const Eigen::Vector2d&) { return false; };
  const Resonator above = find_resonator(grid, field, parts, {grid.at({0, 0.1})}, free);
  EXPECT_NEAR(above.area, kWidth * 0.095, 0.05 * kWidth * 0.095);
  EXPECT_NEAR(above.ruling_length, 0.095, 0.006);
  EXPECT_NEAR(above.free_border, kWidth + 2 * 0.095, 0.012);
  EXPECT_NEAR(above.blocked_share, kWidth * std::numbers::pi / 4 / (kWidth + 0.19 + kWidth * 0.785),
              0.03);
  const auto held = [](const Eigen::Vector2d& place) { return place.y() > 0.149; };
  const Resonator clamped = find_resonator(grid, field, parts, {grid.at({0, 0.1})}, held);
  EXPECT_NEAR(clamped.free_border, 2 * 0.095, 0.012);
  EXPECT_THROW(find_resonator(grid, field, parts, {}, free), Error);
  EXPECT_THROW(find_resonator(grid, field, parts, {-1}, free), Error);
}

std::size_t number_of_parts(const std::vector<int>& parts) {
  std::set<int> all(parts.begin(), parts.end());
  all.erase(-1);
  return all.size();
}

/// Number of parts between a fold along u at v = 0.05 and the rest, with a gap about u = 0.
std::size_t parts_with_gap(double gap, const CreaseOptions& options) {
  const Sheet sheet = a_sheet();
  SheetSampler sampler(sound_grid(sheet.pattern, 2.5e-3), 0);
  SheetField field = sampler.sample(rolled_at(a_mesh(sheet), 0, 10));
  const SoundGrid& grid = sampler.grid();
  for (int c = 0; c < grid.count(); ++c) {
    const Eigen::Vector2d at = grid.centre(c);
    if (std::abs(at.y() - 0.05125) < 1e-3 && std::abs(at.x()) > gap / 2) field.curvature[c] = 300;
  }
  return number_of_parts(cut_at_creases(grid, field, options));
}

TEST(SoundEvents, NarrowGapsOfCreasesClose) {
  EXPECT_EQ(parts_with_gap(0, {}), 2u);
  EXPECT_EQ(parts_with_gap(0.005, {}), 2u);
  EXPECT_EQ(parts_with_gap(0.02, {}), 1u);
  CreaseOptions open;
  open.gap = 0;
  EXPECT_EQ(parts_with_gap(0.005, open), 1u);
  open.gap = 0.03;
  EXPECT_EQ(parts_with_gap(0.02, open), 2u);
}

TEST(SoundEvents, AStripBetweenCreasesIsNoGap) {
  const Sheet sheet = a_sheet();
  SheetSampler sampler(sound_grid(sheet.pattern, 2.5e-3), 0);
  SheetField field = sampler.sample(rolled_at(a_mesh(sheet), 0, 10));
  const SoundGrid& grid = sampler.grid();
  // Two folds along u leave a strip of 7.5 mm, narrower than a gap.
  for (int c = 0; c < grid.count(); ++c) {
    const double v = grid.centre(c).y();
    if (std::abs(v - 0.04625) < 1e-3 || std::abs(v - 0.05625) < 1e-3) field.curvature[c] = 300;
  }
  EXPECT_EQ(number_of_parts(cut_at_creases(grid, field, {})), 3u);
}

TEST(SoundEvents, AnObliqueStripIsOnePart) {
  const Sheet sheet = a_sheet();
  SheetSampler sampler(sound_grid(sheet.pattern, 2.5e-3), 0);
  const SheetField flat = sampler.sample(rolled_at(a_mesh(sheet), 0, 10));
  const SoundGrid& grid = sampler.grid();
  for (const double degrees : {10., 27., 38.}) {
    for (const double width : {0.006, 0.009, 0.014}) {
      SheetField field = flat;
      const double a = degrees * std::numbers::pi / 180;
      const Eigen::Vector2d across(-std::sin(a), std::cos(a));
      for (int c = 0; c < grid.count(); ++c) {
        const double at = grid.centre(c).dot(across);
        // Creases as wide as a cell's diagonal: without gaps.
        if (std::abs(std::abs(at) - width / 2 - 1.8e-3) < 1.8e-3) field.curvature[c] = 300;
      }
      const std::vector<int> parts = cut_at_creases(grid, field, {});
      std::set<int> inside;
      for (int c = 0; c < grid.count(); ++c) {
        const bool strip = std::abs(grid.centre(c).dot(across)) < width / 2;
        if (strip && parts[c] >= 0) inside.insert(parts[c]);
      }
      EXPECT_EQ(inside.size(), 1u) << degrees << " degrees, " << width << " m";
    }
  }
}

TEST(SoundEvents, SlidingIsOneEventWithItsSpeedAndPower) {
  Sheet sheet = a_sheet();
  Obstacle table;
  table.centre = {0, 0, -1e-4};
  sheet.obstacles = {table};
  const ShellMesh mesh = a_mesh(sheet, 400);
  std::vector<SheetSnapshot> frames;
  const double speed = 0.2;
  for (int i = 0; i <= 50; ++i) {
    SheetSnapshot frame = rolled_at(mesh, 0.01 * i, 0);
    const double slid = speed * std::clamp(frame.time - 0.1, 0.0, 0.2);
    frame.x.col(0).array() += slid;
    frame.v = Eigen::MatrixX3d::Zero(mesh.vertex_count(), 3);
    if (frame.time > 0.0999 && frame.time < 0.3001) frame.v.col(0).setConstant(speed);
    frames.push_back(std::move(frame));
  }
  DetectionOptions options;
  options.spacing = 5e-3;  // divides the sheet
  const auto events = all_events(sheet, options, frames);
  ASSERT_EQ(events.size(), 1u);
  const SoundEvent& e = events.front();
  EXPECT_EQ(e.kind, SoundKind::friction);
  EXPECT_NEAR(e.time, 0.1, 1e-9);
  EXPECT_NEAR(e.duration, 0.2, 1e-9);
  EXPECT_NEAR(e.area, kWidth * kHeight, 1e-9);
  for (const Sliding& at : e.sliding) EXPECT_NEAR(at.speed, speed, 1e-12);
  // Pressure k (d_c - gap) = 1e7 (5e-4 - 1e-4) Pa, coefficient 0.4.
  EXPECT_NEAR(e.energy, 0.4 * 4000 * speed * kWidth * kHeight * 0.2, 1e-9);
}

TEST(SoundEvents, StepsOfTearsAreEventsAndCutsAreNot) {
  Sheet sheet = a_sheet();
  sheet.toughness.energy = 1e4;
  const ShellMesh mesh = a_mesh(sheet, 400);
  std::vector<SheetSnapshot> frames;
  for (int i = 0; i < 4; ++i) {
    SheetSnapshot frame = rolled_at(mesh, 0.04 * i, 0);
    frame.torn = {{0, 0, {0, -0.15}, {}}, {0, 0, {0, -0.1}, {}}};
    for (int k = 1; k <= i; ++k) {
      frame.torn.push_back({0, 0.04 * k - 0.01, {0, -0.1 + 0.002 * k}, {0, 0, 1}});
    }
    frames.push_back(std::move(frame));
  }
  const auto events = all_events(sheet, {}, frames);
  ASSERT_EQ(events.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(events[k].kind, SoundKind::tear);
    EXPECT_DOUBLE_EQ(events[k].time, 0.04 * (k + 1) - 0.01);
    EXPECT_NEAR(events[k].energy, 1e4 * 1e-4 * 0.002, 1e-12);
  }
}

TEST(SoundEvents, StateOfADetectorGoesOn) {
  const Sheet sheet = a_sheet();
  const ShellMesh mesh = a_mesh(sheet, 400);
  const auto swing = [](double t) { return 30 * std::cos(2 * std::numbers::pi * 10 * t); };
  const auto frames = motion(mesh, 0.4, 0.004, swing);
  RunContext context;
  SoundDetector whole(sheet, {});
  std::vector<SoundEvent> expected, found;
  const auto add = [](std::vector<SoundEvent> more, std::vector<SoundEvent>& to) {
    to.insert(to.end(), more.begin(), more.end());
  };
  for (const SheetSnapshot& frame : frames) add(whole.push(frame, context), expected);
  auto first = std::make_unique<SoundDetector>(sheet, DetectionOptions{});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    add(first->push(frames[i], context), found);
    StateWriter out;
    first->save(out);
    const State state = out.take();
    StateReader in(state);
    first = std::make_unique<SoundDetector>(sheet, DetectionOptions{});
    first->load(in, frames[i]);
    in.require_end();
  }
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 0; i < found.size(); ++i) {
    StateWriter a, b;
    save(found[i], a);
    save(expected[i], b);
    EXPECT_EQ(a.take(), b.take());
  }
}

TEST(SoundEvents, FramesThatAreNoSheetAreRefused) {
  const Sheet sheet = a_sheet();
  const ShellMesh mesh = a_mesh(sheet, 400);
  const auto refused = [&](const std::function<void(SheetSnapshot&)>& spoil) {
    SheetSnapshot frame = rolled_at(mesh, 0, 5);
    spoil(frame);
    RunContext context;
    SoundDetector detector(sheet, {});
    EXPECT_THROW(detector.push(frame, context), Error);
  };
  refused([](SheetSnapshot& f) { f.x(3, 1) = std::nan(""); });
  refused([](SheetSnapshot& f) { f.mesh.triangles(0, 0) = -1; });
  refused([](SheetSnapshot& f) { f.mesh.triangles.resize(0, 3); });
  refused([](SheetSnapshot& f) { f.mesh.triangles.row(0).reverseInPlace(); });
  refused([](SheetSnapshot& f) { f.x.conservativeResize(5, 3); });
}

}  // namespace
}  // namespace geoprior::sound
