#pragma once

#include <Eigen/Core>
#include <memory>

#include "models/details/detail_scene.h"

namespace geoprior::details {

/// Nearest points of a surface in space, by a tree of boxes (CGAL). Points on a shared edge belong
/// to one of its triangles.
class SurfaceProjector {
 public:
  explicit SurfaceProjector(const TriMesh& surface);
  ~SurfaceProjector();
  SurfaceProjector(const SurfaceProjector&) = delete;
  SurfaceProjector& operator=(const SurfaceProjector&) = delete;

  struct Nearest {
    SurfacePoint point;
    double distance = 0;  ///< m
  };
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& x) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace geoprior::details
