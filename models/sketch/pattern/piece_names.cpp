#include "models/sketch/pattern/piece_names.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace geoprior::sketch {
namespace {

/// Least length of the mean of a piece's normals at which it looks into a direction. Ours.
constexpr double kLeastFacing = 0.35;

const Stroke* drawn_stroke(const Drawing& drawing, const SketchSurface& surface, int view,
                           int number, StrokeKind kind) {
  if (view < 0 || number < 0 || view >= std::ssize(surface.hull.views)) return nullptr;
  const View* drawn = drawing.find(surface.hull.views[view].kind);
  if (drawn == nullptr) return nullptr;
  const std::vector<const Stroke*> strokes = strokes_of(*drawn, kind);
  return number < std::ssize(strokes) ? strokes[number] : nullptr;
}

class PieceNaming {
 public:
  PieceNaming(Pattern& pattern, const Drawing& drawing, const SketchSurface& surface,
              const Eigen::MatrixX3d& X)
      : pattern_(pattern), drawing_(drawing), surface_(surface), X_(X) {}

  void name() {
    for (PatternPiece& piece : pattern_.pieces) {
      std::map<std::string, double> votes;
      third_.clear();
      for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
        for (int k = 0; k < 3; ++k)
          third_[{piece.triangles(t, k), piece.triangles(t, (k + 1) % 3)}] =
              piece.triangles(t, (k + 2) % 3);
      }
      for (PieceEdge& edge : piece.edges) vote(piece, edge, votes);
      named_.push_back(most(votes));
      facing_.push_back(facing(piece));
    }
    for (std::size_t p = 0; p < pattern_.pieces.size(); ++p) {
      if (named_[p].empty()) named_[p] = std::exchange(facing_[p], {});
    }
    const std::vector<std::string> first = named_;
    for (std::size_t p = 0; p < named_.size(); ++p) {
      if (!named_[p].empty() && repeated(first, p) && !facing_[p].empty())
        named_[p].append(" ").append(facing_[p]);
    }
    const std::vector<std::string> second = named_;
    std::map<std::string, int> count;
    for (std::size_t p = 0; p < named_.size(); ++p) {
      if (named_[p].empty()) continue;
      if (repeated(second, p)) named_[p].append(" ").append(std::to_string(++count[second[p]]));
      pattern_.pieces[p].name = named_[p];
    }
  }

 private:
  static bool repeated(const std::vector<std::string>& names, std::size_t p) {
    return std::count(names.begin(), names.end(), names[p]) > 1;
  }

  static std::string most(const std::map<std::string, double>& votes) {
    std::string best;
    double largest = 0;
    for (const auto& [name, length] : votes) {
      if (length <= largest * (1 + 1e-9)) continue;
      largest = length;
      best = name;
    }
    return best;
  }

  /// Names the edge, and counts its length for what its stroke calls the piece.
  void vote(const PatternPiece& piece, PieceEdge& edge, std::map<std::string, double>& votes) {
    if (edge.seam >= 0) {
      if (edge.seam >= std::ssize(surface_.seams)) {
        edge.name = "opening";
        return;
      }
      const StrokePath& seam = surface_.seams[edge.seam];
      edge.name = seam.id;
      const Stroke* stroke =
          drawn_stroke(drawing_, surface_, seam.view, seam.number, StrokeKind::seam);
      if (stroke != nullptr) vote_seam(piece, edge, *stroke, seam.view, votes);
      return;
    }
    std::map<int, int> borders;
    for (const int v : edge.vertices) {
      const int s = piece.surface_vertex[v];
      if (s < std::ssize(surface_.border_of) && surface_.border_of[s] >= 0)
        ++borders[surface_.border_of[s]];
    }
    if (borders.empty()) return;
    const auto& place =
        surface_.borders
            [std::max_element(borders.begin(), borders.end(), [](const auto& a, const auto& b) {
               return a.second < b.second;
             })->first];
    edge.name = place.id;
    const Stroke* stroke =
        drawn_stroke(drawing_, surface_, place.view, place.number, StrokeKind::border);
    if (stroke == nullptr) return;
    for (const std::string& name : panels_in(stroke->name)) votes[name] += length_of(piece, edge);
  }

