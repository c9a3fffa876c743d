#include "models/grammar/objects/spacing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "models/grammar/maps/strokes.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

/// Of each distance, so that rounding does not bring two elements too near.
constexpr double kKeepsClear = 1 - 1e-12;
/// Room beyond which it is of no matter, in radii: a little more than what gives full size.
constexpr double kElementRoom = 1 + 1e-9, kCandidateRoom = 1 + kCandidateBand + 1e-9;
/// Slack of tests that leave out what cannot count, so that rounding leaves out nothing else.
constexpr double kLeftOut = 1 + 1e-12;
constexpr double kNotYet = -1;  // a size that is not found yet
constexpr std::size_t kSpacingBlock = 4096;
/// Candidates' distance over that of elements. Above (1 + kCandidateBand) / 2, where a candidate
/// that is not there is in nobody's way.
constexpr double kCandidateDistance = 0.7;
/// Elements are apart by a little more than they need: they are of size 1 in spite of kKeepsClear.
constexpr double kFullAtRest = 1 + 1e-9;

/// Circles meet below the first, and are then pushed to the second, over the sum of their radii.
constexpr double kCirclesTouch = 1 + 1e-9, kCirclesClear = 1 + 1e-6;
constexpr int kMostPushes = 300;
/// Relative slack of the distances of stones, beyond rounding.
constexpr double kStepSlack = 1e-9;
/// How far along the path a stone that is moved takes others along: so many pitches and so many
/// times its shift.
constexpr double kFollowPitches = 4, kFollowShifts = 2.5;

double full_room(SpacedKind kind) {
  return kind == SpacedKind::candidate ? kCandidateRoom : kElementRoom;
}

double size_for_room(SpacedKind kind, double room) {
  const double m = kKeepsClear * room;
  return std::clamp(kind == SpacedKind::candidate ? (m - 1) / kCandidateBand : m, 0.0, 1.0);
}

bool is_given(SpacedKind kind, SpacedState state) {
  return kind == SpacedKind::fixed || state == SpacedState::known;
}

Eigen::AlignedBox3d box_of_points(std::span<const Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : points) box.extend(x);
  return box;
}

/// The cells of a uniform grid over a box, numbered along x, then y, then z.
class CellGrid {
 public:
  /// @param least_side  of a cell (m); they are larger where there would be more than 8 a point
  CellGrid(const Eigen::AlignedBox3d& box, double points, double least_side)
      : box_(box), side_(least_side) {
    if (box.isEmpty()) return;
    const double most = 8 * points + 64;
    while (std::max(1.0, cells_along(0)) * std::max(1.0, cells_along(1)) *
               std::max(1.0, cells_along(2)) >
           most)
      side_ *= 1.25;
    for (int k = 0; k < 3; ++k) count_[k] = static_cast<int>(cells_along(k));
    inverse_ = 1 / side_;
  }

  [[nodiscard]] int cells() const { return count_[0] * count_[1] * count_[2]; }
  [[nodiscard]] std::array<int, 3> cell_of(const Vector3d& x) const {
    std::array<int, 3> c{};
    for (int k = 0; k < 3; ++k)
      c[k] = std::clamp(static_cast<int>((x[k] - box_.min()[k]) * inverse_), 0, count_[k] - 1);
    return c;
  }
  [[nodiscard]] int number(const std::array<int, 3>& c) const {
    return (c[2] * count_[1] + c[1]) * count_[0] + c[0];
  }
  /// Calls `visit(first, last)` for the rows of cells around one: cells first … last - 1.
  template <class Visit>
  void visit_rows(const std::array<int, 3>& c, const Visit& visit) const {
    const int from = std::max(c[0] - 1, 0), to = std::min(c[0] + 1, count_[0] - 1);
    for (int z = std::max(c[2] - 1, 0); z <= std::min(c[2] + 1, count_[2] - 1); ++z)
      for (int y = std::max(c[1] - 1, 0); y <= std::min(c[1] + 1, count_[1] - 1); ++y)
        visit(number({from, y, z}), number({to, y, z}) + 1);
  }

