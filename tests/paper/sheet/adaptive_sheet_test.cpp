#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "baselines/paper/adaptive/adaptive.h"
#include "baselines/paper/adaptive/pop_filter.h"
#include "baselines/paper/adaptive/remesh.h"
#include "baselines/paper/dense.h"
#include "core/error.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/sheet/pattern_locator.h"
#include "tests/paper/contact/plane_shapes.h"
#include "tests/paper/sheets.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using test::Recording;

Recording run(const Sheet& sheet, const AdaptiveOptions& options,
              const std::optional<State>& from = {}) {
  Recording recording;
  RunContext context(7);
  make_adaptive_sheet(sheet, options)->run(recording, context, from);
  return recording;
}

/// 20 cm square, the corners of which approach in pairs by 4 cm, from left and right: slowly enough
/// that a linear step does not crush it (0.08 mm a step).
Sheet squeezed_square() {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  sheet.imperfection = 1e-4;
  for (const double u : {-0.1, 0.1}) {
    for (const double v : {-0.1, 0.1}) {
      Keyframe end;
      end.time = 1.2;
      end.shift.x() = -0.2 * u;
      sheet.handles.push_back(
          sheets::point_handle(std::to_string(u) + std::to_string(v), {{u, v}}, {Keyframe{}, end}));
    }
  }
  sheet.duration = 1.2;
  sheet.frame_interval = 0.04;
  sheet.substeps = 8;
  return sheet;
}

AdaptiveOptions fine() {
  AdaptiveOptions options;
  options.size_min = 0.01;
  options.size_max = 0.08;
  return options;
}

ShellMesh mesh_of(const Frame& frame) {
  const Part& surface = frame.require_part("surface");
  ShellMesh mesh;
  mesh.triangles = surface.triangles;
  mesh.pattern = surface.require_array("pattern", NamedArray::On::points, 2).values;
  return mesh;
}

/// The square under squeeze, made once for the tests that look at it.
const Recording& squeezed(bool pop_filter) {
  const auto make = [](bool filter) {
    AdaptiveOptions options = fine();
    options.pop_filter = filter;
    return run(squeezed_square(), options);
  };
  if (pop_filter) {
    static const Recording filtered = make(true);
    return filtered;
  }
  static const Recording plain = make(false);
  return plain;
}

void expect_covered(bool pop_filter) {
  const Sheet sheet = squeezed_square();
  const Recording& recording = squeezed(pop_filter);
  ASSERT_EQ(recording.frames.size(), static_cast<std::size_t>(sheet.frame_count()));
  for (const Frame& frame : recording.frames) {
    const ShellMesh mesh = mesh_of(frame);
    EXPECT_NEAR(plane_shapes::total_area(mesh), 0.04, 1e-14);
    EXPECT_GT(plane_shapes::least_area(mesh), 0);
    EXPECT_EQ(plane_shapes::euler_characteristic(mesh), 1);
    EXPECT_TRUE(frame.require_part("surface").points.allFinite());
    for (const Handle& handle : sheet.handles) {
      EXPECT_LT(plane_shapes::distance_to_vertices(mesh, handle.points[0]), 1e-12);
    }
  }
}

TEST(AdaptiveSheet, CoversThePatternAndKeepsTheHandlesInEveryFrame) { expect_covered(false); }

TEST(AdaptiveSheet, DoesSoWithThePopFilter) { expect_covered(true); }

// The square bends about the v axis: along u the sheet is narrower, and the curved sheet needs more
// triangles than the flat one.
TEST(AdaptiveSheet, RefinesWhereTheSheetBends) {
  const Recording& recording = squeezed(false);
  EXPECT_GT(recording.frames.back().diagnostics.at("triangles"),
            2 * recording.frames.front().diagnostics.at("triangles"));
  AdaptiveOptions blunt = fine();
  blunt.refine_angle = 1e3;
  const double without_angle =
      run(squeezed_square(), blunt).frames.back().diagnostics.at("triangles");
  EXPECT_GT(recording.frames.back().diagnostics.at("triangles"), 1.5 * without_angle);
  double splits = 0;
  for (const Frame& frame : recording.frames) splits += frame.diagnostics.at("splits");
  EXPECT_GT(splits, 0);
  // An elastica of 0.2 m with its ends 0.16 m apart is k / K(k) 0.2 m = 0.053 m high,
  // 2 E(k) / K(k) - 1 = 0.8.
  const Eigen::MatrixX3d& x = recording.frames.back().require_part("surface").points;
  EXPECT_NEAR((x.colwise().maxCoeff() - x.colwise().minCoeff()).z(), 0.053, 0.01);
}

