#include "solvers/sketch/drawing/mirror_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/connectivity.h"

namespace geoprior::sketch {
namespace {

/// Vertices and triangles of the half that is kept, as they are found.
class KeptHalf {
 public:
  KeptHalf(const TexturedSurface& surface, const MirrorPlane& plane, bool positive, double near);
  void cut(Eigen::Index triangle);
  [[nodiscard]] TexturedSurface with_image(const MirrorPlane& plane) const;

 private:
  int kept(int vertex);
  int crossing(int half_edge);
  int add(const Eigen::Vector3d& position, const Eigen::Vector2d& texture, bool in_plane);

  const TexturedSurface& surface_;
  Eigen::MatrixX3d V_;        // of the surface, with near vertices put onto the plane
  Eigen::VectorXd distance_;  // positive on the side that is kept
  std::vector<int> number_;
  EdgeConnectivity edges_;
  std::vector<int> crossing_;  // new vertex of each edge, -1: none yet
  std::vector<Eigen::Vector3d> position_;
  std::vector<Eigen::Vector2d> texture_;
  std::vector<bool> in_plane_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> patch_;
};

KeptHalf::KeptHalf(const TexturedSurface& surface, const MirrorPlane& plane, bool positive,
                   double near)
    : surface_(surface),
      V_(surface.mesh.V),
      distance_(V_.rows()),
      number_(V_.rows(), -1),
      edges_(surface.mesh.F),
      crossing_(edges_.edge_count(), -1) {
  for (Eigen::Index v = 0; v < V_.rows(); ++v) {
    const double d = signed_distance(plane, V_.row(v).transpose());
    const bool on_plane = std::abs(d) <= near;
    if (on_plane) V_.row(v) -= d * plane.normal.transpose();
    distance_(v) = on_plane ? 0 : (positive ? d : -d);
  }
}

int KeptHalf::add(const Eigen::Vector3d& position, const Eigen::Vector2d& texture, bool in_plane) {
  position_.push_back(position);
  texture_.push_back(texture);
  in_plane_.push_back(in_plane);
  return static_cast<int>(position_.size()) - 1;
}

int KeptHalf::kept(int vertex) {
  if (number_[vertex] < 0) {
    number_[vertex] = add(V_.row(vertex).transpose(), surface_.texture.row(vertex).transpose(),
                          distance_(vertex) == 0);
  }
  return number_[vertex];
}

int KeptHalf::crossing(int half_edge) {
  const int edge = edges_.edge_of(half_edge);
  if (crossing_[edge] < 0) {
    const auto [a, b] = edges_.edge(edge);
    const double t = distance_(a) / (distance_(a) - distance_(b));
    crossing_[edge] =
        add(((1 - t) * V_.row(a) + t * V_.row(b)).transpose(),
            ((1 - t) * surface_.texture.row(a) + t * surface_.texture.row(b)).transpose(), true);
  }
  return crossing_[edge];
}

/// The part of a triangle on the side that is kept, a fan of triangles.
void KeptHalf::cut(Eigen::Index triangle) {
  const Eigen::Vector3i corner = surface_.mesh.F.row(triangle).transpose();
  if (!(distance_(corner(0)) > 0 || distance_(corner(1)) > 0 || distance_(corner(2)) > 0)) return;
  std::vector<int> polygon;
  for (int k = 0; k < 3; ++k) {
    const int a = corner(k), b = corner((k + 1) % 3);
    if (distance_(a) >= 0) polygon.push_back(kept(a));
    if (distance_(a) * distance_(b) < 0)
      polygon.push_back(crossing(3 * static_cast<int>(triangle) + k));
  }
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    triangles_.push_back({polygon[0], polygon[k], polygon[k + 1]});
    patch_.push_back(surface_.patch[triangle]);
  }
}

TexturedSurface KeptHalf::with_image(const MirrorPlane& plane) const {
  const Eigen::Index n = position_.size();
  std::vector<int> image(position_.size());
  Eigen::Index count = n;
  for (int v = 0; v < std::ssize(image); ++v)
    image[v] = in_plane_[v] ? v : static_cast<int>(count++);
  TexturedSurface whole;
  whole.mesh.V.resize(count, 3);
  whole.texture.resize(count, 2);
  for (std::size_t v = 0; v < image.size(); ++v) {
    const Eigen::Index row = v;
    whole.mesh.V.row(image[v]) = mirrored(plane, position_[v]).transpose();
    whole.mesh.V.row(row) = position_[v].transpose();
    whole.texture.row(row) = whole.texture.row(image[v]) = texture_[v].transpose();
  }
  const Eigen::Index m = triangles_.size();
  whole.mesh.F.resize(2 * m, 3);
  for (Eigen::Index t = 0; t < m; ++t) {
    const auto& [a, b, c] = triangles_[t];
    whole.mesh.F.row(t) << a, b, c;
    whole.mesh.F.row(m + t) << image[a], image[c], image[b];
  }
  whole.patch = patch_;
  whole.patch.insert(whole.patch.end(), patch_.begin(), patch_.end());
  whole.mirror_image.assign(triangles_.size(), false);
  whole.mirror_image.insert(whole.mirror_image.end(), triangles_.size(), true);
  return whole;
}

}  // namespace

TexturedSurface mirror_half(const TexturedSurface& surface, const MirrorPlane& plane, bool positive,
                            double near) {
  KeptHalf half(surface, plane, positive, near);
  for (Eigen::Index t = 0; t < surface.mesh.F.rows(); ++t) half.cut(t);
  return half.with_image(plane);
}

}  // namespace geoprior::sketch
