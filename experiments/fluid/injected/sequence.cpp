#include "experiments/fluid/injected/sequence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/random.h"
#include "experiments/fluid/injected/contour.h"

namespace geoprior::fluid {
namespace {

constexpr double kGravity = -9.81;  // m/s^2
constexpr double kDepth = 8;        // of a tank, in cells of resolution 1
constexpr double kOffset = 0.37;    // of the lattice: no wall lies on nodes
constexpr double kBumpExtent = 2;   // sigmas of the disc that stands for a bump

double gauss(double x) { return std::exp(-x * x); }

/// A standard normal number of a lattice node in a frame, the same whoever asks.
double node_noise(std::uint64_t seed, int frame, int i, int j, int k) {
  const auto part = [](int n) { return static_cast<std::uint64_t>(n + (1 << 19)); };
  const std::uint64_t node = part(i) << 40 | part(j) << 20 | part(k);
  return RandomStream(seed * 0x9E3779B97F4A7C15ULL + node, static_cast<std::uint64_t>(frame))
      .normal();
}

void require(bool holds, const std::string& problem, const std::string& allowed) {
  if (!holds) throw Error(problem, "injected sequence", allowed);
}

void append(const TriMesh& part, TriMesh& whole) {
  const Eigen::Index n = whole.V.rows(), m = whole.F.rows();
  whole.V.conservativeResize(n + part.V.rows(), 3);
  whole.V.bottomRows(part.V.rows()) = part.V;
  whole.F.conservativeResize(m + part.F.rows(), 3);
  whole.F.bottomRows(part.F.rows()) = part.F.array() + static_cast<int>(n);
}

/// A sphere on a lattice of its own, whose phase is that of the world's.
TriMesh contoured_sphere(const Eigen::Vector3d& centre, double radius, double spacing, double noise,
                         std::uint64_t seed, int frame) {
  const Eigen::Vector3i low = ((centre.array() - radius) / spacing).floor().cast<int>() - 2;
  const Eigen::Vector3i n = ((centre.array() + radius) / spacing).ceil().cast<int>().matrix() +
                            Eigen::Vector3i(2, 2, 2) - low;
  LatticeContour contour(spacing * low.cast<double>(), spacing);
  const auto value = [&](int i, int j, int k) {
    const Eigen::Vector3i node = low + Eigen::Vector3i(i, j, k);
    const double distance = (spacing * node.cast<double>() - centre).norm() - radius;
    if (noise <= 0 || std::abs(distance) > 2 * spacing) return distance;
    return distance + noise * node_noise(seed, frame, node.x(), node.y(), node.z());
  };
  for (int k = 0; k < n.z(); ++k) {
    for (int j = 0; j < n.y(); ++j) {
      for (int i = 0; i < n.x(); ++i) {
        double values[8];
        for (int c = 0; c < 8; ++c) values[c] = value(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
        contour.add_cell(i, j, k, values);
      }
    }
  }
  return contour.mesh();
}

}  // namespace

void describe(OptionVisitor& v, InjectedOptions& o) {
  v.value("bumps", o.bumps,
          {.doc = "Gaussian bumps that travel, each in a lane of its own", .min = 0, .max = 100});
  v.value("rings", o.rings,
          {.doc = "ring waves that expand, each in a place of its own", .min = 0, .max = 100});
  v.value("drops", o.drops,
          {.doc = "drops that fall where a ring begins, at most as many as rings",
           .min = 0,
           .max = 100});
  v.value("crossings", o.crossings,
          {.doc = "pairs of drops that pass each other closely", .min = 0, .max = 100});
  v.value("merges", o.merges,
          {.doc = "pairs of bumps of which one runs into the other", .min = 0, .max = 100});
  v.value(
      "dropout", o.dropout,
      {.doc = "probability that a feature begins to be missing in a frame", .min = 0, .max = 1});
  v.value("longest_dropout", o.longest_dropout,
          {.doc = "frames in a row that a feature may be missing", .min = 1, .max = 100});
  v.value("noise", o.noise,
          {.doc = "standard deviation of the distance at lattice nodes",
           .unit = "h",
           .min = 0,
           .max = 1});
  v.value("resolution", o.resolution, {.doc = "lattice nodes along a cell", .min = 1, .max = 16});
  v.value("frames", o.frames, {.doc = "number of frames", .min = 1, .max = 10000});
  v.value("cell", o.cell,
          {.doc = "edge of a cell at resolution 1", .unit = "m", .min = 1e-6, .max = 1e6});
  v.value("frame_interval", o.frame_interval,
          {.doc = "time from frame to frame", .unit = "s", .min = 1e-6, .max = 1e3});
  v.value("tank", o.tank, {.doc = "makes a closed tank instead of an open height field"});
  v.value("velocity", o.velocity, {.doc = "gives the frames velocities, those of the drops"});
}

InjectedSequence::InjectedSequence(const InjectedOptions& options) : options_(options) {
  const InjectedOptions& o = options_;
  require(o.frames >= 1, std::to_string(o.frames) + " frames", "at least 1");
  require(o.resolution >= 1 && o.resolution <= 16, "resolution " + std::to_string(o.resolution),
          "1 to 16");
  require(o.cell > 0 && o.frame_interval > 0, "cell or frame interval is not positive",
          "positive numbers");
  require(o.dropout >= 0 && o.dropout <= 1 && o.longest_dropout >= 1, "dropouts out of range",
          "a share and at least one frame");
  require(o.noise >= 0 && o.noise <= 1, "noise out of range", "0 to 1");
  require(std::min({o.bumps, o.rings, o.drops, o.crossings, o.merges}) >= 0 && o.drops <= o.rings,
          "counts out of range", "none negative, at most as many drops as rings");
  items_ = injected_layout(o, size_, causes_);
  depth_ = kDepth * o.cell;
  for (int f = 0; f < o.frames; ++f) {
    for (const Item& item : items_) {
      if (item.alive(f)) truth_.push_back(truth_of(item, f));
    }
  }
}

double InjectedSequence::time(int frame) const {
  require(frame >= 0 && frame < options_.frames, "no frame " + std::to_string(frame),
          "0 to " + std::to_string(options_.frames - 1));
  return frame * options_.frame_interval;
}

bool InjectedSequence::Item::alive(int frame) const {
  return frame >= begin && frame < end &&
         std::find(missing.begin(), missing.end(), frame) == missing.end();
}

Eigen::Vector3d InjectedSequence::centre(const Item& item, int frame) const {
  const double t = (frame - item.begin) * options_.frame_interval;
  Eigen::Vector3d x = item.at + t * item.velocity;
  if (item.shape == Shape::drop) x.z() += 0.5 * kGravity * t * t;
  return x;
}

InjectedTruth InjectedSequence::truth_of(const Item& item, int frame) const {
  InjectedTruth truth;
  truth.id = item.id;
  truth.frame = frame;
  truth.isolated = item.shape == Shape::drop;
  truth.centre = centre(item, frame);
  const double t = (frame - item.begin) * options_.frame_interval;
  double low = 0, high = item.amplitude;
  if (item.shape == Shape::drop) {
    truth.radius = item.radius;
    low = truth.centre.z() - item.radius;
    high = truth.centre.z() + item.radius;
    truth.area = 4 * std::numbers::pi * item.radius * item.radius;
  } else {
    truth.radius = kBumpExtent * item.width;
    if (item.shape == Shape::ring) truth.radius = item.radius + item.growth * t + 1.5 * item.width;
    truth.area = std::numbers::pi * truth.radius * truth.radius;
  }
  const Eigen::Vector3d r(truth.radius, truth.radius, 0);
  truth.box_min = truth.centre - r;
  truth.box_max = truth.centre + r;
  truth.box_min.z() = low;
  truth.box_max.z() = high;
  return truth;
}

/// Height of the free surface over the rest level z = 0 (m).
double InjectedSequence::height(double x, double y, int frame) const {
  double z = 0;
  for (const Item& item : items_) {
    if (item.shape == Shape::drop || !item.alive(frame)) continue;
    const Eigen::Vector3d c = centre(item, frame);
    const double r = std::hypot(x - c.x(), y - c.y());
    if (item.shape == Shape::bump) {
      const double gain = item.gain > 0 && frame >= item.grows_at ? item.gain : 0;
      z += (item.amplitude + gain) * gauss(r / (std::numbers::sqrt2 * item.width));
    } else {
      const double t = (frame - item.begin) * options_.frame_interval;
      z += item.amplitude * gauss((r - item.radius - item.growth * t) / item.width);
    }
  }
  return z;
}

TriMesh InjectedSequence::pool(int frame) const {
  const double h = cell();
  const double noise = options_.noise * h;
  // A tank lies inside its lattice; the open field ends with it.
  const int rim = options_.tank ? 2 : 0;
  const int nx = static_cast<int>(std::lround(size_.x() / h)) + 2 * rim;
  const int ny = static_cast<int>(std::lround(size_.y() / h)) + 2 * rim;
  const int below = static_cast<int>(std::ceil(depth_ / h)) + 2;
  const Eigen::Vector3d origin =
      h * Eigen::Vector3d(-rim + kOffset, -rim + kOffset, -below + kOffset);
  std::vector<double> height_at((nx + 1) * (ny + 1));
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i)
      height_at[j * (nx + 1) + i] = height(origin.x() + i * h, origin.y() + j * h, frame);
  }
  const auto value = [&](int i, int j, int k) {
    const Eigen::Vector3d x = origin + h * Eigen::Vector3d(i, j, k);
    double d = x.z() - height_at[j * (nx + 1) + i];
    if (noise > 0 && std::abs(d) < 2 * h) d += noise * node_noise(options_.seed, frame, i, j, k);
    if (!options_.tank) return d;
    return std::max({d, -x.x(), x.x() - size_.x(), -x.y(), x.y() - size_.y(), -depth_ - x.z()});
  };
  LatticeContour contour(origin, h);
  const auto add_column = [&](int i, int j, int from, int to) {
    for (int k = from; k < to; ++k) {
      double values[8];
      for (int c = 0; c < 8; ++c) values[c] = value(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
      contour.add_cell(i, j, k, values);
    }
  };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      double low = 1e30, high = -1e30;
      for (int c = 0; c < 4; ++c) {
        const double z = height_at[(j + (c >> 1)) * (nx + 1) + i + (c & 1)];
        low = std::min(low, z);
        high = std::max(high, z);
      }
      int from = static_cast<int>(std::floor((low - origin.z()) / h)) - 2;
      const int to = static_cast<int>(std::floor((high - origin.z()) / h)) + 3;
      if (options_.tank) {
        const bool side = std::min({i, j, nx - 1 - i, ny - 1 - j}) < rim + 2;
        if (side || from < 4) from = 0;
        if (from > 0) add_column(i, j, 0, 4);
      }
      add_column(i, j, std::max(from, 0), to);
    }
  }
  return contour.mesh();
}

