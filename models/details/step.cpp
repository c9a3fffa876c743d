#include "models/details/step.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace geoprior::details {

StepReport step_details(DetailMesh& details, const Eigen::MatrixX3d& V, LengthRule lengths,
                        double weight_step, RunContext& context,
                        const std::function<void()>& change) {
  StepReport report;
  const std::int64_t refused = details.mesh.refused_flips();
  {
    const Phase phase(context, "move");
    report.flips = move_surface(details, V, lengths);
  }
  change();
  const Phase phase(context, "weights");
  report.max_weight_change = change_weights(details, weight_step);
  // An insertion or a removal may have cleared the way for a flip that was refused before it.
  if (details.mesh.refused_flips() != refused) report.flips += details.mesh.flip_to_delaunay();
  return report;
}

AreaBudget::Lead lead_of(bool anticipate, double weight_rate) {
  const double frames = anticipate ? 1 / weight_rate : 0;
  return {frames / 4, 3 * frames / 4};
}

void fade_detail(DetailMesh& details, int site, AreaBudget& budget) {
  details.site[site].target_weight = 0;
  budget.add(budget.patch_of(details.site[site].at), -1);
}

int revive_details(DetailMesh& details, AreaBudget& budget, double limit) {
  std::vector<std::pair<double, int>> fading;
  for (int i = 0; i < details.site_slots(); ++i) {
    const Detail& d = details.site[i];
    if (details.is_detail(i) && d.target_weight == 0) fading.emplace_back(-d.weight, i);
  }
  std::sort(fading.begin(), fading.end());
  int revived = 0;
  for (const auto& [weight, i] : fading) {
    const int patch = budget.patch_of(details.site[i].at);
    if (budget.deficit(patch) < limit) continue;
    details.site[i].target_weight = 1;
    budget.add(patch, 1);
    ++revived;
  }
  return revived;
}

}  // namespace geoprior::details
