#include "experiments/paper/measures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "experiments/paper/scene/scene.h"
#include "metrics/contact/intersection_depth.h"
#include "metrics/contact/self_contact.h"
#include "metrics/developability/creases.h"
#include "metrics/developability/folds.h"
#include "metrics/isometry/buckled_sector.h"
#include "metrics/isometry/elastica.h"
#include "metrics/isometry/energy_spike.h"
#include "metrics/isometry/shell_energy.h"
#include "metrics/shape/second_differences.h"
#include "metrics/shape/smoothness.h"
#include "metrics/shape/surface_distance.h"
#include "metrics/tracks/weighted_quantile.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/sheet/pattern.h"
#include "models/paper/sheet/pattern_locator.h"

namespace geoprior::paper {
namespace {

constexpr double kSamplesAcross = 32;      // of the Hausdorff distance, along the pattern's width
constexpr double kLeastShortening = 1e-3;  // under it the imperfection decides the height
constexpr int kStripSamples = 9;           // across the strip, where its height is taken
constexpr double kMotionSamples = 48;      // of second differences, along the pattern's width
constexpr double kWorthAnEnergy = 0.1;     // of the run's largest: under it a spike is none

std::string place(const Frame& frame) {
  return "frame at " + std::to_string(frame.parameter) + " s";
}

/// The values that a part may have; null when it has no array of that name.
/// @throws Error  naming the part: the array has another number of components
const Eigen::MatrixXd* values_of(const Part& part, const char* name, NamedArray::On on,
                                 int components, const std::string& where) {
  if (part.find_array(name, on) == nullptr) return nullptr;
  return &part.require_array(name, on, components, where).values;
}

/// What `make(pattern, triangles)` gives for the frame's mesh in the pattern, made once a mesh.
template <class T, std::size_t Remembered, class Make>
T of_pattern_mesh(Memo<T, Remembered>& memo, const SheetFrame& f, Make make) {
  ContentKey key;
  key.add_matrix(f.pattern);
  key.add_matrix(f.triangles());
  return memo.get(key, [&] { return make(f.pattern, f.triangles()); });
}

bool has_turned_over(const SheetFrame& f) {
  return pattern_mesh(f.pattern, f.triangles()).inverted != 0;
}

PlateStiffness plate_of(const PaperMaterial& material) {
  return {material.membrane_stiffness(), material.bending_stiffness(), material.poisson_ratio,
          material.grain_deg.value_or(0) * kDegree, material.along};
}

GriddedSheet gridded(const SheetFrame& f) {
  return gridded_sheet(f.pattern, f.x(), f.triangles(), CreaseOptions{}.grid_spacing);
}

/// The singular points that the detector finds in a frame; `grid()` is it gridded.
template <class Grid>
DetectedCones cones_of(ConeMemo& memo, const SheetFrame& f, Grid grid) {
  ContentKey key;
  key.add_matrix(f.pattern);
  key.add_matrix(f.x());
  key.add_matrix(f.triangles());
  return memo.get(key, [&] {
    return std::make_shared<const std::vector<DetectedCone>>(detect_cones(grid(), CreaseOptions{}));
  });
}

/// The plastic curvature of every triangle (m x 3, 1/m); 0 where the frame has none.
Eigen::MatrixX3d rest_curvature(const SheetFrame& f) {
  const Eigen::MatrixXd* plastic =
      values_of(f.surface, "plastic_curvature", NamedArray::On::cells, 3, "part 'surface'");
  if (plastic == nullptr) return Eigen::MatrixX3d::Zero(f.triangles().rows(), 3);
  return *plastic;
}

std::shared_ptr<const CurvatureFit> fit_of(FitMemo& fits, const SheetFrame& f) {
  return of_pattern_mesh(fits, f, [](const auto& pattern, const auto& triangles) {
    return std::make_shared<const CurvatureFit>(fit_curvature(pattern, triangles));
  });
}

/// A square grid inside the pattern, off its corners and lines of symmetry.
std::vector<Eigen::Vector2d> motion_samples(const Pattern& pattern) {
  const Eigen::AlignedBox2d box = bounding_box(pattern);
  const Eigen::Vector2d low = box.min(), high = box.max();
  const double spacing = width(pattern) / kMotionSamples;
  std::vector<Eigen::Vector2d> samples;
  for (double v = low.y() + 0.37 * spacing; v < high.y(); v += spacing) {
    for (double u = low.x() + 0.41 * spacing; u < high.x(); u += spacing) {
      if (contains(pattern, {u, v})) samples.emplace_back(u, v);
    }
  }
  return samples;
}

/// Where a point of the pattern is in space.
Eigen::Vector3d place_of(const Eigen::Vector2d& p, const PatternLocator& locator,
                         const SheetFrame& f) {
  const PatternLocator::Place at = locator.locate(p);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    x += at.weights(k) * f.x().row(f.triangles()(at.triangle, k)).transpose();
  }
  return x;
}

Eigen::MatrixX3d places_of(const std::vector<Eigen::Vector2d>& points, const SheetFrame& f) {
  const PatternLocator locator({f.pattern, f.triangles()});
  Eigen::MatrixX3d x(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    x.row(i) = place_of(points[i], locator, f).transpose();
  }
  return x;
}

/// The strip between two segments that are moved, when nothing else acts on the sheet at `time`.
std::optional<Strip> strip_of(const Sheet& sheet, double time) {
  std::vector<Strip::Side> sides;
  for (const Handle& handle : sheet.handles) {
    if (handle.motion && handle.segment && handle.is_active(time)) {
      sides.push_back({handle.segment->first, handle.segment->second});
    } else if (handle.is_active(time)) {
      return std::nullopt;
    }
  }
  if (sides.size() != 2 || !sheet.obstacles.empty() || !sheet.gravity.isZero()) return std::nullopt;
  return strip_between(sides[0], sides[1], signed_area(sheet.pattern));
}

}  // namespace

