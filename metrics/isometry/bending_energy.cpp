#include "metrics/isometry/bending_energy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

constexpr int kMostRings = 2;
constexpr std::size_t kPatchesOfBlock = 64;  // fitted by one thread: about 0.2 ms

Eigen::VectorXd areas_in_pattern(const Eigen::MatrixX2d& pattern,
                                 const Eigen::MatrixX3i& triangles) {
  Eigen::VectorXd area(triangles.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector2d a = pattern.row(triangles(t, 0));
    area[t] = cross(pattern.row(triangles(t, 1)).transpose() - a,
                    pattern.row(triangles(t, 2)).transpose() - a) /
              2;
    if (!(area[t] > 0)) {
      throw Error("no area in the pattern, or turned over", "triangle " + std::to_string(t),
                  "counter-clockwise triangles");
    }
  }
  return area;
}

void make_set(std::vector<int>* values) {
  std::sort(values->begin(), values->end());
  values->erase(std::unique(values->begin(), values->end()), values->end());
}

/// The triangles at any of some vertices, ascending.
template <class Vertices>
std::vector<int> touching(const Vertices& vertices, const VertexCorners& corners) {
  std::vector<int> result;
  for (const int v : vertices)
    for (const int c : corners.of(v)) result.push_back(c / 3);
  make_set(&result);
  return result;
}

/// The vertices of the triangles at `vertices`, ascending.
std::vector<int> with_neighbours(const std::vector<int>& vertices, const VertexCorners& corners,
                                 const Eigen::MatrixX3i& triangles) {
  std::vector<int> result;
  for (const int t : touching(vertices, corners))
    for (const int v : triangles.row(t)) result.push_back(v);
  make_set(&result);
  return result;
}

double determinant(const Eigen::RowVector3d& s) { return s[0] * s[2] - s[1] * s[1]; }

/// The least of S + t conic without determinant; S itself when there is none.
Eigen::RowVector3d developable(const Eigen::RowVector3d& s, const Eigen::RowVector3d& conic) {
  // det(S + t Q) = det S + t (S : cof Q) + t^2 det Q.
  const double a = determinant(conic);
  const double b = s[0] * conic[2] + s[2] * conic[0] - 2 * s[1] * conic[1];
  const double c = determinant(s);
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return s;
  // The root of least size, written so that a = 0 is no exception.
  const double sum = b + std::copysign(std::sqrt(discriminant), b);
  if (sum == 0) return s;
  return s - 2 * c / sum * conic;
}

}  // namespace

QuadricCurvature::QuadricCurvature(const Eigen::MatrixX2d& pattern,
                                   const Eigen::MatrixX3i& triangles)
    : triangles_(triangles),
      corners_(triangles, static_cast<int>(pattern.rows())),
      area_(areas_in_pattern(pattern, triangles)),
      patches_(triangles.rows()) {
  const auto fitted = [&](int t) {
    const Eigen::RowVector2d centroid =
        (pattern.row(triangles(t, 0)) + pattern.row(triangles(t, 1)) +
         pattern.row(triangles(t, 2))) /
        3;
    Patch best;
    std::vector<int> vertices{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    for (int ring = 0; ring < kMostRings; ++ring) {
      vertices = with_neighbours(vertices, corners_, triangles);
      const std::optional<QuadricFit> fit =
          fit_quadric(pattern(vertices, Eigen::all).rowwise() - centroid);
      const bool better = fit && (ring == 0 || fit->unobserved < best.fit.unobserved);
      if (better) best = {vertices, *fit};
      if (fit && best.fit.unobserved == 0) break;
    }
    return best;
  };
  parallel_blocks(patches_.size(), kPatchesOfBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) patches_[t] = fitted(static_cast<int>(t));
  });
}

Eigen::RowVector3d QuadricCurvature::shape_operator(const Patch& patch,
                                                    const Eigen::MatrixX3d& x) const {
  Eigen::Matrix<double, 6, 3> f = Eigen::Matrix<double, 6, 3>::Zero();
  for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
    f += patch.fit.weights.row(i).transpose() * x.row(patch.vertices[i]);
  }
  const Eigen::Vector3d n = f.row(QuadricFit::kU)
                                .transpose()
                                .head<3>()
                                .cross(f.row(QuadricFit::kV).transpose().head<3>())
                                .normalized();
  const Eigen::RowVector3d s = (f.bottomRows<3>() * n).transpose();
  return patch.fit.unobserved == 1 ? developable(s, patch.fit.conic.transpose()) : s;
}

Eigen::MatrixX3d QuadricCurvature::shape_operators(const Eigen::MatrixX3d& x) const {
  Eigen::MatrixX3d result(triangles_.rows(), 3);
  parallel_blocks(patches_.size(), kPatchesOfBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) result.row(t) = shape_operator(patches_[t], x);
  });
  return result;
}

Eigen::MatrixX3d QuadricCurvature::patch_means(const Eigen::MatrixX3d& of_triangles) const {
  Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(triangles_.rows(), 3);
  parallel_blocks(patches_.size(), kPatchesOfBlock, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index t = begin; t < static_cast<Eigen::Index>(end); ++t) {
      double sum = 0;
      for (const int near : touching(triangles_.row(t), corners_)) {
        result.row(t) += area_[near] * of_triangles.row(near);
        sum += area_[near];
      }
      result.row(t) /= sum;
    }
  });
  return result;
}

double bending_energy(const QuadricCurvature& curvature, const Eigen::MatrixX3d& x,
                      const Eigen::MatrixX3d& rest_curvature, const PlateStiffness& plate) {
  if (rest_curvature.rows() != curvature.areas().size()) {
    throw Error(std::to_string(rest_curvature.rows()) + " rest curvatures", "bending energy",
                std::to_string(curvature.areas().size()) + ", one a triangle");
  }
  const Eigen::MatrixX3d elastic =
      curvature.shape_operators(x) - curvature.patch_means(rest_curvature);
  double energy = 0;
  for (Eigen::Index t = 0; t < elastic.rows(); ++t) {
    energy += curvature.areas()[t] * plate_form(elastic(t, 0), elastic(t, 1), elastic(t, 2), plate);
  }
  return energy * plate.bending / 2;
}

}  // namespace geoprior
