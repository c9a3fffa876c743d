#include "baselines/details/lloyd_relaxation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "baselines/details/density_moves.h"
#include "baselines/details/voronoi_cell.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Details that move towards each other by this part of a height do not turn a triangle over.
constexpr double kLargestSlide = 0.25;

class LloydRelaxation final : public DetailMethod {
 public:
  LloydRelaxation(const DetailScene& scene, const LloydRelaxationOptions& options)
      : options_(options),
        now_(build_detail_mesh(scene.surface, scene.details)),
        density_(now_),
        budget_(now_, options.patch_details),
        moves_(now_, density_, budget_, options.dead_band) {}

  void step(const Eigen::MatrixX3d& V, RunContext& context) override {
    const std::int64_t refused = now_.mesh.refused_flips();
    const bool moved = moves(V);
    {
      const Phase phase(context, "move");
      flips_ = move_surface(now_, V, options_.lengths);
    }
    keep_number(context);
    slide_.assign(now_.site.size(), 0);
    if (moved) {
      const Phase phase(context, "relax");
      for (int i = 0; i < options_.iterations; ++i) relax();
      set_densities();
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
    double sum = 0, most = 0;
    for (const double slide : slide_) {
      sum += slide;
      most = std::max(most, slide);
    }
    into["mean_slide"] = sum / std::max(1, now_.detail_count());
    into["max_slide"] = most;
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
  /// Where a detail goes in an iteration.
  struct Slide {
    SurfacePoint to;
    double tangent_angle = 0;
    double length = 0;  ///< 0: it stays
  };

  [[nodiscard]] bool moves(const Eigen::MatrixX3d& V) const {
    for (std::size_t v = 0; v < now_.x.size(); ++v)
      if (now_.x[v] != V.row(static_cast<Eigen::Index>(v)).transpose()) return true;
    return false;
  }

  void keep_number(RunContext& context) {
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
    const Phase phase(context, "insert");
    inserted_ = moves_.insert_at_circumcentres(options_.circumradius);
  }

  [[nodiscard]] Slide slide_of(int site, const std::vector<double>& spacing,
                               CellChart& chart) const {
    chart.lay_out(now_, site);
    const VoronoiCell cell = chart.cell(now_, spacing);
    if (!(cell.reach <= kBareRadius * spacing[index(site)])) return {};
    Eigen::Vector2d way = options_.relaxation * cell.centroid;
    const double most = kLargestSlide * chart.least_height();
    if (way.norm() > most) way *= most / way.norm();
    const auto place = chart.point_at(way);
    if (!place || !(way.norm() > 0)) return {};
    const Detail& from = now_.site[index(site)];
    Slide slide;
    slide.to = surface_point_in(now_, place->triangle, place->barycentric);
    slide.length = way.norm();
    if (density_.at(slide.to.face) <= 0) return {};
    slide.tangent_angle = tangent_angle(
        slide.to.face, tangent_direction(from.at.face, from.tangent_angle, *now_.surface, now_.x),
        *now_.surface, now_.x);
    return slide;
  }

  /// All details at once, each by the cells before.
  void relax() {
    const std::vector<double> spacing = spacing_of_sites(now_, density_);
    std::vector<Slide> slides(now_.site.size());
    parallel_blocks(slides.size(), 256, [&](std::size_t begin, std::size_t end) {
      CellChart chart;
      for (std::size_t i = begin; i < end; ++i)
        if (now_.is_detail(static_cast<int>(i)))
          slides[i] = slide_of(static_cast<int>(i), spacing, chart);
    });
    for (std::size_t i = 0; i < slides.size(); ++i) {
      if (!(slides[i].length > 0)) continue;
      now_.site[i].at = slides[i].to;
      now_.site[i].tangent_angle = slides[i].tangent_angle;
      now_.position[i] = position_of(slides[i].to, *now_.surface, now_.x);
      slide_[i] += slides[i].length;
    }
    if (options_.lengths == LengthRule::geodesic)
      measure_sections(now_);
    else
      now_.mesh.measure(now_.position);
    flips_ += now_.mesh.flip_to_delaunay();
  }

  /// Triangles that slide over the surface hold what lies under them.
  void set_densities() {
    for (int t = 0; t < now_.mesh.triangle_slots(); ++t) {
      if (!now_.mesh.triangle_alive(t)) continue;
      double sum = 0;
      for (const int c : now_.mesh.corners(t)) sum += density_.at(now_.site[index(c)].at.face);
      now_.mesh.set_density(t, sum / 3);
    }
  }

  LloydRelaxationOptions options_;
  DetailMesh now_;
  RestDensity density_;
  AreaBudget budget_;
  DensityMoves moves_;
  int inserted_ = 0, revived_ = 0, fading_ = 0, flips_ = 0;
  double max_weight_change_ = 0;
  std::vector<double> slide_;  ///< per site, of the last frame (m)
};

}  // namespace

void describe(OptionVisitor& v, LloydRelaxationOptions& options) {
  static constexpr std::array<std::string_view, 2> kLengths{"chord", "geodesic"};
  v.value("iterations", options.iterations,
          {.doc = "of a frame in which the surface moves", .min = 0, .max = 1000});
  v.value("relaxation", options.relaxation,
          {.doc = "part of the way to the centroid", .min = 0, .max = 2});
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

std::unique_ptr<DetailMethod> make_lloyd_relaxation(const DetailScene& scene,
                                                    const LloydRelaxationOptions& options) {
  require_valid(scene);
  return std::make_unique<LloydRelaxation>(scene, options);
}

std::unique_ptr<Process> make_lloyd_relaxation_process(const DetailScene& scene,
                                                       const LloydRelaxationOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext&) {
    return make_lloyd_relaxation(s, options);
  });
}

}  // namespace geoprior
