#include "baselines/details/re_scatter.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "baselines/details/shared/rest_density.h"
#include "core/parallel.h"
#include "core/random.h"
#include "models/details/point_grid.h"

namespace geoprior::details {
namespace {

/// A frame has fewer details after so many darts for each it asks for. Chosen: the default radius
/// needs a few dozen.
constexpr std::size_t kDartsPerDetail = 100;

/// Darts of a batch that share a random stream.
constexpr std::size_t kBlock = 256;

struct TriedPlace {
  SurfacePoint at;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  std::uint32_t like = 0;  ///< detail at rest
  bool lands = false;
};

class ReScatter final : public DetailMethod {
 public:
  ReScatter(const DetailScene& scene, const ReScatterOptions& options, std::uint64_t seed)
      : options_(options),
        seed_(seed ^ fnv1a("rescatter")),
        now_(build_detail_mesh(scene.surface, scene.details)),
        density_(now_),
        at_rest_(scene.details) {}

  void step(const Eigen::MatrixX3d& V, RunContext& context) override {
    inserted_ = removed_ = 0;
    darts_ = 0;
    {
      const Phase phase(context, "move");
      if (!move_points(V)) return;
    }
    std::vector<Detail> scattered;
    {
      const Phase phase(context, "scatter");
      scattered = scatter();
    }
    const Phase phase(context, "build");
    rebuild(scattered);
  }

  [[nodiscard]] const DetailMesh& details() const override { return now_; }
  void diagnose(std::map<std::string, double>& into) const override {
    into["inserted"] = inserted_;
    into["removed"] = removed_;
    into["darts"] = static_cast<double>(darts_);
  }
  void save(StateWriter& out) const override { now_.save(out); }
  void load(StateReader& in) override { now_.load(in); }

 private:
  /// The surface alone: M_d is built anew. False when it stands still.
  bool move_points(const Eigen::MatrixX3d& V) {
    ++now_.frame;
    bool moved = false;
    for (std::size_t v = 0; v < now_.x.size(); ++v) {
      const Eigen::Vector3d x = V.row(v).transpose();
      moved = moved || now_.x[v] != x;
      now_.x[v] = x;
    }
    return moved;
  }

  /// Partial sums of density x area over the faces: what darts are drawn by.
  [[nodiscard]] std::vector<double> partial_sums() const {
    std::vector<double> sums(now_.surface->face.size());
    double sum = 0;
    for (int f = 0; f < std::ssize(sums); ++f) {
      sum += density_.at(f) * area_of_face(f, *now_.surface, now_.x);
      sums[f] = sum;
    }
    return sums;
  }

  [[nodiscard]] bool lands(const TriedPlace& dart, const PointGrid& grid) const {
    const double radius = options_.radius * density_.spacing(dart.at.face);
    return std::isfinite(radius) && grid.is_free(dart.position, dart.normal, radius);
  }

  void throw_one(TriedPlace& dart, const std::vector<double>& sums, const PointGrid& grid,
                 RandomStream& random) const {
    const double s = random.uniform() * sums.back();
    const auto found = std::upper_bound(sums.begin(), sums.end() - 1, s);
    const double r = std::sqrt(random.uniform()), t = random.uniform();
    dart.at = {static_cast<int>(found - sums.begin()), {1 - r, r * (1 - t), r * t}};
    dart.like = random.below(static_cast<std::uint32_t>(at_rest_.size()));
    dart.position = position_of(dart.at, *now_.surface, now_.x);
    dart.normal = normal_of_face(dart.at.face, *now_.surface, now_.x);
    dart.lands = lands(dart, grid);
  }

  /// Batches of darts: thrown and tried against the details so far in parallel, then admitted one
  /// after the other.
  [[nodiscard]] std::vector<Detail> scatter() {
    const std::vector<double> sums = partial_sums();
    const auto wanted = static_cast<std::size_t>(std::max(3.0, std::round(sums.back())));
    const std::size_t most = wanted * kDartsPerDetail;
    PointGrid grid(options_.radius * density_.mean_spacing(), wanted);
    std::vector<Detail> scattered;
    std::vector<TriedPlace> batch(std::max(wanted, kBlock));
    for (std::size_t thrown = 0; thrown < most && scattered.size() < wanted;
         thrown += batch.size()) {
      parallel_blocks(batch.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        const std::uint64_t first = thrown + begin;
        RandomStream random(seed_, (static_cast<std::uint64_t>(now_.frame) << 40) + first);
        for (std::size_t i = begin; i < end; ++i) throw_one(batch[i], sums, grid, random);
      });
      for (const TriedPlace& dart : batch) {
        if (scattered.size() == wanted) break;
        ++darts_;
        if (!dart.lands || !lands(dart, grid)) continue;
        grid.add(dart.position, dart.normal);
        Detail born = at_rest_[dart.like];
        born.at = dart.at;
        scattered.push_back(born);
      }
    }
    return scattered;
  }

  void rebuild(std::vector<Detail>& scattered) {
    const std::int64_t births = now_.births;
    const int frame = now_.frame;
    removed_ = now_.detail_count();
    inserted_ = static_cast<int>(scattered.size());
    for (std::size_t i = 0; i < scattered.size(); ++i) {
      scattered[i].birth = births + static_cast<std::int64_t>(i);
      scattered[i].birth_frame = frame;
      scattered[i].generation = 0;
    }
    const std::vector<Eigen::Vector3d> x = std::move(now_.x);
    now_ = build_detail_mesh(now_.surface, x, scattered);
    now_.births = births + inserted_;
    now_.frame = frame;
  }

  ReScatterOptions options_;
  std::uint64_t seed_;
  DetailMesh now_;
  RestDensity density_;
  std::vector<Detail> at_rest_;
  int inserted_ = 0, removed_ = 0;
  std::int64_t darts_ = 0;
};

}  // namespace

void describe(OptionVisitor& v, ReScatterOptions& options) {
  v.value("radius", options.radius,
          {.doc = "smallest distance between details, in units of 1 / sqrt(density at rest)",
           .min = 0.1,
           .max = 0.83});
}

std::unique_ptr<DetailMethod> make_re_scatter(const DetailScene& scene,
                                              const ReScatterOptions& options, std::uint64_t seed) {
  require_valid(scene);
  return std::make_unique<ReScatter>(scene, options, seed);
}

std::unique_ptr<Process> make_re_scatter_process(const DetailScene& scene,
                                                 const ReScatterOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext& context) {
    return make_re_scatter(s, options, context.seed());
  });
}

}  // namespace geoprior::details
