#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "baselines/details/detail_mesh.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Walks from one anchor to another through the faces that a plane cuts.
class Section {
 public:
  Section(const DetailMesh& d, int from, int to)
      : d_(d), from_(d.site[index(from)].at), to_(d.site[index(to)].at) {
    start_ = d.position[index(from)];
    end_ = d.position[index(to)];
    chord_ = (end_ - start_).norm();
    const Eigen::Vector3d up =
        normal_of_face(from_.face, *d.surface, d.x) + normal_of_face(to_.face, *d.surface, d.x);
    side_ = up.cross(end_ - start_);
  }

  /// Length of the section; that of the chord where the walk does not arrive.
  [[nodiscard]] double length() const {
    if (from_.face == to_.face || !(side_.squaredNorm() > 0)) return chord_;
    Eigen::Vector3d at = start_;
    double sum = 0;
    int face = from_.face, came_from = -1;
    for (int steps = 0; steps < 4096; ++steps) {
      if (face == to_.face) return std::max(chord_, sum + (end_ - at).norm());
      const auto [next, point] = leave(face, came_from);
      if (next < 0) return chord_;
      sum += (point - at).norm();
      if (sum > 4 * chord_) return chord_;
      at = point;
      came_from = face;
      face = next;
    }
    return chord_;
  }

 private:
  struct Crossing {
    int face = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };

  /// The edge of `face` that the plane cuts, not the one just crossed, nearest to the end.
  [[nodiscard]] Crossing leave(int face, int came_from) const {
    const auto& f = d_.surface->face[index(face)];
    Crossing best;
    double nearest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int g = d_.surface->across[index(face)][k];
      if (g < 0 || g == came_from) continue;
      const Eigen::Vector3d &a = d_.x[index(f[k])], &b = d_.x[index(f[(k + 1) % 3])];
      const double sa = side_.dot(a - start_), sb = side_.dot(b - start_);
      if ((sa > 0) == (sb > 0)) continue;
      const Eigen::Vector3d point = a + sa / (sa - sb) * (b - a);
      const double distance = (point - end_).squaredNorm();
      if (best.face >= 0 && distance >= nearest) continue;
      nearest = distance;
      best = {g, point};
    }
    return best;
  }

  const DetailMesh& d_;
  const SurfacePoint from_, to_;
  Eigen::Vector3d start_, end_, side_;
  double chord_ = 0;
};

}  // namespace

void measure_sections(DetailMesh& d) {
  std::vector<double> length(3 * index(d.mesh.triangle_slots()), 0.0);
  parallel_blocks(length.size(), 1536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int h = static_cast<int>(i);
      if (d.mesh.origin(h) < 0 || d.mesh.twin(h) > h) continue;
      length[i] = Section(d, d.mesh.origin(h), d.mesh.tip(h)).length();
    }
  });
  for (std::size_t i = 0; i < length.size(); ++i)
    if (length[i] > 0) d.mesh.set_length(static_cast<int>(i), length[i]);
}

}  // namespace geoprior
