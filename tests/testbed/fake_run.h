#pragma once

// Runs made by hand, for the tests of what reads runs: pictures and exports.

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/frame.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/journal/sha256.h"

namespace geoprior {

/// A folder of its own for the life of a test.
class TestFolder {
 public:
  TestFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "geoprior-view-XXXXXX").string();
    path = ::mkdtemp(pattern.data());
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path path;
};

/// Axis-aligned box, closed, outward oriented.
inline Part make_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Part part;
  part.points.resize(8, 3);
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      part.points(i, axis) = ((i >> axis) & 1) != 0 ? high[axis] : low[axis];
    }
  }
  part.triangles.resize(12, 3);
  part.triangles << 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3,
      0, 3, 1, 4, 5, 7, 4, 7, 6;
  return part;
}

/// A square of two triangles in the plane z = 0, classes 0 and 1, seen from above.
inline Part two_classes() {
  Part part;
  part.points.resize(4, 3);
  part.points << -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0;
  part.triangles.resize(2, 3);
  part.triangles << 0, 1, 2, 0, 2, 3;
  part.arrays.push_back({"kind", "1", NamedArray::On::cells, Eigen::Vector2d(0, 1)});
  return part;
}

/// Both parts as one mesh.
inline Part join(const Part& a, const Part& b) {
  Part part;
  part.points.resize(a.points.rows() + b.points.rows(), 3);
  part.points << a.points, b.points;
  part.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  part.triangles << a.triangles, (b.triangles.array() + static_cast<int>(a.points.rows())).matrix();
  return part;
}

inline void add_frame(VariantRecord& variant, const std::filesystem::path& folder, double parameter,
                      const Part& part, const std::string& name = "surface") {
  std::array<char, 16> index{};
  std::snprintf(index.data(), index.size(), "_%04zu", variant.frames.size());
  const std::string file =
      "frames/default/" + variant.name + "/" + name + index.data() + part_extension(part);
  make_folders((folder / file).parent_path());
  const std::string xml = part_to_vtk_xml(part, parameter);
  write_file_atomically(folder / file, std::string_view(xml));
  variant.frames.push_back({parameter, {{file, sha256(xml)}}});
}

/// run.h5, and a journal that says so.
inline void write_fake_run(const RunRecord& record, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.h5";
  write_run_file(record, file);
  const std::string lines =
      journal::to_text(journal::RunLine{3, record.experiment_id, record.spec_hash, ""}) + '\n' +
      journal::to_text(journal::ResultLine{{"run.h5", sha256_of_file(file)}}) + '\n';
  write_file_atomically(folder / "journal.jsonl", std::string_view(lines));
}

/// Two variants, three frames at 0, 45 and 90 degrees: boxes that grow in x, with an array
/// "height" on the points.
/// @param height_m  of the boxes, in z
inline RunRecord make_fake_run(const std::filesystem::path& folder, double height_m = 1.0 / 3) {
  RunRecord record;
  record.experiment_id = "test/boxes";
  record.title = "Boxes";
  record.content_sha256 = std::string(64, 'b');
  CaseRecord c;
  c.name = "default";
  c.parameter_name = "angle";
  c.parameter_unit = "deg";
  for (const std::string name : {"first-box", "second-box"}) {
    VariantRecord variant;
    variant.name = name;
    variant.method = "box";
    variant.role = "method";
    variant.status = "done";
    for (int i = 0; i < 3; ++i) {
      Part part = make_box({0, 0, 0}, {1 + 0.1 * i, 1, height_m});
      part.arrays.push_back({"height", "m", NamedArray::On::points, part.points.col(1)});
      add_frame(variant, folder, 45.0 * i, part);
    }
    c.variants.push_back(variant);
  }
  record.cases.push_back(c);
  write_fake_run(record, folder);
  return record;
}

}  // namespace geoprior
