#include "experiments/assembly/files/xtrackcad_paths.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>
#include <utility>

#include "core/angles.h"

namespace geoprior::assembly {
namespace {

/// XTrackCAD calls pieces connected up to here (inches).
constexpr double kConnectedTrackInches = .1;
constexpr double kTrackArcStep = 5 * kDegree;
constexpr int kTrackTransitionSteps = 16;
/// Most points of all ways through a turnout together. The largest one of XTrackCAD's own layouts
/// has about a hundred; a list of paths costs few bytes and could ask for any number.
constexpr int kMostTrackWayPoints = 2000;
constexpr int kMostBoxesOfTrackWay = 8;
constexpr double kTrackHalfHeight = .15;  ///< of the gauge

void reverse_track_if(TrackLine& piece, bool reversed) {
  if (reversed) std::reverse(piece.begin(), piece.end());
}

double gap_to_track(const Eigen::Vector2d& x, const TrackLine& piece) {
  return std::min((piece.front() - x).norm(), (piece.back() - x).norm());
}

/// The pieces one after the other, each turned so that it goes on where the one before ends; the
/// signs of the file are not needed for that. Nothing where they do not meet.
std::optional<TrackLine> track_chain(const std::vector<TrackLine>& pieces,
                                     const std::vector<int>& path) {
  TrackLine line;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const int number = std::abs(path[k]);
    if (number < 1 || number > static_cast<int>(pieces.size())) return std::nullopt;
    TrackLine piece = pieces[number - 1];
    if (k == 0 && path.size() > 1) {
      const int next = std::abs(path[1]);
      if (next < 1 || next > static_cast<int>(pieces.size())) return std::nullopt;
      const TrackLine& other = pieces[next - 1];
      reverse_track_if(piece,
                       gap_to_track(piece.front(), other) < gap_to_track(piece.back(), other));
    } else if (k > 0) {
      if (gap_to_track(line.back(), piece) > kConnectedTrackInches) return std::nullopt;
      reverse_track_if(piece,
                       (piece.back() - line.back()).norm() < (piece.front() - line.back()).norm());
    }
    line.insert(line.end(), piece.begin() + (k == 0 ? 0 : 1), piece.end());
    if (static_cast<int>(line.size()) > kMostTrackWayPoints) return std::nullopt;
  }
  if (line.empty()) return std::nullopt;
  return line;
}

/// Number of the end that is nearest, within the distance of what is connected.
int track_end_at(const std::vector<TrackEnd>& ends, const Eigen::Vector2d& x) {
  int nearest = Way::kInside;
  double least = kConnectedTrackInches;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double gap = (ends[i].position - x).norm();
    if (gap > least) continue;
    least = gap;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

/// The route along a chain, from an end on, or nothing when it joins no end with something else.
std::optional<TrackRoute> track_chain_route(const std::vector<TrackEnd>& ends, TrackLine line) {
  int from = track_end_at(ends, line.front()), to = track_end_at(ends, line.back());
  if (from == to) return std::nullopt;
  if (from == Way::kInside) {
    std::reverse(line.begin(), line.end());
    std::swap(from, to);
  }
  line.front() = ends[from].position;
  if (to != Way::kInside) line.back() = ends[to].position;
  return TrackRoute{from, to, std::move(line)};
}

/// The other end that looks the most the other way: where a train goes on that comes in by `end`.
int track_end_opposite(const std::vector<TrackEnd>& ends, int end) {
  int best = end == 0 ? 1 : 0;
  const auto alike = [&](int i) { return std::cos(ends[i].direction - ends[end].direction); };
  for (int i = 0; i < static_cast<int>(ends.size()); ++i)
    if (i != end && alike(i) < alike(best)) best = i;
  return best;
}

/// Paths cut at their zeros.
std::vector<std::vector<int>> single_track_paths(const std::vector<std::vector<int>>& paths) {
  std::vector<std::vector<int>> single;
  for (const std::vector<int>& path : paths) {
    single.emplace_back();
    for (const int number : path) {
      if (number == 0)
        single.emplace_back();
      else
        single.back().push_back(number);
    }
  }
  return single;
}

std::vector<Eigen::Vector3d> track_way_points(const TrackLine& line, const Pose& pose) {
  constexpr double kSamePoint = 1e-6;  // m
  const Pose to_part = pose.inverse();
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& x : line) {
    const Eigen::Vector3d point = to_part * Eigen::Vector3d(kInch * x.x(), kInch * x.y(), 0);
    if (points.empty() || (point - points.back()).norm() > kSamePoint) points.push_back(point);
  }
  return points;
}

/// To the left of the way at a point, as long as the mitre of the pieces that meet there asks for.
Eigen::Vector3d left_of_track(const std::vector<Eigen::Vector3d>& points, std::size_t i) {
  constexpr double kMostMitre = 2;
  const auto left_of_piece = [&](std::size_t k) -> Eigen::Vector3d {
    return Eigen::Vector3d::UnitZ().cross(points[k + 1] - points[k]).normalized();
  };
  const Eigen::Vector3d before = left_of_piece(i == 0 ? 0 : i - 1);
  const Eigen::Vector3d after = left_of_piece(i + 1 == points.size() ? i - 1 : i);
  const Eigen::Vector3d sum = before + after;
  if (sum.norm() < 1e-6) return before;
  const Eigen::Vector3d middle = sum.normalized();
  return middle * std::min(kMostMitre, 1 / std::max(middle.dot(before), 1e-6));
}

/// Vertices and triangles that the prisms of the ways add up to.
struct TrackPrisms {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;

