#include "models/sketch/pattern/piece_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "models/sketch/pattern/make_pattern.h"
#include "models/sketch/sketch_process.h"
#include "models/sketch/surface/sketch_surface.h"

namespace geoprior::sketch {
namespace {

Stroke stroke(const std::string& id, StrokeKind kind, std::vector<Eigen::Vector2d> points,
              const std::string& name = {}) {
  Stroke s;
  s.id = id;
  s.kind = kind;
  s.points = std::move(points);
  s.name = name;
  return s;
}

/// A box of 0.2 x 0.3 x 0.1 m, open at its lower end, cut by a seam in the side view that goes
/// around it from the hem over the top.
Drawing bag(const std::string& of_seam, const std::string& of_hem) {
  const auto outline = [](double half, double height) {
    Stroke s = stroke("outline", StrokeKind::silhouette,
                      {{-half, 0}, {half, 0}, {half, height}, {-half, height}});
    s.closed = true;
    return s;
  };
  View front{ViewKind::front, {outline(0.1, 0.3)}};
  front.strokes.push_back(stroke("hem", StrokeKind::border, {{-0.1, 0}, {0.1, 0}}, of_hem));
  View side{ViewKind::side, {outline(0.05, 0.3)}};
  Stroke seam = stroke("sides", StrokeKind::seam, {{0, 0}, {0, 0.3}}, of_seam);
  seam.side = DepthSide::both;
  side.strokes.push_back(seam);
  return {"bag", {front, side}};
}

Pattern named(const Drawing& drawing) {
  SketchInput input;
  input.drawing = drawing;
  input.hull.triangles = 1500;
  const PreparedSketch prepared = prepare_sketch(input);
  Pattern pattern =
      make_pattern({prepared.start, prepared.surface.hull.mesh.F}, seam_edges(prepared.surface))
          .pattern;
  name_pieces(pattern, drawing, prepared.surface, prepared.start);
  return pattern;
}

std::vector<std::string> names(const Pattern& pattern) {
  std::vector<std::string> all;
  for (const PatternPiece& piece : pattern.pieces) all.push_back(piece.name);
  std::sort(all.begin(), all.end());
  return all;
}

using Names = std::vector<std::string>;

TEST(PieceNames, AreThoseOfTheViewsWhereNothingIsNamed) {
  const Pattern pattern = named(bag("", ""));
  EXPECT_EQ(names(pattern), (Names{"back", "front"}));
  Names edges;
  for (const PieceEdge& edge : pattern.pieces[0].edges) edges.push_back(edge.name);
  EXPECT_NE(std::find(edges.begin(), edges.end(), "sides"), edges.end());
  EXPECT_NE(std::find(edges.begin(), edges.end(), "hem"), edges.end());
}

// The side view looks from +x: what is to the left on its page is towards +z, the front.
TEST(PieceNames, OfASeamAreLeftAndRightOnThePage) {
  const Drawing drawing = bag("flap + lining", "");
  const Pattern pattern = named(drawing);
  ASSERT_EQ(names(pattern), (Names{"flap", "lining"}));
  const Pattern other = named(bag("lining + flap", ""));
  ASSERT_EQ(other.pieces.size(), 2U);
  EXPECT_EQ(other.pieces[0].name, pattern.pieces[1].name);
}

TEST(PieceNames, OfOneBorderAreToldApartByTheirViews) {
  EXPECT_EQ(names(named(bag("", "body"))), (Names{"body back", "body front"}));
}

}  // namespace
}  // namespace geoprior::sketch
