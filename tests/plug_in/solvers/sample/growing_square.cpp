#include "solvers/sample/growing_square.h"

namespace geoprior::sample {

void describe(OptionVisitor& v, GrowingSquareOptions& options) {
  v.value("rate", options.rate, {.doc = "growth of the edge", .unit = "m/s", .min = 0});
}

void GrowingSquare::solve(double time, RunContext& /*context*/) { time_ = time; }

Frame GrowingSquare::frame() const {
  const double edge = options_.rate * time_;
  Part square;
  square.points.resize(4, 3);
  square.points << 0, 0, 0, edge, 0, 0, edge, edge, 0, 0, edge, 0;
  square.triangles.resize(2, 3);
  square.triangles << 0, 1, 2, 0, 2, 3;
  Frame frame;
  frame.parameter = time_;
  frame.parts["surface"] = std::move(square);
  return frame;
}

}  // namespace geoprior::sample
