#include "models/grammar/objects/volume_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/angles.h"
#include "core/error.h"
#include "core/mesh.h"
#include "core/random.h"
#include "models/grammar/objects/spacing.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Grain = GrainParameter;

/// Random points of the body a ball of the candidates' distance.
constexpr double kBodyTrials = 40;
constexpr int kPebbleSides = 10, kPebbleRings = 5;
constexpr double kMostGrains = 1e6;

/// An ellipsoid in the ball of the grain.
TriMesh pebble_mesh(std::span<const double> p) {
  const Vector3d half = p[Grain::kSize] * p[Grain::kRadius] * Vector3d(1, 0.88, 0.72);
  TriMesh m;
  const int low = kPebbleRings * kPebbleSides, high = low + 1;
  m.V.resize(low + 2, 3);
  m.F.resize(2 * kPebbleRings * kPebbleSides, 3);
  m.V.row(low) << 0, 0, -half.z();
  m.V.row(high) << 0, 0, half.z();
  int f = 0;
  for (int r = 0; r < kPebbleRings; ++r) {
    const double latitude = std::numbers::pi * ((r + 1.0) / (kPebbleRings + 1) - 0.5);
    for (int side = 0; side < kPebbleSides; ++side) {
      const double turn = kFullTurn * side / kPebbleSides;
      const int here = r * kPebbleSides + side;
      const int beside = r * kPebbleSides + (side + 1) % kPebbleSides;
      m.V.row(here) << half.x() * std::cos(latitude) * std::cos(turn),
          half.y() * std::cos(latitude) * std::sin(turn), half.z() * std::sin(latitude);
      if (r == 0) m.F.row(f++) << low, beside, here;
      if (r + 1 == kPebbleRings) {
        m.F.row(f++) << here, beside, high;
        continue;
      }
      m.F.row(f++) << here, beside, beside + kPebbleSides;
      m.F.row(f++) << here, beside + kPebbleSides, here + kPebbleSides;
    }
  }
  return m;
}

void require_volume_options(const VolumeSetOptions& o) {
  const auto require = [](bool holds, const char* name, const char* allowed) {
    if (!holds)
      throw Error(std::string("'") + name + "' is out of its range", "make_volume_set", allowed);
  };
  const double least = std::min({o.width, o.depth, o.height});
  require(least >= 1e-3 && std::max({o.width, o.depth, o.height}) <= 1e3, "width, depth or height",
          "1e-3 to 1e3 m");
  require(o.spacing > 0 && o.spacing <= least / 2, "spacing", "above 0, to half the shortest side");
  const double grains = o.width * o.depth * o.height / (o.spacing * o.spacing * o.spacing);
  require(grains <= kMostGrains, "spacing", "one that leaves room for 1e6 grains at most");
}

Eigen::Quaterniond drawn_turn(RandomStream& random) {
  const double a = std::sqrt(1 - random.uniform()), b = std::sqrt(std::max(0.0, 1 - a * a));
  const double s = kFullTurn * random.uniform(), t = kFullTurn * random.uniform();
  return {a * std::cos(s), a * std::sin(s), b * std::cos(t), b * std::sin(t)};
}

}  // namespace

void describe(OptionVisitor& v, VolumeSetOptions& o) {
  constexpr std::array<std::string_view, 2> kShapes{"ball", "bar"};
  describe_choice(v, "shape", o.shape, kShapes, {.doc = "body that is filled"});
  v.value("width", o.width,
          {.doc = "size of the body along x", .unit = "m", .min = 1e-3, .max = 1e3});
  v.value("depth", o.depth,
          {.doc = "size of the body along y", .unit = "m", .min = 1e-3, .max = 1e3});
  v.value("height", o.height,
          {.doc = "size of the body along z", .unit = "m", .min = 1e-3, .max = 1e3});
  v.value(
      "spacing", o.spacing,
      {.doc = "least distance of two grains of full size; at most half the body's shortest side",
       .unit = "m",
       .min = 1e-6,
       .max = 500});
}

Hierarchy make_volume_set(const VolumeSetOptions& o, std::uint64_t seed) {
  require_volume_options(o);
  RandomStream random(seed, "volume-set");
  const Vector3d sides(o.width, o.depth, o.height);
  const int trials = static_cast<int>(kBodyTrials * sides.prod() / std::pow(o.spacing, 3)) + 1;
  std::vector<Vector3d> points;
  for (int i = 0; i < trials; ++i) {
    Vector3d x;
    for (double& coordinate : x) coordinate = random.uniform() - 0.5;
    if (o.shape == VolumeSetOptions::Shape::ball && x.norm() > 0.5) continue;
    points.push_back(x.cwiseProduct(sides));
  }
  const DiskSampling disk = sample_disks(
      static_cast<int>(points.size()), [&](int i) { return points[i]; }, {-sides / 2, sides / 2},
      o.spacing);
  ElementType root, grain;
  root.name = "volume-set";
  root.keys = [](std::span<const double>, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
  };
  grain.name = "grain";
  grain.parameters = {{"size", "1", 0, 1}, {"radius", "m", 1e-6, 1e3}, {"candidate", "1", 0, 1}};
  grain.keys = root.keys;
  grain.mesh = pebble_mesh;
  Hierarchy out({root, grain});
  const std::size_t count = disk.elements.size() + disk.candidates.size();
  out.reserve(count + 1, 3 * count);
  out.add(0, -1, {});
  for (const Vector3d& x : disk.elements)
    out.add(1, 0, {x, drawn_turn(random)}, std::array{1., o.spacing / 2, 0.});
  for (const Vector3d& x : disk.candidates)
    out.set_present(out.add(1, 0, {x, drawn_turn(random)}, std::array{0., o.spacing / 2, 1.}),
                    false);
  return out;
}

}  // namespace geoprior::grammar
