#include "experiments/grammar/scene/arm.h"

#include <array>

namespace geoprior::grammar {
namespace {

/// A box along x from 0 to `length`, its other sides a fifth of that.
TriMesh arm_box(double length) {
  const double w = length / 10;
  TriMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    mesh.V.row(i) << ((i & 1) != 0 ? length : 0), ((i & 2) != 0 ? w : -w), ((i & 4) != 0 ? w : -w);
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6,
      2, 1, 3, 7, 1, 7, 5;
  return mesh;
}

}  // namespace

void describe(OptionVisitor& v, ArmOptions& options) {
  v.value("joints", options.joints, {.doc = "joints of the chain", .min = 1, .max = 1000});
  v.value("length", options.length,
          {.doc = "length of a part", .unit = "m", .min = 1e-3, .max = 1e3});
}

Hierarchy make_arm(const ArmOptions& options) {
  Hierarchy arm;
  const int root = arm.add_type({.name = "arm"});
  const int joint = arm.add_type(
      {.name = "joint", .keys = [](std::span<const double>, std::vector<Eigen::Vector3d>& out) {
         out.emplace_back(0, 0, 0);
       }});
  const int part = arm.add_type(
      {.name = "part",
       .parameters = {{"length", "m", 1e-3, 1e3}},
       .keys =
           [](std::span<const double> p, std::vector<Eigen::Vector3d>& out) {
             const double l = p[0];
             out.insert(out.end(), {{0, 0, 0}, {l, 0, 0}, {l, l / 10, 0}, {l, 0, l / 10}});
           },
       .mesh = [](std::span<const double> p) { return arm_box(p[0]); }});
  int above = arm.add(root, -1, {});
  for (int i = 0; i < options.joints; ++i) {
    const Pose pose{{i * options.length, 0, 0}};
    above = arm.add(joint, above, pose);
    arm.add(part, above, pose, std::array{options.length});
  }
  return arm;
}

}  // namespace geoprior::grammar
