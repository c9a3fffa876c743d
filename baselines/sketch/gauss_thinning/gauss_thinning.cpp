#include "baselines/sketch/gauss_thinning/gauss_thinning.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "baselines/sketch/shared/symmetric_eigen.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

constexpr std::size_t kTrianglesTogether = 256;

/// Options that make sense, or an Error; also checked because members are built from them.
const GaussThinningOptions& checked_thinning(const GaussThinningOptions& o) {
  const auto refuse = [](const char* what, const char* allowed) {
    throw Error(what, "Gauss thinning", allowed);
  };
  if (!(o.radius >= 0)) refuse("the radius is negative", "0 or more");
  if (!(o.start_angle_deg > 0 && o.start_angle_deg <= 180))
    refuse("start_angle_deg is out of bounds", "above 0, at most 180");
  if (!(o.final_angle_deg > 0 && o.final_angle_deg <= o.start_angle_deg))
    refuse("final_angle_deg is out of bounds", "above 0, at most start_angle_deg");
  if (!(o.shrink > 0 && o.shrink <= 1)) refuse("shrink is out of bounds", "above 0, at most 1");
  return o;
}

/// Rotation by the shortest way from a unit vector to another that is not opposite.
Eigen::Matrix3d shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d axis = from.cross(to);
  const double cosine = from.dot(to);
  Eigen::Matrix3d rotation = axis * axis.transpose() / (1 + cosine);
  rotation.diagonal().array() += cosine;
  rotation(0, 1) -= axis.z();
  rotation(1, 0) += axis.z();
  rotation(0, 2) += axis.y();
  rotation(2, 0) -= axis.y();
  rotation(1, 2) -= axis.x();
  rotation(2, 1) += axis.x();
  return rotation;
}

/// Walks from triangle to triangle over shared vertices; one for each block of triangles.
class NeighbourWalk {
 public:
  NeighbourWalk(const TriMesh& mesh, const VertexCorners& corners,
                const Eigen::MatrixX3d& barycentre, double radius)
      : mesh_(mesh),
        corners_(corners),
        barycentre_(barycentre),
        squared_radius_(radius * radius),
        seen_from_(mesh.triangle_count(), -1) {}

