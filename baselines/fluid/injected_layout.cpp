#include <algorithm>
#include <cmath>

#include "baselines/fluid/injected_sequence.h"
#include "core/random.h"

namespace geoprior {
namespace {

using Item = InjectedSequence::Item;
using Shape = InjectedSequence::Shape;

constexpr double kLane = 24;    // width of a lane in cells
constexpr double kLength = 64;  // of the pool in cells
constexpr int kRingsInALane = 2;
constexpr double kGravity = -9.81;  // m/s^2

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

}  // namespace geoprior
