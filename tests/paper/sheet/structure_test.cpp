#include "solvers/paper/sheet/structure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/planar.h"
#include "core/random.h"
#include "solvers/paper/meshing/ruling_editor.h"
#include "solvers/paper/meshing/ruling_mesh.h"
#include "solvers/paper/sheet/invariants.h"
#include "solvers/paper/sheet/pieces.h"
#include "tests/paper/contact/plane_shapes.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kFlatSize = 0.1;

/// A sheet of 0.2 m by 0.2 m and the structure on it.
struct SquareSheet {
  Pattern pattern = rectangle_pattern(0.2, 0.2);
  std::vector<Vector2d> anchors;
  PaperStructure structure;
  RulingEditor editor{pattern, anchors, {4e-3, 0.1}, structure};

  RulingMesh meshed() {
    RulingMesh mesh = mesh_structure(structure, pattern, anchors, {kFlatSize});
    derive_pieces(structure, pattern, mesh);
    return mesh;
  }
  void add_upright(double x) { editor.add(*editor.chord({x, 0}, {0, 1})); }
  int add_singular(const Vector2d& p) {
    SingularPoint s;
    s.id = static_cast<int>(structure.singular_points.size());
    s.position = p;
    structure.singular_points.push_back(s);
    return s.id;
  }
};

double area_of(const ShellMesh& mesh) {
  double sum = 0;
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    const Vector2d a = mesh.pattern.row(mesh.triangles(f, 0));
    const Vector2d b = mesh.pattern.row(mesh.triangles(f, 1));
    const Vector2d c = mesh.pattern.row(mesh.triangles(f, 2));
    sum += cross(b - a, c - a) / 2;
  }
  return sum;
}

TEST(RulingMesh, FlatSheetHasNoEdgeLongerThanTwiceTheFlatSize) {
  SquareSheet sheet;
  const RulingMesh mesh = sheet.meshed();
  EXPECT_NEAR(area_of(mesh.mesh), 0.04, 1e-15);
  for (int f = 0; f < mesh.mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE((mesh.mesh.pattern.row(mesh.mesh.triangles(f, k)) -
                 mesh.mesh.pattern.row(mesh.mesh.triangles(f, (k + 1) % 3)))
                    .norm(),
                2 * kFlatSize);
    }
  }
  ASSERT_EQ(sheet.structure.pieces.size(), 1U);
  EXPECT_EQ(sheet.structure.pieces[0].kind, PaperPiece::Kind::flat);
}

TEST(Pieces, ParallelRulingsFromBorderToBorderAreOneCylinder) {
  SquareSheet sheet;
  for (const double x : {0.04, -0.04, 0.0, 0.02, -0.02}) sheet.add_upright(x);
  const RulingMesh mesh = sheet.meshed();
  EXPECT_THAT(broken_invariants(sheet.structure, sheet.pattern, mesh.mesh), IsEmpty());
  const PaperPiece& piece = sheet.structure.pieces[0];
  ASSERT_EQ(piece.kind, PaperPiece::Kind::cylinder);
  EXPECT_EQ(piece.rulings.size(), 5U);
  EXPECT_NEAR(std::abs(piece.direction.y()), 1, 1e-12);
  EXPECT_NEAR(signed_area(piece.region), 0.08 * 0.2, 1e-12);
  // The ground left and right of it is flat, and touches it.
  EXPECT_EQ(sheet.structure.pieces.size(), 3U);
  EXPECT_EQ(piece.neighbours, (std::vector<int>{1, 2}));
  for (std::size_t i = 0; i + 1 < piece.rulings.size(); ++i) {
    const auto at = [&](std::size_t k) { return sheet.structure.rulings[piece.rulings[k]].a.x(); };
    EXPECT_NEAR(std::abs(at(i + 1) - at(i)), 0.02, 1e-12);
  }
}

