#include "experiments/details/scene/pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/triangle_tree.h"
#include "core/limits.h"
#include "core/random.h"
#include "models/details/point_grid.h"
#include "models/details/surface_walk.h"
#include "testbed/keyframes.h"

namespace geoprior::details {
namespace {

/// Poisson-disk: darts for each detail that is wanted.
constexpr int kDartsPerDetail = 400;
/// Smallest distance in a cluster over its radius.
constexpr double kApartInCluster = 0.25;
/// Relative: sums of larger ones over a surface would not stay finite.
constexpr double kMostDensity = 1e9;
/// Of a grid: on a surface that fills its box about as many as details.
constexpr double kMostGridCells = 2e7;

/// The surface as what is drawn on: density per area, random places.
class Ground {
 public:
  Ground(const TriMesh& surface, const DetailPatternOptions& options,
         const Eigen::VectorXd& relative)
      : mesh_(surface),
        topology_(surface),
        density_(relative),
        inside_(faces_of_region(surface, options.region)) {
    for (Eigen::Index v = 0; v < mesh_.V.rows(); ++v) x_.emplace_back(mesh_.V.row(v).transpose());
    const Eigen::VectorXd areas = triangle_areas(mesh_.V, mesh_.F);
    sums_.resize(mesh_.F.rows());
    double sum = 0;
    for (Eigen::Index t = 0; t < mesh_.F.rows(); ++t) {
      if (inside_[t] != 0) {
        area_ += areas[t];
        sum += areas[t] * corners(static_cast<int>(t)).mean();
      }
      sums_[t] = sum;
    }
    if (!(area_ > 0)) throw Error("holds no triangle", "scene.pattern.region", "a part of it");
    if (!(sum > 0))
      throw Error("is 0 everywhere", "scene.pattern.density", "0 at some places only");
    if (!std::isfinite(sum))
      throw Error("is too large", "scene.pattern.density", "values whose sum is finite");
    density_ *= options.count / sum;
    sums_ /= sum;
  }