  /// Triangles around one, ascending.
  std::vector<int> around(int centre) {
    std::vector<int> found{centre};
    seen_from_[centre] = centre;
    for (std::size_t next = 0; next < found.size(); ++next) {
      for (int k = 0; k < 3; ++k) {
        for (const int corner : corners_.of(mesh_.F(found[next], k))) {
          const int t = corner / 3;
          const bool near =
              next == 0 ||
              (barycentre_.row(t) - barycentre_.row(centre)).squaredNorm() < squared_radius_;
          if (seen_from_[t] == centre || !near) continue;
          seen_from_[t] = centre;
          found.push_back(t);
        }
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  const TriMesh& mesh_;
  const VertexCorners& corners_;
  const Eigen::MatrixX3d& barycentre_;
  double squared_radius_;
  std::vector<int> seen_from_;
};

}  // namespace

void describe(OptionVisitor& v, GaussThinningOptions& options) {
  v.value(
      "radius", options.radius,
      {.doc = "radius of a neighbourhood, in diagonals of the bounding box", .min = 0, .max = 1});
  v.value("start_angle_deg", options.start_angle_deg,
          {.doc = "angle of the cone of normals that count, at first", .unit = "deg", .max = 180});
  v.value(
      "final_angle_deg", options.final_angle_deg,
      {.doc = "angle of the cone of normals that count, in the end", .unit = "deg", .max = 180});
  v.value("shrink", options.shrink,
          {.doc = "factor on the angle of the cone of normals from one step to the next",
           .min = 0,
           .max = 1});
}

GaussThinning::GaussThinning(const TriMesh& mesh, const GaussThinningOptions& options)
    : mesh_(mesh),
      options_(checked_thinning(options)),
      poisson_(mesh),
      normal_(4, mesh.triangle_count()),
      rotation_(mesh.triangle_count(), Eigen::Matrix3d::Identity()),
      missed_(Eigen::VectorXd::Zero(mesh.triangle_count())),
      cone_deg_(options.start_angle_deg) {
  find_neighbourhoods(options.radius * bounding_box_diagonal(mesh.V));
}

void GaussThinning::find_neighbourhoods(double radius) {
  const std::size_t m = mesh_.triangle_count();
  Eigen::MatrixX3d barycentre(mesh_.triangle_count(), 3);
  for (Eigen::Index t = 0; t < mesh_.F.rows(); ++t) {
    barycentre.row(t) =
        (mesh_.V.row(mesh_.F(t, 0)) + mesh_.V.row(mesh_.F(t, 1)) + mesh_.V.row(mesh_.F(t, 2))) / 3;
  }
  const VertexCorners corners(mesh_.F, mesh_.vertex_count());
  std::vector<std::vector<int>> rows(m);
  parallel_blocks(m, 4 * kTrianglesTogether, [&](std::size_t begin, std::size_t end) {
    NeighbourWalk walk(mesh_, corners, barycentre, radius);
    for (std::size_t t = begin; t < end; ++t) rows[t] = walk.around(static_cast<int>(t));
  });
  begin_.assign(1, 0);
  for (const std::vector<int>& row : rows) {
    neighbour_.insert(neighbour_.end(), row.begin(), row.end());
    begin_.push_back(neighbour_.size());
  }
}

void GaussThinning::measure() {
  parallel_blocks(rotation_.size(), kTrianglesTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Index t = i;
      const Eigen::RowVector3d a = mesh_.V.row(mesh_.F(t, 0));
      const Eigen::Vector3d cross =
          (mesh_.V.row(mesh_.F(t, 1)) - a).cross(mesh_.V.row(mesh_.F(t, 2)) - a).transpose();
      const double twice_area = cross.norm();
      normal_.col(t).head<3>() = cross / (twice_area > 0 ? twice_area : 1);
      normal_(3, t) = twice_area / 2;
    }
  });
}

double GaussThinning::turn_onto_circle(int t, double cone_cosine) {
  const Eigen::Vector3d n = normal_.col(t).head<3>();
  // The fourth row, in which areas take part, is left over: four make a register.
  Eigen::Matrix<double, 4, 3> moments = Eigen::Matrix<double, 4, 3>::Zero();
  for (std::size_t e = begin_[t]; e < begin_[t + 1]; ++e) {
    const auto m = normal_.col(neighbour_[e]);
    if (!(m.head<3>().dot(n) >= cone_cosine)) continue;
    const Eigen::Vector4d weighted = m(3) * m;
    for (int k = 0; k < 3; ++k) moments.col(k) += m(k) * weighted;
  }
  const Eigen::Vector3d axis = smallest_eigenvector(moments.topRows<3>());
  const double sine = n.dot(axis);
  const Eigen::Vector3d on_circle = n - sine * axis;
  const double cosine = on_circle.norm();
  rotation_[t] = cosine > 0.5 ? shortest_rotation(n, on_circle / cosine)
                              : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  return sine * sine;
}

void GaussThinning::step() {
  measure();
  const double cone_cosine = std::cos(cone_deg_ * kDegree);
  parallel_blocks(rotation_.size(), kTrianglesTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Eigen::Index i = t;
      missed_(i) = normal_(3, i) * turn_onto_circle(static_cast<int>(t), cone_cosine);
    }
  });
  const double area = normal_.row(3).sum();
  energy_ = area > 0 ? missed_.sum() / area : 0;
  mesh_.V = poisson_.solve(rotation_, mesh_.V);
  cone_deg_ = std::max(options_.final_angle_deg, cone_deg_ * options_.shrink);
  ++iterations_;
}

}  // namespace geoprior::sketch
