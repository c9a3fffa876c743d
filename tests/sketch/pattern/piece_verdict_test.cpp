#include "experiments/sketch/pattern/piece_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include "experiments/sketch/fabrication/fabrication.h"
#include "experiments/sketch/fabrication/strain_page.h"
#include "experiments/sketch/pattern/strain_sheet.h"
#include "models/sketch/pattern/make_pattern.h"
#include "tests/sketch/pattern/flat_surfaces.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A rectangle of 0.2 m by 0.1 m in the pattern, that lies in space `x` times as wide.
struct Stretched {
  Pattern pattern;
  Eigen::MatrixX3d surface;
};

Stretched stretched(double x) {
  const TriMesh grid =
      flats::grid(8, 4, [](int i, int j) { return Eigen::Vector3d(0.025 * i, 0.025 * j, 0); });
  Stretched made;
  PatternPiece piece;
  piece.name = "flag";
  piece.points = grid.V.leftCols<2>();
  piece.triangles = grid.F;
  piece.surface_vertex.resize(grid.V.rows());
  std::iota(piece.surface_vertex.begin(), piece.surface_vertex.end(), 0);
  std::vector<int> border;
  for (int i = 0; i < 8; ++i) border.push_back(i);
  for (int j = 0; j < 4; ++j) border.push_back(9 * j + 8);
  for (int i = 8; i > 0; --i) border.push_back(36 + i);
  for (int j = 4; j > 0; --j) border.push_back(9 * j);
  piece.borders = {border};
  border.push_back(0);
  piece.edges = {{border, -1, -1, -1, "pole"}};
  made.pattern.pieces = {piece};
  made.surface = grid.V;
  made.surface.col(0) *= x;
  return made;
}

std::map<std::string, std::string> files_of(const Stretched& made,
                                            const FabricationOptions& options = {}) {
  std::map<std::string, std::string> files;
  for (const FabricationFile& file : judged_fabrication_files(made.pattern, made.surface, options))
    files[file.name] = file.bytes;
  return files;
}

TEST(PieceVerdict, MeasuresAKnownStretch) {
  const Stretched made = stretched(1.015);
  const PieceVerdict verdict = judge_pieces(made.pattern, made.surface).at(0);
  EXPECT_NEAR(verdict.strain_p95, 0.015, 1e-9);
  EXPECT_NEAR(verdict.worst, 0.015, 1e-9);
  EXPECT_EQ(verdict.share, 1);
  EXPECT_NEAR(verdict.area, 0.02 * 1.015, 1e-12);
  EXPECT_NEAR(verdict.area_error, 1 / 1.015 - 1, 1e-9);
  EXPECT_EQ(verdict.nearest, "border 'pole'");
  EXPECT_TRUE(verdict.refused.empty());
  EXPECT_NEAR(signed_strain(made.pattern.pieces[0], made.surface).mean(), 0.015, 1e-9)
      << "the surface is longer: above 0";
  const Stretched shorter = stretched(1 / 1.015);
  EXPECT_NEAR(signed_strain(shorter.pattern.pieces[0], shorter.surface).mean(), -0.015, 1e-9);
}

TEST(PieceVerdict, RefusesWhatIsTooSmallForItsSurface) {
  const Stretched made = stretched(1.05);
  const PieceVerdict verdict = judge_pieces(made.pattern, made.surface).at(0);
  EXPECT_THAT(verdict.refused, HasSubstr("4.8 % smaller than its surface"));
  EXPECT_EQ(verdict.share, 0);
  EXPECT_TRUE(verdict.is_strained());
  EXPECT_THAT(verdict_line(made.pattern, 0, verdict), HasSubstr("REFUSED"));
}

TEST(PieceVerdict, RefusesATurnedOverTriangle) {
  Stretched made = stretched(1);
  made.pattern.pieces[0].points.row(9 + 1) << 0.06, 0.025;  // beyond its neighbour
  const PieceVerdict verdict = judge_pieces(made.pattern, made.surface).at(0);
  EXPECT_GT(verdict.flips, 0);
  EXPECT_THAT(verdict.refused, HasSubstr("turned over"));
}

