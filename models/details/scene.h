#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/surface_point.h"
#include "core/inputs/surface_sequence.h"
#include "core/mesh.h"

namespace geoprior::details {

/// One detail: a spike, an instance of a mesh, a hole (thesis 2.2.2: position and weight omega).
struct Detail {
  SurfacePoint at;
  double weight = 1;         ///< omega in [0, 1]: factor of the drawn height or width
  double target_weight = 1;  ///< where the weight goes: 1, or 0 for a detail that fades away
  /// Angle of its tangent direction in the frame of the face: from the face's first edge (vertex 0
  /// to vertex 1), counter-clockwise seen from outside (rad).
  double tangent_angle = 0;
  int type = 0;            ///< which of the scene's kinds of detail
  std::int64_t birth = 0;  ///< identity: counts up, never used again
  int birth_frame = 0;     ///< frame in which it was born; 0 for those of the scene
  int generation = 0;      ///< 0 for the details of the scene, else one more than its neighbours'
};

/// The smooth surface over time: positions for a fixed list of triangles.
class SurfaceMotion {
 public:
  virtual ~SurfaceMotion() = default;
  [[nodiscard]] virtual int frame_count() const = 0;
  /// Parameter of the frame (time in s, factor of stretch …), strictly increasing.
  [[nodiscard]] virtual double parameter(int frame) const = 0;
  /// One row per vertex of the scene's surface (m). Frame 0 is the surface at rest.
  [[nodiscard]] virtual Eigen::MatrixX3d positions(int frame) const = 0;
};

/// Positions that are in memory.
class StoredMotion final : public SurfaceMotion {
 public:
  /// @throws Error  unless there is a frame, all have as many rows, and parameters increase
  StoredMotion(std::vector<Eigen::MatrixX3d> positions, std::vector<double> parameters);
  [[nodiscard]] int frame_count() const override { return static_cast<int>(positions_.size()); }
  [[nodiscard]] double parameter(int frame) const override;
  [[nodiscard]] Eigen::MatrixX3d positions(int frame) const override;

 private:
  std::vector<Eigen::MatrixX3d> positions_;
  std::vector<double> parameters_;
};

/// Positions of a mesh sequence (parameter: its time).
/// @throws Error  naming the first frame whose triangles are not those of the first frame
std::shared_ptr<const SurfaceMotion> motion_of_sequence(const SurfaceSequence& sequence);

/// What every method of the topic takes: a smooth surface, its details, and how it moves.
struct DetailScene {
  TriMesh surface;  ///< at rest; manifold, closed or with borders
  std::vector<Detail>
      details;  ///< at least 3; birth, birth_frame and generation are set by methods
  std::shared_ptr<const SurfaceMotion> motion;
  std::string name = "scene";  ///< what messages call it
};

/// Throws Error, naming place and cause, unless the scene can be worked on: a surface that is
/// finite, manifold, consistently oriented, in one piece and without triangles of no area; at least
/// 3 details with faces of the surface, barycentric coordinates in [0, 1] with sum 1 (1e-6) and
/// weights in [0, 1], no two of them closer than 1e-9 of the surface's size; frame 0 of the motion
/// is the surface.
void require_valid(const DetailScene& scene);

/// Throws Error, naming frame and triangle, when a frame of the motion has another number of
/// vertices, a vertex that is not finite, a triangle of no area, or triangles that turned over: the
/// normal against the frame before by more than 90 degrees, while half of all triangles or more did
/// not (those have turned with the surface).
void require_valid_step(const Eigen::MatrixX3i& F, const Eigen::MatrixX3d& before,
                        const Eigen::MatrixX3d& now, int frame, const std::string& name);

}  // namespace geoprior::details