SurfaceFrame InjectedSequence::frame(int frame) const {
  SurfaceFrame result;
  result.time = time(frame);
  result.mesh = pool(frame);
  const Eigen::Index bed = result.mesh.V.rows();
  std::vector<std::pair<Eigen::Index, Eigen::Vector3d>> moving;
  for (const Item& item : items_) {
    if (item.shape != Shape::drop || !item.alive(frame)) continue;
    append(contoured_sphere(centre(item, frame), item.radius, cell(), options_.noise * cell(),
                            options_.seed + static_cast<std::uint64_t>(item.id), frame),
           result.mesh);
    Eigen::Vector3d velocity = item.velocity;
    velocity.z() += kGravity * (frame - item.begin) * options_.frame_interval;
    moving.emplace_back(result.mesh.V.rows(), velocity);
  }
  if (!options_.velocity) return result;
  result.velocity.setZero(result.mesh.V.rows(), 3);
  Eigen::Index from = bed;
  for (const auto& [to, velocity] : moving) {
    for (; from < to; ++from) result.velocity.row(from) = velocity.transpose();
  }
  return result;
}

namespace {

using Item = InjectedSequence::Item;
using Shape = InjectedSequence::Shape;

constexpr double kLane = 24;    // width of a lane in cells
constexpr double kLength = 64;  // of the pool in cells
constexpr int kRingsInALane = 2;

/// Draws the features; lengths below are in cells of resolution 1, times in frames.
class Layout {
 public:
  explicit Layout(const InjectedOptions& o) : o_(o), random_(o.seed, "injected features") {}

