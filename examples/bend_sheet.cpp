// Bends a sheet: two hands push the ends of a strip of paper towards each other.
//
// Shows the hybrid model, whose rulings follow the bending. Paper hardly stretches: its area stays,
// and the strip becomes the elastica between hinges, EI theta'' + P sin theta = 0, whose rise is
//   h = L k / K(k)   where   2 E(k) / K(k) - 1 = distance of the hands / L,
// K and E the complete elliptic integrals: 0.0390 m for a strip of 0.2 m, pushed together by 0.02
// m.
//
//   build/release/examples/bend_sheet
#include <cmath>
#include <cstdio>

#include "core/mesh.h"
#include "solvers/paper/hybrid.h"

/// Keeps the last frame.
struct LastFrame final : geoprior::FrameSink {
  void frame(geoprior::Frame frame) override { last = std::move(frame); }
  void event(const geoprior::Event&) override {}
  void artifact(geoprior::Artifact) override {}
  void checkpoint(const geoprior::State&) override {}
  geoprior::Frame last;
};

int main() {
  geoprior::paper::Sheet sheet;
  sheet.pattern = geoprior::paper::rectangle_pattern(0.2, 0.05);
  sheet.duration = 1;
  for (const double side : {-1.0, 1.0}) {
    geoprior::paper::Handle& hand = sheet.handles.emplace_back();
    hand.segment = {{side * 0.1, -0.025}, {side * 0.1, 0.025}};
    hand.motion = geoprior::Trajectory{{{.time = 0}, {.time = 1, .shift = {-side * 0.01, 0, 0}}}};
  }
  geoprior::RunContext context;
  LastFrame sink;
  geoprior::paper::make_hybrid_sheet(sheet, {})->run(sink, context, std::nullopt);

  const geoprior::Part& surface = sink.last.require_part("surface");
  const double area = geoprior::triangle_areas(surface.points, surface.triangles).sum();
  const double rise = surface.points.col(2).cwiseAbs().maxCoeff();
  std::printf("rise %.4f m of 0.0390 m, area %.6f m^2 of 0.01 m^2\n", rise, area);
  return std::abs(rise - 0.0390) < 1e-3 && std::abs(area - 0.01) < 1e-5 ? 0 : 1;
}
