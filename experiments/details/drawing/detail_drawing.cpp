#include "experiments/details/drawing/detail_drawing.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"
#include "core/limits.h"

namespace geoprior::details {
namespace {

void require_anchor(const DrawnAnchor& anchor, std::size_t i, const SurfaceTopology& surface) {
  const std::string where = "detail " + std::to_string(i);
  const auto& b = anchor.at.barycentric;
  if (anchor.at.face < 0 || anchor.at.face >= surface.face_count())
    throw Error("is off the surface: face " + std::to_string(anchor.at.face), where,
                "0 … " + std::to_string(surface.face_count() - 1));
  if (!b.allFinite() || b.minCoeff() < -1e-6 || std::abs(b.sum() - 1) > 1e-6)
    throw Error("is off the surface: barycentric coordinates outside its face", where,
                "three numbers in [0, 1] with sum 1");
  if (!(anchor.weight >= 0 && anchor.weight <= 1))
    throw Error("weight " + std::to_string(anchor.weight), where, "0 … 1");
  if (!anchor.tangent.allFinite()) throw Error("tangent is not finite", where, "a direction");
}

/// The anchors to draw. Anchors of other types keep their place in the list with weight 0, so that
/// the numbers of the details stay.
std::vector<DrawnAnchor> drawn_anchors(std::span<const DrawnAnchor> anchors,
                                       const SurfaceTopology& surface, std::optional<int> type) {
  std::vector<DrawnAnchor> drawn(anchors.begin(), anchors.end());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    require_anchor(drawn[i], i, surface);
    if (type && drawn[i].type != *type) drawn[i].weight = 0;
  }
  return drawn;
}

/// What lengths of the options are measured in (m).
double unit_of(const DrawingOptions& options, double mean_edge) {
  const double unit = options.unit == DrawnUnit::metre ? 1.0 : mean_edge;
  if (!(unit > 0))
    throw Error("mean edge " + std::to_string(mean_edge), "drawing", "a positive length");
  return unit;
}

std::string part_name(DrawnKind kind) {
  return kind == DrawnKind::spike ? "spikes" : kind == DrawnKind::mesh ? "instances" : "holes";
}

}  // namespace

void describe(OptionVisitor& v, DrawingOptions& o) {
  static constexpr std::array<std::string_view, 3> kKinds{"spike", "mesh", "hole"};
  static constexpr std::array<std::string_view, 2> kUnits{"mean_edge", "metre"};
  describe_choice(
      v, "kind", o.kind, kKinds,
      {"a detail is drawn as a procedural spike, a mesh on the surface, or a hole in it"});
  describe_choice(v, "unit", o.unit, kUnits,
                  {"radius and height are given in the mean edge of M_d at rest, or in metres"});
  v.value("radius", o.radius, {"radius of a detail of weight 1, in `unit`", "", 0, 1e6});
  v.value("type", o.type, {"the one type of details that is drawn; absent: all types"});
  switch (o.kind) {
    case DrawnKind::spike:
      describe_group(v, "spike", o.spike, {"procedural spike of a detail"});
      break;
    case DrawnKind::mesh:
      describe_group(v, "instance", o.instance, {"mesh of a detail, put onto the surface"});
      break;
    case DrawnKind::hole:
      break;
  }
}

double drawn_size(const DrawingOptions& options, double mean_edge) {
  const bool is_spike = options.kind == DrawnKind::spike;
  return unit_of(options, mean_edge) * (is_spike ? options.spike.height : options.radius);
}

void require_drawable(const DrawingOptions& options, std::size_t details, const TriMesh& instance) {
  const auto count = static_cast<double>(details);
  switch (options.kind) {
    case DrawnKind::spike:
      return require_vertices(count * kSpikeSectors * (kSpikeRings + 1.0),
                              "scene.drawing.look.spike");
    case DrawnKind::hole:
      return require_vertices(count * kHoleSegments, "scene.drawing.look.kind");
    case DrawnKind::mesh:
      break;
  }
  const bool given = options.instance.shape == InstanceShape::given;
  const TriMesh own = given ? TriMesh{} : instance_mesh(options.instance.shape);
  require_vertices(count * (given ? instance : own).vertex_count(),
                   "scene.drawing.look.instance.shape");
}

