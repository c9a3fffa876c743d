#include "models/torus/frames.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "core/frame_loop.h"
#include "core/geometry/area_vector.h"
#include "core/mesh.h"
#include "models/torus/revolution.h"
#include "models/torus/sampling.h"

namespace geoprior::torus {
namespace {

NamedArray parameters_array(const Eigen::MatrixX2d& at) {
  return {"parameters", "1", NamedArray::On::points, at};
}

/// Triangles of a lattice of `side` x `side` points, rows along y; where it is closed, its last
/// row and column join the first ones. Seen from outside of the torus they turn to the left.
Eigen::MatrixX3i lattice_triangles(int side, bool closed) {
  const int cells = closed ? side : side - 1;
  Eigen::MatrixX3i F(2 * static_cast<Eigen::Index>(cells) * cells, 3);
  Eigen::Index row = 0;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int right = (i + 1) % side, above = (j + 1) % side * side;
      F.row(row++) << j * side + i, above + right, j * side + right;
      F.row(row++) << j * side + i, above + i, above + right;
    }
  return F;
}

/// Moves a view's middle point to the origin, turns its mean normal to +z (where it has one: not of
/// the whole torus) and what its rows run along to the plane of x and z, and magnifies it.
void set_upright(Eigen::MatrixX3d& points, const Eigen::MatrixX3i& F, int side, double factor) {
  const Eigen::Vector3d normal = doubled_area_vector(points, F);
  const double area = 2 * triangle_areas(points, F).sum();
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  for (Eigen::Index first = 0; first < points.rows(); first += side)
    along += (points.row(first + side - 1) - points.row(first)).transpose();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  constexpr double kCancelled = 1e-3;
  if (normal.norm() > kCancelled * area) {
    axes.col(2) = normal.normalized();
    axes.col(1) = normal.cross(along).normalized();
    axes.col(0) = axes.col(1).cross(axes.col(2));
  }
  const Eigen::Index half = side / 2;
  const Eigen::RowVector3d middle = points.row(half * side + half);
  points = factor * (points.rowwise() - middle) * axes;
}

FrameTable corner_table(const WindowSet& windows) {
  FrameTable table{{"x [1]", "y [1]", "step [1]"}, Eigen::MatrixXd(windows.corner.rows(), 3)};
  table.rows.leftCols(2) = windows.corner;
  table.rows.col(2).setConstant(windows.step);
  return table;
}

FrameTable corrugation_table(const TorusInput& input, int count) {
  FrameTable table{{"direction [1]", "number [1]", "share [1]", "base [1]"},
                   Eigen::MatrixXd(count, 4)};
  for (int i = 0; i < count; ++i) {
    const Corrugation& c = input.corrugations[i];
    table.rows.row(i) << c.direction, c.number, c.share, stage_base(input, i);
  }
  return table;
}

void add_tables(const TorusInput& input, const FramePlan& plan, Frame& frame) {
  for (const WindowSet& windows : plan.windows) frame.tables[windows.name] = corner_table(windows);
  if (plan.corrugations > 0)
    frame.tables["corrugations"] = corrugation_table(input, plan.corrugations);
}

/// What the points asked for are in a frame.
Part part_of(const FramePart& asked, Eigen::MatrixX3d points) {
  Part out;
  out.points = std::move(points);
  if (const auto& lattice = asked.lattice) {
    out.triangles = lattice_triangles(lattice->side, lattice->closed);
    if (lattice->magnification)
      set_upright(out.points, out.triangles, lattice->side, *lattice->magnification);
    out.arrays.push_back(parameters_array(asked.samples.at));
  } else if (asked.name == "grid") {
    const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(out.points.rows()))));
    out.kind = Part::Kind::grid;
    out.grid_size = {n, n, 1};
    out.grid_spacing = {1. / n, 1. / n, 1};
    out.arrays.push_back({"position", "m", NamedArray::On::points, out.points});
    out.points.resize(0, 3);
  } else if (asked.name.starts_with("windows")) {
    out.kind = Part::Kind::points;
  } else {
    out.kind = Part::Kind::lines;
    std::vector<int>& line = out.lines.emplace_back(out.points.rows());
    std::iota(line.begin(), line.end(), 0);
    line.push_back(0);
  }
  return out;
}

/// What a plan asks for, of the torus of revolution.
Frame asked_frame(const TorusInput& input, const FramePlan& plan) {
  Frame frame;
  frame.parameter = plan.parameter;
  for (const FramePart& asked : plan.parts) {
    Eigen::MatrixX3d points(asked.samples.at.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      points.row(i) = revolution_point(input.radii, asked.samples.at.row(i));
    Part& part = frame.parts[asked.name] = part_of(asked, std::move(points));
    if (part.kind != Part::Kind::grid && !asked.lattice)
      part.arrays.push_back(parameters_array(asked.samples.at));
  }
  add_tables(input, plan, frame);
  return frame;
}

class TorusFrames final : public FrameModel {
 public:
  TorusFrames(const TorusInput& input, std::unique_ptr<TorusMap> map)
      : input_(input), map_(std::move(map)), plans_(plan_frames(input, map_->grid())) {}

  [[nodiscard]] int frame_count() const override { return static_cast<int>(plans_.size()); }

  void begin(FrameSink& /*sink*/, RunContext& context) override {
    const Phase phase(context, "map");
    std::vector<TorusSamples> all;
    for (const FramePlan& plan : plans_)
      for (const FramePart& part : plan.parts) all.push_back(part.samples);
    map_->plan(all, context);
  }

  void record(int number, FrameSink& sink, RunContext& context) override {
    const FramePlan& plan = plans_[number];
    std::size_t first = 0;
    for (int i = 0; i < number; ++i) first += plans_[i].parts.size();
    Frame frame;
    frame.parameter = plan.parameter;
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
      frame.parts[plan.parts[i].name] = part(plan.parts[i], first + i, context);
    if (context.stop_requested()) return;
    const Phase phase(context, "record");
    add_tables(input_, plan, frame);
    for (const FramePart& one : plan.parts)
      if (one.name == "windows") map_->diagnose(one.samples, frame.diagnostics);
    sink.frame(std::move(frame));
  }

 private:
  Part part(const FramePart& asked, std::size_t index, RunContext& context) const {
    Eigen::MatrixX3d points;
    {
      const Phase phase(context, "map");
      points = map_->points(index, asked.samples, context);
    }
    return part_of(asked, std::move(points));
  }

  const TorusInput& input_;
  std::unique_ptr<TorusMap> map_;
  std::vector<FramePlan> plans_;
};

}  // namespace

std::unique_ptr<Process> make_torus_process(const TorusInput& input, TorusMapFactory factory) {
  require_valid(input);
  return frame_process([input, factory = std::move(factory)](RunContext& context) {
    const Phase phase(context, "prepare");
    return std::make_unique<TorusFrames>(input, factory(input, context));
  });
}

std::vector<Frame> asked_frames(const TorusInput& input) {
  std::vector<Frame> frames;
  for (const FramePlan& plan : plan_frames(input, std::nullopt)) {
    frames.push_back(asked_frame(input, plan));
  }
  return frames;
}

}  // namespace geoprior::torus