 private:
  [[nodiscard]] double cells_along(int k) const {
    return std::floor((box_.max()[k] - box_.min()[k]) / side_) + 1;
  }

  Eigen::AlignedBox3d box_;
  double side_, inverse_ = 1;
  std::array<int, 3> count_{1, 1, 1};
};

/// What is read of an element when another asks for its distance.
struct SpacedEntry {
  Vector3d x;
  double radius;
  double was;  ///< its size as it was
  int rank;    ///< in order of priority; -1: fixed
  int number;  ///< in the set
  SpacedKind kind;
  SpacedState state;
};

/// One element on the way to its size: the places of the entries around it that are still to be
/// looked at.
struct SizeSearch {
  int entry = 0;
  int rows = 0, row = 0, at = 0;
  std::array<std::array<int, 2>, 9> around{};
  double room = std::numeric_limits<double>::infinity();
  bool is_asked = false;
};

/// The recursion, from whichever element is asked first.
class SpacingGrid {
 public:
  explicit SpacingGrid(const SpacedSet& set)
      : set_(set), grid_(box_of_points(set.x), set.count(), spacing_reach(largest_radius())) {
    sort_into_cells();
  }

  std::vector<double> solve() {
    // An element near the border of two blocks may be found twice, each time the same.
    parallel_blocks(entries_.size(), kSpacingBlock, [&](std::size_t first, std::size_t last) {
      std::vector<SizeSearch> pending;
      for (int i = static_cast<int>(first); i < static_cast<int>(last); ++i)
        if (size_of(i) == kNotYet) find_size(i, pending);
    });
    std::vector<double> out(entries_.size());
    for (std::size_t i = 0; i < entries_.size(); ++i) out[entries_[i].number] = size_[i];
    return out;
  }

 private:
  [[nodiscard]] double largest_radius() const {
    double out = 0;
    for (const double r : set_.radius) out = std::max(out, r);
    return out;
  }
  [[nodiscard]] double size_of(int entry) {
    return std::atomic_ref<double>(size_[entry]).load(std::memory_order_relaxed);
  }

  void sort_into_cells() {
    const int n = set_.count();
    std::vector<int> cell(n);
    begin_.assign(grid_.cells() + 1, 0);
    parallel_blocks(n, 8 * kSpacingBlock, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) cell[i] = grid_.number(grid_.cell_of(set_.x[i]));
    });
    for (const int c : cell) ++begin_[c + 1];
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    entries_.resize(n);
    size_.resize(n);
    for (int i = 0; i < n; ++i) {
      const int at = next[cell[i]]++;
      const SpacedKind kind = set_.kind[i];
      entries_[at] = {set_.x[i], set_.radius[i], set_.size[i], kind == SpacedKind::fixed ? -1 : i,
                      i,         kind,           set_.state[i]};
      size_[at] = is_given(kind, set_.state[i]) ? set_.size[i] : kNotYet;
    }
  }

  void begin(int entry, SizeSearch& search) const {
    search = {};
    search.entry = entry;
    search.is_asked = entries_[entry].state != SpacedState::kept;
    grid_.visit_rows(grid_.cell_of(entries_[entry].x), [&](int first, int last) {
      search.around[search.rows++] = {begin_[first], begin_[last]};
    });
    search.at = search.around[0][0];
  }

  void find_size(int entry, std::vector<SizeSearch>& pending) {
    pending.emplace_back();
    begin(entry, pending.back());
    while (!pending.empty()) {
      SizeSearch& search = pending.back();
      const int other = look_around(search);
      if (other >= 0) {
        pending.emplace_back();
        begin(other, pending.back());
        continue;
      }
      const SpacedEntry& e = entries_[search.entry];
      const double size = search.is_asked ? size_for_room(e.kind, search.room) : e.was;
      std::atomic_ref<double>(size_[search.entry]).store(size, std::memory_order_relaxed);
      pending.pop_back();
    }
  }

  /// Goes on with the neighbours. @return  one whose size has to be found before; -1: none is left
  int look_around(SizeSearch& search) {
    const SpacedEntry& e = entries_[search.entry];
    const double full = full_room(e.kind);
    while (true) {
      const int last = search.around[search.row][1];
      for (; search.at < last; ++search.at) {
        const SpacedEntry& other = entries_[search.at];
        if (other.rank >= e.rank) continue;
        // Of an element that keeps its size unless something near changes, all count.
        const double room = search.is_asked ? std::min(search.room, full) : full;
        const double reach = kLeftOut * (room * e.radius + other.radius);
        const double squared = (e.x - other.x).squaredNorm();
        if (squared >= reach * reach) continue;
        const double size = size_of(search.at);
        if (size == kNotYet) return search.at;
        const double distance = std::sqrt(squared);
        search.room = std::min(search.room, (distance - size * other.radius) / e.radius);
        if (distance < full * e.radius + other.radius &&
            (other.state == SpacedState::moved || size != other.was))
          search.is_asked = true;
        if (search.is_asked && size_for_room(e.kind, search.room) == 0) return -1;
      }
      if (++search.row == search.rows) return -1;
      search.at = search.around[search.row][0];
    }
  }

  const SpacedSet& set_;
  CellGrid grid_;
  std::vector<int> begin_;  ///< of each cell in `entries_`; cells + 1
  std::vector<SpacedEntry> entries_;
  std::vector<double> size_;  ///< of the entries
};