  std::vector<Item> items;
  std::vector<InjectedCause> causes;

  void add_all() {
    for (int i = 0; i < o_.bumps; ++i) add_bump(lane_++);
    for (int i = 0; i < o_.merges; ++i) add_merge(lane_++);
    const int first = lane_;
    for (int i = 0; i < o_.rings; ++i) add_ring(i, first + i / kRingsInALane);
    lane_ += (o_.rings + kRingsInALane - 1) / kRingsInALane;
    lane_ = std::max(lane_, 2);
    for (int i = 0; i < o_.crossings; ++i) add_crossing(i);
    for (Item& item : items) drop_out(item);
  }
  [[nodiscard]] int lanes() const { return lane_; }

 private:
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  [[nodiscard]] double speed(double cells_per_frame) const {
    return cells_per_frame * o_.cell / o_.frame_interval;
  }
  [[nodiscard]] Eigen::Vector3d at(double x, double y, double z) const {
    return o_.cell * Eigen::Vector3d(x, y, z);
  }
  Item& add(Shape shape, double begin, double end) {
    Item item;
    item.id = static_cast<int>(items.size()) + 1;
    item.shape = shape;
    item.begin = std::clamp(static_cast<int>(begin), 0, o_.frames - 1);
    item.end = std::clamp(static_cast<int>(end), item.begin + 1, o_.frames);
    items.push_back(item);
    return items.back();
  }

