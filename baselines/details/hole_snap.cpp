#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "baselines/details/hole_mesh.h"

namespace geoprior {

/// Moves vertices onto the borders, one by one, nearest first.
///
/// A vertex is then in a hole, outside, or on a border. A triangle counts as kept when a corner is
/// outside; one with corners on the border and inside only is dropped. The result is a manifold
/// when around every vertex on a border the kept triangles hang together; a move after which they
/// would not is refused.
class HoleMesh::Snapper {
 public:
  Snapper(HoleMesh& mesh, std::vector<int>& inside, std::vector<int>& on_border)
      : mesh_(mesh), inside_(inside), on_border_(on_border), triangle_of_(mesh.x_.size(), -1) {
    for (int t = 0; t < static_cast<int>(mesh.corner_.size()); ++t)
      for (const int v : mesh.corner_[index(t)]) triangle_of_[index(v)] = t;
  }

  void run() {
    for (const Move& move : moves()) try_move(move);
  }

 private:
  struct Move {
    double share = 1;  ///< of the edge
    int vertex = -1;
    int toward = -1;
  };
  static constexpr double kFar = 0.3;         ///< largest share of an edge that a vertex moves
  static constexpr double kNeedle = 0.2;      ///< least shape of a triangle after a move
  static constexpr double kTurnCosine = 0.9;  ///< of a triangle by a move

  [[nodiscard]] bool is_in(int v) const { return inside_[index(v)] >= 0; }
  [[nodiscard]] bool is_on(int v) const { return on_border_[index(v)] >= 0; }
  [[nodiscard]] bool is_out(int v) const { return !is_in(v) && !is_on(v); }
  [[nodiscard]] const Eigen::Vector3d& x(int v) const { return mesh_.x_[index(v)]; }

  /// The shortest way of each vertex to a border along an edge, where it is short enough.
  [[nodiscard]] std::vector<Move> moves() const {
    std::vector<Move> best(mesh_.x_.size());
    for (const auto& c : mesh_.corner_) {
      for (std::size_t k = 0; k < 3; ++k) {
        int a = c[k], b = c[(k + 1) % 3];
        if (is_in(a) == is_in(b)) continue;
        if (!is_in(a)) std::swap(a, b);
        const double s = mesh_.place_of_border(a, b, inside_[index(a)]);
        if (s < kFar && s < best[index(a)].share) best[index(a)] = {s, a, b};
        if (1 - s < kFar && 1 - s < best[index(b)].share) best[index(b)] = {1 - s, b, a};
      }
    }
    std::erase_if(best, [](const Move& m) { return m.vertex < 0; });
    std::sort(best.begin(), best.end(), [](const Move& a, const Move& b) {
      return std::tie(a.share, a.vertex) < std::tie(b.share, b.vertex);
    });
    return best;
  }

  /// Neighbours in cyclic order; empty at a border of the surface.
  [[nodiscard]] std::vector<int> ring_of(int v) const {
    std::vector<int> ring;
    const int first = triangle_of_[index(v)];
    int t = first;
    do {
      const auto& c = mesh_.corner_[index(t)];
      const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
      ring.push_back(c[(k + 1) % 3]);
      t = mesh_.across_[index(t)][(k + 2) % 3];
      if (t < 0) return {};
    } while (t != first);
    return ring;
  }

  /// One run of kept triangles, and a gap.
  [[nodiscard]] bool is_simple(const std::vector<int>& ring) const {
    const std::size_t n = ring.size();
    int runs = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const int before = ring[(i + n - 1) % n], w = ring[i], after = ring[(i + 1) % n];
      const bool joined = !is_in(w) && (is_out(before) || is_out(w));
      if ((is_out(w) || is_out(after)) && !joined) ++runs;
    }
    return runs == 1;
  }

  /// Twice the area over the square of the longest edge: 0.87 for equal sides.
  static double shape(const Eigen::Vector3d& normal, const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return normal.norm() /
           std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  }

  /// Whether the pieces around `v` would keep their side and be no needles were it at `to`.
  [[nodiscard]] bool keeps_shape(int v, const std::vector<int>& ring,
                                 const Eigen::Vector3d& to) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int a = ring[i], b = ring[(i + 1) % ring.size()];
      if (!is_out(a) && !is_out(b)) continue;
      const Eigen::Vector3d pa = is_in(a) ? border_between(a, b) : x(a);
      const Eigen::Vector3d pb = is_in(b) ? border_between(b, a) : x(b);
      const Eigen::Vector3d before = (x(a) - x(v)).cross(x(b) - x(v));
      const Eigen::Vector3d after = (pa - to).cross(pb - to);
      if (!is_in(a) && !is_in(b) &&
          shape(after, to, pa, pb) < std::min(kNeedle, 0.5 * shape(before, x(v), pa, pb)))
        return false;
      if (!(after.dot(before) > kTurnCosine * after.norm() * before.norm())) return false;
    }
    return true;
  }

  [[nodiscard]] Eigen::Vector3d border_between(int in, int out) const {
    const double s = mesh_.place_of_border(in, out, inside_[index(in)]);
    return (1 - s) * x(in) + s * x(out);
  }

  void try_move(const Move& move) {
    const int v = move.vertex;
    const std::vector<int> ring = ring_of(v);
    if (ring.empty() || is_on(move.toward)) return;
    const int hole = inside_[index(is_in(v) ? v : move.toward)], was_in = inside_[index(v)];
    for (const int w : ring) {
      if ((is_in(w) && inside_[index(w)] != hole) || (is_on(w) && on_border_[index(w)] != hole))
        return;
    }
    inside_[index(v)] = -1;
    on_border_[index(v)] = hole;
    const Eigen::Vector3d to = (1 - move.share) * x(v) + move.share * x(move.toward);
    const bool allowed = is_simple(ring) && keeps_shape(v, ring, to) &&
                         std::all_of(ring.begin(), ring.end(),
                                     [&](int w) { return !is_on(w) || is_simple(ring_of(w)); });
    if (allowed) {
      mesh_.x_[index(v)] = to;
      mesh_.normal_[index(v)] = ((1 - move.share) * mesh_.normal_[index(v)] +
                                 move.share * mesh_.normal_[index(move.toward)])
                                    .stableNormalized();
    } else {
      inside_[index(v)] = was_in;
      on_border_[index(v)] = -1;
    }
  }

  HoleMesh& mesh_;
  std::vector<int>& inside_;
  std::vector<int>& on_border_;
  std::vector<int> triangle_of_;
};

void HoleMesh::snap_to_borders(std::vector<int>& inside, std::vector<int>& on_border) {
  Snapper(*this, inside, on_border).run();
}

}  // namespace geoprior
