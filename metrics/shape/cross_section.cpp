#include "metrics/shape/cross_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "metrics/developability/bend_side.h"

namespace geoprior {
namespace {

constexpr double kSkinWindow = 2;           // radii along the bone, about the section
constexpr double kEnoughDirections = 0.95;  // of a half; no section is closed by guess

constexpr double kSmallestWedge = 1e-3;  // rad
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A plane with centre and axes: u points outwards, n is the normal.
struct PlaneFrame {
  Eigen::Vector3d centre, u, v, n;
};

PlaneFrame carried(const PlaneFrame& f, const Eigen::Affine3d& T) {
  return {T * f.centre, T.linear() * f.u, T.linear() * f.v, T.linear() * f.n};
}

struct Segment {
  Eigen::Vector2d a, b;
  int slot;  ///< of the region's triangle list
};

/// Where a triangle of the region lies at one hinge, at rest.
struct ChainRange {
  double low, high;  ///< along the chain (m)
  bool is_outer;     ///< its middle is on the outer side of the bones

  [[nodiscard]] bool is_distal() const { return low + high >= 0; }
};

/// One hinge in one pose: what all its sections share.
struct PosedHinge {
  const JointRegion::Hinge& rest;
  Eigen::Affine3d proximal_transform, distal_transform;
  Eigen::Vector3d head;      // posed
  Eigen::Vector3d bisector;  // posed, unit, towards the distal bone; zero when folded flat
  Eigen::Vector3d outer_proximal, outer_distal;  // rest
  double bend_sign = 1;
  bool has_halves = false;
  std::vector<ChainRange> chain;
};

Eigen::Vector3d any_orthogonal(const Eigen::Vector3d& n) {
  Eigen::Index smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  return n.cross(Eigen::Vector3d::Unit(smallest)).normalized();
}

PosedHinge pose_hinge(const JointRegion& region, const JointRegion::Hinge& hinge,
                      const Eigen::MatrixX3i& F, const Eigen::MatrixX3d& rest, const Pose& pose) {
  PosedHinge p{hinge, pose[hinge.proximal_joint], pose[hinge.joint], {}, {}, {}, {}, 1, false, {}};
  p.head = p.distal_transform * hinge.head;
  const Eigen::Vector3d m =
      p.distal_transform.linear() * hinge.distal - p.proximal_transform.linear() * hinge.proximal;
  p.bisector = m.norm() > 1e-6 ? Eigen::Vector3d(m.normalized()) : Eigen::Vector3d::Zero();
  const std::optional<BendSides> sides = bend_sides(hinge, pose);
  p.has_halves = sides.has_value();
  if (sides) {
    p.bend_sign = sides->sign;
    p.outer_distal = sides->distal;
    p.outer_proximal = sides->proximal;
  } else {
    p.outer_distal = any_orthogonal(hinge.distal);
    p.outer_proximal = any_orthogonal(hinge.proximal);
  }
  p.chain.reserve(region.triangles.size());
  for (const int t : region.triangles) {
    ChainRange range{std::numeric_limits<double>::infinity(),
                     -std::numeric_limits<double>::infinity(), false};
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d x = rest.row(F(t, k)).transpose();
      const double s = chain_coordinate(hinge, x);
      range.low = std::min(range.low, s);
      range.high = std::max(range.high, s);
      middle += (x - hinge.head) / 3;
    }
    range.is_outer = middle.dot(range.is_distal() ? p.outer_distal : p.outer_proximal) > 0;
    p.chain.push_back(range);
  }
  return p;
}

/// Segments in which the plane cuts the region's triangles that lie near `s` along the chain.
///
/// A vertex in the plane counts as above it, and each mesh edge is cut from its lower vertex, so
/// that neighbouring segments share their end points bitwise.
std::vector<Segment> cut(const JointRegion& region, const Eigen::MatrixX3i& F,
                         const Eigen::MatrixX3d& V, const PosedHinge& hinge, double s,
                         const PlaneFrame& plane) {
  std::vector<Segment> segments;
  const double window = kSkinWindow * hinge.rest.radius;
  for (int slot = 0; slot < std::ssize(region.triangles); ++slot) {
    const ChainRange& range = hinge.chain[slot];
    if (range.low > s + window || range.high < s - window) continue;
    const int t = region.triangles[slot];
    std::array<Eigen::Vector3d, 3> r;
    std::array<double, 3> d{};
    for (std::size_t k = 0; k < 3; ++k) {
      r[k] = V.row(F(t, k)).transpose() - plane.centre;
      d[k] = r[k].dot(plane.n);
    }
    std::array<Eigen::Vector2d, 2> ends;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3 && count < 2; ++k) {
      std::size_t i = k;
      std::size_t j = (k + 1) % 3;
      if ((d[i] >= 0) == (d[j] >= 0)) continue;
      if (F(t, i) > F(t, j)) std::swap(i, j);
      const Eigen::Vector3d x = r[i] + d[i] / (d[i] - d[j]) * (r[j] - r[i]);
      ends[count++] = {x.dot(plane.u), x.dot(plane.v)};
    }
    if (count == 2) segments.push_back({ends[0], ends[1], slot});
  }
  return segments;
}