  void add_quad(int a, int b, int c, int d) {
    triangles.emplace_back(a, b, c);
    triangles.emplace_back(a, c, d);
  }

  void add(const std::vector<Eigen::Vector3d>& points, double gauge) {
    const int first = static_cast<int>(vertices.size()), n = static_cast<int>(points.size());
    const Eigen::Vector3d up(0, 0, kTrackHalfHeight * gauge);
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d left = gauge / 2 * left_of_track(points, i);
      for (const double side : {1., -1.}) {
        const Eigen::Vector3d x = points[i] + side * left;
        vertices.push_back(x + up);
        vertices.push_back(x - up);
      }
    }
    enum Corner { kLeftTop, kLeftBottom, kRightTop, kRightBottom };
    const auto at = [&](int i, Corner corner) { return first + 4 * i + corner; };
    for (int i = 0; i + 1 < n; ++i)
      for (const auto& [a, b] : {std::pair{kRightTop, kLeftTop},
                                 {kLeftTop, kLeftBottom},
                                 {kLeftBottom, kRightBottom},
                                 {kRightBottom, kRightTop}})
        add_quad(at(i, a), at(i + 1, a), at(i + 1, b), at(i, b));
    add_quad(at(0, kLeftTop), at(0, kLeftBottom), at(0, kRightBottom), at(0, kRightTop));
    add_quad(at(n - 1, kRightTop), at(n - 1, kRightBottom), at(n - 1, kLeftBottom),
             at(n - 1, kLeftTop));
  }

  [[nodiscard]] TriMesh mesh() const {
    TriMesh out;
    out.V.resize(static_cast<Eigen::Index>(vertices.size()), 3);
    out.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      out.V.row(static_cast<Eigen::Index>(i)) = vertices[i].transpose();
    for (std::size_t i = 0; i < triangles.size(); ++i)
      out.F.row(static_cast<Eigen::Index>(i)) = triangles[i].transpose();
    return out;
  }
};

/// The box about the points first to last of a way, along their chord.
Box track_box(const std::vector<Eigen::Vector3d>& points, int first, int last, double gauge) {
  Eigen::Vector3d chord = points[last] - points[first];
  if (chord.norm() < 1e-6) chord = points[first + 1] - points[first];
  Box box;
  box.pose.linear() =
      Eigen::AngleAxisd(std::atan2(chord.y(), chord.x()), Eigen::Vector3d::UnitZ()).matrix();
  const Eigen::Matrix3d to_box = box.pose.linear().transpose();
  Eigen::Vector3d low = to_box * points[first], high = low;
  for (int i = first; i <= last; ++i) {
    low = low.cwiseMin(to_box * points[i]);
    high = high.cwiseMax(to_box * points[i]);
  }
  box.pose.translation() = box.pose.linear() * ((low + high) / 2);
  box.half = (high - low) / 2 + Eigen::Vector3d(0, gauge, kTrackHalfHeight * gauge);
  return box;
}