TEST(AdaptiveSheet, GoesOnFromACheckpointAsIfNothingHadHappened) {
  const Recording& whole = squeezed(false);
  const std::size_t done = 25;
  const Recording rest = run(squeezed_square(), fine(), whole.checkpoints[done - 1]);
  ASSERT_EQ(rest.frames.size(), whole.frames.size() - done);
  for (std::size_t i = 0; i < rest.frames.size(); ++i) {
    const Frame &a = rest.frames[i], &b = whole.frames[i + done];
    EXPECT_EQ(a.require_part("surface").points, b.require_part("surface").points);
    EXPECT_EQ(a.require_part("surface").triangles, b.require_part("surface").triangles);
    EXPECT_EQ(a.diagnostics, b.diagnostics);
  }
}

TEST(AdaptiveSheet, RefusesSizesInTheWrongOrder) {
  AdaptiveOptions options;
  options.size_min = 0.3;
  EXPECT_THROW(make_adaptive_sheet(squeezed_square(), options), Error);
}

/// Mean over changed vertices off the border of the difference between elastic force per area and
/// what it was at that place before (N/m^2).
double pop(const Sheet& sheet, const ShellState& before, const ShellState& after,
           const std::vector<bool>& changed) {
  const auto density = [&](const ShellState& state) -> Eigen::MatrixX3d {
    ShellStepper stepper(sheet, {}, 1);
    stepper.set_mesh(state);
    Eigen::VectorXd area = Eigen::VectorXd::Zero(state.mesh.vertex_count());
    for (int f = 0; f < state.mesh.triangle_count(); ++f) {
      for (int k = 0; k < 3; ++k) {
        area[state.mesh.triangles(f, k)] += plane_shapes::twice_area(state.mesh, f) / 6;
      }
    }
    return stepper.elastic_forces(state).array().colwise() / area.array();
  };
  const Eigen::MatrixX3d old = density(before), now = density(after);
  const PatternLocator locator(before.mesh);
  double sum = 0;
  int count = 0;
  for (int v = 0; v < after.mesh.vertex_count(); ++v) {
    if (!changed[v]) continue;
    const PatternLocator::Place place = locator.locate(after.mesh.pattern.row(v));
    Eigen::RowVector3d was = Eigen::RowVector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      was += place.weights[k] * old.row(before.mesh.triangles(place.triangle, k));
    }
    sum += (now.row(v) - was).norm();
    ++count;
  }
  return sum / count;
}

TEST(PopFilter, BringsTheElasticForcesBackToWhatTheyWere) {
  const Sheet sheet = squeezed_square();
  ShellState before = sheets::at_rest(sheet, 300, UniformLayout::delaunay);
  ShellStepper stepper(sheet, {}, 1);
  stepper.set_mesh(before);
  sheets::advance(stepper, before, 0.01, 100);
  SizingOptions options;
  options.size_min = 0.01;
  ShellState after = before;
  const RemeshReport report = remesh(sheet, sizing_tensors(before, {}, options), after);
  ASSERT_GT(report.collapses + report.flips, 10);
  ShellState filtered = after;
  const int steps =
      filter_pops(sheet, {}, before, stepper.elastic_forces(before), report.changed, {}, filtered);
  EXPECT_GT(steps, 0);
  EXPECT_LT(pop(sheet, before, filtered, report.changed),
            0.2 * pop(sheet, before, after, report.changed));
  // Vertices that remeshing left alone stay where they are.
  for (int v = 0; v < after.mesh.vertex_count(); ++v) {
    if (!report.changed[v]) {
      EXPECT_EQ(filtered.x.row(v), after.x.row(v));
    }
  }
}

}  // namespace
}  // namespace geoprior::paper
