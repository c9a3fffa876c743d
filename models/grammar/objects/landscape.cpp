#include "models/grammar/objects/landscape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/random.h"
#include "models/grammar/objects/forest.h"
#include "models/grammar/objects/spacing.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kTerrainCells = 40;  // along a side
constexpr int kHillWaves = 7, kWoodWaves = 9;
/// What a plinth reaches into the ground, and the least that is seen of it (m).
constexpr double kPlinthFoot = 0.05, kLeastPlinth = 0.2;
constexpr double kRoofRise = 0.42, kEaves = 0.35;  // over the depth of the floor; m
/// Distance of pines from the middle of the path and from a house's circle (m).
constexpr double kPathClearing = 1.6, kHouseClearing = 0.4;
constexpr double kHouseRoom = 1.2;  // distance of houses over the least one
constexpr int kHouseTrials = 20000, kPineTrials = 20;
constexpr int kStoneParts = 4;  // places from one stone to the next
constexpr int kCurveSteps = 4000;

/// A sum of plane waves over the plan: a smooth random function.
class WaveField {
 public:
  WaveField(int waves, double longest, double shortest, RandomStream& random) {
    for (int k = 0; k < waves; ++k) {
      const double length = longest * std::pow(shortest / longest, k / (waves - 1.0));
      const double turn = kFullTurn * random.uniform(), phase = kFullTurn * random.uniform();
      waves_.push_back(
          {kFullTurn / length * Vector2d(std::cos(turn), std::sin(turn)), phase, length / longest});
    }
  }
  [[nodiscard]] double at(double x, double y) const {
    double sum = 0;
    for (const PlaneWave& w : waves_) sum += w.height * std::cos(w.k.dot(Vector2d(x, y)) + w.phase);
    return sum;
  }

 private:
  struct PlaneWave {
    Vector2d k;  // 1/m
    double phase, height;
  };
  std::vector<PlaneWave> waves_;
};

/// A height field: vertices row by row, diagonals that alternate.
TriMesh hills(const LandscapeOptions& o, RandomStream& random) {
  const double side = std::min(o.width, o.depth);
  const WaveField field(kHillWaves, 1.1 * side, 0.3 * side, random);
  constexpr int n = kTerrainCells;
  TriMesh out;
  out.V.resize((n + 1) * (n + 1), 3);
  out.F.resize(2 * n * n, 3);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = o.width * (1. * i / n - 0.5), y = o.depth * (1. * j / n - 0.5);
      out.V.row(j * (n + 1) + i) << x, y, field.at(x, y);
    }
  const double low = out.V.col(2).minCoeff(), high = out.V.col(2).maxCoeff();
  out.V.col(2) = (out.V.col(2).array() - low) * (o.relief / (high - low));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      const int f = 2 * (j * n + i);
      if ((i + j) % 2 == 0) {
        out.F.row(f) << a, b, c;
        out.F.row(f + 1) << a, c, d;
      } else {
        out.F.row(f) << a, b, d;
        out.F.row(f + 1) << b, c, d;
      }
    }
  return out;
}

/// A house that is planned: its floor.
struct HousePlot {
  Pose pose;
  TrianglePlace place;
  double width, depth;
};

/// A stone of the path or a place between two.
struct StonePlace {
  TrianglePlace place;
  Vector3d x;
};

/// What stands on the terrain, before it becomes a hierarchy.
class Settlement {
 public:
  Settlement(const LandscapeOptions& o, const Ground& ground, RandomStream& random)
      : o_(o), ground_(ground), random_(random) {
    lay_path();
    place_houses();
    plant_woods();
  }
  std::vector<StonePlace> stones;
  std::vector<HousePlot> houses;
  std::vector<TrianglePlace> pines, pine_candidates;

 private:
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  [[nodiscard]] double distance_from_path(const Vector3d& x) const {
    double out = std::numeric_limits<double>::infinity();
    for (const StonePlace& stone : stones)
      out = std::min(out, (stone.x - x).head<2>().squaredNorm());
    return std::sqrt(out);
  }