void add_track_boxes(const std::vector<Eigen::Vector3d>& points, double gauge,
                     std::vector<Box>& boxes) {
  const int pieces = static_cast<int>(points.size()) - 1;
  const int count = std::min(pieces, kMostBoxesOfTrackWay);
  for (int b = 0; b < count; ++b)
    boxes.push_back(track_box(points, b * pieces / count, (b + 1) * pieces / count, gauge));
}

}  // namespace

TrackLine arc_line(const Eigen::Vector2d& centre, const Eigen::Vector2d& from,
                   const Eigen::Vector2d& to, double sweep) {
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / kTrackArcStep - 1e-6)));
  const Eigen::Vector2d start = from - centre;
  const double r0 = start.norm(), r1 = (to - centre).norm();
  const double angle = std::atan2(start.y(), start.x());
  TrackLine line{from};
  for (int i = 1; i < steps; ++i) {
    const double t = static_cast<double>(i) / steps, a = angle + t * sweep;
    line.emplace_back(centre + ((1 - t) * r0 + t * r1) * Eigen::Vector2d(std::cos(a), std::sin(a)));
  }
  line.push_back(to);
  return line;
}

TrackLine transition_line(const TrackEnd& from, const TrackEnd& to) {
  const double length = (to.position - from.position).norm();
  const auto outward = [&](const TrackEnd& end) -> Eigen::Vector2d {
    return length * Eigen::Vector2d(std::cos(end.direction), std::sin(end.direction));
  };
  const Eigen::Vector2d m0 = -outward(from), m1 = outward(to);
  TrackLine line{from.position};
  for (int i = 1; i < kTrackTransitionSteps; ++i) {
    const double t = static_cast<double>(i) / kTrackTransitionSteps, s = 1 - t;
    line.emplace_back(s * s * (1 + 2 * t) * from.position + t * s * s * m0 - t * t * s * m1 +
                      t * t * (1 + 2 * s) * to.position);
  }
  line.push_back(to.position);
  return line;
}

std::vector<TrackRoute> turnout_routes(const std::vector<TrackEnd>& ends,
                                       const std::vector<TrackLine>& pieces,
                                       const std::vector<std::vector<int>>& paths) {
  std::vector<TrackRoute> routes;
  std::set<std::pair<int, int>> joined;
  std::vector<bool> is_reached(ends.size(), false);
  std::size_t points = 0;
  for (const std::vector<int>& path : single_track_paths(paths)) {
    std::optional<TrackLine> line = track_chain(pieces, path);
    if (!line || points + line->size() > kMostTrackWayPoints) continue;
    std::optional<TrackRoute> route = track_chain_route(ends, std::move(*line));
    if (!route || !joined.insert(std::minmax(route->from, route->to)).second) continue;
    for (const int end : {route->from, route->to})
      if (end != Way::kInside) is_reached[end] = true;
    points += route->line.size();
    routes.push_back(std::move(*route));
  }
  for (int i = 0; i < static_cast<int>(ends.size()) && ends.size() > 1; ++i) {
    if (is_reached[i]) continue;
    const int other = track_end_opposite(ends, i);
    is_reached[other] = true;
    routes.push_back({other, i, {ends[other].position, ends[i].position}});
  }
  return routes;
}

void set_track_body(PartType& type, const std::vector<TrackRoute>& routes, const Pose& pose,
                    double gauge) {
  TrackPrisms prisms;
  for (const TrackRoute& route : routes) {
    std::vector<Eigen::Vector3d> points = track_way_points(route.line, pose);
    if (points.size() < 2) continue;
    prisms.add(points, gauge);
    add_track_boxes(points, gauge, type.boxes);
    type.ways.push_back({route.from, route.to, std::move(points)});
  }
  type.mesh = prisms.mesh();
}

bool is_of_gauge(const PartType& type, double gauge) {
  return type.boxes.empty() ||
         std::abs(type.boxes.front().half.z() - kTrackHalfHeight * gauge) < 1e-6 * gauge;
}

}  // namespace geoprior::assembly
