#include "core/geometry/procedural.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/limits.h"

namespace geoprior {
namespace {

/// Rings of a surface of revolution about x, without its two poles: (x, radius), x not decreasing.
struct Profile {
  std::vector<Eigen::Vector2d> rings;
  double first_pole = 0;
  double last_pole = 0;
};

void require_positive(double x, const char* what) {
  if (!(x > 0) || !std::isfinite(x)) throw Error(std::string(what) + " is not positive", "", "> 0");
}

/// Triangles of `rings` rings of `segments` vertices between two poles (the first and the last
/// vertex), outward. Odd rings are turned by half a segment: every inner vertex has six neighbours
/// and no direction of twist is preferred.
Eigen::MatrixX3i revolution_triangles(int rings, int segments) {
  Eigen::MatrixX3i F(2 * segments * rings, 3);
  const int last_pole = 1 + rings * segments;
  Eigen::Index row = 0;
  const auto id = [&](int ring, int k) { return 1 + ring * segments + k % segments; };
  for (int k = 0; k < segments; ++k) F.row(row++) << 0, id(0, k + 1), id(0, k);
  for (int i = 0; i + 1 < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const int a = id(i, k), b = id(i, k + 1), c = id(i + 1, k + 1), d = id(i + 1, k);
      if (i % 2 == 0) {
        F.row(row++) << a, b, d;
        F.row(row++) << b, c, d;
      } else {
        F.row(row++) << a, b, c;
        F.row(row++) << a, c, d;
      }
    }
  }
  for (int k = 0; k < segments; ++k)
    F.row(row++) << last_pole, id(rings - 1, k), id(rings - 1, k + 1);
  return F;
}

TriMesh surface_of_revolution(const Profile& profile, int segments) {
  const auto rings = static_cast<int>(profile.rings.size());
  TriMesh mesh;
  mesh.V.resize(2 + rings * segments, 3);
  mesh.V.row(0) << profile.first_pole, 0, 0;
  Eigen::Index row = 1;
  for (int i = 0; i < rings; ++i) {
    const Eigen::Vector2d& ring = profile.rings[i];
    for (int k = 0; k < segments; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5 * (i % 2)) / segments;
      mesh.V.row(row++) << ring.x(), ring.y() * std::cos(angle), ring.y() * std::sin(angle);
    }
  }
  mesh.V.row(row) << profile.last_pole, 0, 0;
  mesh.F = revolution_triangles(rings, segments);
  return mesh;
}

/// Steps of about `spacing` along `length`, at least two. A double: it is estimated before it is
/// made.
double steps(double length, double spacing) { return std::max(2.0, std::round(length / spacing)); }

double cap_steps(double radius, double height, double spacing) {
  return steps(std::max(radius, 0.5 * std::numbers::pi * std::sqrt(radius * height)), spacing);
}

/// Rings of a half ellipsoid from just after its pole up to, not including, its equator, as
/// (height above the equator, radius); concentric circles when `height` is 0.
std::vector<Eigen::Vector2d> cap_rings(double radius, double height, double spacing) {
  const int n = static_cast<int>(cap_steps(radius, height, spacing));
  std::vector<Eigen::Vector2d> rings;
  for (int i = 1; i < n; ++i) {
    const double t = static_cast<double>(i) / n;
    const double angle = 0.5 * std::numbers::pi * t;
    rings.emplace_back(height * std::cos(angle), radius * (height > 0 ? std::sin(angle) : t));
  }
  return rings;
}

void append_last_cap(Profile& profile, double x, double radius, double height, double spacing) {
  std::vector<Eigen::Vector2d> cap = cap_rings(radius, height, spacing);
  std::reverse(cap.begin(), cap.end());
  for (const Eigen::Vector2d& ring : cap) profile.rings.emplace_back(x + ring.x(), ring.y());
  profile.last_pole = x + height;
}

void append_first_cap(Profile& profile, double x, double radius, double height, double spacing) {
  profile.first_pole = x - height;
  for (const Eigen::Vector2d& ring : cap_rings(radius, height, spacing))
    profile.rings.emplace_back(x - ring.x(), ring.y());
}

