#include "models/sketch/ridges/edge_flips.h"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "core/connectivity.h"

namespace geoprior::sketch {
namespace {

class FlipPass {
 public:
  explicit FlipPass(Eigen::MatrixX3i& F) : F_(F), edges_(F), touched_(F.rows(), 0) {}

  int run(const std::function<bool(const EdgeDiamond&)>& is_wanted) {
    int flips = 0;
    for (int e = 0; e < edges_.edge_count(); ++e) {
      const std::optional<EdgeDiamond> found = diamond(e);
      if (!found || !is_wanted(*found)) continue;
      flip(*found);
      ++flips;
    }
    return flips;
  }

 private:
  /// Nothing where a flip would leave no manifold, or touch what another one has touched.
  [[nodiscard]] std::optional<EdgeDiamond> diamond(int e) const {
    const std::span<const int> sides = edges_.half_edges(e);
    if (sides.size() != 2) return std::nullopt;
    const int h = sides[0], g = sides[1];
    EdgeDiamond at_edge{h / 3, g / 3, edges_.origin(h), edges_.tip(h), 0, 0, {}};
    at_edge.c = edges_.tip(EdgeConnectivity::next(h));
    at_edge.d = edges_.tip(EdgeConnectivity::next(g));
    at_edge.around = {edges_.across(h / 3, EdgeConnectivity::next(h) % 3),
                      edges_.across(h / 3, EdgeConnectivity::previous(h) % 3),
                      edges_.across(g / 3, EdgeConnectivity::next(g) % 3),
                      edges_.across(g / 3, EdgeConnectivity::previous(g) % 3)};
    const bool used = touched_[at_edge.left] || touched_[at_edge.right] ||
                      std::any_of(at_edge.around.begin(), at_edge.around.end(), [&](int triangle) {
                        return triangle >= 0 && touched_[triangle];
                      });
    if (used || edges_.origin(g) != at_edge.b || at_edge.c == at_edge.d) return std::nullopt;
    if (edges_.find(at_edge.c, at_edge.d) || edges_.valence(at_edge.a) <= 3 ||
        edges_.valence(at_edge.b) <= 3)
      return std::nullopt;
    return at_edge;
  }

  void flip(const EdgeDiamond& of) {
    F_.row(of.left) << of.c, of.d, of.b;
    F_.row(of.right) << of.d, of.c, of.a;
    touched_[of.left] = touched_[of.right] = 1;
    for (const int triangle : of.around) {
      if (triangle >= 0) touched_[triangle] = 1;
    }
  }

  Eigen::MatrixX3i& F_;
  EdgeConnectivity edges_;
  std::vector<char> touched_;
};

}  // namespace

int flip_edges(Eigen::MatrixX3i& F, const std::function<bool(const EdgeDiamond&)>& is_wanted) {
  return FlipPass(F).run(is_wanted);
}

}  // namespace geoprior::sketch
