#include "experiments/fluid/scene/feature_files.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>

#include "core/error.h"
#include "testbed/formats/hdf5/content.h"
#include "testbed/formats/hdf5/file.h"

namespace geoprior::fluid {
namespace {

constexpr std::int64_t kSchema = 1;
constexpr const char* kFileKind = "geoprior feature library";
constexpr const char* kDifferential = "differential";
constexpr const char* kIsolated = "isolated";

using Row4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
using FloatRows = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using DoubleRows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using IntRows = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

template <class T, class Matrix>
void append(std::vector<T>& out, const Matrix& rows) {
  out.insert(out.end(), rows.data(), rows.data() + rows.size());
}

template <class T>
void write(H5Group& group, const char* name, const std::vector<std::size_t>& extents,
           const std::vector<T>& values) {
  group.write_block(name, extents, std::span<const T>(values));
}

void write_placements(H5Group& group, const Feature& feature) {
  std::vector<double> values;
  for (const Eigen::Isometry3d& placement : feature.placement) {
    append(values, Row4(placement.matrix()));
  }
  write(group, "placement", {feature.placement.size(), 4, 4}, values);
}

void write_maps(H5Group& group, const Feature& feature) {
  const std::size_t n = feature.resolution;
  group.write_attribute("resolution", static_cast<std::int64_t>(n));
  group.write_attribute("extent", feature.extent);
  std::vector<float> displacement, alpha;
  displacement.reserve(feature.maps.size() * n * n * 3);
  alpha.reserve(feature.maps.size() * n * n);
  for (const MapFrame& map : feature.maps) {
    append(displacement, FloatRows(map.displacement));
    append(alpha, map.alpha);
  }
  write(group, "displacement", {feature.maps.size(), n, n, 3}, displacement);
  write(group, "alpha", {feature.maps.size(), n, n}, alpha);
}

void write_meshes(H5Group& group, const Feature& feature) {
  std::vector<std::int64_t> vertex_offset{0}, triangle_offset{0};
  std::vector<double> vertices;
  std::vector<std::int32_t> triangles;
  for (const TriMesh& mesh : feature.meshes) {
    append(vertices, DoubleRows(mesh.V));
    append(triangles, IntRows(mesh.F));
    vertex_offset.push_back(vertex_offset.back() + mesh.V.rows());
    triangle_offset.push_back(triangle_offset.back() + mesh.F.rows());
  }
  write(group, "vertex_offset", {vertex_offset.size()}, vertex_offset);
  write(group, "triangle_offset", {triangle_offset.size()}, triangle_offset);
  write(group, "vertices", {vertices.size() / 3, 3}, vertices);
  write(group, "triangles", {triangles.size() / 3, 3}, triangles);
}

void write_feature(H5Group& features, const Feature& feature) {
  H5Group group = features.create_group(std::to_string(feature.id));
  const bool differential = feature.kind == RegionKind::differential;
  group.write_attribute("name", feature.name);
  group.write_attribute("kind", std::string(differential ? kDifferential : kIsolated));
  group.write_attribute("cell", feature.cell);
  group.write_attribute("frames", static_cast<std::int64_t>(feature.frame_count()));
  write(group, "times", {feature.times.size()}, feature.times);
  write_placements(group, feature);
  write(group, "area", {feature.area.size()}, feature.area);
  write(group, "volume", {feature.volume.size()}, feature.volume);
  if (differential) {
    write_maps(group, feature);
  } else {
    write_meshes(group, feature);
  }
}

/// A data set of these extents.
template <class T>
std::vector<T> read(const H5Node& group, const char* name,
                    const std::vector<std::size_t>& extents) {
  H5Block<T> block = group.read_block<T>(name, extents.size());
  if (block.extents != extents) {
    std::string text;
    for (const std::size_t n : extents) text += (text.empty() ? "" : " x ") + std::to_string(n);
    throw Error("has another size", group.place() + "/" + name, text);
  }
  return std::move(block.values);
}

template <class T>
std::vector<T> read_rows(const H5Node& group, const char* name) {
  H5Block<T> block = group.read_block<T>(name, 2);
  if (block.extents[1] != 3) throw Error("has not three columns", group.place() + "/" + name);
  return std::move(block.values);
}

void read_placements(const H5Node& group, Feature& feature) {
  const std::size_t frames = feature.times.size();
  const std::vector<double> values = read<double>(group, "placement", {frames, 4, 4});
  feature.placement.resize(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    feature.placement[i].matrix() = Eigen::Map<const Row4>(values.data() + 16 * i);
  }
}

void read_maps(const H5Node& group, Feature& feature) {
  const std::int64_t resolution = group.read_int("resolution");
  if (resolution < 1 || resolution > 1 << 15) {
    throw Error("resolution is " + std::to_string(resolution), group.place());
  }
  feature.resolution = static_cast<int>(resolution);
  feature.extent = group.read_double("extent");
  const std::size_t frames = feature.times.size(), n = static_cast<std::size_t>(resolution);
  const std::vector<float> displacement = read<float>(group, "displacement", {frames, n, n, 3});
  const std::vector<float> alpha = read<float>(group, "alpha", {frames, n, n});
  const Eigen::Index texels = n * n;
  feature.maps.resize(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    feature.maps[i].displacement =
        Eigen::Map<const FloatRows>(displacement.data() + i * n * n * 3, texels, 3);
    feature.maps[i].alpha = Eigen::Map<const Eigen::VectorXf>(alpha.data() + i * n * n, texels);
  }
}

/// Offsets into `rows` rows: from 0, never falling, to the end.
void require_offsets(const std::vector<std::int64_t>& offsets, std::size_t rows,
                     const std::string& where) {
  const bool ordered = std::is_sorted(offsets.begin(), offsets.end());
  if (ordered && offsets.front() == 0 && offsets.back() == static_cast<std::int64_t>(rows)) return;
  throw Error("are no offsets", where, "0, never falling, up to " + std::to_string(rows));
}

void read_meshes(const H5Node& group, Feature& feature) {
  const std::size_t frames = feature.times.size();
  const auto vertex = read<std::int64_t>(group, "vertex_offset", {frames + 1});
  const auto triangle = read<std::int64_t>(group, "triangle_offset", {frames + 1});
  const auto vertices = read_rows<double>(group, "vertices");
  const auto triangles = read_rows<std::int32_t>(group, "triangles");
  require_offsets(vertex, vertices.size() / 3, group.place() + "/vertex_offset");
  require_offsets(triangle, triangles.size() / 3, group.place() + "/triangle_offset");
  feature.meshes.resize(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    feature.meshes[i].V =
        Eigen::Map<const DoubleRows>(vertices.data() + 3 * vertex[i], vertex[i + 1] - vertex[i], 3);
    feature.meshes[i].F = Eigen::Map<const IntRows>(triangles.data() + 3 * triangle[i],
                                                    triangle[i + 1] - triangle[i], 3);
  }
}

Feature read_feature(const H5Node& group, int id) {
  Feature feature;
  feature.id = id;
  feature.name = group.read_text("name");
  const std::string kind = group.read_text("kind");
  if (kind != kDifferential && kind != kIsolated) {
    throw Error("is of the kind '" + kind + "'", group.place(), "differential, isolated");
  }
  feature.kind = kind == kDifferential ? RegionKind::differential : RegionKind::isolated;
  feature.cell = group.read_double("cell");
  feature.times = group.read_block<double>("times", 1).values;
  if (group.read_int("frames") != feature.frame_count()) {
    throw Error("has " + std::to_string(feature.frame_count()) + " times", group.place(),
                std::to_string(group.read_int("frames")) + ", its frames");
  }
  read_placements(group, feature);
  feature.area = group.read_block<double>("area", 1).values;
  feature.volume = group.read_block<double>("volume", 1).values;
  if (feature.kind == RegionKind::differential) {
    read_maps(group, feature);
  } else {
    read_meshes(group, feature);
  }
  return feature;
}

int id_of(const std::string& name, const H5Node& features) {
  const bool digits = !name.empty() && name.size() <= 9 &&
                      name.find_first_not_of("0123456789") == std::string::npos;
  if (!digits) throw Error("has the feature '" + name + "'", features.place(), "whole numbers");
  return std::stoi(name);
}

}  // namespace

std::vector<std::byte> feature_library_bytes(const std::vector<Feature>& features) {
  require_valid(features, "feature library");
  H5File file = H5File::create();
  {
    H5Group root = file.root();
    root.write_attribute("kind", std::string(kFileKind));
    root.write_attribute("schema_version", kSchema);
    H5Group group = root.create_group("features");
    for (const Feature& feature : features) write_feature(group, feature);
  }
  return file.bytes();
}

std::vector<Feature> read_feature_library(const std::filesystem::path& path) {
  const H5Node root = read_hdf5(path);
  if (root.read_text("kind") != kFileKind) throw Error("is no feature library", path.string());
  const std::int64_t schema = root.read_int("schema_version");
  if (schema != kSchema) {
    throw Error("has schema version " + std::to_string(schema), path.string(),
                std::to_string(kSchema));
  }
  const H5Node group = root.open_group("features");
  std::vector<Feature> features;
  for (const std::string& name : group.children()) {
    features.push_back(read_feature(group.open_group(name), id_of(name, group)));
  }
  std::sort(features.begin(), features.end(),
            [](const Feature& a, const Feature& b) { return a.id < b.id; });
  require_valid(features, path.string());
  return features;
}

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

}  // namespace geoprior::fluid
