#include "experiments/details/scene/deformation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "testbed/keyframes.h"

namespace geoprior::details {
namespace {

using Kind = DeformationKind;

bool has_axis(Kind kind) { return kind != Kind::scale && kind != Kind::inflate; }
bool is_angle(Kind kind) { return kind == Kind::twist || kind == Kind::bend; }

/// An operation at one time.
struct Stage {
  const DeformationOptions& options;
  double value;
  Eigen::Vector3d centre, axis, side;  ///< unit axis and side, at right angles
  double from, to;
};

double smooth(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// Integral of `smooth` from 0.
double smooth_integral(double s) {
  if (s <= 0) return 0;
  if (s >= 1) return 0.5 + (s - 1);
  return s * s * s * (1 - s / 2);
}

/// Where a stretch of from … to takes the coordinate u: its factor is `value` between two ramps.
///
/// u' = u + (value - 1) times the integral of a trapezoid with smooth flanks, scaled so that the
/// whole becomes `value` times as long.
double stretched(double u, const Stage& s) {
  const double length = s.to - s.from;
  const double flank = std::max(s.options.ramp / 2 * length, 1e-12 * length);
  const auto integral = [&](double x) {
    return flank *
           (smooth_integral((x - s.from) / flank) - smooth_integral((x - s.to + flank) / flank));
  };
  return u + (s.value - 1) * length / (length - flank) * integral(u);
}

Eigen::Vector3d bent(const Eigen::Vector3d& d, const Stage& s) {
  const double angle = s.value * std::numbers::pi / 180;
  const double u = d.dot(s.axis), w = d.dot(s.side);
  const double inside = std::clamp(u, s.from, s.to) - s.from;
  const double length = s.to - s.from;
  const double turned = angle * inside / length;
  // Chord of the arc of the axis: L / angle (sin, 1 - cos), without the division by a small angle.
  const auto sinc = [](double x) { return std::abs(x) < 1e-6 ? 1 - x * x / 6 : std::sin(x) / x; };
  const double half = turned / 2;
  const double chord = inside * sinc(half);
  const double beyond = u - s.from - inside;
  const double along =
      s.from + chord * std::cos(half) + beyond * std::cos(turned) - w * std::sin(turned);
  const double up = chord * std::sin(half) + beyond * std::sin(turned) + w * std::cos(turned);
  return along * s.axis + up * s.side + (d - u * s.axis - w * s.side);
}

Eigen::Vector3d moved(const Eigen::Vector3d& x, const Stage& s) {
  const Eigen::Vector3d d = x - s.centre;
  const double u = d.dot(s.axis);
  switch (s.options.kind) {
    case Kind::stretch: {
      const bool whole = !s.options.from && !s.options.to;
      const double along = whole ? s.value * u : stretched(u, s);
      // Across, only what is stretched; the whole flank of a ramp counts by its local factor.
      const double flank = std::max(s.options.ramp / 2 * (s.to - s.from), 1e-12);
      const double share = whole ? 1 : smooth((u - s.from) / flank) * smooth((s.to - u) / flank);
      const double across = std::pow(s.value, -s.options.cross * share);
      return s.centre + along * s.axis + across * (d - u * s.axis);
    }
    case Kind::scale:
      return s.centre + s.value * d;
    case Kind::squeeze: {
      const double middle = (s.from + s.to) / 2, half = (s.to - s.from) / 2;
      const bool whole = !s.options.from && !s.options.to;
      const double share = whole ? 1 : smooth(1 - std::abs(u - middle) / half);
      return s.centre + u * s.axis + (1 + (s.value - 1) * share) * (d - u * s.axis);
    }
    case Kind::twist: {
      const double share = (std::clamp(u, s.from, s.to) - s.from) / (s.to - s.from);
      const double angle = s.value * share * std::numbers::pi / 180;
      return s.centre + Eigen::AngleAxisd(angle, s.axis) * d;
    }
    case Kind::bend:
      return s.centre + bent(d, s);
    case Kind::inflate:
      break;
  }
  return x;
}

/// Normals averaged over the neighbours of each vertex, `times` times: the field then varies less
/// than the surface, and an offset along it folds later.
Eigen::MatrixX3d smoothed_normals(const TriMesh& mesh, int times) {
  Eigen::MatrixX3d normals = vertex_normals(mesh);
  const VertexGraph rings = one_rings(mesh.F, mesh.vertex_count());
  for (int i = 0; i < times; ++i) {
    Eigen::MatrixX3d mean = normals;
    for (int v = 0; v < mesh.vertex_count(); ++v)
      for (const int w : rings.of(v)) mean.row(v) += normals.row(w);
    normals = mean.rowwise().normalized();
  }
  return normals;
}

/// Steps along the normals until the area of the triangles that take part is `factor` times as
/// large: outwards in steps of a hundredth of the size, then by bisection.
Eigen::MatrixX3d inflated(const TriMesh& mesh, const Eigen::VectorXd& share, int smooth,
                          double factor, const std::string& where) {
  const Eigen::MatrixX3d along = smoothed_normals(mesh, smooth).array().colwise() * share.array();
  Eigen::VectorXd takes_part(mesh.F.rows());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const bool any = share[mesh.F(t, 0)] + share[mesh.F(t, 1)] + share[mesh.F(t, 2)] > 0;
    takes_part[t] = any ? 1 : 0;
  }
  const auto area = [&](double d) {
    return triangle_areas(mesh.V + d * along, mesh.F).dot(takes_part);
  };
  const double wanted = factor * area(0);
  const double step = (factor < 1 ? -0.01 : 0.01) * bounding_box_diagonal(mesh.V);
  const auto short_of = [&](double d) { return factor < 1 ? area(d) > wanted : area(d) < wanted; };
  constexpr int kMostSteps = 500;
  int steps = 0;
  while (steps < kMostSteps && short_of((steps + 1) * step)) ++steps;
  if (steps == kMostSteps) {
    throw Error("does not reach an area of " + std::to_string(factor) + " times what it was", where,
                "a curved surface, a smaller factor");
  }
  double low = steps * step, high = (steps + 1) * step;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (short_of(middle) ? low : high) = middle;
  }
  return mesh.V + low * along;
}

std::string place(std::size_t operation) {
  return "scene.motion.deform." + std::to_string(operation);
}

void require_keys(const std::vector<AmountKey>& keys, bool angle, const std::string& where) {
  if (keys.empty()) throw Error("has no keys", where + ".keys", "at least one");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string key = where + ".keys." + std::to_string(i);
    if (i > 0 && !(keys[i].t > keys[i - 1].t))
      throw Error("is not after the key before", key + ".t", "times that increase");
    if (!angle && !(keys[i].value > 0)) throw Error("is no factor", key + ".value", "above 0");
  }
}