/// Direction k of n: angle 2 pi k / n from u. In quarters, so that the axes are exact.
Eigen::Vector2d direction(int k, int n) {
  const int quarter = n / 4;
  const double angle = 2 * std::numbers::pi * (k % quarter) / n;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  switch (k / quarter) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

/// Share of direction k in the outer half: 1, 0, or one half on the border.
double outer_share(int k, int n) {
  const int quarter = n / 4;
  if (k == quarter || k == 3 * quarter) return 0.5;
  return k < quarter || k > 3 * quarter ? 1.0 : 0.0;
}

/// First crossing of each ray from the centre with the segments that `seen` allows (a farther one
/// may be the next finger's); NaN where there is none.
template <class Seen>
std::vector<double> radial_profile(const std::vector<Segment>& segments, int n, const Seen& seen) {
  std::vector<double> rho(n, kNone);
  for (int k = 0; k < n; ++k) {
    const Eigen::Vector2d dir = direction(k, n);
    double& nearest = rho[k];
    for (const Segment& segment : segments) {
      const double a = dir.x() * segment.a.y() - dir.y() * segment.a.x();
      const double b = dir.x() * segment.b.y() - dir.y() * segment.b.x();
      if ((a >= 0) == (b >= 0) || !seen(k, segment)) continue;
      const double t = dir.dot(segment.a + a / (a - b) * (segment.b - segment.a));
      if (t > 0 && !(t >= nearest)) nearest = t;
    }
  }
  return rho;
}

/// Centroid of the area inside a radial profile, in the plane; the centre when the profile has
/// gaps.
Eigen::Vector2d profile_centroid(const std::vector<double>& rho) {
  const int n = static_cast<int>(rho.size());
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double area = 0;
  for (int k = 0; k < n; ++k) {
    const double r = rho[k];
    if (std::isnan(r)) return Eigen::Vector2d::Zero();
    moment += r * r * r / 3 * direction(k, n);
    area += r * r / 2;
  }
  return moment / area;
}

/// Sums over the directions of one half (or of the whole) that both profiles have.
struct HalfArea {
  double posed = 0;
  double reference = 0;  ///< at rest, cut off at the posed bisector
  double rest = 0;       ///< at rest, uncut
  double wanted = 0;     ///< directions
  double found = 0;

  [[nodiscard]] std::optional<double> ratio(double min_share) const {
    if (!(found >= kEnoughDirections * wanted) || !(reference > min_share * rest)) return {};
    return posed / reference;
  }
};

struct ProfilePair {
  std::vector<double> rest, posed;
  std::vector<double> limit;  ///< of the posed bisector plane; infinite where it does not cut
};

HalfArea half_area(const ProfilePair& p, double outer_weight, double inner_weight) {
  HalfArea half;
  const int n = static_cast<int>(p.rest.size());
  for (int k = 0; k < n; ++k) {
    const double share = outer_share(k, n);
    const double weight = outer_weight * share + inner_weight * (1 - share);
    half.wanted += weight;
    if (weight == 0 || std::isnan(p.rest[k]) || std::isnan(p.posed[k])) continue;
    const double limit = p.limit[k];
    half.found += weight;
    const double rest = p.rest[k];
    const double reference = std::min(rest, limit);
    const double posed = std::min(p.posed[k], limit);
    half.rest += weight * rest * rest;
    half.reference += weight * reference * reference;
    half.posed += weight * posed * posed;
  }
  return half;
}

/// Distance along each direction to the posed bisector plane, on the inner side.
std::vector<double> bisector_limit(const PosedHinge& hinge, const PlaneFrame& posed, double side,
                                   int n) {
  std::vector<double> limit(n, std::numeric_limits<double>::infinity());
  if (!hinge.has_halves) return limit;
  for (int k = 0; k < n; ++k) {
    if (outer_share(k, n) > 0) continue;
    const Eigen::Vector2d d = direction(k, n);
    const double slope = side * hinge.bisector.dot(d.x() * posed.u + d.y() * posed.v);
    const double distance = side * hinge.bisector.dot(posed.centre - hinge.head);
    if (slope < -1e-9) limit[k] = std::max(distance, 0.0) / -slope;
  }
  return limit;
}

/// Whether a section at rest is a limb's: rays meet skin all round. Where a palm or a web begins
/// they do not, and what those of one half meet is no limb's outline.
bool goes_round(const std::vector<double>& rest) {
  const auto met = std::count_if(rest.begin(), rest.end(), [](double r) { return !std::isnan(r); });
  return static_cast<double>(met) >= kEnoughDirections * static_cast<double>(rest.size());
}

/// Everything the sections of one region read.
struct Surface {
  const JointRegion& region;
  const Eigen::MatrixX3i& F;
  const Eigen::MatrixX3d& rest;
  const Eigen::MatrixX3d& posed;
  const CrossSectionOptions& options;
};

/// Section orthogonal to a bone: side +1 the joint's own bone, -1 the parent's.
SectionRatio bone_section(const Surface& surface, const PosedHinge& hinge, double side, double s) {
  const bool is_distal = side > 0;
  const int n = surface.options.directions;
  PlaneFrame rest;
  rest.n = is_distal ? hinge.rest.distal : hinge.rest.proximal;
  rest.u = is_distal ? hinge.outer_distal : hinge.outer_proximal;
  rest.v = rest.n.cross(rest.u);
  rest.centre = hinge.rest.head + s * rest.n;
  const auto seen = [&](int, const Segment& segment) {
    return !hinge.has_halves || hinge.chain[segment.slot].is_distal() == is_distal;
  };
  const Eigen::Vector2d centroid = profile_centroid(
      radial_profile(cut(surface.region, surface.F, surface.rest, hinge, side * s, rest), n, seen));
  rest.centre += centroid.x() * rest.u + centroid.y() * rest.v;
  const PlaneFrame posed =
      carried(rest, is_distal ? hinge.distal_transform : hinge.proximal_transform);
  const ProfilePair profiles{
      radial_profile(cut(surface.region, surface.F, surface.rest, hinge, side * s, rest), n, seen),
      radial_profile(cut(surface.region, surface.F, surface.posed, hinge, side * s, posed), n,
                     seen),
      bisector_limit(hinge, posed, side, n)};
  SectionRatio section;
  section.place = is_distal ? SectionRatio::Place::distal : SectionRatio::Place::proximal;
  section.s = s;
  if (!goes_round(profiles.rest)) return section;
  section.whole = half_area(profiles, 1, 1).ratio(surface.options.min_share);
  if (!hinge.has_halves) return section;
  section.outer = half_area(profiles, 1, 0).ratio(surface.options.min_share);
  section.inner = half_area(profiles, 0, 1).ratio(surface.options.min_share);
  const double point = profiles.posed.front() / profiles.rest.front();
  if (section.outer && std::isfinite(point)) section.outer_point = point;
  return section;
}

/// Outer half planes through the bend axis, between the two bones' planes at the joint.
void add_wedge_sections(const Surface& surface, const PosedHinge& hinge, int index,
                        std::vector<SectionRatio>& sections) {
  const Eigen::Vector3d rest_axis = hinge.bend_sign * hinge.rest.bend_axis;
  const Eigen::Vector3d posed_axis = hinge.proximal_transform.linear() * rest_axis;
  const auto angle = [](const Eigen::Vector3d& axis, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to) {
    return std::atan2(axis.dot(from.cross(to)), from.dot(to));
  };
  const Eigen::Vector3d from = hinge.proximal_transform.linear() * hinge.outer_proximal;
  const Eigen::Vector3d to = hinge.distal_transform.linear() * hinge.outer_distal;
  const double posed_angle = angle(posed_axis, from, to);
  const double rest_angle = angle(rest_axis, hinge.outer_proximal, hinge.outer_distal);
  if (posed_angle < kSmallestWedge) return;
  const auto half_plane = [](const Eigen::Vector3d& head, const Eigen::Vector3d& axis,
                             const Eigen::Vector3d& start, double turn) {
    const Eigen::Vector3d u = Eigen::AngleAxisd(turn, axis) * start;
    return PlaneFrame{head, u, axis, u.cross(axis)};
  };
  const int n = surface.options.directions;
  const auto seen = [&](int k, const Segment& segment) {
    return outer_share(k, n) > 0 && hinge.chain[segment.slot].is_outer;
  };
  for (int w = 0; w < surface.options.wedge_planes; ++w) {
    const double f = (w + 0.5) / surface.options.wedge_planes;
    const PlaneFrame rest =
        half_plane(hinge.rest.head, rest_axis, hinge.outer_proximal, f * rest_angle);
    const PlaneFrame posed = half_plane(hinge.head, posed_axis, from, f * posed_angle);
    const ProfilePair profiles{
        radial_profile(cut(surface.region, surface.F, surface.rest, hinge, 0, rest), n, seen),
        radial_profile(cut(surface.region, surface.F, surface.posed, hinge, 0, posed), n, seen),
        std::vector<double>(n, std::numeric_limits<double>::infinity())};
    SectionRatio section;
    section.hinge = index;
    section.place = SectionRatio::Place::wedge;
    section.s = f;
    section.outer = half_area(profiles, 1, 0).ratio(surface.options.min_share);
    const double point = profiles.posed.front() / profiles.rest.front();
    if (section.outer && std::isfinite(point)) section.outer_point = point;
    sections.push_back(section);
  }
}

void widen(std::optional<double>& extreme, const std::optional<double>& value, bool want_max) {
  if (!value) return;
  if (!extreme || (want_max ? *value > *extreme : *value < *extreme)) extreme = value;
}

}  // namespace

