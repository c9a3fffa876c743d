// Flattens a patch: a quarter of a cone is laid flat at true scale.
//
// Shows that a developable surface unrolls without strain. As rigid as possible, over the layout z
// and a turn R_t of every triangle (a cone's minimum is 0, the isometry):
//   E(z, R) = sum_t area_t |J_t(z) - R_t|^2,   J_t the linear map of triangle t.
//
//   build/release/examples/flatten_patch
#include <cmath>
#include <cstdio>
#include <numbers>

#include "models/sketch/flatten/flatten.h"

int main() {
  constexpr int kRings = 8, kRulings = 16;
  geoprior::TriMesh cone{Eigen::MatrixX3d(kRings * kRulings, 3),
                         Eigen::MatrixX3i(2 * (kRings - 1) * (kRulings - 1), 3)};
  for (int v = 0; v < kRings * kRulings; ++v) {
    const double s = 0.1 + 0.02 * (v / kRulings);  // along the ruling, from the apex (m)
    const double angle = std::numbers::pi / 2 * (v % kRulings) / (kRulings - 1);
    cone.V.row(v) << 0.6 * s * std::cos(angle), 0.6 * s * std::sin(angle), -0.8 * s;
  }
  for (int r = 0, f = 0; r + 1 < kRings; ++r) {
    for (int a = r * kRulings; a + 1 < (r + 1) * kRulings; ++a, f += 2) {
      cone.F.row(f) << a, a + kRulings, a + kRulings + 1;
      cone.F.row(f + 1) << a, a + kRulings + 1, a + 1;
    }
  }

  const geoprior::sketch::Flattening flat = geoprior::sketch::flatten(cone);

  std::printf("strain of the flat cone %.1e, overlaps %zu\n", flat.report.strain,
              flat.report.overlaps.size());
  return flat.report.strain < 1e-6 && flat.report.overlaps.empty() ? 0 : 1;
}
