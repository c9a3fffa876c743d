#include "solvers/paper/meshing/refinement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/state_bytes.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "solvers/paper/meshing/ruling_mesh.h"
#include "solvers/paper/sheet/invariants.h"
#include "solvers/paper/sheet/pieces.h"
#include "solvers/paper/sheet/structure_bytes.h"
#include "tests/paper/sheet/hybrid_fixture.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using ::testing::IsEmpty;

constexpr double kCoarse = 0.04;

/// Longest edges of the triangles with centres near a place, and of the others (m).
struct Longest {
  double near = 0, elsewhere = 0;
};
Longest longest_edges(const ShellMesh& mesh, const Vector2d& place, double reach) {
  Longest result;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto p = [&](int k) -> Vector2d { return mesh.pattern.row(mesh.triangles(t, k % 3)); };
    double edge = 0;
    for (int k = 0; k < 3; ++k) edge = std::max(edge, (p(k + 1) - p(k)).norm());
    const bool near = ((p(0) + p(1) + p(2)) / 3 - place).norm() < reach;
    double& longest = near ? result.near : result.elsewhere;
    longest = std::max(longest, edge);
  }
  return result;
}

/// A flat sheet, stretched by a hundredth where u > 0.
ShellState half_stretched() {
  const Sheet sheet = square_sheet(1);
  ShellState state = resting_state(sheet, mesh_structure({}, sheet.pattern, {}, {kCoarse}).mesh, 1);
  for (int v = 0; v < state.mesh.vertex_count(); ++v) {
    if (state.x(v, 0) > 0) state.x(v, 0) *= 1.01;
  }
  return state;
}

TEST(StrainedPlaces, LieWhereTheSheetIsStretchedAndHalveItsEdges) {
  const ShellState state = half_stretched();
  const std::vector<FinePlace> places = strained_places(state, 5e-3, 0.01, {});
  ASSERT_FALSE(places.empty());
  for (const FinePlace& place : places) {
    EXPECT_GT(place.centre.x(), -kCoarse / 2);
    EXPECT_LE(place.edge, kCoarse);
    EXPECT_GE(place.edge, kCoarse / 4);
  }
  EXPECT_THAT(strained_places(state, 0.02, 0.01, {}), IsEmpty()) << "nothing strains as much";
  EXPECT_THAT(strained_places(state, 5e-3, kCoarse, {}), IsEmpty()) << "finer than allowed";
}

TEST(StrainedPlaces, AreNotAskedForAgain) {
  const ShellState state = half_stretched();
  const std::vector<FinePlace> places = strained_places(state, 5e-3, 0.01, {});
  EXPECT_THAT(strained_places(state, 5e-3, 0.01, places), IsEmpty());
}

TEST(RulingMesh, IsFinerAboutAFinePlaceOnly) {
  const Pattern pattern = rectangle_pattern(0.2, 0.2);
  for (const Vector2d& centre : {Vector2d(0.03, -0.02), Vector2d(0.1, 0.05), Vector2d(0.1, 0.1)}) {
    const auto meshed = [&](double edge) {
      PaperStructure structure;
      structure.fine_places = {{centre, edge}};
      RulingMesh mesh = mesh_structure(structure, pattern, {}, {kCoarse});
      derive_pieces(structure, pattern, mesh);
      EXPECT_THAT(broken_invariants(structure, pattern, mesh.mesh), IsEmpty());
      return mesh.mesh;
    };
    const ShellMesh coarse = mesh_structure({}, pattern, {}, {kCoarse}).mesh;
    for (const double edge : {kCoarse / 2, kCoarse / 4}) {
      const ShellMesh mesh = meshed(edge);
      EXPECT_GT(longest_edges(coarse, centre, kCoarse).near, 1.5 * edge);
      EXPECT_LT(longest_edges(mesh, centre, edge).near, 1.5 * edge) << centre.transpose();
      EXPECT_GT(longest_edges(mesh, centre, 4 * edge).elsewhere, 0.9 * kCoarse);
      EXPECT_LT(mesh.triangle_count(), coarse.triangle_count() + 100);
    }
  }
}

TEST(StructureBytes, KeepFinePlaces) {
  PaperStructure structure;
  structure.fine_places = {{{0.01, 0.02}, 0.005}, {{-0.03, 0}, 0.01}};
  StateWriter out;
  write_structure(structure, out);
  const State bytes = out.take();
  StateReader in(bytes);
  const PaperStructure again = read_structure(in);
  ASSERT_EQ(again.fine_places.size(), 2U);
  EXPECT_EQ(again.fine_places[1].centre, structure.fine_places[1].centre);
  EXPECT_EQ(again.fine_places[1].edge, 0.01);
}

/// Five hands hold a square, four near its corners and one within, and come nearer at different
/// heights.
Sheet crushed_sheet() {
  Sheet sheet = square_sheet(1.6);
  sheet.imperfection = 5e-4;
  const std::vector<std::pair<Vector2d, Eigen::Vector3d>> ways = {
      {{-0.085, -0.085}, {0.02, 0.024, 0.008}},
      {{0.085, -0.085}, {-0.022, 0.018, -0.01}},
      {{0.085, 0.085}, {-0.018, -0.022, 0.012}},
      {{-0.085, 0.085}, {0.024, -0.02, -0.006}},
      {{0.02, 0.01}, {0, 0, -0.03}}};
  for (const auto& [place, way] : ways) {
    Handle hand = point_handle("hand " + std::to_string(sheet.handles.size()), place,
                               {{0, {0, 0, 0}}, {1.6, way}});
    hand.disc_radius = 0.01;
    sheet.handles.push_back(hand);
  }
  return sheet;
}

/// Largest RMS of the strain in the run.
double worst_strain(const Sheet& sheet, int refinements, std::size_t& places) {
  HybridOptions options;
  options.refinements = refinements;
  double worst = 0;
  run_hybrid(sheet, options, 1, [&](const HybridMesher& mesher, const ShellState& state) {
    worst = std::max(worst, isometry(state).rms);
    places = mesher.structure().fine_places.size();
  });
  return worst;
}

TEST(HybridRefinement, KeepsASheetThatHandsCrushFromStraining) {
  const Sheet sheet = crushed_sheet();
  std::size_t places = 0, none = 0;
  const double refined = worst_strain(sheet, HybridOptions{}.refinements, places);
  EXPECT_GT(places, 0U);
  EXPECT_LT(refined, 0.7 * worst_strain(sheet, 0, none));
  EXPECT_EQ(none, 0U);
}

TEST(HybridRefinement, LeavesASheetThatBendsAlone) {
  std::size_t places = 1;
  worst_strain(bent_sheet(), HybridOptions{}.refinements, places);
  EXPECT_EQ(places, 0U);
}

}  // namespace
}  // namespace geoprior::paper