  /// A place, with probability in proportion to the density.
  [[nodiscard]] SurfacePoint draw(RandomStream& random) const {
    const double s = random.uniform();
    const auto* end = sums_.data() + sums_.size() - 1;
    const int face = static_cast<int>(std::upper_bound(sums_.data(), end, s) - sums_.data());
    const Eigen::Vector3d rho = corners(face);
    for (;;) {
      const double r = std::sqrt(random.uniform()), t = random.uniform();
      const Eigen::Vector3d b(1 - r, r * (1 - t), r * t);
      if (random.uniform() * rho.maxCoeff() <= b.dot(rho)) return {face, b};
    }
  }
  [[nodiscard]] double density(const SurfacePoint& p) const {
    return corners(p.face).dot(p.barycentric);
  }
  [[nodiscard]] bool holds(const SurfacePoint& p) const { return inside_[p.face] != 0; }
  [[nodiscard]] Eigen::Vector3d position(const SurfacePoint& p) const {
    return position_of(p, topology_, x_);
  }
  [[nodiscard]] Eigen::Vector3d normal(const SurfacePoint& p) const {
    return normal_of_face(p.face, topology_, x_);
  }
  [[nodiscard]] double area() const { return area_; }
  [[nodiscard]] const TriMesh& mesh() const { return mesh_; }
  [[nodiscard]] const SurfaceTopology& topology() const { return topology_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& x() const { return x_; }

 private:
  [[nodiscard]] Eigen::Vector3d corners(int face) const {
    return {density_[mesh_.F(face, 0)], density_[mesh_.F(face, 1)], density_[mesh_.F(face, 2)]};
  }

  const TriMesh& mesh_;
  SurfaceTopology topology_;
  std::vector<Eigen::Vector3d> x_;
  Eigen::VectorXd density_;  ///< per vertex (1/m^2)
  Eigen::VectorXd sums_;     ///< partial sums of the details expected on the faces, up to 1
  std::vector<char> inside_;
  double area_ = 0;  ///< of the region
};

using Places = std::vector<SurfacePoint>;

Places uniform(const Ground& ground, int count, RandomStream& random) {
  Places places;
  for (int i = 0; i < count; ++i) places.push_back(ground.draw(random));
  return places;
}

/// @param share  of the density that is asked for
Places poisson_disk(const Ground& ground, int count, double radius, double share,
                    RandomStream& random) {
  const double mean = ground.area() / count;
  PointGrid grid(radius * std::sqrt(mean), count);
  Places places;
  const std::int64_t darts = std::int64_t{kDartsPerDetail} * count;
  for (std::int64_t i = 0; i < darts && std::ssize(places) < count; ++i) {
    const SurfacePoint p = ground.draw(random);
    const Eigen::Vector3d x = ground.position(p), n = ground.normal(p);
    if (!grid.is_free(x, n, radius / std::sqrt(share * ground.density(p)))) continue;
    grid.add(x, n);
    places.push_back(p);
  }
  return places;
}

Places jittered_grid(const Ground& ground, const DetailPatternOptions& options,
                     RandomStream& random) {
  const Eigen::RowVector3d low = ground.mesh().V.colwise().minCoeff();
  const Eigen::RowVector3d size = ground.mesh().V.colwise().maxCoeff() - low;
  if (!(size.z() <= 1e-9 * size.norm())) {
    throw Error("needs a flat surface", "scene.pattern.kind", "a plane of constant z");
  }
  if (options.density.kind != DensityKind::constant) {
    throw Error("is the same everywhere on a grid", "scene.pattern.density", "constant");
  }
  const double spacing = std::sqrt(ground.area() / options.count);
  const double columns = std::max(1.0, std::round(size.x() / spacing));
  const double rows = std::max(1.0, std::round(size.y() / spacing));
  require_count(columns * rows, "cells of a grid", kMostGridCells, "scene.pattern.count");
  const int nx = static_cast<int>(columns), ny = static_cast<int>(rows);
  const TriangleTree tree(ground.mesh());
  Places places;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const double dx = options.jitter * (random.uniform() - 0.5);
      const double dy = options.jitter * (random.uniform() - 0.5);
      const Eigen::Vector3d x(low.x() + size.x() * (i + 0.5 + dx) / nx,
                              low.y() + size.y() * (j + 0.5 + dy) / ny, low.z());
      const TriangleTree::Nearest nearest = tree.nearest(x);
      // Cells beside the outline of the surface, and of the region, stay empty.
      if (nearest.distance < 1e-6 * spacing && ground.holds(nearest.point))
        places.push_back(nearest.point);
    }
  }
  return places;
}

/// Fewer than `size` where the region or a border cuts the disc.
void add_cluster(const Ground& ground, const SurfacePoint& centre, int size, double radius,
                 RandomStream& random, Places& places) {
  constexpr int kTries = 100;
  const std::size_t first = places.size();
  for (int tries = 0; tries < kTries * size; ++tries) {
    if (places.size() == first + size) return;
    const Eigen::Vector3d direction =
        tangent_direction(centre.face, kFullTurn * random.uniform(), ground.topology(), ground.x());
    const double length = radius * std::sqrt(random.uniform());
    const SurfacePoint p = trace_straight(centre, direction, length, ground.topology(), ground.x());
    const Eigen::Vector3d x = ground.position(p);
    const auto is_near = [&](const SurfacePoint& q) {
      return (ground.position(q) - x).norm() < kApartInCluster * radius;
    };
    const bool crowded = std::any_of(places.begin() + first, places.end(), is_near);
    if (!crowded && ground.holds(p)) places.push_back(p);
  }
}

Places clusters(const Ground& ground, const DetailPatternOptions& options, RandomStream& random) {
  const double share = 1.0 / options.cluster_size;
  const int count = std::max(1, static_cast<int>(std::lround(options.count * share)));
  Places places;
  for (const SurfacePoint& centre : poisson_disk(ground, count, options.radius, share, random)) {
    const double spacing = 1 / std::sqrt(share * ground.density(centre));
    add_cluster(ground, centre, options.cluster_size, options.cluster_radius * spacing, random,
                places);
  }
  return places;
}

Places places_of(const Ground& ground, const DetailPatternOptions& options, RandomStream& random) {
  switch (options.kind) {
    case PatternKind::uniform:
      return uniform(ground, options.count, random);
    case PatternKind::poisson_disk:
      return poisson_disk(ground, options.count, options.radius, 1, random);
    case PatternKind::grid:
      return jittered_grid(ground, options, random);
    case PatternKind::clusters:
      return clusters(ground, options, random);
    case PatternKind::file:
      break;
  }
  throw Error("is not sampled", "scene.pattern.kind", "poisson-disk, grid, uniform, clusters");
}

bool is_in(const RegionOptions& region, const Eigen::Vector3d& direction, const Eigen::Vector3d& x,
           const Eigen::Vector3d& normal) {
  const Eigen::Vector3d from = x - to_vector(region.point);
  if (region.kind == RegionKind::half_space) return from.dot(direction) >= 0;
  if (region.kind == RegionKind::ball) return from.norm() <= region.radius;
  return normal.dot(direction) >= std::cos(region.angle_deg * std::numbers::pi / 180);
}

}  // namespace