Stage stage_at(const DeformationOptions& options, const TriMesh& rest, double t,
               const std::string& where) {
  Stage s{options,
          amount_at(options.keys, t),
          to_vector(options.centre),
          to_vector(options.axis).normalized(),
          Eigen::Vector3d::Zero(),
          0,
          0};
  if (!has_axis(options.kind)) return s;
  const Eigen::VectorXd along = (rest.V.rowwise() - s.centre.transpose()) * s.axis;
  s.from = options.from.value_or(along.minCoeff());
  s.to = options.to.value_or(along.maxCoeff());
  if (!(s.from < s.to)) throw Error("is not below `to`", where + ".from", "less than `to`");
  const Eigen::Vector3d side = to_vector(options.side);
  s.side = (side - side.dot(s.axis) * s.axis).normalized();
  return s;
}

void require_valid(const DeformationOptions& options, const std::string& where) {
  require_keys(options.keys, is_angle(options.kind), where);
  if (!has_axis(options.kind)) return;
  const Eigen::Vector3d axis = to_vector(options.axis);
  if (!(axis.norm() > 0))
    throw Error("has no direction", where + ".axis", "a vector of any length");
  if (options.kind == Kind::bend && !(to_vector(options.side).cross(axis).norm() > 0))
    throw Error("runs along the axis", where + ".side", "a direction across the axis");
}

Eigen::VectorXd falloff_of(const DeformationOptions& options, const Eigen::MatrixX3d& V) {
  if (!options.radius) return Eigen::VectorXd::Ones(V.rows());
  const Eigen::RowVector3d centre = to_vector(options.centre).transpose();
  const Eigen::ArrayXd d2 = (V.rowwise() - centre).rowwise().squaredNorm();
  return (1 - d2 / (*options.radius * *options.radius)).max(0).square();
}

}  // namespace

