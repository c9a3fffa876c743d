#include "experiments/sketch/command/chosen_snap.h"

#include "core/error.h"
#include "solvers/sketch/one_view.h"

namespace geoprior::sketch {
namespace {

/// How well a drawing is met with some snapping.
struct SnapTrial {
  double distance = 0;  ///< of borders from where they were drawn, root mean square (m)
  int matches = 0;
};

std::optional<SnapTrial> try_snap(const View& view, const OneViewOptions& options) {
  try {
    const OneViewResult result = reconstruct_one_view(view, options);
    return SnapTrial{result.depth.rms[static_cast<int>(DepthTerm::accuracy)], result.matches};
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<double> chosen_snap(const View& view) {
  constexpr double kNearer = 4;
  OneViewOptions options;
  const double usual = options.curves.snap;
  const std::optional<SnapTrial> as_usual = try_snap(view, options);
  for (const double share : {0.5, 0.25}) {
    options.curves.snap = share * usual;
    const std::optional<SnapTrial> trial = try_snap(view, options);
    if (!trial) continue;
    const bool better = !as_usual || (kNearer * trial->distance < as_usual->distance &&
                                      trial->matches >= as_usual->matches);
    if (better) return options.curves.snap;
  }
  return std::nullopt;
}

}  // namespace geoprior::sketch
