#include "models/details/process.h"

#include <algorithm>
#include <utility>

#include "core/frame_loop.h"

namespace geoprior::details {
namespace {

/// Numbers of details, then of ghosts: the points of "detail_mesh".
std::vector<int> points_in_order(const DetailMesh& d) {
  std::vector<int> order;
  for (const SiteKind kind : {SiteKind::detail, SiteKind::ghost})
    for (int i = 0; i < d.site_slots(); ++i)
      if (d.kind[i] == kind) order.push_back(i);
  return order;
}

Part surface_part(const DetailMesh& d) {
  Part part;
  part.points.resize(d.x.size(), 3);
  for (std::size_t v = 0; v < d.x.size(); ++v) part.points.row(v) = d.x[v].transpose();
  part.triangles.resize(d.surface->face_count(), 3);
  for (int t = 0; t < d.surface->face_count(); ++t)
    part.triangles.row(t) = Eigen::Map<const Eigen::RowVector3i>(d.surface->face[t].data());
  return part;
}

Eigen::MatrixX3d points_of(const DetailMesh& d, std::span<const int> sites) {
  Eigen::MatrixX3d points(sites.size(), 3);
  for (std::size_t i = 0; i < sites.size(); ++i) points.row(i) = d.position[sites[i]].transpose();
  return points;
}

template <class Value>
NamedArray point_array(const char* name, std::span<const int> sites, Eigen::Index components,
                       const Value& value) {
  NamedArray array{name, "1", NamedArray::On::points, Eigen::MatrixXd(sites.size(), components)};
  for (std::size_t i = 0; i < sites.size(); ++i) array.values.row(i) = value(sites[i]);
  return array;
}

Part details_part(const DetailMesh& d, std::span<const int> sites) {
  Part part;
  part.kind = Part::Kind::points;
  part.points = points_of(d, sites);
  const auto number = [&](const char* name, const auto& value) {
    part.arrays.push_back(point_array(name, sites, 1, [&](int i) {
      return Eigen::Matrix<double, 1, 1>::Constant(static_cast<double>(value(d.site[i])));
    }));
  };
  const auto vector = [&](const char* name, const auto& value) {
    part.arrays.push_back(point_array(
        name, sites, 3, [&](int i) -> Eigen::RowVector3d { return value(d.site[i]).transpose(); }));
  };
  number("weight", [](const Detail& x) { return x.weight; });
  number("target_weight", [](const Detail& x) { return x.target_weight; });
  number("type", [](const Detail& x) { return x.type; });
  number("birth", [](const Detail& x) { return x.birth; });
  number("birth_frame", [](const Detail& x) { return x.birth_frame; });
  number("generation", [](const Detail& x) { return x.generation; });
  number("face", [](const Detail& x) { return x.at.face; });
  vector("barycentric", [](const Detail& x) { return x.at.barycentric; });
  vector("normal", [&](const Detail& x) { return normal_of_face(x.at.face, *d.surface, d.x); });
  vector("tangent", [&](const Detail& x) {
    return tangent_direction(x.at.face, x.tangent_angle, *d.surface, d.x);
  });
  return part;
}

Part mesh_part(const DetailMesh& d, std::span<const int> sites,
               std::span<const std::array<int, 3>> triangles) {
  std::vector<int> row(d.site_slots(), -1);
  for (int i = 0; i < std::ssize(sites); ++i) row[sites[i]] = i;
  Part part;
  part.points = points_of(d, sites);
  part.triangles.resize(triangles.size(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) part.triangles(t, k) = row[triangles[t][k]];
  part.arrays.push_back(point_array("ghost", sites, 1, [&](int i) {
    return Eigen::Matrix<double, 1, 1>::Constant(d.is_detail(i) ? 0.0 : 1.0);
  }));
  return part;
}

class DetailFrames final : public FrameModel {
 public:
  DetailFrames(const DetailScene& scene, std::unique_ptr<DetailMethod> method)
      : scene_(scene), method_(std::move(method)) {}

  [[nodiscard]] int frame_count() const override { return scene_.motion->frame_count(); }

  void start(RunContext& /*context*/) override { before_ = scene_.motion->positions(0); }

  void load(StateReader& in, int next_frame) override {
    method_->load(in);
    before_ = scene_.motion->positions(next_frame - 1);
  }

  void advance(int frame, FrameSink& /*sink*/, RunContext& context) override {
    Eigen::MatrixX3d V = scene_.motion->positions(frame);
    require_valid_step(scene_.surface.F, before_, V, frame, scene_.name);
    const Phase phase(context, "step");
    method_->step(V, context);
    before_ = std::move(V);
  }

  void record(int number, FrameSink& sink, RunContext& context) override {
    const Phase phase(context, "record");
    Frame frame = detail_frame(method_->details(), scene_.motion->parameter(number));
    method_->diagnose(frame.diagnostics);
    sink.frame(std::move(frame));
  }

  void save(StateWriter& out) const override { method_->save(out); }

 private:
  const DetailScene& scene_;
  std::unique_ptr<DetailMethod> method_;
  Eigen::MatrixX3d before_;  ///< vertices in the frame that `method_` has reached
};

}  // namespace

Frame detail_frame(const DetailMesh& d, double parameter) {
  const std::vector<int> all = points_in_order(d);
  const std::span<const int> details(all.data(), d.detail_count());
  Frame frame;
  frame.parameter = parameter;
  frame.parts["surface"] = surface_part(d);
  frame.parts["details"] = details_part(d, details);
  Part mesh = mesh_part(d, all, d.mesh.triangles());
  NamedArray density{"density", "1/m^2", NamedArray::On::cells,
                     Eigen::MatrixXd(mesh.triangles.rows(), 1)};
  Eigen::Index row = 0;
  for (int t = 0; t < d.mesh.triangle_slots(); ++t)
    if (d.mesh.triangle_alive(t)) density.values(row++, 0) = d.mesh.density(t);
  mesh.arrays.push_back(std::move(density));
  frame.parts["detail_mesh"] = std::move(mesh);
  frame.parts["visible_mesh"] = mesh_part(d, all, visible_triangles(d, 0.5));
  auto& diagnostics = frame.diagnostics;
  diagnostics["details"] = d.detail_count();
  diagnostics["visible_details"] = static_cast<double>(
      std::count_if(details.begin(), details.end(), [&](int i) { return d.site[i].weight > 0.5; }));
  diagnostics["ghosts"] = d.ghost_count();
  diagnostics["mean_edge"] = mean_edge(d);
  return frame;
}

std::unique_ptr<Process> make_detail_process(const DetailScene& scene,
                                             DetailMethodFactory factory) {
  require_valid(scene);
  return frame_process([scene, factory = std::move(factory)](RunContext& context) {
    const Phase phase(context, "prepare");
    return std::make_unique<DetailFrames>(scene, factory(scene, context));
  });
}

}  // namespace geoprior::details
