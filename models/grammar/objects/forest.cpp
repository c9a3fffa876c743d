#include "models/grammar/objects/forest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "core/random.h"
#include "models/grammar/objects/spacing.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Conifer = ConiferParameter;

constexpr int kConiferSides = 8;
/// Elements in a square of the least distance, as `sample_disks` leaves them.
constexpr double kForestDensity = 0.617;
/// Random points in such a square.
constexpr double kForestTrials = 14;
/// Side of the tiles that it is filled by, in least distances.
constexpr double kForestTile = 12;
/// Part of its cell, about the middle, in which a conifer is that keeps no distance.
constexpr double kForestJitter = 0.8;

void require_forest_options(const ForestOptions& o) {
  const auto require = [](bool holds, const char* name, const char* allowed) {
    if (!holds)
      throw Error(std::string("'") + name + "' is out of its range", "make_forest", allowed);
  };
  require(o.elements >= 1 && o.elements <= 10000000, "elements", "1 to 1e7");
  require(o.distance >= 1e-3 && o.distance <= 1e3, "distance", "1e-3 to 1e3 m");
  require(o.aspect >= 1e-3 && o.aspect <= 1e3, "aspect", "1e-3 to 1e3");
}

/// Sides of the ground of so many squares of a side.
std::array<double, 2> ground_sides(double squares, double side, double aspect) {
  const double width = side * std::sqrt(squares / aspect);
  return {width, aspect * width};
}

/// Tile by tile, row by row, so that what is near is near in the hierarchy too; at random within a
/// tile.
DiskSampling spaced_ground(const ForestOptions& o, RandomStream& random) {
  const auto [width, depth] = ground_sides(o.elements / kForestDensity, o.distance, o.aspect);
  const double tile = kForestTile * o.distance;
  const int columns = std::max(1, static_cast<int>(std::lround(width / tile)));
  const int rows = std::max(1, static_cast<int>(std::lround(depth / tile)));
  const Vector3d side(width / columns, depth / rows, 0), half(width / 2, depth / 2, 0);
  const double squares = side.x() * side.y() / (o.distance * o.distance);
  const int trials = static_cast<int>(kForestTrials * squares) + 1;
  const std::uint64_t seed = random.next();
  RandomStream places(seed);
  const auto point = [&](int i) -> Vector3d {
    if (i == 0) places = RandomStream(seed);
    const int t = i / trials;
    const double u = t % columns + places.uniform(), v = t / columns + places.uniform();
    return Vector3d(u, v, 0).cwiseProduct(side) - half;
  };
  return sample_disks(columns * rows * trials, point, {-half, half}, o.distance);
}

/// Cells row by row; the last row is filled as far as elements go. A cell's place depends on where
/// it is about the middle alone: forests of any size are alike there.
DiskSampling loose_ground(const ForestOptions& o, RandomStream& random) {
  const auto [width, depth] = ground_sides(o.elements, o.distance, o.aspect);
  const int columns = std::max(1, static_cast<int>(std::lround(width / o.distance)));
  const int rows = std::max(1, static_cast<int>(std::lround(depth / o.distance)));
  const std::uint64_t seed = random.next();
  DiskSampling out;
  out.elements.reserve(o.elements);
  for (int i = 0; i < o.elements; ++i) {
    const int column = i % columns - columns / 2, row = i / columns - rows / 2;
    RandomStream cell(seed, static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32 |
                                static_cast<std::uint32_t>(row));
    const double x = column + 0.5 + kForestJitter * (cell.uniform() - 0.5);
    const double y = row + 0.5 + kForestJitter * (cell.uniform() - 0.5);
    out.elements.emplace_back(o.distance * x, o.distance * y, 0);
  }
  return out;
}

ElementType conifer_type() {
  ElementType out;
  out.name = "conifer";
  out.parameters = {{"size", "1", 0, 1},
                    {"radius", "m", 1e-6, 1e3},
                    {"height", "m", 1e-6, 1e3},
                    {"candidate", "1", 0, 1}};
  out.keys = [](std::span<const double> p, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
    keys.emplace_back(0, 0, p[Conifer::kSize] * p[Conifer::kHeight]);
  };
  out.mesh = [](std::span<const double> p) {
    return conifer_mesh(p[Conifer::kSize] * p[Conifer::kHeight],
                        0.85 * p[Conifer::kSize] * p[Conifer::kRadius]);
  };
  return out;
}

}  // namespace

