#include <cmath>
#include <set>

#include "core/error.h"
#include "experiments/fluid/feature_files.h"

namespace geoprior {
namespace {

constexpr int kMostTexels = 4096;        // along a map
constexpr double kRotationError = 1e-6;  // of R'R - I
constexpr float kAlphaError = 1e-6F;

/// Checks one feature; every message begins with its place and id.
class Check {
 public:
  Check(const Feature& feature, const std::string& where)
      : f_(feature), where_(where + ", feature " + std::to_string(feature.id)) {}

  void all() const {
    require(f_.id >= 1, "has no id", "1 and up");
    require(std::isfinite(f_.cell) && f_.cell > 0, "has no cell size", "a positive number");
    require(!f_.times.empty(), "has no frames", "1 or more");
    times();
    placements();
    per_frame(f_.area, "area");
    per_frame(f_.volume, "volume");
    if (f_.kind == RegionKind::differential) {
      maps();
    } else {
      meshes();
    }
  }

 private:
  void require(bool holds, const std::string& problem, const std::string& allowed) const {
    if (!holds) throw Error(problem, where_, allowed);
  }
  void in_frame(bool holds, std::size_t frame, const std::string& problem,
                const std::string& allowed) const {
    if (!holds) throw Error(problem, where_ + ", frame " + std::to_string(frame), allowed);
  }
  void count(std::size_t found, const std::string& what) const {
    require(found == f_.times.size(), "has " + std::to_string(found) + " " + what,
            std::to_string(f_.times.size()) + ", one a frame");
  }

  void times() const {
    for (std::size_t i = 0; i < f_.times.size(); ++i) {
      in_frame(std::isfinite(f_.times[i]) && (i == 0 || f_.times[i] > f_.times[i - 1]), i,
               "has the time " + std::to_string(f_.times[i]), "times that increase");
    }
  }

  void placements() const {
    count(f_.placement.size(), "placements");
    for (std::size_t i = 0; i < f_.placement.size(); ++i) {
      const Eigen::Matrix3d R = f_.placement[i].linear();
      const bool rigid =
          f_.placement[i].matrix().allFinite() &&
          (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kRotationError &&
          R.determinant() > 0;
      in_frame(rigid, i, "has a placement that is not rigid", "a rotation and a shift");
    }
  }

  void per_frame(const std::vector<double>& values, const std::string& what) const {
    if (values.empty()) return;
    count(values.size(), what + " values");
    for (std::size_t i = 0; i < values.size(); ++i) {
      in_frame(std::isfinite(values[i]), i, what + " is not finite", "a number");
    }
  }

  void maps() const {
    require(f_.resolution >= 2 && f_.resolution <= kMostTexels,
            "has the resolution " + std::to_string(f_.resolution),
            "2 to " + std::to_string(kMostTexels));
    require(std::isfinite(f_.extent) && f_.extent > 0, "has no extent", "a positive number");
    require(f_.meshes.empty(), "is differential and has meshes", "maps");
    count(f_.maps.size(), "maps");
    const Eigen::Index texels = static_cast<Eigen::Index>(f_.resolution) * f_.resolution;
    for (std::size_t i = 0; i < f_.maps.size(); ++i) {
      const MapFrame& map = f_.maps[i];
      in_frame(map.displacement.rows() == texels && map.alpha.size() == texels, i,
               "has a map of another size", std::to_string(texels) + " texels");
      in_frame(map.displacement.allFinite(), i, "has a displacement that is not finite", "numbers");
      in_frame(map.alpha.allFinite() && map.alpha.minCoeff() >= -kAlphaError &&
                   map.alpha.maxCoeff() <= 1 + kAlphaError,
               i, "has an alpha out of range", "0 to 1");
    }
  }

  void meshes() const {
    require(f_.maps.empty(), "is isolated and has maps", "meshes");
    count(f_.meshes.size(), "meshes");
    for (std::size_t i = 0; i < f_.meshes.size(); ++i) {
      const TriMesh& mesh = f_.meshes[i];
      in_frame(mesh.F.rows() > 0, i, "has an empty mesh", "one triangle or more");
      in_frame(mesh.V.allFinite(), i, "has a position that is not finite", "numbers");
      in_frame(mesh.F.minCoeff() >= 0 && mesh.F.maxCoeff() < mesh.vertex_count(), i,
               "has a triangle that refers to vertex " +
                   std::to_string(mesh.F.minCoeff() < 0 ? mesh.F.minCoeff() : mesh.F.maxCoeff()),
               "0 to " + std::to_string(mesh.vertex_count() - 1));
    }
  }

  const Feature& f_;
  std::string where_;
};

}  // namespace

void require_valid(const Feature& feature, const std::string& where) {
  Check(feature, where).all();
}

void require_valid(const std::vector<Feature>& features, const std::string& where) {
  std::set<int> ids;
  for (const Feature& feature : features) {
    require_valid(feature, where);
    if (!ids.insert(feature.id).second) {
      throw Error("has two features of the id " + std::to_string(feature.id), where,
                  "ids that differ");
    }
  }
}

}  // namespace geoprior
