#include "baselines/details/delaunay_refinement.h"

namespace geoprior::details {
namespace {

class DelaunayRefinement final : public DetailMethod {
 public:
  DelaunayRefinement(const DetailScene& scene, const DelaunayRefinementOptions& options)
      : options_(options),
        now_(build_detail_mesh(scene.surface, scene.details)),
        density_(now_),
        budget_(now_, options.patch_details),
        moves_(now_, density_, budget_, options.dead_band) {}

  void step(const Eigen::MatrixX3d& V, RunContext& context) override {
    const std::int64_t refused = now_.mesh.refused_flips();
    {
      const Phase phase(context, "move");
      flips_ = move_surface(now_, V, options_.lengths);
    }
    changes_ = moves_.keep_number(options_, context);
    const Phase phase(context, "weights");
    max_weight_change_ = change_weights(now_, options_.weight_rate);
    // An insertion or a removal may have cleared the way for a flip that was refused before it.
    if (now_.mesh.refused_flips() != refused) flips_ += now_.mesh.flip_to_delaunay();
  }

  [[nodiscard]] const DetailMesh& details() const override { return now_; }
  void diagnose(std::map<std::string, double>& into) const override {
    changes_.diagnose(into);
    into["flips"] = flips_;
    into["refused_flips"] = static_cast<double>(now_.mesh.refused_flips());
    into["max_weight_change"] = max_weight_change_;
  }
  void save(StateWriter& out) const override {
    now_.save(out);
    budget_.save(out);
  }
  void load(StateReader& in) override {
    now_.load(in);
    budget_.load(in);
  }

 private:
  DelaunayRefinementOptions options_;
  DetailMesh now_;
  RestDensity density_;
  AreaBudget budget_;
  DensityMoves moves_;
  DensityChanges changes_;
  int flips_ = 0;
  double max_weight_change_ = 0;
};

}  // namespace

std::unique_ptr<DetailMethod> make_delaunay_refinement(const DetailScene& scene,
                                                       const DelaunayRefinementOptions& options) {
  require_valid(scene);
  return std::make_unique<DelaunayRefinement>(scene, options);
}

std::unique_ptr<Process> make_delaunay_refinement_process(
    const DetailScene& scene, const DelaunayRefinementOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext&) {
    return make_delaunay_refinement(s, options);
  });
}

}  // namespace geoprior::details