  void add_bump(int lane) {
    const double frames = o_.frames;
    Item& bump = add(Shape::bump, between(0.05, 0.2) * frames, between(0.8, 0.95) * frames);
    const bool back = random_.uniform() < 0.5;
    const double travel = between(24, 36) / std::max(bump.end - bump.begin, 1);
    bump.at = at(back ? kLength - 14 : 14, (lane + 0.5) * kLane, 0);
    bump.velocity.x() = (back ? -1 : 1) * speed(travel);
    bump.width = between(2.6, 3.4) * o_.cell;
    bump.amplitude = between(2.2, 3.2) * o_.cell;
  }

  /// The second bump runs towards the first and ends 6.5 sigmas before it, which then grows.
  void add_merge(int lane) {
    const double frames = o_.frames;
    const double sigma = 2.8;
    Item& still = add(Shape::bump, 0.05 * frames, 0.95 * frames);
    still.at = at(20, (lane + 0.5) * kLane, 0);
    still.width = sigma * o_.cell;
    still.amplitude = 2.4 * o_.cell;
    still.grows_at = static_cast<int>(between(0.55, 0.65) * frames);
    still.gain = 1.2 * o_.cell;
    const int end = still.grows_at, first = still.id;
    Item& runner = add(Shape::bump, 0.05 * frames, end);
    const double travel = 44 - 20 - 6.5 * sigma;
    runner.at = at(44, (lane + 0.5) * kLane, 0);
    runner.velocity.x() = -speed(travel / std::max(runner.end - 1 - runner.begin, 1));
    runner.width = sigma * o_.cell;
    runner.amplitude = 2.4 * o_.cell;
    causes.push_back({runner.id, first, true});
  }