  [[nodiscard]] Eigen::Vector3d place(const PatternPiece& piece, int v) const {
    return X_.row(piece.surface_vertex[v]).transpose();
  }

  [[nodiscard]] double length_of(const PatternPiece& piece, const PieceEdge& edge) const {
    double sum = 0;
    for (std::size_t i = 1; i < edge.vertices.size(); ++i)
      sum += (place(piece, edge.vertices[i]) - place(piece, edge.vertices[i - 1])).norm();
    return sum;
  }

  /// Which side of the stroke the piece lies on, segment by segment, as the page shows it.
  void vote_seam(const PatternPiece& piece, const PieceEdge& edge, const Stroke& stroke, int view,
                 std::map<std::string, double>& votes) const {
    const std::vector<std::string> names = panels_in(stroke.name);
    if (names.empty()) return;
    const OutlinedView& seen = surface_.hull.views[view];
    for (std::size_t i = 1; i < edge.vertices.size(); ++i) {
      const Eigen::Vector3d a = place(piece, edge.vertices[i - 1]),
                            b = place(piece, edge.vertices[i]);
      const double length = (b - a).norm();
      if (names.size() == 1) {
        votes[names[0]] += length / 2;  // of two pieces
        continue;
      }
      const Eigen::Vector2d middle = seen.project((a + b) / 2);
      const Eigen::Vector2d aside = inwards(piece, edge.vertices[i - 1], edge.vertices[i], seen);
      const bool first = stroke.closed         ? is_inside(stroke.points, middle + 0.5 * aside)
                         : runs_across(stroke) ? aside.y() > 0
                                               : aside.x() < 0;
      votes[first ? names[0] : names[1]] += length;
    }
  }

  /// From the edge's middle to the third corner of its triangle of the piece, in the view.
  [[nodiscard]] Eigen::Vector2d inwards(const PatternPiece& piece, int a, int b,
                                        const OutlinedView& seen) const {
    const auto third = third_.find({a, b});
    if (third == third_.end()) return Eigen::Vector2d::Zero();
    return seen.project(place(piece, third->second)) -
           seen.project((place(piece, a) + place(piece, b)) / 2);
  }

  static bool runs_across(const Stroke& stroke) {
    const Eigen::Vector2d along = stroke.points.back() - stroke.points.front();
    return std::abs(along.x()) > std::abs(along.y());
  }

  static bool is_inside(const std::vector<Eigen::Vector2d>& loop, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      if ((loop[i].y() > p.y()) == (loop[j].y() > p.y())) continue;
      const double at = loop[i].x() + (p.y() - loop[i].y()) / (loop[j].y() - loop[i].y()) *
                                          (loop[j].x() - loop[i].x());
      if (p.x() < at) inside = !inside;
    }
    return inside;
  }

  [[nodiscard]] std::string facing(const PatternPiece& piece) const {
    static constexpr std::array<std::array<const char*, 2>, 3> kSides{
        {{"left", "right"}, {"top", "bottom"}, {"front", "back"}}};
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double area = 0;
    for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
      const Eigen::Vector3d a = place(piece, piece.triangles(t, 0));
      const Eigen::Vector3d normal =
          (place(piece, piece.triangles(t, 1)) - a).cross(place(piece, piece.triangles(t, 2)) - a);
      sum += normal;
      area += normal.norm();
    }
    if (!(sum.norm() > kLeastFacing * area)) return {};
    Eigen::Index axis = 0;
    sum.cwiseAbs().maxCoeff(&axis);
    return kSides[axis][sum[axis] > 0 ? 0 : 1];
  }

  Pattern& pattern_;
  const Drawing& drawing_;
  const SketchSurface& surface_;
  const Eigen::MatrixX3d& X_;
  std::vector<std::string> named_, facing_;
  std::map<std::pair<int, int>, int> third_;  ///< corner of the triangle at a directed edge
};

}  // namespace

void name_pieces(Pattern& pattern, const Drawing& drawing, const SketchSurface& surface,
                 const Eigen::MatrixX3d& X) {
  PieceNaming(pattern, drawing, surface, X).name();
}

}  // namespace geoprior::sketch
