#pragma once

#include <memory>
#include <optional>

#include "core/curvature_fit.h"
#include "core/frame.h"
#include "metrics/developability.h"
#include "metrics/isometry.h"
#include "metrics/pattern_mesh.h"
#include "models/paper/sheet.h"
#include "testbed/memo.h"
#include "testbed/topic.h"

namespace geoprior::paper {

/// What the rows of the paper metric table (metrics.cpp) read: quantities of one frame of one
/// scene, absent where they have no meaning.
using Value = std::optional<double>;

/// One frame of one scene, as every metric sees it.
struct SheetFrame {
  const Sheet& sheet;
  const Frame& frame;
  const Part& surface;
  Eigen::MatrixX2d pattern;

  [[nodiscard]] const Eigen::MatrixX3d& x() const { return surface.points; }
  [[nodiscard]] const Eigen::MatrixX3i& triangles() const { return surface.triangles; }
};

/// @throws Error  when the frame has no part "surface" of triangles with a point array "pattern",
///                or a coordinate is not finite
SheetFrame sheet_frame(const Scene& scene, const Frame& frame);

/// Everything that is read off the surface of one frame alone.
struct SurfaceMeasures {
  IsometrySummary isometry;
  DevelopabilitySummary developability;
  double crease_length = 0;  ///< m
  int cones = 0;             ///< detected apexes
  int facets = 0;
  Value facet_area_median;  ///< m^2; absent when all facets are dust
  PatternMeshSummary mesh;
  double uncovered_area = 0;  ///< |area of the mesh - area of the pattern| (m^2)
  /// J; absent when a triangle has no area in the pattern or is turned over there, the kinetic
  /// energy also without velocities.
  Value membrane_energy, bending_energy, kinetic_energy;
  int intersecting_pairs = 0;
  double intersection_depth = 0;  ///< m
};

/// Values that the metrics of a frame share, and the bending fits of the last meshes.
struct SheetMemo {
  Memo<SurfaceMeasures> surface;
  Memo<std::shared_ptr<const CurvatureFit>, 4> fit;
};
SurfaceMeasures surface_measures(SheetMemo& memo, const SheetFrame& f);

/// Norms of the total forces of the handles that hold the sheet (N); absent when none does.
struct HandleForce {
  double max = 0, mean = 0;
};
std::optional<HandleForce> handle_force(const SheetFrame& f);

/// Height of the middle against the closed form (metrics/elastica.h) at the distance of the ends,
/// relative. Absent unless the scene is a strip: two opposite sides of a rectangle held as
/// segments, no gravity, no obstacle and no other handle that acts at that time; and until it is
/// shortened by a thousandth.
Value elastica_error(const SheetFrame& f);

/// Width of the buckled sector of a sheet pushed into a ring (degrees): metrics/buckled_sector.h
/// about the point of the pattern that starts at the centre of the scene's first torus. Absent
/// without a torus and before there is a cone.
Value ring_sector(const SheetFrame& f);

/// Hausdorff distance of the two surfaces over the width of the pattern.
double hausdorff_ratio(const SheetFrame& f, const SheetFrame& reference);

}  // namespace geoprior::paper
