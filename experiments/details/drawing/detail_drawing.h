#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/options.h"
#include "experiments/details/drawing/cut_holes.h"
#include "experiments/details/drawing/drawn_instances.h"
#include "experiments/details/drawing/drawn_spikes.h"

namespace geoprior::details {

enum class DrawnKind { spike, mesh, hole };
enum class DrawnUnit { mean_edge, metre };

/// How details become geometry (thesis 2.2.2: procedural spikes, meshes, holes in the surface). All
/// methods are drawn alike, from what a recorded frame holds.
struct DrawingOptions {
  DrawnKind kind = DrawnKind::spike;
  DrawnUnit unit = DrawnUnit::mean_edge;
  double radius = 0.35;  ///< base of a spike, unit of a mesh, radius of a hole
  std::optional<int> type;
  SpikeOptions spike;
  InstanceOptions instance;
};
void describe(OptionVisitor& v, DrawingOptions& options);

/// Size of a detail of weight 1 (m): height of a spike, radius of a hole and of a mesh.
///
/// @param mean_edge  of M_d at rest (m)
/// @throws Error     when the mean edge is needed and not positive
double drawn_size(const DrawingOptions& options, double mean_edge);

/// Refuses a drawing of so many details that its mesh is too large (core/limits.h).
/// @param instance  for kind `mesh` with shape `given`, else unused
/// @throws Error    naming scene.drawing.look and the number of vertices
void require_drawable(const DrawingOptions& options, std::size_t details,
                      const TriMesh& instance = {});

/// Draws details on a surface.
///
/// @param surface    triangles of the surface; manifold
/// @param x          its vertices now (m)
/// @param anchors    details on it; those of weight 0 are not drawn
/// @param mean_edge  of M_d at rest (m): what lengths in mean edges are measured in, the same
///                   in all frames, so that details keep their size
/// @param instance   for kind `mesh` with shape `given`, else unused
/// @throws Error     for an anchor off the surface (names it), an instance without triangles, or a
///                   mean edge that is needed and not positive
DrawnDetails draw_details(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                          std::span<const DrawnAnchor> anchors, const DrawingOptions& options,
                          double mean_edge, const TriMesh& instance = {});
/// Draws details on a mesh whose topology is made here.
DrawnDetails draw_details(const TriMesh& surface, std::span<const DrawnAnchor> anchors,
                          const DrawingOptions& options, double mean_edge,
                          const TriMesh& instance = {});

/// Anchors of the part "details" of a recorded frame (`detail_frame`).
/// @throws Error  for an array that is missing
std::vector<DrawnAnchor> anchors_of(const Part& details);

/// Adds the part "spikes", "instances" or "holes" to a recorded frame. Point arrays: "detail" (row
/// in the part "details"; -1 on the surface away from holes), "weight" and "type" of that detail (0
/// and -1 there), "normal" (3) for smooth shading. With "holes" the part stands for the surface.
/// @return  name of the part
std::string add_drawing(Frame& frame, const DrawingOptions& options, double mean_edge,
                        const TriMesh& instance = {});

}  // namespace geoprior::details