TEST(Pieces, SectorsAboutASingularPointAreConesAndTheRestIsFlat) {
  SquareSheet sheet;
  sheet.add_upright(-0.06);
  sheet.add_upright(0.06);
  const int p = sheet.add_singular({0.01, 0});
  for (const double x : {-0.06, -0.03, 0.0, 0.03, 0.06}) {
    for (const double y : {-0.1, 0.1}) {
      const auto ray = sheet.editor.ray_to(p, {x, y});
      ASSERT_TRUE(ray) << x << " " << y;
      sheet.editor.add(*ray);
    }
  }
  const RulingMesh mesh = sheet.meshed();
  EXPECT_THAT(broken_invariants(sheet.structure, sheet.pattern, mesh.mesh), IsEmpty());
  int cones = 0, flats = 0;
  double cone_area = 0;
  for (const PaperPiece& piece : sheet.structure.pieces) {
    if (piece.kind == PaperPiece::Kind::cone) {
      ++cones;
      EXPECT_EQ(piece.rulings.size(), 5U);
      EXPECT_EQ(piece.singular_point, p);
      cone_area += signed_area(piece.region);
    }
    flats += piece.kind == PaperPiece::Kind::flat ? 1 : 0;
  }
  EXPECT_EQ(cones, 2);
  // Two triangles from the apex to the upright lines, and the ground beyond the lines.
  EXPECT_EQ(flats, 4);
  EXPECT_NEAR(cone_area, 2 * 0.12 * 0.1 / 2, 1e-12);
  EXPECT_EQ(sheet.structure.pieces_at(p).size(), 2U);
  EXPECT_EQ(sheet.structure.rulings_at(p).size(), 10U);
}

/// The square sheet with a square hole of 0.04 m in its middle.
struct PiercedSheet : SquareSheet {
  PiercedSheet() { pattern.holes = {{{-0.02, -0.02}, {-0.02, 0.02}, {0.02, 0.02}, {0.02, -0.02}}}; }
  [[nodiscard]] RulingEditor pen() { return {pattern, anchors, {4e-3, 0.1}, structure}; }

  void add_line(const Vector2d& p, const Vector2d& d) {
    const auto line = pen().chord(p, d);
    ASSERT_TRUE(line) << p.transpose();
    pen().add(*line);
  }
  [[nodiscard]] int count(PaperPiece::Kind kind) const {
    int sum = 0;
    for (const PaperPiece& piece : structure.pieces) sum += piece.kind == kind ? 1 : 0;
    return sum;
  }
  void expect_covered(const RulingMesh& mesh) const {
    EXPECT_THAT(broken_invariants(structure, pattern, mesh.mesh), IsEmpty());
    EXPECT_EQ(plane_shapes::euler_characteristic(mesh.mesh), 0);
    double sum = 0;
    for (const PaperPiece& piece : structure.pieces) sum += signed_area(piece.region);
    EXPECT_NEAR(sum, 0.04 - 0.0016, 1e-12);
    EXPECT_EQ(structure.piece_at({0, 0}), -1);
  }
};

constexpr auto kCylinder = PaperPiece::Kind::cylinder;
constexpr auto kCone = PaperPiece::Kind::cone;
constexpr auto kFlat = PaperPiece::Kind::flat;

TEST(PiecesAtAHole, FlatGroundMayHaveAHole) {
  PiercedSheet sheet;
  const RulingMesh mesh = sheet.meshed();
  sheet.expect_covered(mesh);
  ASSERT_EQ(sheet.structure.pieces.size(), 1U);
  EXPECT_EQ(sheet.structure.pieces[0].region.holes.size(), 1U);
  EXPECT_EQ(sheet.structure.piece_at({0.05, 0}), 0);
}

TEST(PiecesAtAHole, RulingsEndAtTheNearestLoop) {
  PiercedSheet sheet;
  sheet.add_line({0.003, 0.06}, {0, 1});
  EXPECT_NEAR((sheet.structure.rulings[0].a - Vector2d(0.003, 0.02)).norm(), 0, 1e-12);
  EXPECT_NEAR((sheet.structure.rulings[0].b - Vector2d(0.003, 0.1)).norm(), 0, 1e-12);
  const RulingHit hit = sheet.pen().propagate({0.06, 0}, {-1, 0});
  EXPECT_EQ(hit.kind, RulingHit::Kind::border);
  EXPECT_NEAR(hit.distance, 0.04, 1e-12);
  EXPECT_GE(hit.index, 4) << "an edge of the hole";
  EXPECT_FALSE(sheet.pen().chord({0, 0}, {0, 1})) << "in the hole";
  EXPECT_FALSE(sheet.pen().chord({0.021, 0}, {0, 1})) << "too near along its side";
  sheet.expect_covered(sheet.meshed());
}