  void add_ring(int index, int lane) {
    const double frames = o_.frames;
    const double x = 16 + 32 * (index % kRingsInALane);
    const double y = (lane + 0.5) * kLane;
    const int begin = static_cast<int>(between(0.35, 0.55) * frames);
    if (index < o_.drops) add_falling_drop(x, y, begin);
    Item& ring = add(Shape::ring, begin, begin + 0.4 * frames);
    ring.at = at(x, y, 0);
    ring.radius = 2 * o_.cell;
    ring.growth = speed(2.4 / std::max(ring.end - ring.begin, 1));
    ring.width = 2.4 * o_.cell;
    ring.amplitude = between(1.6, 2.2) * o_.cell;
    if (index < o_.drops) causes.push_back({ring.id - 1, ring.id, false});
  }

  /// A drop whose lowest point is about to touch the pool in the last frame before `impact`.
  void add_falling_drop(double x, double y, int impact) {
    const int length = std::min(impact, 10);
    Item& drop = add(Shape::drop, impact - length, impact);
    drop.radius = between(2.0, 2.6) * o_.cell;
    const double fall = (drop.end - 1 - drop.begin) * o_.frame_interval;
    const double drift = between(-0.4, 0.4);  // cells a frame
    const Eigen::Vector3d last = at(x, y, 0) + Eigen::Vector3d(0, 0, drop.radius + 1.5 * o_.cell);
    const double top = between(-0.5, 0.2);  // vertical speed at first (m/s)
    drop.velocity = Eigen::Vector3d(speed(drift), 0, top);
    drop.at = last - drop.velocity * fall;
    drop.at.z() = last.z() - top * fall - 0.5 * kGravity * fall * fall;
  }

  /// Two drops on opposite arcs that meet in the middle, a gap of less than their radius apart.
  void add_crossing(int index) {
    const int middle = static_cast<int>(between(0.4, 0.6) * o_.frames);
    const int reach = std::min({8, middle, o_.frames - 1 - middle});
    const double y = (1 + index) * kLane, gap = 1.5, radius = 2.0;
    const double x = between(26, 38), z = 34 + 8 * index;
    for (const double way : {-1.0, 1.0}) {
      Item& drop = add(Shape::drop, middle - reach, middle + reach + 1);
      drop.radius = radius * o_.cell;
      const double back = reach * o_.frame_interval;
      const double rise = between(-0.2, 0.2);  // vertical speed in the middle (m/s)
      drop.velocity = Eigen::Vector3d(way * speed(between(0.8, 1.1)), 0, rise - kGravity * back);
      drop.at = at(x, y + way * (radius + gap / 2), z);
      drop.at.x() -= drop.velocity.x() * back;
      drop.at.z() += -rise * back + 0.5 * kGravity * back * back;
    }
  }

  void drop_out(Item& item) {
    for (int f = item.begin + 2; f < item.end - 2; ++f) {
      if (random_.uniform() >= o_.dropout) continue;
      const int length =
          1 + static_cast<int>(random_.below(static_cast<std::uint32_t>(o_.longest_dropout)));
      for (int k = 0; k < length && f < item.end - 2; ++k) item.missing.push_back(f++);
    }
  }

  const InjectedOptions& o_;
  RandomStream random_;
  int lane_ = 0;
};

}  // namespace

std::vector<Item> injected_layout(const InjectedOptions& options, Eigen::Vector2d& size,
                                  std::vector<InjectedCause>& causes) {
  Layout layout(options);
  layout.add_all();
  size = options.cell * Eigen::Vector2d(kLength, kLane * layout.lanes());
  causes = layout.causes;
  return layout.items;
}

}  // namespace geoprior::fluid
