// Drops a sheet of paper for one frame with the hybrid method: it falls as implicit Euler says.
#include <cmath>
#include <cstdio>

#include "solvers/paper/hybrid.h"

namespace {

/// Keeps the last frame.
class LastFrame final : public geoprior::FrameSink {
 public:
  void frame(geoprior::Frame frame) override { last = std::move(frame); }
  void event(const geoprior::Event&) override {}
  void artifact(geoprior::Artifact) override {}
  void checkpoint(const geoprior::State&) override {}

  geoprior::Frame last;
};

}  // namespace

int main() {
  geoprior::paper::Sheet sheet;
  sheet.pattern = geoprior::paper::rectangle_pattern(0.2, 0.1);
  sheet.imperfection = 0;
  sheet.duration = sheet.frame_interval;
  geoprior::RunContext context;
  LastFrame sink;
  geoprior::paper::make_hybrid_sheet(sheet, {})->run(sink, context, std::nullopt);

  // n steps of dt under g: v_k = k dt g, so x_n = g dt^2 n (n + 1) / 2.
  const int n = sheet.substeps;
  const double dt = sheet.frame_interval / n;
  const double expected = sheet.gravity.z() * dt * dt * n * (n + 1) / 2;
  const double fallen = sink.last.require_part("surface").points.col(2).mean();
  std::printf("fallen %.9f m, expected %.9f m\n", fallen, expected);
  return std::abs(fallen - expected) <= 1e-9 ? 0 : 1;
}
