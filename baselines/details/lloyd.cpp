#include "baselines/details/lloyd.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "baselines/details/shared/voronoi_cell.h"
#include "core/parallel.h"

namespace geoprior::details {
namespace {

/// Details that move towards each other by this part of a height do not turn a triangle over.
constexpr double kLargestSlide = 0.25;

class Lloyd final : public DensityMethod {
 public:
  Lloyd(const DetailScene& scene, const LloydOptions& options)
      : DensityMethod(scene, options), options_(options) {}

  void diagnose(std::map<std::string, double>& into) const override {
    DensityMethod::diagnose(into);
    double sum = 0, most = 0;
    for (const double slide : slide_) {
      sum += slide;
      most = std::max(most, slide);
    }
    into["mean_slide"] = sum / std::max(1, now_.detail_count());
    into["max_slide"] = most;
  }

 protected:
  int relax(bool surface_moved, RunContext& context) override {
    slide_.assign(now_.site.size(), 0);
    if (!surface_moved) return 0;
    const Phase phase(context, "relax");
    int flips = 0;
    for (int i = 0; i < options_.iterations; ++i) flips += slide_all();
    set_densities();
    return flips;
  }

 private:
  /// Where a detail goes in an iteration.
  struct Slide {
    SurfacePoint to;
    double tangent_angle = 0;
    double length = 0;  ///< 0: it stays
  };

  [[nodiscard]] Slide slide_of(int site, const std::vector<double>& spacing,
                               CellChart& chart) const {
    chart.lay_out(now_, site);
    const VoronoiCell cell = chart.cell(now_, spacing);
    if (!(cell.reach <= kBareRadius * spacing[site])) return {};
    Eigen::Vector2d way = options_.relaxation * cell.centroid;
    const double most = kLargestSlide * chart.least_height();
    if (way.norm() > most) way *= most / way.norm();
    const auto place = chart.point_at(way);
    if (!place || !(way.norm() > 0)) return {};
    const Detail& from = now_.site[site];
    Slide slide;
    slide.to = surface_point_in(now_, place->triangle, place->barycentric);
    slide.length = way.norm();
    if (density_.at(slide.to.face) <= 0) return {};
    slide.tangent_angle = tangent_angle(
        slide.to.face, tangent_direction(from.at.face, from.tangent_angle, *now_.surface, now_.x),
        *now_.surface, now_.x);
    return slide;
  }

  /// One iteration: moves all details at once, each by the cells that they had before it.
  /// @return  number of flips
  int slide_all() {
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
    measure_edges(now_, options_.lengths);
    return now_.mesh.flip_to_delaunay();
  }

  /// Triangles that slide over the surface hold what lies under them.
  void set_densities() {
    for (int t = 0; t < now_.mesh.triangle_slots(); ++t) {
      if (!now_.mesh.triangle_alive(t)) continue;
      double sum = 0;
      for (const int c : now_.mesh.corners(t)) sum += density_.at(now_.site[c].at.face);
      now_.mesh.set_density(t, sum / 3);
    }
  }

  LloydOptions options_;
  std::vector<double> slide_;  ///< per site, of the last frame (m)
};

}  // namespace

void describe(OptionVisitor& v, LloydOptions& options) {
  v.value("iterations", options.iterations,
          {.doc = "relaxations of a frame in which the surface moves", .min = 0, .max = 1000});
  v.value("relaxation", options.relaxation,
          {.doc = "part of the way to the centroid of its cell that a detail goes",
           .min = 0,
           .max = 2});
  describe(v, static_cast<DensityMoveOptions&>(options));
}

std::unique_ptr<DetailMethod> make_lloyd(const DetailScene& scene, const LloydOptions& options) {
  require_valid(scene);
  return std::make_unique<Lloyd>(scene, options);
}

std::unique_ptr<Process> make_lloyd_process(const DetailScene& scene, const LloydOptions& options) {
  return make_detail_process(
      scene, [options](const DetailScene& s, RunContext&) { return make_lloyd(s, options); });
}

}  // namespace geoprior::details