// Between two uprights: a hole alone, a hole that a line reaches, and one that lines reach on both
// sides; in each case all of it is one cylinder.
TEST(PiecesAtAHole, AStripWithAHoleIsACylinder) {
  for (int lines = 0; lines <= 2; ++lines) {
    PiercedSheet sheet;
    sheet.add_line({-0.06, 0}, {0, 1});
    sheet.add_line({0.06, 0}, {0, 1});
    if (lines > 0) sheet.add_line({0, 0.06}, {0, 1});
    if (lines > 1) sheet.add_line({0, -0.06}, {0, 1});
    sheet.expect_covered(sheet.meshed());
    ASSERT_EQ(sheet.count(kCylinder), 1) << lines;
    EXPECT_EQ(sheet.count(kFlat), 2) << lines;
    const PaperPiece& piece = sheet.structure.pieces[0];
    EXPECT_EQ(piece.rulings.size(), 2U + static_cast<std::size_t>(lines));
    EXPECT_NEAR(signed_area(piece.region), 0.12 * 0.2 - 0.0016, 1e-12);
    EXPECT_EQ(piece.region.holes.size(), 1U);
  }
}

TEST(PiecesAtAHole, GroundBesideALineWithAHoleInItIsFlat) {
  PiercedSheet sheet;
  sheet.add_line({0, 0.06}, {0, 1});
  sheet.add_line({0, -0.06}, {0, 1});
  sheet.expect_covered(sheet.meshed());
  EXPECT_EQ(sheet.count(kFlat), 2);
  EXPECT_EQ(sheet.structure.pieces.size(), 2U);
}

TEST(PiecesAtAHole, ASectorWithAHoleIsACone) {
  PiercedSheet sheet;
  const int p = sheet.add_singular({0, -0.1});
  for (const double x : {-0.095, 0.0, 0.095}) {
    const auto ray = sheet.pen().ray(p, {x, 0.2});
    ASSERT_TRUE(ray) << x;
    sheet.pen().add(*ray);
  }
  EXPECT_NEAR(sheet.structure.rulings[1].b.y(), -0.02, 1e-12) << "the middle one ends at the hole";
  sheet.expect_covered(sheet.meshed());
  ASSERT_EQ(sheet.count(kCone), 1);
  EXPECT_EQ(sheet.structure.pieces[0].rulings.size(), 3U);
  EXPECT_NEAR(signed_area(sheet.structure.pieces[0].region), 0.19 * 0.2 / 2 - 0.0016, 1e-12);
}

TEST(Pieces, CylinderKeepsItsIdWhenAHalfIsCutOff) {
  SquareSheet sheet;
  for (const double x : {-0.06, -0.04, -0.02, 0.0, 0.02, 0.04, 0.06}) sheet.add_upright(x);
  sheet.meshed();
  const int id = sheet.structure.pieces[0].id;
  std::vector<bool> marked(7, false);
  marked[1] = true;  // the strips left of it are too wide to stay, the others remain one cylinder
  marked[2] = true;
  sheet.editor.remove(marked);
  const int p = sheet.add_singular({-0.03, 0});
  sheet.editor.add(*sheet.editor.ray_to(p, {-0.06, 0.1}));
  sheet.editor.add(*sheet.editor.ray_to(p, {0, 0.1}));
  sheet.meshed();
  ASSERT_EQ(sheet.structure.pieces[0].kind, PaperPiece::Kind::cone);
  int kept = 0;
  for (const PaperPiece& piece : sheet.structure.pieces) {
    if (piece.kind != PaperPiece::Kind::cylinder) continue;
    EXPECT_EQ(piece.id, id);
    EXPECT_EQ(piece.rulings.size(), 4U);
    ++kept;
  }
  EXPECT_EQ(kept, 1);
}

TEST(RulingEditor, RefusesWhatCrossesOrComesTooNear) {
  SquareSheet sheet;
  sheet.add_upright(0);
  EXPECT_FALSE(sheet.editor.chord({0.05, 0.05}, {1, 0}));  // crosses
  EXPECT_FALSE(sheet.editor.chord({0.003, 0}, {0, 1}));    // snaps onto the line there is
  EXPECT_FALSE(sheet.editor.chord({0.099, 0}, {0, 1}));    // is the border
  EXPECT_TRUE(sheet.editor.chord({0.02, 0}, {0.05, 1}));
}

TEST(RulingEditor, LeadsARulingThroughAnAnchorNearby) {
  SquareSheet sheet;
  sheet.anchors.emplace_back(0.002, 0.03);
  sheet.add_upright(0);
  EXPECT_DOUBLE_EQ(sheet.structure.rulings[0].a.x(), 0.002);
  const RulingMesh mesh = sheet.meshed();
  EXPECT_EQ(mesh.ruling_paths[0].size(), 3U);
  EXPECT_THAT(broken_invariants(sheet.structure, sheet.pattern, mesh.mesh), IsEmpty());
}