Joint joint_on_x_axis(const std::string& name, int parent, double head, double tail) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.head = {head, 0, 0};
  joint.tail = Eigen::Vector3d(tail, 0, 0);
  joint.axes = {{"flexion", Eigen::Vector3d::UnitY()},
                {"twist", Eigen::Vector3d::UnitX()},
                {"abduction", Eigen::Vector3d::UnitZ()}};
  return joint;
}

/// Weights along a chain of joints: `step(i, x)` rises from 0 to 1 where the skin passes from joint
/// i - 1 to joint i; w_j = (product of the steps up to j) (1 - next step), a partition of unity.
template <class Step>
SkinWeights chain_weights(const Eigen::MatrixX3d& V, int joints, const Step& step) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < V.rows(); ++v) {
    double reached = 1;
    for (int j = 0; j < joints; ++j) {
      const double next = j + 1 < joints ? step(j + 1, V(v, 0)) : 0;
      if (const double w = reached * (1 - next); w > 0) entries.emplace_back(v, j, w);
      reached *= next;
    }
  }
  SkinWeights weights(V.rows(), joints);
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

void check(const CylinderOptions& o) {
  require_positive(o.radius, "cylinder radius");
  require_positive(o.half_length, "cylinder half length");
  require_positive(o.ramp_width, "cylinder ramp width");
  if (!(o.cap_height >= 0)) throw Error("cylinder cap height is negative", "", ">= 0");
  if (o.segments < 3) throw Error("a cylinder of fewer than 3 segments", "", ">= 3");
  if (o.rings_per_half < 1) throw Error("a cylinder without rings", "", ">= 1");
}

double ring_edge(double radius, int segments) { return 2 * std::numbers::pi * radius / segments; }

void require_size(const CylinderOptions& o) {
  const double rings = 2.0 * o.rings_per_half + 1 +
                       2 * cap_steps(o.radius, o.cap_height, ring_edge(o.radius, o.segments));
  require_vertices(rings * o.segments, "scene.cylinder.segments");
}

void require_size(const FingerOptions& o) {
  const double spacing = o.ring_spacing * ring_edge(o.radius[0], o.segments);
  double rings = steps(o.hand_length, spacing) + cap_steps(o.radius[0], o.radius[0], spacing) +
                 cap_steps(o.radius[3], o.radius[3], spacing);
  for (const double length : o.phalanx_length) rings += steps(length, spacing);
  require_vertices(rings * o.segments, "scene.finger.segments");
}

Profile cylinder_profile(const CylinderOptions& o) {
  const double spacing = ring_edge(o.radius, o.segments);
  Profile profile;
  append_first_cap(profile, -o.half_length, o.radius, o.cap_height, spacing);
  for (int i = -o.rings_per_half; i <= o.rings_per_half; ++i)
    profile.rings.emplace_back(o.half_length * i / o.rings_per_half, o.radius);
  append_last_cap(profile, o.half_length, o.radius, o.cap_height, spacing);
  return profile;
}

/// Straight tapered pieces between the joints, half spheres at both ends.
Profile finger_profile(const FingerOptions& o) {
  const double spacing = o.ring_spacing * ring_edge(o.radius[0], o.segments);
  Profile profile;
  append_first_cap(profile, -o.hand_length, o.radius[0], o.radius[0], spacing);
  const auto piece = [&](double begin, double length, double r0, double r1) {
    const int n = static_cast<int>(steps(length, spacing));
    for (int i = 0; i < n; ++i) {
      const double t = static_cast<double>(i) / n;
      profile.rings.emplace_back(begin + t * length, r0 + t * (r1 - r0));
    }
  };
  piece(-o.hand_length, o.hand_length, o.radius[0], o.radius[0]);
  double x = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    piece(x, o.phalanx_length[i], o.radius[i], o.radius[i + 1]);
    x += o.phalanx_length[i];
  }
  profile.rings.emplace_back(x, o.radius[3]);
  append_last_cap(profile, x, o.radius[3], o.radius[3], spacing);
  return profile;
}

}  // namespace

