#include "baselines/details/dart_throwing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "baselines/details/shared/rest_density.h"
#include "core/parallel.h"
#include "core/random.h"
#include "models/details/point_grid.h"
#include "models/details/step.h"

namespace geoprior::details {
namespace {

/// A dart in a triangle of M_d that hit nothing so far.
struct Dart {
  int triangle = 0;
  std::array<int, 3> corner{};
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  SurfacePoint at;
  bool lands = false;
};

/// Uniform in the triangle.
Eigen::Vector3d uniform_barycentric(RandomStream& random) {
  const double r = std::sqrt(random.uniform()), s = random.uniform();
  return {1 - r, r * (1 - s), r * s};
}

class DartThrowing final : public DetailMethod {
 public:
  DartThrowing(const DetailScene& scene, const DartThrowingOptions& options, std::uint64_t seed)
      : options_(options),
        seed_(seed ^ fnv1a("darts")),
        now_(build_detail_mesh(scene.surface, scene.details)),
        density_(now_) {}

  void step(const Eigen::MatrixX3d& V, RunContext& context) override {
    report_ = step_details(now_, V, options_.lengths, options_.weight_rate, context, [&] {
      const Phase phase(context, "insert");
      throw_darts();
    });
  }

  [[nodiscard]] const DetailMesh& details() const override { return now_; }
  void diagnose(std::map<std::string, double>& into) const override {
    into["inserted"] = inserted_;
    into["flips"] = report_.flips;
    into["max_weight_change"] = report_.max_weight_change;
  }
  void save(StateWriter& out) const override { now_.save(out); }
  void load(StateReader& in) override { now_.load(in); }

 private:
  [[nodiscard]] double radius_at(int face) const {
    return options_.radius * density_.spacing(face);
  }

  /// Away from its corners a Delaunay triangle is at most its circumradius from the nearest vertex.
  [[nodiscard]] bool has_room(int t) const {
    double least = std::numeric_limits<double>::infinity();
    for (const int c : now_.mesh.corners(t))
      least = std::min(least, radius_at(now_.site[c].at.face));
    return circumradius(now_.mesh, t) > least;
  }

  [[nodiscard]] bool lands(const SurfacePoint& at, const PointGrid& grid) const {
    const double radius = radius_at(at.face);
    return std::isfinite(radius) &&
           RestDensity::stretch(at.face, now_) > options_.stretch_threshold &&
           grid.is_free(position_of(at, *now_.surface, now_.x),
                        normal_of_face(at.face, *now_.surface, now_.x), radius);
  }

  /// Each triangle draws from a stream of its own, whatever the others do.
  void throw_into(Dart& dart, const PointGrid& grid) const {
    RandomStream random(seed_, (static_cast<std::uint64_t>(now_.frame) << 32) |
                                   static_cast<std::uint32_t>(dart.triangle));
    for (int k = 0; k < options_.darts && !dart.lands; ++k) {
      dart.barycentric = uniform_barycentric(random);
      if (dart.barycentric.minCoeff() <= 0) continue;
      dart.at = surface_point_in(now_, dart.triangle, dart.barycentric);
      dart.lands = lands(dart.at, grid);
    }
  }

  [[nodiscard]] std::vector<Dart> triangles_with_room() const {
    std::vector<char> room(now_.mesh.triangle_slots(), 0);
    parallel_blocks(room.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        room[t] = now_.mesh.triangle_alive(static_cast<int>(t)) && has_room(static_cast<int>(t));
    });
    std::vector<Dart> darts;
    for (int t = 0; t < std::ssize(room); ++t) {
      if (room[t] == 0) continue;
      Dart dart;
      dart.triangle = t;
      dart.corner = now_.mesh.corners(dart.triangle);
      darts.push_back(dart);
    }
    return darts;
  }

  /// Darts are tried against the details of the frame before in parallel; those that land become
  /// details one after the other, unless one of them came too near or rewrote their triangle (which
  /// has its turn in the next frame).
  void throw_darts() {
    inserted_ = 0;
    std::vector<Dart> darts = triangles_with_room();
    if (darts.empty()) return;
    PointGrid grid(options_.radius * density_.mean_spacing(), 2 * now_.site.size());
    grid.add_details(now_);
    parallel_blocks(darts.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) throw_into(darts[i], grid);
    });
    for (const Dart& dart : darts) {
      if (!dart.lands || !now_.mesh.triangle_alive(dart.triangle) ||
          now_.mesh.corners(dart.triangle) != dart.corner || !lands(dart.at, grid))
        continue;
      const NewDetail born{dart.barycentric, dart.at,
                           newborn_like_neighbour(now_, dart.triangle, dart.barycentric, dart.at)};
      const int site = insert_details(now_, dart.triangle, {&born, 1})[0];
      grid.add(now_.position[site], normal_of_face(dart.at.face, *now_.surface, now_.x));
      ++inserted_;
    }
  }

  DartThrowingOptions options_;
  std::uint64_t seed_;
  DetailMesh now_;
  RestDensity density_;
  int inserted_ = 0;
  StepReport report_;
};

}  // namespace

void describe(OptionVisitor& v, DartThrowingOptions& options) {
  v.value("radius", options.radius,
          {.doc = "smallest distance between details, in units of 1 / sqrt(density at rest)",
           .min = 0.3,
           .max = 2});
  v.value("stretch_threshold", options.stretch_threshold,
          {.doc = "a face is stretched above this ratio of its area to that at rest", .min = 1});
  v.value("darts", options.darts,
          {.doc = "darts thrown into a triangle with room, in a frame", .min = 1, .max = 1000});
  v.value("weight_rate", options.weight_rate,
          {.doc = "largest change of a weight in a frame", .min = 1e-3, .max = 1});
  describe_lengths(v, options.lengths);
}

std::unique_ptr<DetailMethod> make_dart_throwing(const DetailScene& scene,
                                                 const DartThrowingOptions& options,
                                                 std::uint64_t seed) {
  require_valid(scene);
  return std::make_unique<DartThrowing>(scene, options, seed);
}

std::unique_ptr<Process> make_dart_throwing_process(const DetailScene& scene,
                                                    const DartThrowingOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext& context) {
    return make_dart_throwing(s, options, context.seed());
  });
}

}  // namespace geoprior::details
