#include "solvers/embryo/ontology/geometry.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

namespace geoprior::embryo {

namespace {

Primitive primitive_of(std::string_view class_name) {
  if (class_name == "Line") return Primitive::line;
  if (class_name == "Plane") return Primitive::plane;
  if (class_name == "Ovoid") return Primitive::ovoid;
  if (class_name == "Cylinder") return Primitive::cylinder;
  if (class_name == "Duct") return Primitive::duct;
  return Primitive::point;
}

/// Local x of what does not say it: the body's x axis, or y where the local z is along that.
Eigen::Vector3d usual_up(const Eigen::Vector3d& axis) {
  constexpr double kAlong = 0.9;
  return std::abs(axis.x()) < kAlong ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
}

Anchor anchor_of(const TypedGraph& graph, Term duct, const std::string& end,
                 const std::map<Term, int>& structures) {
  Anchor anchor;
  const std::optional<Term> on = graph.reference(duct, end + "sOn");
  if (on) anchor.structure = structures.at(*on);
  anchor.at = graph.vector(duct, end + (on ? "At" : "Point")).value_or(Eigen::Vector3d::Zero());
  return anchor;
}

void read_duct(const TypedGraph& graph, Term node, const std::map<Term, int>& structures,
               Geometry& out) {
  out.start = anchor_of(graph, node, "start", structures);
  out.end = anchor_of(graph, node, "end", structures);
  const std::vector<double> via = graph.numbers(node, "via").value_or(std::vector<double>());
  for (std::size_t i = 0; i + 2 < via.size(); i += 3)
    out.via.emplace_back(via[i], via[i + 1], via[i + 2]);
  out.radius = graph.number(node, "radius").value_or(0);
  out.end_radius = graph.number(node, "endRadius").value_or(out.radius);
  out.branchings = graph.number(node, "branchings").value_or(0);
}

Eigen::Vector3d radii_of(const TypedGraph& graph, Term node, const Geometry& geometry) {
  const auto number = [&](std::string_view name) { return graph.number(node, name).value_or(0); };
  switch (geometry.primitive) {
    case Primitive::line:
      return {0, 0, number("length") / 2};
    case Primitive::plane:
      return {number("extent"), number("extent"), 0};
    case Primitive::cylinder:
      return {number("radius"), number("radius"), number("length") / 2};
    case Primitive::ovoid:
      return graph.vector(node, "radii").value_or(Eigen::Vector3d::Zero());
    case Primitive::point:
    case Primitive::duct:
      break;
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

Geometry geometry_of(const TypedGraph& graph, Term node, const std::map<Term, int>& structures) {
  Geometry out;
  out.primitive = primitive_of(vocabulary_classes()[graph.class_of(node)].name);
  if (const std::optional<Term> frame = graph.reference(node, "frame"))
    out.frame = structures.at(*frame);
  if (out.primitive == Primitive::duct) {
    read_duct(graph, node, structures, out);
    return out;
  }
  const auto direction = [&](std::string_view name, const Eigen::Vector3d& usual) {
    return graph.vector(node, name).value_or(usual).normalized().eval();
  };
  out.position = graph.vector(node, "position").value_or(Eigen::Vector3d::Zero());
  const bool is_plane = out.primitive == Primitive::plane;
  out.axis = direction(is_plane ? "normal" : "axis", Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d up = direction("up", usual_up(out.axis));
  out.up = (up - up.dot(out.axis) * out.axis).normalized();
  out.radii = radii_of(graph, node, out);
  out.egg = graph.number(node, "egg").value_or(0);
  if (out.primitive == Primitive::cylinder) out.radius = out.end_radius = out.radii.x();
  return out;
}

}  // namespace geoprior::embryo
