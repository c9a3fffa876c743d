#include "testbed/formats/mesh/polygon_soup.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/error.h"

namespace geoprior {
namespace {

/// Newell's normal, twice the area vector of a polygon that need not be planar.
Eigen::Vector3d area_vector(const std::vector<Eigen::Vector3d>& points, std::span<const int> face) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& origin = points[face[0]];
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Eigen::Vector3d u = points[face[i]] - origin;
    sum += u.cross(points[face[i + 1]] - origin);
  }
  return sum;
}

/// Clips ears off a polygon seen along its normal.
class EarClipper {
 public:
  EarClipper(const std::vector<Eigen::Vector3d>& points, std::span<const int> face)
      : points_(points), normal_(area_vector(points, face)), left_(face.begin(), face.end()) {}

  void clip(std::vector<Eigen::Vector3i>& triangles) {
    while (left_.size() > 3) {
      const std::size_t ear = find_ear();
      triangles.emplace_back(before(ear), left_[ear], after(ear));
      left_.erase(left_.begin() + ear);
    }
    triangles.emplace_back(left_[0], left_[1], left_[2]);
  }

 private:
  [[nodiscard]] int before(std::size_t i) const {
    return left_[(i + left_.size() - 1) % left_.size()];
  }
  [[nodiscard]] int after(std::size_t i) const { return left_[(i + 1) % left_.size()]; }

  /// Twice the signed area along the normal, times its length.
  [[nodiscard]] double turn(int a, int b, int c) const {
    const auto at = [&](int v) -> const Eigen::Vector3d& { return points_[v]; };
    return (at(b) - at(a)).cross(at(c) - at(a)).dot(normal_);
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const int a = before(i), b = left_[i], c = after(i);
    if (!(turn(a, b, c) > 0)) return false;
    return std::none_of(left_.begin(), left_.end(), [&](int p) {
      return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
             turn(c, a, p) >= 0;
    });
  }

  /// The ear with the shortest cut; corner 1 (a fan) where nothing is an ear.
  [[nodiscard]] std::size_t find_ear() const {
    std::size_t best = 1;
    double shortest = -1;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const double cut = (points_[before(i)] - points_[after(i)]).squaredNorm();
      if ((shortest < 0 || cut < shortest) && is_ear(i)) {
        best = i;
        shortest = cut;
      }
    }
    return best;
  }

  const std::vector<Eigen::Vector3d>& points_;
  Eigen::Vector3d normal_;
  std::vector<int> left_;
};

Eigen::MatrixX3d rows_of(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::MatrixX3d out(vectors.size(), 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    out.row(i) = vectors[i].transpose();
  }
  return out;
}

void check_face(const PolygonSoup& soup, std::span<const int> face, std::size_t number,
                const std::string& name) {
  const auto where = [&] { return name + ", face " + std::to_string(number); };
  if (face.size() < 3 || face.size() > PolygonSoup::kMostCorners) {
    throw Error("has " + std::to_string(face.size()) + " corners", where(),
                "3 to " + std::to_string(PolygonSoup::kMostCorners));
  }
  for (const int v : face) {
    if (v >= 0 && static_cast<std::size_t>(v) < soup.points.size()) continue;
    throw Error("refers to vertex " + std::to_string(v) + ", counted from 0", where(),
                soup.points.empty() ? "no vertex there is"
                                    : "0 to " + std::to_string(soup.points.size() - 1));
  }
}

}  // namespace

void triangulate_face(const std::vector<Eigen::Vector3d>& points, std::span<const int> face,
                      std::vector<Eigen::Vector3i>& triangles) {
  if (face.size() == 3) {
    triangles.emplace_back(face[0], face[1], face[2]);
  } else {
    EarClipper(points, face).clip(triangles);
  }
}

MeshFile mesh_of(const PolygonSoup& soup, const std::string& name) {
  std::vector<Eigen::Vector3i> triangles;
  triangles.reserve(soup.ends.size());
  std::size_t begin = 0;
  for (std::size_t f = 0; f < soup.ends.size(); ++f) {
    const std::span<const int> face(soup.corners.data() + begin, soup.ends[f] - begin);
    check_face(soup, face, f, name);
    triangulate_face(soup.points, face, triangles);
    begin = soup.ends[f];
  }
  MeshFile file;
  file.mesh.V = rows_of(soup.points);
  file.mesh.F.resize(triangles.size(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    file.mesh.F.row(t) = triangles[t].transpose();
  }
  file.velocity = rows_of(soup.velocity);
  return file;
}

}  // namespace geoprior
