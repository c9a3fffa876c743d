#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/context.h"
#include "core/frame.h"
#include "core/method.h"
#include "models/details/mesh.h"

namespace geoprior::details {

/// A method of the topic, thesis or baseline: from one frame of the surface to the next.
class DetailMethod {
 public:
  virtual ~DetailMethod() = default;
  /// Follows the surface to the positions `V` of the next frame. This is what is timed.
  virtual void step(const Eigen::MatrixX3d& V, RunContext& context) = 0;
  [[nodiscard]] virtual const DetailMesh& details() const = 0;
  /// What only the method knows of its last step (inserted, merged, flips, failed_queries …).
  virtual void diagnose(std::map<std::string, double>& /*into*/) const {}
  /// All that `step` depends on, so that a run can go on after a stop.
  virtual void save(StateWriter& out) const = 0;
  virtual void load(StateReader& in) = 0;
};

/// Makes a method at frame 0 of the scene. Phase "prepare" is around it.
using DetailMethodFactory =
    std::function<std::unique_ptr<DetailMethod>(const DetailScene&, RunContext&)>;

/// One recorded state. Metrics of the topic read these parts and nothing else:
///
/// - "surface" (triangles): the deformed surface, vertices and triangles numbered as in the scene;
/// - "details" (points): every detail; point arrays "weight" [1], "target_weight" [1], "type",
///   "birth" (identity, the same in all frames), "birth_frame", "generation", "face" and
///   "barycentric" (3) (anchor on "surface"), "normal" (3) and "tangent" (3) (unit vectors);
/// - "detail_mesh" (triangles): M_d; the points are those of "details" in the same order, then
///   ghosts; point array "ghost" (0 or 1), cell array "density" [1/m^2] (carried, see
///   IntrinsicTriangulation). An edge of M_d joins two points that share a triangle; metrics of
///   spacing take the edges whose two triangles have no ghost (`among_details`): near a border the
///   ghosts, whose spacing changes with the motion, decide which edges there are;
/// - "visible_mesh" (triangles): the same points, the triangulation of the details of weight above
///   1/2 and the ghosts: the spacing that one sees.
///
/// Diagnostics of every method: details, visible_details, ghosts, mean_edge [m].
Frame detail_frame(const DetailMesh& details, double parameter);

/// The loop around a method: one frame of the motion a frame, a checkpoint each; checks every frame
/// (`require_valid_step`). Phases: "prepare", "step" (the method alone), "record".
/// @throws Error  for a scene that is not valid (`require_valid`); while running, for a frame that
///                is not: frames made so far stay
std::unique_ptr<Process> make_detail_process(const DetailScene& scene, DetailMethodFactory factory);

}  // namespace geoprior::details