SheetFrame sheet_frame(const PaperScene& scene, const Frame& frame) {
  const Part& surface = frame.require_part("surface");
  const Eigen::MatrixXd& pattern =
      frame.require_array("surface", "pattern", NamedArray::On::points).values;
  if (pattern.cols() < 2) {
    throw Error("point array 'pattern' of part 'surface' has " + std::to_string(pattern.cols()) +
                    " components",
                place(frame), "two, the coordinates in the pattern");
  }
  if (!surface.points.allFinite() || !pattern.allFinite()) {
    throw Error("a coordinate of part 'surface' is not finite", place(frame), "finite numbers");
  }
  return {scene, scene.sheet, frame, surface, pattern.leftCols<2>()};
}

IsometrySummary sheet_isometry(const SheetFrame& f) {
  return isometry(f.pattern, f.x(), f.triangles());
}

DevelopabilitySummary sheet_developability(const SheetFrame& f) {
  return developability({f.x(), f.triangles()});
}

CreaseMeasures crease_measures(ConeMemo& memo, const SheetFrame& f) {
  CreaseMeasures out;
  const CreaseOptions options;
  const GriddedSheet sheet = gridded(f);
  out.crease_length = crease_length(sheet, options);
  const auto grid = [&]() -> const GriddedSheet& { return sheet; };
  out.cones = static_cast<int>(cones_of(memo, f, grid)->size());
  const std::vector<double> facets = facet_areas(sheet, options);
  out.facets = static_cast<int>(facets.size());
  if (facets.empty()) return out;
  const Eigen::Map<const Eigen::VectorXd> areas(facets.data(), out.facets);
  out.facet_area_median = weighted_quantile(areas, areas, 0.5);
  return out;
}

std::optional<EnergyMeasures> energy_measures(FitMemo& fits, const SheetFrame& f) {
  if (has_turned_over(f)) return std::nullopt;
  const PlateStiffness plate = plate_of(f.sheet.material);
  const auto fit = fit_of(fits, f);
  EnergyMeasures out;
  out.membrane = membrane_energy(f.pattern, f.x(), f.triangles(), plate);
  out.bending = bending_energy(*fit, f.x(), rest_curvature(f), plate);
  if (const auto* v =
          values_of(f.surface, "velocity", NamedArray::On::points, 3, "part 'surface'")) {
    const double density = f.sheet.material.area_density;
    out.kinetic = kinetic_energy(f.pattern, *v, f.triangles(), density);
  }
  return out;
}

std::optional<FoldMeasures> fold_measures(FitMemo& fits, const SheetFrame& f) {
  if (has_turned_over(f)) return std::nullopt;
  const auto fit = fit_of(fits, f);
  return FoldMeasures{
      cancelling_share(sheet_folds(*fit, f.pattern, f.x()), f.scene.fold_radius),
      fold_energy(*fit, f.pattern, f.x(), rest_curvature(f), plate_of(f.sheet.material))};
}

std::optional<MotionMeasures> motion_measures(FitMemo& fits, const PaperScene& scene,
                                              const FrameSequence& frames) {
  const std::vector<double> times = frames.parameters();
  if (times.size() < 3 || !equally_spaced(times)) return std::nullopt;
  const std::vector<Eigen::Vector2d> samples = motion_samples(scene.sheet.pattern);
  SecondDifferences differences;
  std::vector<double> energies;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::shared_ptr<const Frame> frame = frames.frame(i);
    const SheetFrame f = sheet_frame(scene, *frame);
    const auto energy = energy_measures(fits, f);
    energies.push_back(energy ? energy->membrane + energy->bending : 0);
    differences.add(places_of(samples, f));
  }
  return MotionMeasures{differences.quantile(95), energy_spike(energies, kWorthAnEnergy)};
}