DrawnDetails draw_details(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                          std::span<const DrawnAnchor> anchors, const DrawingOptions& options,
                          double mean_edge, const TriMesh& instance) {
  const double unit = unit_of(options, mean_edge);
  const auto drawn = drawn_anchors(anchors, surface, options.type);
  const double radius = options.radius * unit;
  require_drawable(options, drawn.size(), instance);
  switch (options.kind) {
    case DrawnKind::spike:
      return draw_spikes(surface, x, drawn, options.spike, radius, options.spike.height * unit);
    case DrawnKind::hole:
      return cut_holes(surface, x, drawn, radius).drawn;
    case DrawnKind::mesh:
      break;
  }
  const bool given = options.instance.shape == InstanceShape::given;
  if (given && instance.F.rows() == 0)
    throw Error("the mesh of a detail has no triangles", "drawing", "a triangle mesh");
  return draw_instances(surface, x, drawn, given ? instance : instance_mesh(options.instance.shape),
                        radius, options.instance.sink);
}

DrawnDetails draw_details(const TriMesh& surface, std::span<const DrawnAnchor> anchors,
                          const DrawingOptions& options, double mean_edge,
                          const TriMesh& instance) {
  std::vector<Eigen::Vector3d> x(surface.V.rows());
  for (std::size_t v = 0; v < x.size(); ++v) x[v] = surface.V.row(v);
  return draw_details(SurfaceTopology(surface), x, anchors, options, mean_edge, instance);
}

std::vector<DrawnAnchor> anchors_of(const Part& details) {
  const auto array = [&](const char* name, int components) -> const Eigen::MatrixXd& {
    return details.require_array(name, NamedArray::On::points, components, "part 'details'").values;
  };
  const auto &weight = array("weight", 1), &type = array("type", 1), &face = array("face", 1);
  const auto &barycentric = array("barycentric", 3), &tangent = array("tangent", 3);
  std::vector<DrawnAnchor> anchors(details.points.rows());
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    anchors[i].at = {static_cast<int>(face(i, 0)), barycentric.row(i).transpose()};
    anchors[i].weight = weight(i, 0);
    anchors[i].tangent = tangent.row(i).transpose();
    anchors[i].type = static_cast<int>(type(i, 0));
  }
  return anchors;
}

std::string add_drawing(Frame& frame, const DrawingOptions& options, double mean_edge,
                        const TriMesh& instance) {
  const Part& surface = frame.require_part("surface");
  const auto anchors = anchors_of(frame.require_part("details"));
  DrawnDetails drawn =
      draw_details({surface.points, surface.triangles}, anchors, options, mean_edge, instance);
  Part part;
  part.points = std::move(drawn.mesh.V);
  part.triangles = std::move(drawn.mesh.F);
  const auto number = [&](const char* name, double none, const auto& value) {
    Eigen::MatrixXd values(part.points.rows(), 1);
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
      const int i = drawn.detail[v];
      values(v, 0) = i < 0 ? none : static_cast<double>(value(i));
    }
    part.arrays.push_back({name, "1", NamedArray::On::points, std::move(values)});
  };
  number("detail", -1, [](int i) { return i; });
  number("weight", 0, [&](int i) { return anchors[i].weight; });
  number("type", -1, [&](int i) { return anchors[i].type; });
  part.arrays.push_back({"normal", "1", NamedArray::On::points, std::move(drawn.normals)});
  const std::string name = part_name(options.kind);
  frame.parts[name] = std::move(part);
  return name;
}

}  // namespace geoprior::details
