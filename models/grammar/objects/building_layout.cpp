#include "models/grammar/objects/building_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geoprior::grammar {
namespace {

constexpr double kUsualPitch = 1.8;     ///< of an opening that has no neighbour
constexpr double kRowTolerance = 1e-9;  ///< m

using LaidRow = std::vector<LaidOpening>;

/// By how much distances from the wall's middle grow: as the wall, as far as all finds place.
double row_scale(const LaidRow& row, double length_before, double length) {
  double scale = length / length_before;
  for (const auto& [o, origin] : row) {
    const double reach = std::abs(o.along - length_before / 2);
    if (!o.held && reach > kRowTolerance)
      scale = std::min(scale, (length / 2 - kWallEnd - o.width / 2) / reach);
  }
  return scale;
}

/// Brings distances into range, from the middle, or from what is held, outwards.
void space_row(LaidRow& row) {
  const int n = static_cast<int>(row.size());
  const auto x = [&](int i) -> double& { return row[i].opening.along; };
  const auto least = [&](int i) { return least_pitch(row[i].opening, row[i + 1].opening); };
  std::vector<int> held;
  for (int i = 0; i < n; ++i)
    if (row[i].opening.held) held.push_back(i);
  int first = (n - 1) / 2, last = n / 2;
  if (!held.empty()) {
    first = held.front();
    last = held.back();
  } else if (first < last) {
    const double middle = (x(first) + x(last)) / 2;
    const double half = std::clamp(x(last) - x(first), least(first), kMostPitch) / 2;
    x(first) = middle - half;
    x(last) = middle + half;
  }
  for (std::size_t k = 1; k < held.size(); ++k) {
    const int to = held[k];
    double least_rest = 0;
    for (int i = held[k - 1] + 1; i < to; ++i) least_rest += least(i);
    for (int i = held[k - 1] + 1; i < to; ++i) {
      const double low = std::max(x(i - 1) + least(i - 1), x(to) - (to - i) * kMostPitch);
      const double high = std::min(x(i - 1) + kMostPitch, x(to) - least_rest);
      x(i) = std::max(low, std::min(x(i), high));
      least_rest -= least(i);
    }
  }
  for (int i = first - 1; i >= 0; --i)
    x(i) = std::clamp(x(i), x(i + 1) - kMostPitch, x(i + 1) - least(i));
  for (int i = last + 1; i < n; ++i)
    x(i) = std::clamp(x(i), x(i - 1) + least(i - 1), x(i - 1) + kMostPitch);
}

/// Takes away, between two that are held, what finds no place, and fills too wide a gap.
void count_between_held(LaidRow& row) {
  int a = -1;
  for (int b = 0; b < std::ssize(row); ++b) {
    if (!row[b].opening.held) continue;
    const double distance = a < 0 ? 0 : row[b].opening.along - row[a].opening.along;
    while (a >= 0 && b - a > 1) {
      double least = 0;
      for (int i = a; i < b; ++i) least += least_pitch(row[i].opening, row[i + 1].opening);
      int out = (a + b) / 2;
      if (row[out].opening.door && b - a > 2) ++out;
      if (least <= distance + kRowTolerance || row[out].opening.door) break;
      row.erase(row.begin() + out);
      --b;
    }
    while (a >= 0 && (b - a) * kMostPitch < distance - kRowTolerance) {
      Opening more = row[a].opening.door ? row[b].opening : row[a].opening;
      more.held = more.door = false;
      more.along = (row[(a + b) / 2].opening.along + row[(a + b) / 2 + 1].opening.along) / 2;
      row.insert(row.begin() + (a + b) / 2 + 1, {more, -static_cast<int>(row.size())});
      ++b;
    }
    a = b;
  }
}

/// Drops what sticks out at an end: false, when nothing does.
bool drop_at_ends(LaidRow& row, double length) {
  const auto out = [&](const Opening& o) {
    return std::min(o.along, length - o.along) < kWallEnd + o.width / 2 - kRowTolerance;
  };
  const auto drop = [&](bool at_start) {
    auto end = at_start ? row.begin() : row.end() - 1;
    if (row.size() < 2 || !out(end->opening)) return false;
    if (end->opening.door || end->opening.held) end += at_start ? 1 : -1;
    if (end->opening.door || end->opening.held) return false;
    row.erase(end);
    return true;
  };
  const bool dropped = drop(true);
  return drop(false) || dropped;
}

/// Adds openings beside the outermost ones where there is room at both ends, or, where some are
/// held, at either.
void add_at_ends(LaidRow& row, double length) {
  const bool held =
      std::any_of(row.begin(), row.end(), [](const auto& laid) { return laid.opening.held; });
  while (true) {
    const double pitch = row.size() < 2 ? kUsualPitch
                                        : (row.back().opening.along - row.front().opening.along) /
                                              static_cast<double>(row.size() - 1);
    const auto beside = [&](const Opening& end, double sign) {
      Opening more = end;
      more.held = false;
      if (end.door) {
        // A window of usual proportions: the top where the door's is.
        more.door = false;
        more.sill = 0.4 * end.height;
        more.height = 0.6 * end.height;
      }
      more.along += sign * std::clamp(pitch, least_pitch(end, more), kMostPitch);
      return more;
    };
    const Opening left = beside(row.front().opening, -1), right = beside(row.back().opening, 1);
    const bool at_start = left.along - left.width / 2 >= kWallEnd;
    const bool at_end = right.along + right.width / 2 <= length - kWallEnd;
    if (held ? !(at_start || at_end) : !(at_start && at_end)) return;
    if (at_start) row.insert(row.begin(), {left, -1});
    if (at_end) row.push_back({right, -1});
  }
}

}  // namespace

