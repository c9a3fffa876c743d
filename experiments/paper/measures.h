#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/frame.h"
#include "core/geometry/curvature_fit.h"
#include "experiments/paper/scene/scene.h"
#include "metrics/developability/creases.h"
#include "metrics/developability/developability.h"
#include "metrics/isometry/bending_energy.h"
#include "metrics/isometry/isometry.h"
#include "metrics/spacing/pattern_mesh.h"
#include "models/paper/sheet/sheet.h"
#include "testbed/frame_sequence.h"
#include "testbed/memo.h"

namespace geoprior::paper {

/// What the groups of the paper metric table (metrics.cpp) measure: quantities of one frame of one
/// scene, absent where they have no meaning.
using Value = std::optional<double>;

/// One frame of one scene, as every metric sees it.
struct SheetFrame {
  const PaperScene& scene;
  const Sheet& sheet;
  const Frame& frame;
  const Part& surface;
  Eigen::MatrixX2d pattern;

  [[nodiscard]] const Eigen::MatrixX3d& x() const { return surface.points; }
  [[nodiscard]] const Eigen::MatrixX3i& triangles() const { return surface.triangles; }
};

/// @throws Error  when the frame has no part "surface" of triangles with a point array "pattern",
///                or a coordinate is not finite
SheetFrame sheet_frame(const PaperScene& scene, const Frame& frame);

IsometrySummary sheet_isometry(const SheetFrame& f);
DevelopabilitySummary sheet_developability(const SheetFrame& f);

/// Folds, singular points and facets, on a common grid of the pattern
/// (metrics/developability/creases.h).
struct CreaseMeasures {
  double crease_length = 0;  ///< m
  int cones = 0;             ///< detected apexes
  int facets = 0;
  Value facet_area_median;  ///< m^2; absent when all facets are dust
};
/// Singular points of the last frames: those of the reference are asked for with every variant.
using DetectedCones = std::shared_ptr<const std::vector<DetectedCone>>;
using ConeMemo = Memo<DetectedCones>;
CreaseMeasures crease_measures(ConeMemo& memo, const SheetFrame& f);

/// J; kinetic energy absent without velocities.
struct EnergyMeasures {
  double membrane = 0, bending = 0;
  Value kinetic;
};
/// Fits of curvature to the last meshes in the pattern: frames of a method that does not remesh
/// have one in common, and making it costs more than measuring with it.
using FitMemo = Memo<std::shared_ptr<const CurvatureFit>, 4>;
/// Absent when a triangle has no area in the pattern or is turned over there.
std::optional<EnergyMeasures> energy_measures(FitMemo& fits, const SheetFrame& f);

/// How the sheet is folded along the edges of its mesh (metrics/developability/folds.h).
struct FoldMeasures {
  double cancelling_share = 0;
  double energy = 0;  ///< J
};
/// Absent when a triangle has no area in the pattern or is turned over there.
std::optional<FoldMeasures> fold_measures(FitMemo& fits, const SheetFrame& f);

/// How quietly the sheet moves, at the points of a grid of the pattern: the same on every mesh.
struct MotionMeasures {
  /// That 95 % of the points stay under, of |x_{i+1} - 2 x_i + x_{i-1}| over all frames (m).
  /// Absent where no point of the grid lies in the pattern.
  std::optional<double> second_difference_p95;
  /// Most that a frame's elastic energy is over that of the greater of its two neighbours, where it
  /// is a tenth of the run's largest or more.
  double energy_spike = 0;
};
/// Absent for fewer than three frames, or when frames are not equally spaced.
std::optional<MotionMeasures> motion_measures(FitMemo& fits, const PaperScene& scene,
                                              const FrameSequence& frames);

/// The same of the patches of quadrics (metrics/isometry/bending_energy.h).
using QuadricMemo = Memo<std::shared_ptr<const QuadricCurvature>, 4>;
/// Elastic energy of bending by quadrics (J). Only where every method has a smooth sheet: two
/// opposite sides of a rectangle held as segments and nothing else at work, as for
/// `elastica_error`. Creases and fans about an apex are not measured. Absent when a triangle has no
/// area in the pattern or is turned over there.
Value quadric_bending_energy(QuadricMemo& quadrics, const SheetFrame& f);

/// The mesh in the pattern.
struct MeshMeasures {
  Eigen::Index triangles = 0;
  PatternMeshSummary pattern;
  double uncovered_area = 0;  ///< |area of the mesh - area of the pattern| (m^2)
};
MeshMeasures mesh_measures(const SheetFrame& f);

struct ContactMeasures {
  int intersecting_pairs = 0;
  double intersection_depth = 0;  ///< m
};
ContactMeasures contact_measures(const SheetFrame& f);

/// Work of the handles since the start (J), as the method summed it; absent when it does not.
Value handle_work(const SheetFrame& f);

/// Total force of each handle that holds the sheet, by its number (N).
std::map<int, Eigen::Vector3d> handle_forces(const SheetFrame& f);

/// Norms of the total forces of the handles that hold the sheet (N); absent when none does.
struct HandleForce {
  double max = 0, mean = 0;
};
std::optional<HandleForce> handle_force(const SheetFrame& f);

/// Height of the middle against the closed form (metrics/isometry/elastica.h) at the distance of
/// the ends, relative. Absent unless the scene is a strip: two opposite sides of a rectangle held
/// as segments, no gravity, no obstacle and no other handle that acts at that time; and until it is
/// shortened by a thousandth.
Value elastica_error(const SheetFrame& f);

/// Width of the buckled sector of a sheet pushed into a ring (degrees):
/// metrics/isometry/buckled_sector.h about the point of the pattern that starts at the centre of
/// the scene's first torus. Absent without a torus and before there is a cone.
Value ring_sector(const SheetFrame& f);

/// Hausdorff distance of the two surfaces over the width of the pattern.
double hausdorff_ratio(const SheetFrame& f, const SheetFrame& reference);

/// Largest, over the singular points that `detect_cones` finds on the reference, of the distance in
/// the pattern to the nearest that it finds here (m). Points that the reference lacks cost nothing:
/// read it beside their number. Without any here the diagonal of the pattern's bounding box; absent
/// where the reference has none.
Value dcone_distance(ConeMemo& memo, const SheetFrame& f, const SheetFrame& reference);

}  // namespace geoprior::paper
