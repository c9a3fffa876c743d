#include "models/details/point_grid.h"

#include <cmath>

namespace geoprior::details {

PointGrid::PointGrid(double cell, std::size_t expected) : cell_(cell) {
  std::size_t buckets = 16;
  while (buckets < 2 * expected) buckets *= 2;
  first_.assign(buckets, -1);
  entry_.reserve(expected);
}

std::int64_t PointGrid::cell_of(double coordinate) const {
  return static_cast<std::int64_t>(std::floor(coordinate / cell_));
}

/// Three large primes (Teschner et al. 2003), then the high bits mixed in.
std::size_t PointGrid::bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 73856093u ^
                    static_cast<std::uint64_t>(y) * 19349663u ^
                    static_cast<std::uint64_t>(z) * 83492791u;
  h ^= h >> 17;
  return static_cast<std::size_t>(h) & (first_.size() - 1);
}

void PointGrid::add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
  int& first = first_[bucket(cell_of(position.x()), cell_of(position.y()), cell_of(position.z()))];
  const int number = static_cast<int>(entry_.size());
  entry_.push_back({position, normal, first});
  first = number;
}

void PointGrid::add_details(const DetailMesh& details) {
  for (int i = 0; i < details.site_slots(); ++i) {
    if (!details.is_detail(i)) continue;
    add(details.position[i], normal_of_face(details.site[i].at.face, *details.surface, details.x));
  }
}

/// `visit(number, entry)` for a superset of the points within the radius; two cells may share a
/// bucket, so a point may be visited twice. Stops when `visit` returns false.
template <class Visit>
void PointGrid::visit_near(const Eigen::Vector3d& p, double radius, const Visit& visit) const {
  std::array<std::int64_t, 3> low{}, high{};
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = cell_of(p[k] - radius);
    high[k] = cell_of(p[k] + radius);
  }
  for (std::int64_t x = low[0]; x <= high[0]; ++x)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t z = low[2]; z <= high[2]; ++z)
        for (int i = first_[bucket(x, y, z)]; i >= 0; i = entry_[i].next)
          if (!visit(i, entry_[i])) return;
}

bool PointGrid::is_free(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                        double radius) const {
  bool free = true;
  visit_near(position, radius, [&](int, const Entry& e) {
    free = (e.position - position).squaredNorm() >= radius * radius || e.normal.dot(normal) <= 0;
    return free;
  });
  return free;
}

int PointGrid::nearest(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                       double radius) const {
  int best = -1;
  double least = radius * radius;
  visit_near(position, radius, [&](int i, const Entry& e) {
    const double d = (e.position - position).squaredNorm();
    const bool nearer = d < least || (d == least && (best < 0 || i < best));
    if (nearer && e.normal.dot(normal) > 0) {
      least = d;
      best = i;
    }
    return true;
  });
  return best;
}

}  // namespace geoprior::details