std::vector<char> faces_of_region(const TriMesh& surface,
                                  const std::vector<RegionOptions>& region) {
  const Eigen::MatrixX3d normals = vertex_normals(surface);
  std::vector<char> inside(surface.F.rows(), 1);
  for (std::size_t i = 0; i < region.size(); ++i) {
    Eigen::Vector3d direction = to_vector(region[i].direction);
    if (region[i].kind != RegionKind::ball && !(direction.norm() > 0)) {
      throw Error("has no direction", "scene.pattern.region." + std::to_string(i) + ".direction",
                  "a vector of any length");
    }
    direction.normalize();
    for (int t = 0; t < std::ssize(inside); ++t) {
      const SurfacePoint centre{t, Eigen::Vector3d::Constant(1.0 / 3)};
      const Eigen::Vector3d x = position_of(centre, surface.V, surface.F);
      const Eigen::Vector3d n = position_of(centre, normals, surface.F).normalized();
      if (is_in(region[i], direction, x, n) == region[i].outside) inside[t] = 0;
    }
  }
  return inside;
}

Eigen::VectorXd gradient_density(const TriMesh& surface, const DensityOptions& options) {
  if (options.kind == DensityKind::constant) return Eigen::VectorXd::Ones(surface.V.rows());
  const Eigen::Vector3d axis = to_vector(options.axis);
  if (!(axis.norm() > 0)) {
    throw Error("has no direction", "scene.pattern.density.axis", "a vector of any length");
  }
  const Eigen::VectorXd along = surface.V * axis.normalized();
  const double low = along.minCoeff(), range = along.maxCoeff() - low;
  if (!(range > 0)) return Eigen::VectorXd::Constant(along.size(), options.from);
  return options.from + (along.array() - low) / range * (options.to - options.from);
}

std::vector<Detail> scatter(const TriMesh& surface, const DetailPatternOptions& options,
                            const Eigen::VectorXd& relative, std::uint64_t experiment_seed) {
  const Ground ground(surface, options, relative);
  const std::uint64_t seed = scene_seed(experiment_seed, options.seed);
  RandomStream places(seed, "places"), looks(seed, "looks");
  std::vector<Detail> details;
  for (const SurfacePoint& at : places_of(ground, options, places)) {
    Detail& d = details.emplace_back();
    d.at = at;
    d.tangent_angle = kFullTurn * looks.uniform();
    if (options.aligned) {
      d.tangent_angle =
          tangent_angle(at.face, to_vector(options.direction), ground.topology(), ground.x());
    }
    d.type = static_cast<int>(looks.below(static_cast<std::uint32_t>(options.types)));
  }
  if (details.size() < 3) {
    throw Error("gives " + std::to_string(details.size()) + " details", "scene.pattern",
                "at least 3: a higher count, a larger region");
  }
  return details;
}

