#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "experiments/paper/measures.h"
#include "experiments/paper/topic.h"

namespace geoprior::paper {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors.
// Smooth quantities follow the solver's round-off; a count changes when something crosses its
// threshold; singular values of an isometry have the root of round-off.
constexpr Tolerance kSmooth{1e-12, 1e-6};
constexpr Tolerance kStrain{1e-7, 1e-6};
constexpr Tolerance kCount{1, 0.02};
constexpr Tolerance kShare{0.01, 0};

using SharedMemo = std::shared_ptr<SheetMemo>;

MetricEntry entry(std::string name, std::string unit, std::string definition, Direction direction,
                  Tolerance tolerance, std::function<Value(const SheetFrame&)> measure) {
  MetricEntry e;
  e.name = std::move(name);
  e.unit = std::move(unit);
  e.definition = std::move(definition);
  e.direction = direction;
  e.tolerance = tolerance;
  e.of_frame = [measure = std::move(measure)](const Scene& scene, const Frame& frame,
                                              const Frame*) {
    return measure(sheet_frame(scene, frame));
  };
  return e;
}

/// Adds rows that read one number off the surface.
class SurfaceRows {
 public:
  SurfaceRows(std::vector<MetricEntry>& table, SharedMemo memo)
      : table_(table), memo_(std::move(memo)) {}
  template <class Read>
  void add(const char* name, const char* unit, const char* definition, Direction direction,
           Tolerance tolerance, Read read) {
    table_.push_back(entry(name, unit, definition, direction, tolerance,
                           [memo = memo_, read](const SheetFrame& f) -> Value {
                             return read(surface_measures(*memo, f));
                           }));
  }