/// The recursion of `space_path`.
class StonePath {
 public:
  StonePath(std::vector<PathStone>& stones, double pitch, const PathGround& ground)
      : stones_(stones), pitch_(pitch), ground_(ground) {
    for (const PathStone& stone : stones) nodes_.emplace_back(stone.along, stone.x);
    std::stable_sort(nodes_.begin(), nodes_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
  }

  void halve(int first, int last) {
    if (last - first < 2) return;
    const PathStone &a = stones_[first], &b = stones_[last];
    const double whole = 2 * (1 + 2 * kStepSlack) * kLeastStep;
    const double steps = (a.x - b.x).norm() / pitch_;
    const double share = std::clamp((steps - whole) / (kLargestStep - whole), 0.0, 1.0);
    const int middle = middle_of(first, last);
    PathStone& stone = stones_[middle];
    stone.size = std::min(a.size, b.size) * share;
    if (stone.size == 0 || !find_place(stone, a, b)) {
      for (int i = first + 1; i < last; ++i) stones_[i].size = 0;
      return;
    }
    halve(first, middle);
    halve(middle, last);
  }

 private:
  /// The middle one of those that are there at rest, or of all.
  [[nodiscard]] int middle_of(int first, int last) const {
    std::vector<int> own;
    for (int i = first + 1; i < last; ++i)
      if (!stones_[i].is_candidate) own.push_back(i);
    return own.empty() ? (first + last) / 2 : own[(own.size() - 1) / 2];
  }

  bool find_place(PathStone& stone, const PathStone& a, const PathStone& b) const {
    const double least = kLeastStep * pitch_;
    if ((stone.x - a.x).norm() < least) return slide(stone, a, b.along);
    if ((stone.x - b.x).norm() < least) return slide(stone, b, a.along);
    return true;
  }

  /// Along the path towards `end` until it is clear of `other`. @return  whether there is a place
  bool slide(PathStone& stone, const PathStone& other, double end) const {
    const double least = (1 + kStepSlack) * kLeastStep * pitch_;
    const double sign = end > stone.along ? 1 : -1;
    const auto is_clear = [&](double along) {
      const auto x = place_at(along);
      return x && (*x - other.x).norm() >= least;
    };
    // From node to node, then within the piece in which it becomes clear.
    double near = stone.along, far = end;
    const int n = static_cast<int>(nodes_.size());
    for (int k = 0; k < n; ++k) {
      const double along = nodes_[sign > 0 ? k : n - 1 - k].first;
      if (sign * (along - near) <= 0 || sign * (end - along) <= 0) continue;
      if (is_clear(along)) {
        far = along;
        break;
      }
      near = along;
    }
    for (int k = 0; k < 60; ++k) {
      const double middle = (near + far) / 2;
      (is_clear(middle) ? far : near) = middle;
    }
    if (!is_clear(far)) return false;
    stone.along = far;
    stone.x = *place_at(far);
    return true;
  }

  /// On the curve through all places of the path.
  [[nodiscard]] std::optional<Vector3d> place_at(double along) const {
    auto after = std::lower_bound(nodes_.begin(), nodes_.end(), along,
                                  [](const auto& node, double x) { return node.first < x; });
    if (after == nodes_.begin()) ++after;
    if (after == nodes_.end()) --after;
    const auto before = after - 1;
    const double length = after->first - before->first;
    const double share = length > 0 ? (along - before->first) / length : 0;
    return ground_(before->second + share * (after->second - before->second));
  }

  std::vector<PathStone>& stones_;
  double pitch_;
  const PathGround& ground_;
  std::vector<std::pair<double, Vector3d>> nodes_;  ///< by place in the path
};

}  // namespace

