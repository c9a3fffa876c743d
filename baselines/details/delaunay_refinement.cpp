#include "baselines/details/delaunay_refinement.h"

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "baselines/details/density_moves.h"

namespace geoprior {
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
    {
      const Phase phase(context, "budget");
      const double frames = options_.anticipate ? 1 / options_.weight_rate : 0;
      moves_.measure({frames / 4, 3 * frames / 4});
      revived_ = moves_.revive();
    }
    {
      const Phase phase(context, "merge");
      fading_ = moves_.fade_shortest_edges(options_.shortest_edge);
    }
    {
      const Phase phase(context, "insert");
      inserted_ = moves_.insert_at_circumcentres(options_.circumradius);
    }
    const Phase phase(context, "weights");
    max_weight_change_ = change_weights(now_, options_.weight_rate);
    // An insertion or a removal may have cleared the way for a flip that was refused before it.
    if (now_.mesh.refused_flips() != refused) flips_ += now_.mesh.flip_to_delaunay();
  }

  [[nodiscard]] const DetailMesh& details() const override { return now_; }
  void diagnose(std::map<std::string, double>& into) const override {
    into["inserted"] = inserted_;
    into["revived"] = revived_;
    into["fading"] = fading_;
    into["flips"] = flips_;
    into["refused_flips"] = static_cast<double>(now_.mesh.refused_flips());
    into["max_weight_change"] = max_weight_change_;
  }
  void save(StateWriter& out) const override {
    now_.save(out);
    out.items(budget_.areas());
  }
  void load(StateReader& in) override {
    now_.load(in);
    std::vector<double> areas;
    in.items(areas);
    budget_.set_areas(std::move(areas));
  }

 private:
  DelaunayRefinementOptions options_;
  DetailMesh now_;
  RestDensity density_;
  AreaBudget budget_;
  DensityMoves moves_;
  int inserted_ = 0, revived_ = 0, fading_ = 0, flips_ = 0;
  double max_weight_change_ = 0;
};

}  // namespace

void describe(OptionVisitor& v, DelaunayRefinementOptions& options) {
  static constexpr std::array<std::string_view, 2> kLengths{"chord", "geodesic"};
  v.value("circumradius", options.circumradius,
          {.doc = "least circumradius that is filled, in units of the lattice's", .min = 0});
  v.value("shortest_edge", options.shortest_edge,
          {.doc = "edges below may lose an end, in units of the lattice's", .min = 0});
  v.value("patch_details", options.patch_details, {.doc = "details of a patch at rest", .min = 1});
  v.value("dead_band", options.dead_band,
          {.doc = "a patch acts when off by more than 1/2 + this", .min = 0, .max = 10});
  v.value("anticipate", options.anticipate,
          {.doc = "patches ask for what they need K / 4 frames ahead when they grow, 3 K / 4 when "
                  "they shrink, K = 1 / weight_rate"});
  v.value("weight_rate", options.weight_rate,
          {.doc = "largest change of a weight in a frame", .min = 1e-3, .max = 1});
  describe_choice(v, "lengths", options.lengths, kLengths,
                  {.doc = "edges of M_d: distance of their ends, or along the surface"});
}

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

}  // namespace geoprior