void describe(OptionVisitor& v, AmountKey& key) {
  v.value("t", key.t, {.doc = "time of an amount", .unit = "s", .required = true});
  v.value("value", key.value,
          {.doc = "amount: a factor, of twist and bend an angle in degrees", .required = true});
}

void describe(OptionVisitor& v, DeformationOptions& options) {
  static constexpr std::array<std::string_view, 6> kKinds{"stretch", "scale", "inflate",
                                                          "squeeze", "twist", "bend"};
  describe_choice(
      v, "kind", options.kind, kKinds,
      {.doc = "stretch: factor along axis, cross, from, to, ramp; scale: factor about "
              "centre; inflate: factor of the area, along normals, smooth; squeeze: factor of "
              "the distance from axis, from, to; twist: degrees about axis, from, to; "
              "bend: degrees of axis towards side, from, to"});
  describe_list(v, "keys", options.keys,
                {.doc = "amounts of the operation at times that increase, linear between"});
  v.value("centre", options.centre,
          {.doc = "centre of the operation and of the ball that limits it", .unit = "m"});
  if (has_axis(options.kind)) {
    v.value("axis", options.axis,
            {.doc = "axis of the operation through its centre, of any length"});
    v.value("from", options.from,
            {.doc = "place along the axis where the operation begins; absent: at the lower end",
             .unit = "m"});
    v.value("to", options.to,
            {.doc = "place along the axis where the operation ends; absent: at the upper end",
             .unit = "m"});
  }
  if (options.kind == Kind::stretch) {
    v.value("cross", options.cross,
            {.doc = "exponent by which the surface is multiplied across the axis: factor^-cross",
             .min = -1,
             .max = 1});
    v.value("ramp", options.ramp,
            {.doc = "share of from … to in which a stretch sets in and out", .min = 0, .max = 1});
  }
  if (options.kind == Kind::inflate) {
    v.value("smooth", options.smooth,
            {.doc = "times that the normals of an inflation are averaged over neighbours",
             .min = 0,
             .max = 10000});
  }
  if (options.kind == Kind::bend)
    v.value("side", options.side, {.doc = "direction towards which a bend turns the axis"});
  v.value("radius", options.radius,
          {.doc = "radius of the ball about the centre that limits the operation; absent: none",
           .unit = "m",
           .min = 1e-9});
}

double amount_at(const std::vector<AmountKey>& keys, double t) {
  if (t <= keys.front().t) return keys.front().value;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (t > keys[i].t) continue;
    const AmountKey &a = keys[i - 1], &b = keys[i];
    return a.value + (b.value - a.value) * (t - a.t) / (b.t - a.t);
  }
  return keys.back().value;
}

ScriptedMotion::ScriptedMotion(TriMesh rest, std::shared_ptr<const SurfaceMotion> base,
                               std::vector<DeformationOptions> operations,
                               std::vector<double> parameters)
    : rest_(std::move(rest)),
      base_(std::move(base)),
      operations_(std::move(operations)),
      parameters_(std::move(parameters)) {
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    require_valid(operations_[i], place(i));
    stage_at(operations_[i], rest_, 0, place(i));
    falloff_.push_back(falloff_of(operations_[i], rest_.V));
  }
}

double ScriptedMotion::parameter(int frame) const { return parameters_.at(frame); }

Eigen::MatrixX3d ScriptedMotion::positions(int frame) const {
  const double t = parameter(frame);
  TriMesh now{base_->positions(base_->frame_count() == 1 ? 0 : frame), rest_.F};
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    const Stage stage = stage_at(operations_[i], rest_, t, place(i));
    const bool identity = stage.value == (is_angle(operations_[i].kind) ? 0.0 : 1.0);
    if (identity) continue;
    const Eigen::VectorXd& share = falloff_[i];
    if (operations_[i].kind == Kind::inflate) {
      now.V = inflated(now, share, operations_[i].smooth, stage.value,
                       place(i) + ", frame " + std::to_string(frame));
      continue;
    }
    for (Eigen::Index v = 0; v < now.V.rows(); ++v) {
      const Eigen::Vector3d x = now.V.row(v);
      now.V.row(v) += share[v] * (moved(x, stage) - x).transpose();
    }
  }
  return now.V;
}

}  // namespace geoprior::details