TEST(RulingEditor, RandomRulingsOnAnyPatternKeepAllInvariants) {
  const Pattern ell{{{0, 0}, {0.2, 0}, {0.2, 0.08}, {0.1, 0.08}, {0.1, 0.2}, {0, 0.2}}};
  Pattern pierced = plane_shapes::pierced_square();
  for (std::size_t k = 0; k < pierced.loop_count(); ++k) {
    for (Vector2d& p : k == 0 ? pierced.border : pierced.holes[k - 1]) p *= 0.06;
  }
  for (const Pattern& pattern : {rectangle_pattern(0.21, 0.297), disc_pattern(0.1, 48), ell,
                                 plane_shapes::ring_pattern(), pierced}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      RandomStream random(seed);
      const auto inside = [&] {
        for (;;) {
          const Vector2d p(0.4 * (random.uniform() - 0.5), 0.4 * (random.uniform() - 0.5));
          if (contains(pattern, p) && nearest_on_border(pattern, p).distance > 0.01) return p;
        }
      };
      PaperStructure structure;
      const std::vector<Vector2d> anchors{inside()};
      const RulingEditor editor(pattern, anchors, {4e-3, 0.1}, structure);
      for (int k = 0; k < 3; ++k) {
        SingularPoint s;
        s.position = inside();
        structure.singular_points.push_back(s);
        const auto& all = structure.singular_points;
        const auto near = [&](const Vector2d& q) {
          const double distance = (q - s.position).norm();
          return distance > 0 && distance < 0.02;
        };
        if (near(anchors[0]) || (k > 0 && near(all[0].position)) ||
            (k > 1 && near(all[1].position))) {
          structure.singular_points.pop_back();
        }
      }
      const auto count = static_cast<std::uint32_t>(structure.singular_points.size());
      for (int k = 0; k < 150; ++k) {
        const double angle = 6.283185307179586 * random.uniform();
        const Vector2d d(std::cos(angle), std::sin(angle));
        const auto r = k % 2 == 0 || count == 0
                           ? editor.chord(inside(), d)
                           : editor.ray(static_cast<int>(random.below(count)), d);
        if (r) structure.rulings.push_back(*r);
      }
      RulingMesh mesh = mesh_structure(structure, pattern, anchors, {kFlatSize});
      derive_pieces(structure, pattern, mesh);
      EXPECT_THAT(broken_invariants(structure, pattern, mesh.mesh), IsEmpty()) << "seed " << seed;
      EXPECT_GT(structure.rulings.size(), 5U);
      double covered = 0;
      for (const PaperPiece& piece : structure.pieces) covered += signed_area(piece.region);
      EXPECT_NEAR(covered, signed_area(pattern), 1e-9) << "seed " << seed;
    }
  }
}

TEST(Invariants, NameWhatIsBroken) {
  SquareSheet sheet;
  sheet.add_upright(0);
  const RulingMesh mesh = sheet.meshed();
  PaperStructure crossing = sheet.structure;
  Ruling level;
  level.a = {-0.1, 0.01};
  level.b = {0.1, 0.01};
  crossing.rulings.push_back(level);
  EXPECT_THAT(broken_invariants(crossing, sheet.pattern, mesh.mesh),
              ::testing::UnorderedElementsAre(HasSubstr("rulings 0 and 1 cross"),
                                              HasSubstr("ruling 1 is no path")));
  PaperStructure loose = sheet.structure;
  loose.rulings[0].a.y() += 0.01;
  EXPECT_THAT(broken_invariants(loose, sheet.pattern, mesh.mesh),
              ::testing::Contains(HasSubstr("ends neither")));
  ShellMesh holed = mesh.mesh;
  holed.triangles.conservativeResize(holed.triangles.rows() - 1, 3);
  EXPECT_THAT(broken_invariants(sheet.structure, sheet.pattern, holed),
              ::testing::Contains(HasSubstr("cover")));
  ShellMesh turned = mesh.mesh;
  turned.triangles.row(0).reverseInPlace();
  EXPECT_THAT(broken_invariants(sheet.structure, sheet.pattern, turned),
              ::testing::Contains(HasSubstr("turned over")));
  PaperStructure floating = sheet.structure;
  floating.singular_points.emplace_back();
  floating.singular_points.back().position = {0.0123, 0.0456};
  EXPECT_THAT(broken_invariants(floating, sheet.pattern, mesh.mesh),
              ::testing::Contains(HasSubstr("is no vertex")));
}

}  // namespace
}  // namespace geoprior::paper