Value quadric_bending_energy(QuadricMemo& quadrics, const SheetFrame& f) {
  if (!strip_of(f.sheet, f.frame.parameter) || has_turned_over(f)) return std::nullopt;
  const auto curvature =
      of_pattern_mesh(quadrics, f, [](const auto& pattern, const auto& triangles) {
        return std::make_shared<const QuadricCurvature>(pattern, triangles);
      });
  return bending_energy(*curvature, f.x(), rest_curvature(f), plate_of(f.sheet.material));
}

MeshMeasures mesh_measures(const SheetFrame& f) {
  MeshMeasures out;
  out.triangles = f.triangles().rows();
  out.pattern = pattern_mesh(f.pattern, f.triangles());
  out.uncovered_area = std::abs(out.pattern.area - signed_area(f.sheet.pattern));
  return out;
}

ContactMeasures contact_measures(const SheetFrame& f) {
  const auto pairs = intersecting_triangles(f.x(), f.triangles());
  return {static_cast<int>(pairs.size()), intersection_depth(f.x(), f.triangles(), pairs)};
}

Value handle_work(const SheetFrame& f) {
  const auto work = f.frame.diagnostics.find("handle_work");
  if (work == f.frame.diagnostics.end()) return std::nullopt;
  return work->second;
}

std::map<int, Eigen::Vector3d> handle_forces(const SheetFrame& f) {
  std::map<int, Eigen::Vector3d> total;
  const Part* handles = f.frame.find_part("handles");
  if (handles == nullptr) return total;
  const std::string where = "part 'handles' of the " + place(f.frame);
  const auto* handle = values_of(*handles, "handle", NamedArray::On::points, 1, where);
  const auto* force = values_of(*handles, "force", NamedArray::On::points, 3, where);
  if (handle == nullptr || force == nullptr) return total;
  const auto count = static_cast<double>(f.sheet.handles.size());
  for (Eigen::Index i = 0; i < handle->rows(); ++i) {
    const double h = (*handle)(i, 0);
    if (!(h >= 0 && h < count) || h != std::floor(h)) {
      throw Error("array 'handle' has " + std::to_string(h), where,
                  "numbers of the scene's handles, from 0 on");
    }
    total.try_emplace(static_cast<int>(h), Eigen::Vector3d::Zero()).first->second +=
        force->row(i).transpose();
  }
  return total;
}

std::optional<HandleForce> handle_force(const SheetFrame& f) {
  const std::map<int, Eigen::Vector3d> forces = handle_forces(f);
  if (forces.empty()) return std::nullopt;
  HandleForce out;
  for (const auto& [h, sum] : forces) {
    out.max = std::max(out.max, sum.norm());
    out.mean += sum.norm() / static_cast<double>(forces.size());
  }
  return out;
}

Value elastica_error(const SheetFrame& f) {
  const std::optional<Strip> strip = strip_of(f.sheet, f.frame.parameter);
  if (!strip) return std::nullopt;
  const PatternLocator locator({f.pattern, f.triangles()});
  const auto in_space = [&](const Eigen::Vector2d& p) { return place_of(p, locator, f); };
  std::vector<BentLine> lines;
  for (int i = 0; i < kStripSamples; ++i) {
    const double s = (i + 0.5) / kStripSamples;
    lines.push_back(
        {in_space(strip->at(s, 0)), in_space(strip->at(s, 0.5)), in_space(strip->at(s, 1))});
  }
  const StripRise rise = strip_rise(lines);
  if (rise.distance > (1 - kLeastShortening) * strip->length()) return std::nullopt;
  const double exact = elastica_height(strip->length(), rise.distance);
  return std::abs(rise.height - exact) / exact;
}

Value ring_sector(const SheetFrame& f) {
  for (const Obstacle& obstacle : f.sheet.obstacles) {
    if (obstacle.kind != Obstacle::Kind::torus) continue;
    const Eigen::Vector3d apex = f.sheet.placement.inverse() * obstacle.centre;
    return buckled_sector(f.pattern, f.x(), f.triangles(), apex.head<2>(), obstacle.radius,
                          obstacle.axis);
  }
  return std::nullopt;
}

double hausdorff_ratio(const SheetFrame& f, const SheetFrame& reference) {
  const double across = width(f.sheet.pattern);
  return hausdorff_distance({f.x(), f.triangles()}, {reference.x(), reference.triangles()},
                            across / kSamplesAcross) /
         across;
}

Value dcone_distance(ConeMemo& memo, const SheetFrame& f, const SheetFrame& reference) {
  const DetectedCones wanted = cones_of(memo, reference, [&] { return gridded(reference); });
  if (wanted->empty()) return std::nullopt;
  const DetectedCones found = cones_of(memo, f, [&] { return gridded(f); });
  const double none = bounding_box(f.sheet.pattern).diagonal().norm();
  double farthest = 0;
  for (const DetectedCone& cone : *wanted) {
    double nearest = none;
    for (const DetectedCone& other : *found) {
      nearest = std::min(nearest, (other.position - cone.position).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

}  // namespace geoprior::paper