void SpacedSet::resize(int n) {
  x.resize(n);
  radius.resize(n);
  size.resize(n);
  kind.resize(n);
  state.resize(n);
}

void SpacedSet::add(const Vector3d& place, double its_radius, double its_size, SpacedKind its_kind,
                    SpacedState its_state) {
  x.push_back(place);
  radius.push_back(its_radius);
  size.push_back(its_size);
  kind.push_back(its_kind);
  state.push_back(its_state);
}

double spacing_reach(double largest_radius) { return (kCandidateRoom + 1 + 1e-6) * largest_radius; }

std::vector<double> spaced_sizes_plainly(const SpacedSet& set) {
  std::vector<double> out = set.size;
  for (int i = 0; i < set.count(); ++i) {
    if (is_given(set.kind[i], set.state[i])) continue;
    double room = std::numeric_limits<double>::infinity();
    bool is_asked = set.state[i] != SpacedState::kept;
    for (int j = 0; j < set.count(); ++j) {
      if (j == i || (j > i && set.kind[j] != SpacedKind::fixed)) continue;
      const double distance = (set.x[i] - set.x[j]).norm();
      room = std::min(room, (distance - out[j] * set.radius[j]) / set.radius[i]);
      if (distance < full_room(set.kind[i]) * set.radius[i] + set.radius[j] &&
          (set.state[j] == SpacedState::moved || out[j] != set.size[j]))
        is_asked = true;
    }
    if (is_asked) out[i] = size_for_room(set.kind[i], room);
  }
  return out;
}

std::vector<double> spaced_sizes(const SpacedSet& set) { return SpacingGrid(set).solve(); }

bool circles_meet(const SpacedCircle& a, const SpacedCircle& b) {
  return (a.centre - b.centre).norm() < kCirclesTouch * (a.radius + b.radius);
}

bool push_circles_apart(std::vector<SpacedCircle>& circles) {
  for (int sweep = 0; sweep < kMostPushes; ++sweep) {
    bool all_clear = true;
    for (std::size_t i = 0; i < circles.size(); ++i)
      for (std::size_t j = i + 1; j < circles.size(); ++j) {
        SpacedCircle &a = circles[i], &b = circles[j];
        if ((a.is_fixed && b.is_fixed) || !circles_meet(a, b)) continue;
        all_clear = false;
        const Eigen::Vector2d d = b.centre - a.centre;
        const double distance = d.norm(),
                     lacking = kCirclesClear * (a.radius + b.radius) - distance;
        const Eigen::Vector2d push =
            distance > 0 ? Eigen::Vector2d(lacking / distance * d) : Eigen::Vector2d(lacking, 0);
        const double share = a.is_fixed ? 0 : b.is_fixed ? 1 : 0.5;
        a.centre -= share * push;
        b.centre += (1 - share) * push;
      }
    if (all_clear) return true;
  }
  return false;
}