  /// Along a sine in plan, each place at its distance in space from the one before.
  void lay_path() {
    const double turns = between(0.75, 1.1), phase = kFullTurn * random_.uniform();
    const auto curve = [&](double u) -> std::optional<TrianglePlace> {
      const double x = 0.88 * o_.width * (u - 0.5);
      return ground_.below({x, 0.2 * o_.depth * std::sin(kFullTurn * turns * u + phase), 0});
    };
    const double step = o_.pitch / kStoneParts;
    std::vector<StonePlace> found{{*curve(0), ground_.at(*curve(0))}};
    double low = 0;
    for (int i = 1; i <= kCurveSteps; ++i) {
      double high = 1. * i / kCurveSteps;
      while ((ground_.at(*curve(high)) - found.back().x).norm() >= step) {
        double a = low, b = high;
        for (int k = 0; k < 60; ++k) {
          const double middle = (a + b) / 2;
          ((ground_.at(*curve(middle)) - found.back().x).norm() < step ? a : b) = middle;
        }
        found.push_back({*curve(b), ground_.at(*curve(b))});
        low = b;
      }
      low = high;
    }
    found.resize((found.size() - 1) / kStoneParts * kStoneParts + 1);
    stones = std::move(found);
  }

  /// Near the path, on ground that is not steep.
  void place_houses() {
    for (int trial = 0; trial < kHouseTrials; ++trial) {
      if (static_cast<int>(houses.size()) == o_.houses) return;
      const double width = between(5.5, 8), depth = between(4.5, 6);
      const double radius = house_radius(width, depth);
      const Vector3d at(between(-0.35, 0.35) * o_.width, between(-0.35, 0.35) * o_.depth, 0);
      const double from_path = distance_from_path(at);
      if (from_path < radius + 0.8 || from_path > radius + 6) continue;
      const bool is_free = std::all_of(houses.begin(), houses.end(), [&](const HousePlot& other) {
        const double least = radius + house_radius(other.width, other.depth);
        return (other.pose.position - at).head<2>().norm() >= kHouseRoom * least;
      });
      const auto place = ground_.below(at);
      if (!is_free || !place) continue;
      const HousePlot plot{{ground_.at(*place), facing_path(at)}, *place, width, depth};
      if (plinth_depth(ground_, plot.pose, width, depth) < 0.28 * o_.relief + 0.2)
        houses.push_back(plot);
    }
    throw Error("leaves room for " + std::to_string(houses.size()) + " houses", "make_landscape",
                "fewer houses, or larger ground");
  }

  /// Upright, its x axis along the path.
  [[nodiscard]] Eigen::Quaterniond facing_path(const Vector3d& at) const {
    const auto nearer = [&](const StonePlace& a, const StonePlace& b) {
      return (a.x - at).head<2>().squaredNorm() < (b.x - at).head<2>().squaredNorm();
    };
    const auto nearest = std::min_element(stones.begin() + 4, stones.end() - 4, nearer);
    const Vector3d along = (nearest + 4)->x - (nearest - 4)->x;
    const double half = std::atan2(along.y(), along.x()) / 2;
    return {std::cos(half), 0, 0, std::sin(half)};
  }

  void plant_woods() {
    const double side = std::min(o_.width, o_.depth);
    const WaveField field(kWoodWaves, 0.9 * side, 0.12 * side, random_);
    std::vector<double> sample(1000);
    for (double& s : sample)
      s = field.at(between(-0.5, 0.5) * o_.width, between(-0.5, 0.5) * o_.depth);
    std::sort(sample.begin(), sample.end());
    const double least = sample[std::min(999, static_cast<int>((1 - o_.woods) * 1000))];
    const double squares = o_.width * o_.depth / (o_.spacing * o_.spacing);
    std::vector<Vector3d> points;
    std::vector<TrianglePlace> places;
    for (int i = 0; i < static_cast<int>(kPineTrials * squares); ++i) {
      const Vector3d at(between(-0.48, 0.48) * o_.width, between(-0.48, 0.48) * o_.depth, 0);
      if (field.at(at.x(), at.y()) < least || distance_from_path(at) < kPathClearing) continue;
      const bool is_free = std::all_of(houses.begin(), houses.end(), [&](const HousePlot& house) {
        return (house.pose.position - at).head<2>().norm() >=
               house_radius(house.width, house.depth) + o_.spacing / 2 + kHouseClearing;
      });
      if (!is_free) continue;
      places.push_back(*ground_.below(at));
      points.push_back(ground_.at(places.back()));
    }
    const Vector3d half(o_.width / 2, o_.depth / 2, o_.relief);
    const DiskSampling disk = sample_disks(
        static_cast<int>(points.size()), [&](int i) { return points[i]; }, {-half, half},
        o_.spacing);
    for (const int i : disk.element_number) pines.push_back(places[i]);
    for (const int i : disk.candidate_number) pine_candidates.push_back(places[i]);
  }