TEST(JudgedFabrication, KeepsARefusedPieceOutOfTheCutFilesUnlessForced) {
  const Stretched made = stretched(1.05);
  const auto refused = files_of(made);
  EXPECT_FALSE(refused.contains("pattern.svg"));
  EXPECT_FALSE(refused.contains("pattern.dxf"));
  EXPECT_THAT(refused.at("pattern-refused.txt"), HasSubstr("smaller than its surface"));
  EXPECT_THAT(refused.at("pattern-refused.txt"), HasSubstr("piece 1 of 1 'flag': "))
      << "counted as in the verdict";
  EXPECT_THAT(refused.at("pattern-strain.svg"), HasSubstr("REFUSED"));
  FabricationOptions force;
  force.force = true;
  const auto forced = files_of(made, force);
  EXPECT_FALSE(forced.contains("pattern-refused.txt"));
  EXPECT_THAT(forced.at("pattern.svg"), HasSubstr("strain p95 5.0 %"));
  EXPECT_THAT(forced.at("pattern.dxf"), HasSubstr("ANNOTATION: strain p95 5.0 "));
}

TEST(JudgedFabrication, LeavesTheOtherPiecesAndTheirNumbers) {
  Stretched made = stretched(1.05);
  const Stretched good = stretched(1);
  PatternPiece second = good.pattern.pieces[0];
  second.name = "sail";
  for (int& v : second.surface_vertex) v += static_cast<int>(made.surface.rows());
  second.points.col(0).array() += 0.3;
  made.pattern.pieces.push_back(second);
  Eigen::MatrixX3d both(2 * made.surface.rows(), 3);
  both << made.surface, good.surface;
  made.surface = both;
  const auto files = files_of(made);
  EXPECT_THAT(files.at("pattern.svg"), HasSubstr("data-name=\"sail\""));
  EXPECT_THAT(files.at("pattern.svg"), Not(HasSubstr("data-name=\"flag\"")));
  EXPECT_THAT(files.at("pattern.svg"), HasSubstr("1 of 2 pieces"));
  EXPECT_THAT(files.at("pattern.dxf"), Not(HasSubstr("P1-FLAG")));
  EXPECT_THAT(files.at("pattern.dxf"), HasSubstr("P2-SAIL"));
  EXPECT_THAT(files.at("pattern.csv"), HasSubstr("\"sail\""));
  EXPECT_THAT(files.at("pattern.csv"), Not(HasSubstr("\"flag\"")));
  EXPECT_THAT(files.at("pattern.json"), HasSubstr("\"refused\": true"));
  EXPECT_THAT(files.at("pattern-verdict.txt"), HasSubstr("piece 2 of 2 'sail'"));
}

TEST(JudgedFabrication, SuggestsACutWhereAPieceIsStrained) {
  // A cap of a sphere, laid flat in one piece: a cut would ease it.
  TriMesh cap = flats::hemisphere(3);
  cap.V *= 0.1;
  const MadePattern made = make_pattern(cap, {});
  const Stretched strained{made.pattern, cap.V};
  const auto files = files_of(strained);
  EXPECT_THAT(files.at("pattern-verdict.txt"), HasSubstr("along the dashed line"));
  EXPECT_THAT(files.at("pattern-strain.svg"), HasSubstr("stroke-dasharray"));
  FabricationOptions without;
  without.add_seam = false;
  EXPECT_THAT(files_of(strained, without).at("pattern-verdict.txt"), Not(HasSubstr("dashed line")));
}

TEST(StrainSheet, PaintsElongationRedAndCompressionBlue) {
  EXPECT_GT(strain_colour(0.1).x(), 0.8);
  EXPECT_GT(strain_colour(-0.1).z(), 0.8);
  EXPECT_GT(strain_colour(0).y(), 0.7);
  EXPECT_EQ(strain_colour(0.5), strain_colour(0.1)) << "what is beyond the bar is its end";
  const Stretched made = stretched(1.05);
  const StrainSheet sheet =
      strain_sheet(made.pattern, made.surface, judge_pieces(made.pattern, made.surface));
  std::size_t triangles = 0;
  for (const StrainPatch& patch : sheet.patches) triangles += patch.triangles.size();
  EXPECT_EQ(triangles, 64U + 2 * 25) << "of the piece and of the bar";
  EXPECT_EQ(sheet.worst.size(), 3U) << "a circle and a cross";
}

TEST(StrainSheet, IsTheLastPageOfThePdf) {
  const auto files = files_of(stretched(1));
  EXPECT_THAT(files.at("pattern.pdf"), HasSubstr("/Count 2"));
  EXPECT_THAT(files.at("pattern.pdf"), HasSubstr("not to cut by"));
}

}  // namespace
}  // namespace geoprior::sketch
