// Cuts a feature: a bump on calm water is found, followed and lifted out of its animation.
//
// Shows features of space-time. Vertices of large mean curvature, |H| h above a threshold that the
// calm water decides, are regions; regions that overlap in successive frames are a track; a track
// is lifted out as a displacement d over a base surface b of its own:  x(u, t) = b(u, t) + d(u, t).
// Its foot, flatter than the threshold, stays with the bed: a tenth of the height.
//
//   build/release/examples/cut_feature
#include <cmath>
#include <cstdio>

#include "solvers/fluid/extraction.h"

int main() {
  constexpr int kSide = 81;         // vertices along an edge of the water
  constexpr double kEdge = 0.01;    // between them (m)
  constexpr double kHeight = 0.03;  // of the bump (m)
  std::vector<geoprior::SurfaceFrame> frames(8);
  for (int t = 0; t < 8; ++t) {
    frames[t].time = 0.04 * t;
    frames[t].mesh.V.resize(kSide * kSide, 3);
    frames[t].mesh.F.resize(2 * (kSide - 1) * (kSide - 1), 3);
    for (int v = 0, f = 0; v < kSide * kSide; ++v) {
      const double x = kEdge * (v % kSide), y = kEdge * (v / kSide);
      const double r = std::hypot(x - 0.35 - 0.01 * t, y - 0.4) / 0.05;  // it moves along x
      frames[t].mesh.V.row(v) << x, y, kHeight * std::exp(-r * r);
      if (v % kSide + 1 == kSide || v / kSide + 1 == kSide) continue;
      frames[t].mesh.F.row(f++) << v, v + 1, v + kSide + 1;
      frames[t].mesh.F.row(f++) << v, v + kSide + 1, v + kSide;
    }
  }
  const geoprior::StoredSequence water(std::move(frames), "water");

  geoprior::RunContext context;
  const geoprior::fluid::ExtractionOptions options;
  const auto found = geoprior::fluid::extract_regions(water, options, context);
  const auto features = geoprior::fluid::lift_features(water, found, options, {}, context);
  if (features.size() != 1) return 1;
  const auto& placement = features[0].placement;
  const double height = features[0].maps[4].displacement.col(2).maxCoeff();  // over its bed (m)
  const double way = placement.back().translation().x() - placement.front().translation().x();
  std::printf("height %.4f m of 0.03 m, way %.4f m of 0.07 m\n", height, way);
  return std::abs(height - kHeight) < 0.15 * kHeight && std::abs(way - 0.07) < 2e-3 ? 0 : 1;
}