 private:
  std::vector<MetricEntry>& table_;
  SharedMemo memo_;
};

using Surface = SurfaceMeasures;

void add_isometry(SurfaceRows rows) {
  constexpr auto lower = Direction::lower_is_better;
  rows.add("isometry_rms", "1",
           "root mean square, by pattern area, of |sigma - 1|, sigma the two singular values of "
           "each triangle's map from the pattern to space",
           lower, kStrain, [](const Surface& s) { return s.isometry.rms; });
  rows.add("isometry_max", "1", "largest |sigma - 1| of a triangle", lower, kStrain,
           [](const Surface& s) { return s.isometry.max; });
  rows.add("edge_length_error", "1",
           "relative change of length against the pattern that 95 % of the edges, by their length, "
           "stay under",
           lower, kStrain, [](const Surface& s) { return s.isometry.edge_error_p95; });
  rows.add("edge_length_error_max", "1",
           "largest relative change of an edge's length against the pattern", lower, kStrain,
           [](const Surface& s) { return s.isometry.edge_error_max; });
  rows.add("area_drift", "1", "area in space over the area of the pattern's triangles, minus 1",
           Direction::closer_to_target, kStrain,
           [](const Surface& s) { return s.isometry.area_drift; });
}

void add_developability(SurfaceRows rows) {
  constexpr auto lower = Direction::lower_is_better;
  rows.add("angle_defect_mean", "rad", "mean of |angle defect| over the interior vertices", lower,
           kSmooth, [](const Surface& s) { return s.developability.angle_defect_mean; });
  rows.add("angle_defect_max", "rad", "largest |angle defect| of an interior vertex", lower,
           kSmooth, [](const Surface& s) { return s.developability.angle_defect_max; });
  rows.add("hinge_energy_sum", "rad",
           "sum over the interior vertices of the smallest eigenvalue of sum theta n n' over the "
           "star (Stein, Grinspun, Crane 2018)",
           lower, kSmooth, [](const Surface& s) { return s.developability.hinge_energy_sum; });
  rows.add("hinge_energy_max", "rad", "largest such eigenvalue", lower, kSmooth,
           [](const Surface& s) { return s.developability.hinge_energy_max; });
  rows.add("gauss_image_thinness", "1",
           "share of the area at interior vertices whose triangles' normals lie within one degree "
           "of a great circle",
           Direction::higher_is_better, kShare,
           [](const Surface& s) { return s.developability.thinness; });
}

void add_creases(SurfaceRows rows) {
  constexpr auto none = Direction::none;
  rows.add("crease_length", "m",
           "length in the pattern of the folds where the normal turns by more than 20 degrees "
           "within about 5 mm, by crossings of the links of a 2.5 mm grid (Cauchy, Crofton)",
           none, {5e-3, 0.02}, [](const Surface& s) { return s.crease_length; });
  rows.add("dcone_count", "1",
           "singular points: peaks above 0.05 rad, 20 mm apart, of the hinge energy of a ring of "
           "10 mm radius about the points of a 5 mm grid",
           none, kCount, [](const Surface& s) { return s.cones; });
  rows.add("facet_count", "1",
           "facets of at least 1 cm^2 between creases: connected points of a 2.5 mm grid whose "
           "neighbours' normals differ by at most 20 degrees",
           none, kCount, [](const Surface& s) { return s.facets; });
  rows.add("facet_area_median", "m^2",
           "median area of those facets, weighted by area: half of the sheet lies in facets no "
           "larger",
           none, {1e-4, 0.02}, [](const Surface& s) { return s.facet_area_median; });
}

void add_energies(SurfaceRows rows, std::vector<MetricEntry>& table) {
  constexpr auto none = Direction::none;
  rows.add("membrane_energy", "J",
           "elastic energy of stretching of the mesh, St. Venant-Kirchhoff, with the scene's "
           "material",
           none, kSmooth, [](const Surface& s) { return s.membrane_energy; });
  rows.add("bending_energy", "J",
           "elastic energy of bending of the mesh, from the shape operators that the dihedral "
           "angles give, minus the plastic curvature, with the scene's material unweakened",
           none, kSmooth, [](const Surface& s) { return s.bending_energy; });
  rows.add("kinetic_energy", "J", "kinetic energy of the velocities, linear on each triangle", none,
           kSmooth, [](const Surface& s) { return s.kinetic_energy; });
  table.push_back(entry("handle_work", "J",
                        "work done on the sheet by the prescribed handles since the start, summed "
                        "over the steps by the method",
                        none, kSmooth, [](const SheetFrame& f) -> Value {
                          const auto work = f.frame.diagnostics.find("handle_work");
                          if (work == f.frame.diagnostics.end()) return std::nullopt;
                          return work->second;
                        }));
  table.push_back(entry("handle_force_max", "N",
                        "largest norm of the total force of a handle on the sheet, mean over the "
                        "steps of the frame",
                        none, kSmooth, [](const SheetFrame& f) -> Value {
                          const std::optional<HandleForce> force = handle_force(f);
                          return force ? Value(force->max) : std::nullopt;
                        }));
  table.push_back(entry("handle_force_mean", "N",
                        "mean over the handles of the norm of the total force on the sheet, mean "
                        "over the steps of the frame",
                        none, kSmooth, [](const SheetFrame& f) -> Value {
                          const std::optional<HandleForce> force = handle_force(f);
                          return force ? Value(force->mean) : std::nullopt;
                        }));
}

void add_mesh(SurfaceRows rows, std::vector<MetricEntry>& table) {
  table.push_back(entry(
      "triangles", "1", "triangles of the surface's mesh", Direction::lower_is_better, kCount,
      [](const SheetFrame& f) -> Value { return static_cast<double>(f.triangles().rows()); }));
  rows.add("min_altitude", "m",
           "smallest height of a triangle of the pattern over its longest edge; negative for one "
           "turned over",
           Direction::higher_is_better, kSmooth,
           [](const Surface& s) { return s.mesh.min_altitude; });
  rows.add("min_area", "m^2", "smallest signed area of a triangle of the pattern",
           Direction::higher_is_better, kSmooth, [](const Surface& s) { return s.mesh.min_area; });
  rows.add("inverted_triangles", "1",
           "triangles that are turned over in the pattern or have no area there",
           Direction::lower_is_better, kCount, [](const Surface& s) { return s.mesh.inverted; });
  rows.add("uncovered_area", "m^2",
           "absolute difference of the pattern's area and the sum of its triangles' signed areas",
           Direction::lower_is_better, kSmooth, [](const Surface& s) { return s.uncovered_area; });
}

void add_contact(SurfaceRows rows) {
  rows.add("intersecting_pairs", "1", "pairs of triangles that intersect each other",
           Direction::lower_is_better, kCount,
           [](const Surface& s) { return s.intersecting_pairs; });
  rows.add("intersection_depth", "m",
           "largest, over the intersecting pairs, of the shortest way along a normal of the two "
           "that takes them apart; at most the triangles' height",
           Direction::lower_is_better, {1e-9, 1e-6},
           [](const Surface& s) { return s.intersection_depth; });
}

void add_comparisons(std::vector<MetricEntry>& table) {
  table.push_back(entry("elastica_error", "1",
                        "height of the middle of a strip pinned at two opposite sides against "
                        "Euler's elastica of the same distance of the ends, relative; absent until "
                        "the strip is shortened by a thousandth",
                        Direction::lower_is_better, {1e-7, 1e-6}, elastica_error));
  MetricEntry sector = entry(
      "dcone_sector", "deg",
      "sector over which a sheet pushed into a ring (the scene's torus) leaves it: 1.653 times the "
      "width at a fifth of the rise, on the ring's circle in the pattern; absent before the rise "
      "is half of the apex' depth and when there are several sectors",
      Direction::closer_to_target, {0.5, 0}, ring_sector);
  sector.target = 138.99;  // small slopes, no thickness
  table.push_back(std::move(sector));
  MetricEntry hausdorff =
      entry("hausdorff_ratio", "1",
            "Hausdorff distance from the surface of the reference variant, sampled every 32nd of "
            "the pattern's width, over that width",
            Direction::lower_is_better, {1e-7, 1e-6}, {});
  hausdorff.needs_reference = true;
  hausdorff.of_frame = [](const Scene& scene, const Frame& frame, const Frame* reference) -> Value {
    if (reference == nullptr) return std::nullopt;
    return hausdorff_ratio(sheet_frame(scene, frame), sheet_frame(scene, *reference));
  };
  table.push_back(std::move(hausdorff));
}

}  // namespace

std::vector<MetricEntry> metrics() {
  std::vector<MetricEntry> table;
  const SurfaceRows rows(table, std::make_shared<SheetMemo>());
  add_isometry(rows);
  add_developability(rows);
  add_creases(rows);
  add_energies(rows, table);
  add_mesh(rows, table);
  add_contact(rows);
  add_comparisons(table);
  return table;
}

}  // namespace geoprior::paper