  const LandscapeOptions& o_;
  const Ground& ground_;
  RandomStream& random_;
};

// ---- Types -------------------------------------------------------------------------------------

double roof_rise(double depth) { return kRoofRise * depth; }

/// A closed solid of eight corners: bottom counter-clockwise from above, then top.
void append_block(const std::array<Vector3d, 8>& corners, TriMesh& m) {
  constexpr int kFaces[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                 {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  const int v = m.vertex_count(), f = m.triangle_count();
  m.V.conservativeResize(v + 8, 3);
  m.F.conservativeResize(f + 12, 3);
  for (int k = 0; k < 8; ++k) m.V.row(v + k) = corners[k];
  for (int k = 0; k < 12; ++k)
    m.F.row(f + k) << v + kFaces[k][0], v + kFaces[k][1], v + kFaces[k][2];
}

std::array<Vector3d, 8> upright_block(double width, double depth, double low, double high) {
  std::array<Vector3d, 8> out;
  const auto corner = floor_corners(width, depth);
  for (int k = 0; k < 4; ++k) {
    out[k] = corner[k] + low * Vector3d::UnitZ();
    out[k + 4] = corner[k] + high * Vector3d::UnitZ();
  }
  return out;
}

/// Plinth, walls, a gable roof along x, a door.
TriMesh house_mesh(std::span<const double> p) {
  using House = HouseParameter;
  const double width = p[House::kWidth], depth = p[House::kDepth], height = p[House::kHeight];
  const double rise = roof_rise(depth);
  TriMesh m;
  append_block(upright_block(width + 0.2, depth + 0.2, -p[House::kPlinth], 0.02), m);
  append_block(upright_block(width, depth, 0, height), m);
  const double slope = 2 * rise / depth, out = kEaves;
  auto gable = upright_block(width + 2 * out, depth + 2 * out, height - slope * out, height + rise);
  for (int k = 4; k < 8; ++k) gable[k].y() = gable[k].y() > 0 ? 0.02 : -0.02;
  append_block(gable, m);
  auto door = upright_block(1, 0.16, 0, std::min(2.1, 0.8 * height));
  for (Vector3d& x : door) x.y() -= depth / 2;
  append_block(door, m);
  auto chimney = upright_block(0.6, 0.6, height, height + 1.25 * rise);
  for (Vector3d& x : chimney) x += Vector3d(width / 4, depth / 6, 0);
  append_block(chimney, m);
  return m;
}

TriMesh stone_mesh(std::span<const double> p) {
  constexpr int kSides = 9;
  constexpr std::array<std::array<double, 2>, 3> kProfile{{{0.8, -0.2}, {0.84, 0.08}, {0.7, 0.15}}};
  constexpr int kRings = static_cast<int>(kProfile.size());
  const double scale = p[StoneParameter::kSize] * p[StoneParameter::kRadius];
  TriMesh m;
  m.V.resize(kRings * kSides + 1, 3);
  m.F.resize((2 * kRings - 1) * kSides, 3);
  const int top = kRings * kSides;
  m.V.row(top) << 0, 0, 0.17 * scale;
  int f = 0;
  for (int r = 0; r < kRings; ++r) {
    for (int side = 0; side < kSides; ++side) {
      const double angle = kFullTurn * side / kSides;
      const double radius = scale * kProfile[r][0];
      const int here = r * kSides + side, beside = r * kSides + (side + 1) % kSides;
      m.V.row(here) << radius * std::cos(angle), 0.85 * radius * std::sin(angle),
          scale * kProfile[r][1];
      if (r + 1 == kRings) {
        m.F.row(f++) << here, beside, top;
        continue;
      }
      m.F.row(f++) << here, beside, beside + kSides;
      m.F.row(f++) << here, beside + kSides, here + kSides;
    }
  }
  return m;
}

const ParameterType kUnitShare{"size", "1", 0, 1};

ElementType pine_type() {
  using Pine = PineParameter;
  ElementType out;
  out.name = "pine";
  out.parameters = {kUnitShare,
                    {"radius", "m", 1e-6, 1e3},
                    {"height", "m", 1e-6, 1e3},
                    {"triangle", "1", 0, 1e9},
                    {"b0", "1", 0, 1},
                    {"b1", "1", 0, 1},
                    {"candidate", "1", 0, 1}};
  out.keys = [](std::span<const double> p, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
    keys.emplace_back(0, 0, p[Pine::kSize] * p[Pine::kHeight]);
  };
  out.mesh = [](std::span<const double> p) {
    return conifer_mesh(p[Pine::kSize] * p[Pine::kHeight], 0.9 * p[Pine::kSize] * p[Pine::kRadius]);
  };
  return out;
}

ElementType house_type() {
  using House = HouseParameter;
  ElementType out;
  out.name = "house";
  out.parameters = {{"width", "m", 1, 100},  {"depth", "m", 1, 100},    {"height", "m", 1, 50},
                    {"plinth", "m", 0, 1e4}, {"triangle", "1", 0, 1e9}, {"b0", "1", 0, 1},
                    {"b1", "1", 0, 1}};
  out.keys = [](std::span<const double> p, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
    for (const Vector3d& corner : floor_corners(p[House::kWidth], p[House::kDepth]))
      keys.push_back(corner);
    keys.emplace_back(0, 0, p[House::kHeight] + roof_rise(p[House::kDepth]));
  };
  out.mesh = house_mesh;
  return out;
}

ElementType stone_type() {
  ElementType out;
  out.name = "stone";
  out.parameters = {kUnitShare,
                    {"radius", "m", 1e-6, 1e3},
                    {"along", "1", 0, 1},
                    {"triangle", "1", 0, 1e9},
                    {"b0", "1", 0, 1},
                    {"b1", "1", 0, 1},
                    {"candidate", "1", 0, 1}};
  out.keys = [](std::span<const double>, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
  };
  out.mesh = stone_mesh;
  return out;
}

std::vector<ElementType> landscape_types(const Eigen::MatrixX3i& triangles) {
  ElementType landscape, terrain, grove, village, path;
  landscape.name = "landscape";
  landscape.keys = [](std::span<const double>, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
  };
  terrain.name = "terrain";
  terrain.triangles = triangles;
  grove.name = "grove";
  village.name = "village";
  path.name = "path";
  path.parameters = {{"pitch", "m", 1e-6, 1e3}};
  return {landscape, terrain, grove, village, path, pine_type(), house_type(), stone_type()};
}

void require_landscape_options(const LandscapeOptions& o) {
  const auto require = [](bool holds, const char* name, const char* allowed) {
    if (!holds)
      throw Error(std::string("'") + name + "' is out of its range", "make_landscape", allowed);
  };
  require(std::min(o.width, o.depth) >= 20 && std::max(o.width, o.depth) <= 1e4, "width or depth",
          "20 to 1e4 m");
  require(o.relief >= 0.01 && o.relief <= std::min(o.width, o.depth) / 4, "relief",
          "0.01 m to a fourth of the shorter side");
  require(o.houses >= 0 && o.houses <= 100, "houses", "0 to 100");
  require(o.woods >= 0 && o.woods <= 1, "woods", "0 to 1");
  require(o.spacing >= 0.2 && o.spacing <= 20, "spacing", "0.2 to 20 m");
  require(o.pitch >= 0.2 && o.pitch <= 5, "pitch", "0.2 to 5 m");
}

Eigen::Quaterniond drawn_yaw(RandomStream& random) {
  const double half = kFullTurn * random.uniform() / 2;
  return {std::cos(half), 0, 0, std::sin(half)};
}

void add_settlement(const LandscapeOptions& o, const Settlement& all, const Ground& ground,
                    RandomStream& random, Hierarchy& out) {
  const int grove = out.add(out.find_type("grove"), 0, {});
  const int village = out.add(out.find_type("village"), 0, {});
  const int path = out.add(out.find_type("path"), 0, {}, std::array{o.pitch});
  const int pine = out.find_type("pine"), house = out.find_type("house"),
            stone = out.find_type("stone");
  const auto add_pine = [&](const TrianglePlace& at, bool is_candidate) {
    const double height = o.spacing * (1.5 + 0.9 * random.uniform());
    const std::array values{is_candidate ? 0. : 1., o.spacing / 2, height,
                            1. * at.triangle,       at.b0,         at.b1,
                            is_candidate ? 1. : 0.};
    const int e = out.add(pine, grove, {ground.at(at), drawn_yaw(random)}, values);
    if (is_candidate) out.set_present(e, false);
  };
  for (const TrianglePlace& at : all.pines) add_pine(at, false);
  for (const TrianglePlace& at : all.pine_candidates) add_pine(at, true);
  for (const HousePlot& h : all.houses) {
    const double plinth = plinth_depth(ground, h.pose, h.width, h.depth);
    const double height = 2.7 + 0.8 * random.uniform();
    out.add(house, village, h.pose,
            std::array{h.width, h.depth, height, plinth, 1. * h.place.triangle, h.place.b0,
                       h.place.b1});
  }
  for (std::size_t i = 0; i < all.stones.size(); ++i) {
    const bool is_candidate = i % kStoneParts != 0;
    const TrianglePlace& at = all.stones[i].place;
    const double along = static_cast<double>(i) / static_cast<double>(all.stones.size() - 1);
    const std::array values{is_candidate ? 0. : 1., o.pitch / 2, along,
                            1. * at.triangle,       at.b0,       at.b1,
                            is_candidate ? 1. : 0.};
    const int e = out.add(stone, path, {ground.at(at), drawn_yaw(random)}, values);
    if (is_candidate) out.set_present(e, false);
  }
}

}  // namespace

void describe(OptionVisitor& v, LandscapeOptions& o) {
  v.value("width", o.width,
          {.doc = "size of the ground along x", .unit = "m", .min = 20, .max = 1e4});
  v.value("depth", o.depth,
          {.doc = "size of the ground along y", .unit = "m", .min = 20, .max = 1e4});
  v.value("relief", o.relief,
          {.doc = "height of the highest place over the lowest; at most a fourth of the ground's "
                  "shorter side",
           .unit = "m",
           .min = 0.01,
           .max = 2500});
  v.value("houses", o.houses, {.doc = "number of houses", .min = 0, .max = 100});
  v.value("woods", o.woods, {.doc = "part of the ground that is wooded", .min = 0, .max = 1});
  v.value("spacing", o.spacing,
          {.doc = "least distance of two pines of full size", .unit = "m", .min = 0.2, .max = 20});
  v.value("pitch", o.pitch,
          {.doc = "distance of consecutive stones of the path", .unit = "m", .min = 0.2, .max = 5});
}

double house_radius(double width, double depth) { return 0.5 * std::hypot(width, depth); }

std::array<Vector3d, 4> floor_corners(double width, double depth) {
  const double w = width / 2, d = depth / 2;
  return {Vector3d(-w, -d, 0), Vector3d(w, -d, 0), Vector3d(w, d, 0), Vector3d(-w, d, 0)};
}

Ground::Ground(std::span<const Vector3d> points, const Eigen::MatrixX3i& triangles)
    : points_(points.begin(), points.end()), triangles_(triangles) {
  for (const Vector3d& x : points_) box_.extend(x);
  const int n = static_cast<int>(triangles_.rows());
  const int side = std::max(1, static_cast<int>(std::sqrt(n / 2.0)));
  cells_ = {side, side};
  begin_.assign(side * side + 1, 0);
  const auto visit = [&](int t, const auto& take) {
    Eigen::AlignedBox3d box;
    for (const int v : triangles_.row(t)) box.extend(points_[v]);
    const auto low = cell_of(box.min()), high = cell_of(box.max());
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) take(y * cells_[0] + x);
  };
  for (int t = 0; t < n; ++t) visit(t, [&](int cell) { ++begin_[cell + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  entry_.resize(begin_.back());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (int t = 0; t < n; ++t) visit(t, [&](int cell) { entry_[next[cell]++] = t; });
}

std::array<int, 2> Ground::cell_of(const Vector3d& x) const {
  std::array<int, 2> out{};
  for (int k = 0; k < 2; ++k) {
    const double share = (x[k] - box_.min()[k]) / std::max(box_.sizes()[k], 1e-300);
    out[k] = static_cast<int>(std::clamp(share * cells_[k], 0.0, cells_[k] - 1.0));
  }
  return out;
}

std::optional<TrianglePlace> Ground::below(const Vector3d& x) const {
  constexpr double kRim = -1e-9;
  const auto c = cell_of(x);
  const int cell = c[1] * cells_[0] + c[0];
  std::optional<TrianglePlace> out;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = begin_[cell]; k < begin_[cell + 1]; ++k) {
    const auto corner = triangles_.row(entry_[k]);
    const Vector2d p = points_[corner[2]].head<2>(), d = x.head<2>() - p;
    const Vector2d u = points_[corner[0]].head<2>() - p, v = points_[corner[1]].head<2>() - p;
    const double area = u.x() * v.y() - u.y() * v.x();
    if (!(std::abs(area) > 1e-12 * (u.squaredNorm() + v.squaredNorm()))) continue;
    const double b0 = (d.x() * v.y() - d.y() * v.x()) / area;
    const double b1 = (u.x() * d.y() - u.y() * d.x()) / area;
    if (b0 < kRim || b1 < kRim || 1 - b0 - b1 < kRim) continue;
    TrianglePlace place{entry_[k], std::clamp(b0, 0.0, 1.0), 0};
    place.b1 = std::clamp(b1, 0.0, 1 - place.b0);
    const double away = std::abs(at(place).z() - x.z());
    if (away >= nearest) continue;
    nearest = away;
    out = place;
  }
  return out;
}

double Ground::gap(const Vector3d& x) const {
  if (const auto place = below(x)) return x.z() - at(*place).z();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : points_) nearest = std::min(nearest, (p - x).norm());
  return nearest;
}

double plinth_depth(const Ground& ground, const Pose& pose, double width, double depth) {
  double out = kLeastPlinth;
  for (const Vector3d& corner : floor_corners(width, depth))
    out = std::max(out, ground.gap(pose * corner) + kPlinthFoot);
  return out;
}

double house_radius(const Hierarchy& h, int house) {
  return house_radius(h.parameter(house, HouseParameter::kWidth),
                      h.parameter(house, HouseParameter::kDepth));
}

double plinth_depth(const Ground& ground, const Hierarchy& h, int house, const Pose& pose) {
  return plinth_depth(ground, pose, h.parameter(house, HouseParameter::kWidth),
                      h.parameter(house, HouseParameter::kDepth));
}

int terrain_of(const Hierarchy& h, int landscape) {
  for (const int child : h.children(landscape))
    if (h.type(child).name == "terrain" && h.present(child)) return child;
  throw Error("has no terrain", "element '" + h.label(landscape) + "'", "one that is present");
}

Ground ground_of(const Hierarchy& h, int landscape) {
  const int terrain = terrain_of(h, landscape);
  return {h.points(terrain), h.type(terrain).triangles};
}

Hierarchy make_landscape(const LandscapeOptions& o, std::uint64_t seed) {
  require_landscape_options(o);
  RandomStream random(seed, "landscape");
  const TriMesh mesh = hills(o, random);
  std::vector<Vector3d> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) vertices.emplace_back(mesh.V.row(v));
  const Ground ground(vertices, mesh.F);
  const Settlement all(o, ground, random);
  Hierarchy out(landscape_types(mesh.F));
  out.add(0, -1, {});
  out.add(1, 0, {}, {}, vertices);
  add_settlement(o, all, ground, random, out);
  return out;
}

}  // namespace geoprior::grammar
