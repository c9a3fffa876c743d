#include "solvers/sketch/one_view_process.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "core/connectivity.h"
#include "core/frame_loop.h"
#include "core/geometry/topology.h"
#include "models/sketch/drawing/drawing_part.h"
#include "models/sketch/sketch_process.h"

namespace geoprior::sketch {
namespace {

NamedArray one_view_array(const char* name, NamedArray::On on, Eigen::Index rows,
                          Eigen::Index columns = 1) {
  return {name, "1", on, Eigen::MatrixXd::Zero(rows, columns)};
}

Part textured_part(const View& view, const OneViewResult& result) {
  const TexturedSurface& surface = result.surface;
  using On = NamedArray::On;
  const Eigen::Index n = surface.mesh.V.rows(), m = surface.mesh.F.rows();
  Part part;
  part.points = surface.mesh.V;
  part.triangles = surface.mesh.F;
  NamedArray texture = one_view_array("texture", On::points, n, 2);
  texture.values = surface.texture;
  NamedArray border = one_view_array("border", On::points, n);
  for (const Edge& e : boundary_edges(surface.mesh.F))
    border.values(e[0]) = border.values(e[1]) = 1;
  NamedArray seam = one_view_array("seam", On::points, n);
  for (const SeamEdge& s : patch_seams(surface))
    seam.values(s.edge[0]) = seam.values(s.edge[1]) = 1;
  NamedArray patch = one_view_array("patch", On::cells, m);
  NamedArray panel = one_view_array("panel", On::cells, m);
  NamedArray image = one_view_array("mirror_image", On::cells, m);
  const std::vector<std::string> names = panels_of(view);
  for (Eigen::Index t = 0; t < m; ++t) {
    const int p = surface.patch[t];
    const auto name = std::find(names.begin(), names.end(), result.patches[p].name);
    patch.values(t) = p;
    panel.values(t) = name == names.end() ? -1 : static_cast<double>(name - names.begin());
    image.values(t) = surface.mirror_image[t] ? 1 : 0;
  }
  part.arrays = {
      std::move(texture), std::move(border), std::move(seam), one_view_array("fold", On::points, n),
      std::move(patch),   std::move(panel),  std::move(image)};
  return part;
}

/// Borders with points of their own: a node that curves share is one of each.
Part curves_part(const OneViewResult& result) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<std::pair<int, int>> places;  // curve and number of its node
  for (int c = 0; c < std::ssize(result.net.curves); ++c) {
    const SketchCurve& curve = result.net.curves[c];
    std::vector<int> line;
    for (int i = 0; i < curve.size(); ++i) {
      line.push_back(static_cast<int>(places.size()));
      places.emplace_back(c, i);
    }
    if (curve.closed) line.push_back(line.front());
    part.lines.push_back(std::move(line));
  }
  const Eigen::Index n = places.size();
  part.points.resize(n, 3);
  NamedArray stroke = one_view_array("stroke", NamedArray::On::points, n);
  NamedArray drawn_at = one_view_array("drawn_at", NamedArray::On::points, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [c, k] = places[i];
    const SketchCurve& curve = result.net.curves[c];
    part.points.row(i) = result.depth.nodes.row(curve.nodes[k]);
    stroke.values(i) = curve.stroke;
    drawn_at.values(i) = curve.drawn_at[k];
  }
  part.arrays = {std::move(stroke), std::move(drawn_at)};
  return part;
}

Part rulings_part(const OneViewResult& result) {
  Part part;
  part.kind = Part::Kind::lines;
  part.points = result.depth.nodes;
  for (const RuledPatch& patch : result.rulings) {
    const SketchCurve& first = result.net.curves[patch.first];
    const SketchCurve& second = result.net.curves[patch.second];
    for (const std::array<int, 2>& cell : patch.cells)
      part.lines.push_back({node_of(first, cell[0]), node_of(second, cell[1])});
  }
  return part;
}

class OneView final : public FrameModel {
 public:
  OneView(const OneViewInput& input, const OneViewOptions& options)
      : input_(input), options_(options) {}
  [[nodiscard]] int frame_count() const override { return 1; }
  void record(int /*number*/, FrameSink& sink, RunContext& context) override {
    OneViewResult result;
    {
      const Phase phase(context, "reconstruct");
      result = reconstruct_one_view(input_.view, options_);
    }
    Frame frame = one_view_frame(input_.view, result);
    if (input_.patterns && result.surface.mesh.F.rows() > 0) flatten(result, frame, sink, context);
    const Phase phase(context, "record");
    frame.parts["drawing"] = drawing_part({{}, {input_.view}});
    sink.frame(std::move(frame));
  }

 private:
  void flatten(const OneViewResult& result, Frame& frame, FrameSink& sink,
               RunContext& context) const {
    MadePattern made;
    {
      const Phase phase(context, "flatten");
      // The grain points up on the object, not in the picture.
      const Eigen::Matrix3d frame_of_object = drawn_object_frame(input_.view, result.planes.chosen);
      const TriMesh& mesh = result.surface.mesh;
      made = make_pattern({mesh.V * frame_of_object.transpose(), mesh.F},
                          patch_seams(result.surface), input_.pattern);
    }
    add_pattern(frame, made);
    if (!input_.files) return;
    const Phase phase(context, "record");
    OneViewFiles files = input_.files(input_.view, result, made.pattern);
    for (Artifact& file : files.artifacts) sink.artifact(std::move(file));
    frame.diagnostics.merge(files.diagnostics);
    frame.parts.merge(files.parts);
  }

  const OneViewInput& input_;  ///< of the process, which outlives its model
  OneViewOptions options_;
};

}  // namespace

Frame one_view_frame(const View& view, const OneViewResult& result) {
  Frame frame;
  frame.parts["surface"] = textured_part(view, result);
  frame.parts["strokes"] = curves_part(result);
  Part rulings = rulings_part(result);
  if (!rulings.lines.empty()) frame.parts["rulings"] = std::move(rulings);
  for (int t = 0; t < kDepthTerms; ++t) {
    if (result.depth.rows[t] == 0) continue;
    frame.diagnostics[std::string("residual_") + depth_term_name(static_cast<DepthTerm>(t))] =
        result.depth.rms[t];
  }
  frame.diagnostics["condition"] = result.depth.condition;
  frame.diagnostics["matches"] = result.matches;
  if (result.refined) {
    frame.diagnostics["refine_iterations"] = result.refined->iterations;
    frame.diagnostics["vector_ratio"] = result.refined->vector_ratio;
    frame.diagnostics["perspective"] = result.refined->perspective;
  }
  return frame;
}

std::vector<SeamEdge> patch_seams(const TexturedSurface& surface) {
  const EdgeConnectivity edges(surface.mesh.F);
  std::map<std::pair<int, int>, std::vector<Edge>> between;
  for (int h = 0; h < 3 * surface.mesh.triangle_count(); ++h) {
    const int twin = edges.twin(h);
    if (twin < h) continue;  // a border, or seen from the other side
    const int a = surface.patch[h / 3], b = surface.patch[twin / 3];
    if (a != b) between[std::minmax(a, b)].push_back({edges.origin(h), edges.origin(twin)});
  }
  std::vector<SeamEdge> seams;
  int number = 0;
  for (const auto& [patches, chain] : between) {
    for (const Edge& edge : chain) seams.push_back({edge, number});
    ++number;
  }
  return seams;
}

std::unique_ptr<Process> make_one_view_process(const OneViewInput& input,
                                               const OneViewOptions& options) {
  return frame_process(
      [input, options](RunContext&) { return std::make_unique<OneView>(input, options); });
}

}  // namespace geoprior::sketch