void describe(OptionVisitor& v, ForestOptions& o) {
  v.value("elements", o.elements,
          {.doc = "number of conifers; met within some percent where they keep apart",
           .min = 1,
           .max = 1e7});
  v.value("distance", o.distance,
          {.doc = "mean distance of neighbouring conifers; the least one where they keep apart",
           .unit = "m",
           .min = 1e-3,
           .max = 1e3});
  v.value("apart", o.apart, {.doc = "whether conifers keep apart"});
  v.value("aspect", o.aspect,
          {.doc = "depth of the ground over its width", .min = 1e-3, .max = 1e3});
}

/// The half angle's sine and cosine come from the whole one's, without the angle.
Eigen::Quaterniond upright_turn(const Eigen::Matrix3d& m, const Eigen::Quaterniond& turn) {
  const double sine = m(1, 0) - m(0, 1), cosine = m(0, 0) + m(1, 1);
  const double length = std::sqrt(sine * sine + cosine * cosine);
  if ((sine == 0 && cosine > 0) || length == 0) return turn;
  // The larger of the two is found by a root, the other by a quotient.
  double c = std::sqrt((1 + std::abs(cosine) / length) / 2);
  double s = sine / (2 * length * c);
  if (cosine < 0) std::swap(c, s);
  return Eigen::Quaterniond(c, 0, 0, s) * turn;
}

TriMesh conifer_mesh(double height, double radius) {
  struct Cone {
    double low, high, radius;  // over height, over height, over the radius
  };
  constexpr std::array<Cone, 4> kCones{
      {{-0.04, 0.3, 0.16}, {0.16, 0.55, 1}, {0.38, 0.78, 0.76}, {0.62, 1, 0.5}}};
  TriMesh m;
  m.V.resize(static_cast<int>(kCones.size()) * (kConiferSides + 2), 3);
  m.F.resize(static_cast<int>(kCones.size()) * 2 * kConiferSides, 3);
  int v = 0, f = 0;
  for (const Cone& cone : kCones) {
    const int low = v + kConiferSides, high = low + 1;
    for (int side = 0; side < kConiferSides; ++side) {
      const double angle = kFullTurn * side / kConiferSides;
      const double r = radius * cone.radius;
      m.V.row(v + side) << r * std::cos(angle), r * std::sin(angle), height * cone.low;
      const int after = v + (side + 1) % kConiferSides;
      m.F.row(f++) << low, after, v + side;
      m.F.row(f++) << high, v + side, after;
    }
    m.V.row(low) << 0, 0, height * cone.low;
    m.V.row(high) << 0, 0, height * cone.high;
    v = high + 1;
  }
  return m;
}

Hierarchy make_forest(const ForestOptions& o, std::uint64_t seed) {
  require_forest_options(o);
  RandomStream random(seed, "forest");
  const DiskSampling disk = o.apart ? spaced_ground(o, random) : loose_ground(o, random);
  ElementType root;
  root.name = "forest";
  root.parameters = {{"spacing", "m", 0, 1e3}};
  Hierarchy out({root, conifer_type()});
  const std::size_t count = disk.elements.size() + disk.candidates.size();
  out.reserve(count + 1, 4 * count + 1);
  out.add(0, -1, {}, std::array{o.apart ? o.distance : 0.});
  const auto add = [&](const Vector3d& x, bool is_candidate) {
    const double height = o.distance * (1.5 + 0.9 * random.uniform());
    const double half = kFullTurn * random.uniform() / 2;
    const Pose pose{x, Eigen::Quaterniond(std::cos(half), 0, 0, std::sin(half))};
    const int e =
        out.add(1, 0, pose,
                std::array{is_candidate ? 0. : 1., o.distance / 2, height, is_candidate ? 1. : 0.});
    if (is_candidate) out.set_present(e, false);
  };
  for (const Vector3d& x : disk.elements) add(x, false);
  for (const Vector3d& x : disk.candidates) add(x, true);
  return out;
}

}  // namespace geoprior::grammar