RiggedMesh two_bone_cylinder(const CylinderOptions& options) {
  check(options);
  require_size(options);
  RiggedMesh rig;
  rig.mesh = surface_of_revolution(cylinder_profile(options), options.segments);
  rig.skeleton.joints = {joint_on_x_axis("lower", -1, -options.half_length, 0),
                         joint_on_x_axis("upper", 0, 0, options.half_length)};
  rig.weights = chain_weights(rig.mesh.V, 2, [&](int, double x) {
    return std::clamp(0.5 + x / options.ramp_width, 0.0, 1.0);
  });
  return rig;
}

std::vector<int> mid_ring(const CylinderOptions& options) {
  check(options);
  require_size(options);
  const auto rings = static_cast<int>(cylinder_profile(options).rings.size());
  std::vector<int> ring;
  for (int k = 0; k < options.segments; ++k) ring.push_back(1 + rings / 2 * options.segments + k);
  return ring;
}

RiggedMesh capsule_finger(const FingerOptions& options) {
  require_positive(options.hand_length, "hand length");
  require_positive(options.ramp_width, "finger ramp width");
  require_positive(options.ring_spacing, "finger ring spacing");
  for (const double length : options.phalanx_length) require_positive(length, "phalanx length");
  for (const double radius : options.radius) require_positive(radius, "finger radius");
  if (options.segments < 3) throw Error("a finger of fewer than 3 segments", "", ">= 3");
  require_size(options);

  RiggedMesh rig;
  rig.mesh = surface_of_revolution(finger_profile(options), options.segments);
  const auto& length = options.phalanx_length;
  const std::array<double, 4> head{0, length[0], length[0] + length[1],
                                   length[0] + length[1] + length[2]};
  rig.skeleton.joints = {joint_on_x_axis("hand", -1, -options.hand_length, 0),
                         joint_on_x_axis("proximal", 0, head[0], head[1]),
                         joint_on_x_axis("middle", 1, head[1], head[2]),
                         joint_on_x_axis("distal", 2, head[2], head[3])};
  rig.weights = chain_weights(rig.mesh.V, 4, [&](int joint, double x) {
    const int i = joint - 1;
    const double width = options.ramp_width * options.radius[i];
    const double t = std::clamp(0.5 + (x - head[i]) / width, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  });
  return rig;
}

void describe(OptionVisitor& v, CylinderOptions& options) {
  v.value("radius", options.radius, {.doc = "r, radius of the tube", .unit = "m", .min = 1e-6});
  v.value("half_length", options.half_length,
          {.doc = "length from the joint to either end of the straight part",
           .unit = "m",
           .min = 1e-6});
  v.value("cap_height", options.cap_height,
          {.doc = "half axis of the end caps along the bone; 0: flat", .unit = "m", .min = 0});
  v.value("segments", options.segments, {.doc = "vertices of a ring", .min = 3, .max = 100000});
  v.value("rings_per_half", options.rings_per_half,
          {.doc = "rings on one side of the joint", .min = 1, .max = 100000});
  v.value(
      "ramp_width", options.ramp_width,
      {.doc = "length over which the weights pass from bone to bone", .unit = "m", .min = 1e-9});
}

void describe(OptionVisitor& v, FingerOptions& options) {
  v.value(
      "hand_length", options.hand_length,
      {.doc = "length of the stump of the hand before the first joint", .unit = "m", .min = 1e-6});
  v.value("phalanx_length", options.phalanx_length,
          {.doc = "lengths of the proximal, the middle and the distal phalanx",
           .unit = "m",
           .min = 1e-6});
  std::vector<double> radius(options.radius.begin(), options.radius.end());
  v.value("radius", radius,
          {.doc = "radii at the base of each phalanx and at the tip: four numbers",
           .unit = "m",
           .min = 1e-6});
  if (radius.size() != options.radius.size())
    throw Error(std::to_string(radius.size()) + " numbers", "scene.finger.radius", "4");
  std::copy(radius.begin(), radius.end(), options.radius.begin());
  v.value("segments", options.segments, {.doc = "vertices of a ring", .min = 3, .max = 100000});
  v.value("ramp_width", options.ramp_width,
          {.doc = "length over which the weights pass from bone to bone, in local radii",
           .min = 1e-6,
           .max = 10});
  v.value("ring_spacing", options.ring_spacing,
          {.doc = "distance of rings in edge lengths of a ring", .min = 0.01, .max = 100});
}

}  // namespace geoprior
