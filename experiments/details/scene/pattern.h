#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/details/scene.h"

namespace geoprior::details {

enum class PatternKind { poisson_disk, grid, uniform, clusters, file };
enum class DensityKind { constant, gradient, array };
enum class RegionKind { half_space, ball, facing };

/// How many details an area gets, relative to elsewhere. A tagged choice by `kind`.
struct DensityOptions {
  DensityKind kind = DensityKind::constant;
  std::array<double, 3> axis{1, 0, 0};
  double from = 1, to = 1;  ///< of the gradient: at its two ends of the surface
  std::string array;
};
void describe(OptionVisitor& v, DensityOptions& options);

/// A condition on where details are. A tagged choice by `kind`.
struct RegionOptions {
  RegionKind kind = RegionKind::half_space;
  std::array<double, 3> point{0, 0, 0};      ///< of the half space's plane, centre of the ball (m)
  std::array<double, 3> direction{0, 0, 1};  ///< into the half space; that normals face
  double radius = 1;
  double angle_deg = 60;
  bool outside = false;
};
void describe(OptionVisitor& v, RegionOptions& options);

/// `pattern` of a scene: details on the surface at rest.
struct DetailPatternOptions {
  PatternKind kind = PatternKind::poisson_disk;
  int count = 1000;
  double radius = 0.78;  ///< poisson_disk: smallest distance x sqrt(density)
  double jitter = 0.6;
  int cluster_size = 6;
  double cluster_radius = 0.25;
  DensityOptions density;
  std::vector<RegionOptions> region;
  std::string file;
  std::optional<double> max_distance;
  int types = 1;
  bool aligned = false;
  std::array<double, 3> direction{1, 0, 0};
  int seed = 1;
};
void describe(OptionVisitor& v, DetailPatternOptions& options);

/// Density that falls or grows along an axis, per vertex: linear from one end of the surface to the
/// other; constant for the kind `constant`.
/// @throws Error  for an axis without direction, or densities that are 0 at both ends
Eigen::VectorXd gradient_density(const TriMesh& surface, const DensityOptions& options);

/// A flag a triangle: whether its centre meets all conditions.
/// @throws Error  naming the key: a direction that is none
std::vector<char> faces_of_region(const TriMesh& surface, const std::vector<RegionOptions>& region);

/// Details of a sampled pattern. Same surface, options and seeds: same details.
///
/// - uniform: places drawn with the density, independently (a Poisson process of fixed number).
/// - poisson-disk: drawn likewise; one that has another within radius / sqrt(density at it) is
///   refused, until there are `count` or one of 400 darts a detail is left. At random 0.834 is the
///   largest radius that can hold the number (Feder 1980).
/// - grid: squares of the plane, each with a detail shifted at random (flat surfaces in z = const).
/// - clusters: centres as poisson-disk, about each a disc of details along the surface, no two
///   nearer than a quarter of its radius.
///
/// The density is scaled so that it sums to `count` over the surface.
/// @param relative  density at each vertex, not negative, in any unit
/// @param experiment_seed  moved on by that of the options (core/random.h, scene_seed)
/// @throws Error  naming the key: density 0 everywhere, a region that holds nothing, a grid on a
///                surface that is not flat, fewer than 3 details
std::vector<Detail> scatter(const TriMesh& surface, const DetailPatternOptions& options,
                            const Eigen::VectorXd& relative, std::uint64_t experiment_seed = 1);

}  // namespace geoprior::details