std::vector<SectionRatio> cross_sections(const JointRegion& region, const Eigen::MatrixX3i& F,
                                         const Eigen::MatrixX3d& rest,
                                         const Eigen::MatrixX3d& posed, const Pose& pose,
                                         const CrossSectionOptions& options) {
  if (rest.rows() != posed.rows()) {
    throw Error(std::to_string(posed.rows()) + " posed vertices", "cross sections",
                std::to_string(rest.rows()) + ", as at rest");
  }
  if (options.directions < 8 || options.directions % 4 != 0 || options.planes < 2) {
    throw Error("directions " + std::to_string(options.directions) + ", planes " +
                    std::to_string(options.planes),
                "cross sections", "a multiple of 4 from 8 on, and at least 2");
  }
  const Surface surface{region, F, rest, posed, options};
  std::vector<SectionRatio> sections;
  for (int h = 0; h < std::ssize(region.hinges); ++h) {
    const PosedHinge hinge = pose_hinge(region, region.hinges[h], F, rest, pose);
    for (const double side : {-1.0, 1.0}) {
      const double reach = side > 0 ? hinge.rest.distal_reach : hinge.rest.proximal_reach;
      for (int i = 0; i < options.planes; ++i) {
        sections.push_back(bone_section(surface, hinge, side, reach * i / (options.planes - 1)));
        sections.back().hinge = h;
      }
    }
    if (hinge.has_halves) add_wedge_sections(surface, hinge, h, sections);
  }
  return sections;
}

SectionSummary summarize(const std::vector<SectionRatio>& sections) {
  SectionSummary summary;
  std::optional<double> largest_outer;
  for (const SectionRatio& section : sections) {
    const bool has_halves = section.outer.has_value() || section.inner.has_value();
    for (const std::optional<double>& ratio :
         {section.outer, section.inner, has_halves ? std::nullopt : section.whole}) {
      widen(summary.shrink, ratio, false);
      widen(summary.bulge, ratio, true);
    }
    widen(largest_outer, section.outer, true);
    widen(summary.elbow_collapse, section.outer_point, false);
  }
  if (largest_outer) summary.outer_bulge = *largest_outer - 1;
  return summary;
}

}  // namespace geoprior
