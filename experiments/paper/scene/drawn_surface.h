#pragma once

#include <Eigen/Core>

#include "core/frame.h"
#include "core/geometry/curved/curved_surface.h"

namespace geoprior::paper {

/// What the sheet of a frame looks like: smooth where paper is smooth, sharp where it creases, on
/// any mesh.
///
/// A triangle mesh of paper stands for a surface that its facets hide: planes, cylinders and cones.
/// Its vertices have normals, and `curved_surface` is the surface through both.
///
/// An edge is sharp where the paper has yielded across it by more than kYieldedFold, and where it
/// folds by more than kSharpFold. About a vertex the triangles that no sharp edge divides have one
/// normal, with the weights of Max (1999), n = sum (e x f) / (|e|^2 |f|^2) over their corners with
/// sides e and f: of chords that is the normal of their circle.
///
/// Where the frame has rulings, each has one normal from end to end: that of the plane beside it,
/// if there is one, else the mean of the strips at its sides, each weighted by one over its width
/// as the circle through three points asks for. A corner where two rulings of different normals
/// meet is an apex: every line from it is straight, with the normal of its other end. So planes are
/// planes, cylinders have arcs between their rulings, and cones are straight towards their apex.
/// The simulated sheet need not be what its structure says: where the triangles along a ruling turn
/// by more than kUneven from their mean, or those of a flat piece do, that one is drawn as any
/// mesh is.
///
/// The surface stays within kFarthest of the triangles; shading keeps the normals that it would
/// have without that bound. What it does not know: how wide a crease is (it is a line), and that a
/// sheet may not reach through an obstacle that its facets only touch.
struct DrawnSurface {
  static constexpr const char* kPart = "drawn";  ///< of a frame
  static constexpr double kYieldedFold = 12;  ///< plastic curvature times width, at an edge (deg)
  static constexpr double kSharpFold = 75;    ///< deg
  static constexpr double kUneven = 4;        ///< deg
  static constexpr double kFarthest = 5e-4;   ///< m
  static constexpr double kTolerance = 5e-5;  ///< that an edge misses of its curve (m)
  static constexpr double kTurn = 10;         ///< of the normal along an edge (deg)
  /// Edge that is not divided, of the sheet's size: that of a uniform mesh of 4096 triangles.
  static constexpr double kShortest = 0.022;
  static constexpr double kPlaceUnit = 1.0 / (1 << 20);   ///< of recorded points (m)
  static constexpr double kNormalUnit = 1.0 / (1 << 11);  ///< of recorded normals
};

/// @param surface  triangles with the point array "pattern" and the cell array "plastic_curvature"
/// @param rulings  lines between its vertices; null: there are none
EdgeNormals paper_normals(const Part& surface, const Part* rulings);

/// As it is drawn, `sampling.farthest` from the triangles at most.
CurvedSampling paper_sampling(const Part& surface);

/// Adds the part "drawn" (triangles; point array "normal" [1] (3), once for every normal that a
/// point has; the cell arrays "piece" and "kind" of "surface", where it has them) and the
/// diagnostic drawn_distance (m): how far it leaves the triangles that it is made from. Points and
/// normals are whole numbers of kPlaceUnit and kNormalUnit, which makes the files short.
void add_drawn_surface(Frame& frame);

}  // namespace geoprior::paper
