#include "models/sketch/flatten/flatten.h"

#include <cmath>
#include <vector>

#include "models/sketch/flatten/conformal_energy.h"
#include "models/sketch/flatten/convex_layout.h"
#include "models/sketch/flatten/flat_overlap.h"
#include "models/sketch/flatten/flat_triangles.h"
#include "models/sketch/flatten/rigid_layout.h"
#include "models/sketch/flatten/symmetric_dirichlet.h"
#include "models/sketch/pattern/piece_borders.h"

namespace geoprior::sketch {
namespace {

/// Depth of triangles that count as overlapping, over the diagonal of the layout: ours, above what
/// rounding leaves of triangles that touch.
constexpr double kOverlapDepth = 1e-6;

/// A map that turns nothing over, from the conformal one or a convex layout, made as isometric as
/// the symmetric Dirichlet energy can; nothing when both turn something over.
bool lay_without_flips(const TriMesh& piece, const std::vector<FlatTriangle>& triangles,
                       const std::vector<int>& border, Eigen::VectorXcd start, Eigen::VectorXcd& z,
                       FlattenReport& report) {
  const auto all_counter_clockwise = [&] {
    for (int t = 0; t < piece.triangle_count(); ++t) {
      const auto corner = [&](int k) { return start(piece.F(t, k)); };
      if (!(twice_signed_area(corner(0), corner(1), corner(2)) > 0)) return false;
    }
    return true;
  };
  if (!all_counter_clockwise()) start = convex_layout(piece, triangles, border);
  if (!all_counter_clockwise()) return false;
  report.unflip_iterations = lower_symmetric_dirichlet(triangles, piece.F, start, {}).iterations;
  z = start;
  return true;
}

RigidLayoutOptions layout_options(const FlattenOptions& options) {
  return {
      .iterations = options.iterations, .tolerance = options.tolerance, .mixing = options.mixing};
}

void centre_on_area(const std::vector<FlatTriangle>& triangles, const Eigen::MatrixX3i& F,
                    Eigen::VectorXcd& z) {
  Complex moment = 0;
  double area = 0;
  for (int t = 0; t < std::ssize(triangles); ++t) {
    moment += triangles[t].area * (z(F(t, 0)) + z(F(t, 1)) + z(F(t, 2))) / 3.0;
    area += triangles[t].area;
  }
  if (area > 0) z.array() -= moment / area;
}

double flat_diagonal(const Eigen::MatrixX2d& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

}  // namespace

void describe(OptionVisitor& v, FlattenOptions& options) {
  v.value("iterations", options.iterations,
          {.doc = "most steps of as-rigid-as-possible", .min = 0});
  v.value("tolerance", options.tolerance,
          {.doc = "relative change of energy at which as-rigid-as-possible stops", .min = 0});
  v.value("mixing", options.mixing,
          {.doc = "steps that the Anderson acceleration combines; 0: none", .min = 0, .max = 20});
  v.value("unflip", options.unflip,
          {.doc = "whether a layout with triangles turned over is made anew, by symmetric "
                  "Dirichlet energy"});
}

Flattening flatten(const TriMesh& piece, const FlattenOptions& options) {
  const std::vector<int> border = piece_borders(piece, "flattening").front();
  const std::vector<FlatTriangle> triangles = flat_triangles(piece);
  Flattening flat;
  FlattenReport& report = flat.report;
  Eigen::VectorXcd start =
      spectral_conformal_map(piece, conformal_energy(piece.F, triangles, piece.vertex_count()));
  scale_to_area(triangles, piece.F, start);
  report.flipped_at_first = static_cast<int>(flipped_triangles(triangles, piece.F, start).size());

  const RigidLayout rigid(triangles, piece.F, piece.vertex_count());
  Eigen::VectorXcd z = start;
  report.iterations = rigid.improve(z, layout_options(options)).iterations;
  report.flipped = flipped_triangles(triangles, piece.F, z);
  report.flipped_when_rigid = static_cast<int>(report.flipped.size());
  if (options.unflip && !report.flipped.empty() &&
      lay_without_flips(piece, triangles, border, start, z, report)) {
    report.flipped = flipped_triangles(triangles, piece.F, z);
  }
  double area = 0;
  for (const FlatTriangle& t : triangles) area += t.area;
  report.strain = area > 0 ? std::sqrt(2 * rigid.energy(z) / area) : 0;
  centre_on_area(triangles, piece.F, z);
  flat.points = to_points(z);
  report.overlaps =
      overlapping_triangles(flat.points, piece.F, kOverlapDepth * flat_diagonal(flat.points));
  return flat;
}

void hold_lengths(const TriMesh& piece, std::span<const KeptLength> kept,
                  const FlattenOptions& options, Flattening& flat) {
  const std::vector<FlatTriangle> triangles = flat_triangles(piece);
  const RigidLayout rigid(triangles, piece.F, piece.vertex_count());
  Flattening held = flat;
  Eigen::VectorXcd z = to_complex(flat.points);
  const RigidLayoutReport laid = rigid.hold(z, kept, layout_options(options));
  centre_on_area(triangles, piece.F, z);
  held.points = to_points(z);
  held.report.flipped = flipped_triangles(triangles, piece.F, z);
  held.report.overlaps =
      overlapping_triangles(held.points, piece.F, kOverlapDepth * flat_diagonal(held.points));
  if (held.report.flipped.size() > flat.report.flipped.size() ||
      held.report.overlaps.size() > flat.report.overlaps.size()) {
    z = to_complex(flat.points);
    flat.report.length_error = rigid.hold(z, kept, {.length_rounds = 0}).length_error;
    return;
  }
  double area = 0;
  for (const FlatTriangle& t : triangles) area += t.area;
  held.report.strain = area > 0 ? std::sqrt(2 * rigid.energy(z) / area) : 0;
  held.report.iterations += laid.iterations;
  held.report.length_error = laid.length_error;
  flat = std::move(held);
}

}  // namespace geoprior::sketch