void space_path(std::vector<PathStone>& stones, double pitch, const PathGround& ground) {
  StonePath path(stones, pitch, ground);
  const int last = static_cast<int>(stones.size()) - 1;
  int before = 0;
  for (int i = 0; i <= last; ++i) {
    if (i != 0 && i != last && !stones[i].is_fixed) continue;
    if (!stones[i].is_fixed) stones[i].size = 1;
  }
  for (int i = 1; i <= last; ++i) {
    if (i != last && !stones[i].is_fixed) continue;
    path.halve(before, i);
    before = i;
  }
}

std::optional<double> broken_step(std::span<const PathStone> stones, double pitch) {
  const double low = (1 - 1e-6) * kLeastStep * pitch, high = (1 + 1e-6) * kLargestStep * pitch;
  const PathStone* before = nullptr;
  for (const PathStone& stone : stones) {
    if (stone.size == 0) continue;
    const double step = before != nullptr ? (stone.x - before->x).norm() : pitch;
    if (!(step >= low && step <= high)) return step;
    before = &stone;
  }
  return std::nullopt;
}

void bend_path(std::vector<PathStone>& stones, int moved, const Vector3d& shift, double pitch,
               const PathGround& ground) {
  if (shift == Vector3d::Zero()) return;
  const auto pitches = static_cast<double>(std::count_if(
      stones.begin(), stones.end(), [](const PathStone& s) { return !s.is_candidate; }));
  const double follow = (kFollowPitches + kFollowShifts * shift.norm() / pitch) / pitches;
  const double from = stones[moved].along;
  double before = follow, after = follow;
  for (const PathStone& s : stones) {
    if (s.is_fixed && s.along < from) before = std::min(before, from - s.along);
    if (s.is_fixed && s.along > from) after = std::min(after, s.along - from);
  }
  for (int i = 0; i < std::ssize(stones); ++i) {
    PathStone& s = stones[i];
    const double away = std::abs(s.along - from) / (s.along < from ? before : after);
    if (i == moved || s.is_fixed || away >= 1) continue;
    if (const auto x = ground(s.x + falloff(away) * shift)) s.x = *x;
  }
}

struct DiskSampler::Cells {
  CellGrid grid;
  std::vector<int> first;  ///< the last disk that was placed in a cell, or -1
  std::vector<int> next;   ///< the one before it in the same cell, or -1
};

DiskSampler::DiskSampler(const Eigen::AlignedBox3d& box, double distance, double places)
    : squared_(distance * distance), cells_(new Cells{{box, places, distance}, {}, {}}) {
  cells_->first.assign(cells_->grid.cells(), -1);
}

DiskSampler::~DiskSampler() = default;

bool DiskSampler::place(const Vector3d& x) {
  const std::array<int, 3> cell = cells_->grid.cell_of(x);
  bool is_free = true;
  cells_->grid.visit_rows(cell, [&](int from, int to) {
    for (int c = from; is_free && c < to; ++c)
      for (int k = cells_->first[c]; is_free && k >= 0; k = cells_->next[k])
        is_free = (x - places_[k]).squaredNorm() >= squared_;
  });
  if (!is_free) return false;
  int& first = cells_->first[cells_->grid.number(cell)];
  cells_->next.push_back(first);
  first = static_cast<int>(places_.size());
  places_.push_back(x);
  return true;
}

DiskSampling sample_disks(int count, const std::function<Vector3d(int)>& point,
                          const Eigen::AlignedBox3d& box, double spacing) {
  DiskSampling out;
  DiskSampler elements(box, kFullAtRest * spacing, count);
  DiskSampler dense(box, kCandidateDistance * spacing, count);
  for (int i = 0; i < count; ++i)
    if (elements.place(point(i))) out.element_number.push_back(i);
  out.elements = elements.places();
  for (const Vector3d& x : out.elements) dense.place(x);
  for (int i = 0; i < count; ++i)
    if (dense.place(point(i))) out.candidate_number.push_back(i);
  out.candidates.assign(dense.places().begin() + static_cast<int>(out.elements.size()),
                        dense.places().end());
  return out;
}

}  // namespace geoprior::grammar