void describe(OptionVisitor& v, DensityOptions& options) {
  static constexpr std::array<std::string_view, 3> kKinds{"constant", "gradient", "array"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "the density is the same everywhere, a gradient (axis, from, to), or an "
                          "array of the surface"});
  if (options.kind == DensityKind::gradient) {
    v.value("axis", options.axis, {.doc = "axis along which the density changes, of any length"});
    v.value("from", options.from,
            {.doc = "density at the lower end of the surface along the axis",
             .min = 0,
             .max = kMostDensity});
    v.value("to", options.to,
            {.doc = "density at the upper end of the surface along the axis, linear between",
             .min = 0,
             .max = kMostDensity});
  }
  if (options.kind == DensityKind::array) {
    v.value(
        "array", options.array,
        {.doc = "array of the points of the surface's .vtp that holds the density, not negative",
         .required = true});
  }
}

void describe(OptionVisitor& v, RegionOptions& options) {
  static constexpr std::array<std::string_view, 3> kKinds{"half-space", "ball", "facing"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "half-space: point, direction (into it); ball: point, radius; facing: "
                          "direction, angle_deg of normals to it"});
  if (options.kind != RegionKind::facing) {
    v.value("point", options.point,
            {.doc = "point of the half space's plane, or centre of the ball", .unit = "m"});
  }
  if (options.kind != RegionKind::ball) {
    v.value("direction", options.direction,
            {.doc = "direction into the half space, or that normals face, of any length"});
  } else {
    v.value("radius", options.radius, {.doc = "radius of the ball", .unit = "m", .min = 1e-9});
  }
  if (options.kind == RegionKind::facing) {
    v.value(
        "angle_deg", options.angle_deg,
        {.doc = "largest angle of a normal to the direction", .unit = "deg", .min = 0, .max = 180});
  }
  v.value("outside", options.outside,
          {.doc = "the condition is turned round: details are where it does not hold"});
}

void describe(OptionVisitor& v, DetailPatternOptions& options) {
  static constexpr std::array<std::string_view, 5> kKinds{"poisson-disk", "grid", "uniform",
                                                          "clusters", "file"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "poisson-disk: radius; grid: jitter (planes); uniform: independent of "
                          "each other; clusters: cluster_size, cluster_radius; file: file"});
  if (options.kind == PatternKind::file) {
    v.value("file", options.file,
            {.doc = "positions of details: .csv with the columns x, y, z and, if need be, weight, "
                    "type; or "
                    "the vertices of a mesh file",
             .required = true,
             .named = Named::file});
    v.value(
        "max_distance", options.max_distance,
        {.doc = "largest distance of a position from the surface; absent: a hundredth of its size",
         .unit = "m",
         .min = 0});
  } else {
    v.value("count", options.count,
            {.doc = "number of details asked for", .min = 3, .max = 2000000});
    describe_group(v, "density", options.density,
                   {.doc = "details per area, relative to elsewhere"});
    describe_list(v, "region", options.region,
                  {.doc = "conditions that must all hold where there are details"});
    v.value("types", options.types, {.doc = "types of details, drawn at random", .min = 1});
  }
  if (options.kind == PatternKind::poisson_disk || options.kind == PatternKind::clusters) {
    v.value("radius", options.radius,
            {.doc = "smallest distance of details, or of centres of clusters, times sqrt(density)",
             .min = 0,
             .max = 1});
  }
  if (options.kind == PatternKind::grid) {
    v.value(
        "jitter", options.jitter,
        {.doc = "range of a detail's shift along each axis, over the spacing", .min = 0, .max = 1});
  }
  if (options.kind == PatternKind::clusters) {
    v.value("cluster_size", options.cluster_size,
            {.doc = "number of details of a cluster", .min = 2, .max = 20});
    v.value(
        "cluster_radius", options.cluster_radius,
        {.doc = "radius of a cluster, over the spacing of the centres", .min = 0.01, .max = 0.5});
  }
  v.value("aligned", options.aligned,
          {.doc = "tangents of details lie along `direction`, else at random"});
  v.value("direction", options.direction,
          {.doc = "direction of aligned tangents, projected to the surface"});
  v.value("seed", options.seed,
          {.doc = "seed of places, types and tangents, added to that of the experiment",
           .min = 0,
           .max = 2e9});
}

}  // namespace geoprior::details