double yaw_of(const Eigen::Quaterniond& turn) { return 2 * std::atan2(turn.z(), turn.w()); }

Eigen::Quaterniond turn_of_yaw(double yaw) { return {std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)}; }

StoreyBox storey_box(const Pose& pose, double width, double depth, double height) {
  return {pose.position, yaw_of(pose.turn), width, depth, height};
}

std::vector<int> present_children(const Hierarchy& hierarchy, int parent, const char* type) {
  std::vector<int> out;
  for (const int child : hierarchy.children(parent))
    if (hierarchy.present(child) && hierarchy.type(child).name == type) out.push_back(child);
  return out;
}

std::vector<int> storeys_of(const Hierarchy& hierarchy, int building) {
  std::vector<int> storeys = present_children(hierarchy, building, "storey");
  std::stable_sort(storeys.begin(), storeys.end(), [&](int a, int b) {
    return hierarchy.position(a).z() < hierarchy.position(b).z();
  });
  return storeys;
}

Pose wall_pose(const Pose& storey, int side, double width, double depth) {
  constexpr double kHalf = std::numbers::sqrt2 / 2;
  // Turns by 0, 90, 180 and 270 degrees.
  static const Eigen::Quaterniond kTurn[] = {
      {1, 0, 0, 0}, {kHalf, 0, 0, kHalf}, {0, 0, 0, 1}, {-kHalf, 0, 0, kHalf}};
  const double x = side == 0 || side == 3 ? -width / 2 : width / 2;
  const double y = side < 2 ? -depth / 2 : depth / 2;
  return {storey * Eigen::Vector3d(x, y, 0), storey.turn * kTurn[side]};
}

std::vector<double> wall_parameters(int side, double width, double depth, double height) {
  const bool front = side % 2 == 0;
  return {front ? width : depth, height, static_cast<double>(side), (front ? depth : width) / 2};
}

Pose opening_pose(const Pose& wall, const Opening& o) {
  return {wall * Eigen::Vector3d(o.along, 0, o.sill + o.height / 2), wall.turn};
}

double least_pitch(const Opening& a, const Opening& b) {
  return std::max(kLeastPitch, (a.width + b.width) / 2 + kOpeningGap);
}

std::vector<LaidOpening> lay_out_row(std::span<const Opening> row, double length_before,
                                     double height_before, double length, double height) {
  LaidRow laid;
  for (std::size_t i = 0; i < row.size(); ++i) laid.push_back({row[i], static_cast<int>(i)});
  if (laid.empty()) return laid;
  for (auto& [o, origin] : laid) {
    if (o.held) continue;
    o.sill *= height / height_before;
    o.height *= height / height_before;
  }
  count_between_held(laid);
  while (true) {
    LaidRow placed = laid;
    const double scale = row_scale(laid, length_before, length);
    for (auto& [o, origin] : placed)
      if (!o.held && length != length_before)
        o.along = length / 2 + scale * (o.along - length_before / 2);
    space_row(placed);
    // Which ones stick out is seen where they are placed, who is left is placed anew.
    LaidRow left = placed;
    if (!drop_at_ends(left, length)) {
      add_at_ends(placed, length);
      return placed;
    }
    std::erase_if(laid, [&](const LaidOpening& o) {
      return std::none_of(left.begin(), left.end(),
                          [&](const LaidOpening& l) { return l.origin == o.origin; });
    });
  }
}

}  // namespace geoprior::grammar
