// Frames leave a run exactly, and never into someone else's folder.

#include "testbed/view/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "testbed/view/mesh_text.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

int count_files(const fs::path& folder, const std::string& extension) {
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    count += entry.path().extension() == extension ? 1 : 0;
  }
  return count;
}

TEST(Export, ObjKeepsEveryBitOfThePositions) {
  const TestFolder folder;
  make_fake_run(folder.path);
  export_run(OpenedRun(folder.path), "obj", folder.path / "out");
  EXPECT_EQ(count_files(folder.path / "out", ".obj"), 6);
  std::ifstream in(folder.path / "out/default/second-box/frames/surface_0002.obj");
  const Part expected = make_box({0, 0, 0}, {1.2, 1, 1.0 / 3});
  std::string line;
  Eigen::Index vertex = 0;
  Eigen::Index triangle = 0;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Eigen::RowVector3d p;
      words >> p[0] >> p[1] >> p[2];
      EXPECT_EQ(p, expected.points.row(vertex++));
    } else if (kind == "f") {
      Eigen::RowVector3i f;
      words >> f[0] >> f[1] >> f[2];
      EXPECT_EQ((f.array() - 1).matrix(), expected.triangles.row(triangle++));
    }
  }
  EXPECT_EQ(vertex, 8);
  EXPECT_EQ(triangle, 12);
}

TEST(Export, PlyHoldsPositionsArraysAndTriangles) {
  Part part = make_box({0, 0, 0}, {1, 2, 1.0 / 3});
  part.arrays.push_back({"hinge energy", "J", NamedArray::On::points, part.points.col(1)});
  const std::string ply = part_to_ply(part, "two\nlines");
  EXPECT_THAT(ply, StartsWith("ply\nformat binary_little_endian 1.0\ncomment two lines\n"
                              "element vertex 8\n"));
  EXPECT_THAT(ply, HasSubstr("property double hinge_energy\nelement face 12\n"));
  const std::string end = "end_header\n";
  const std::size_t body = ply.find(end) + end.size();
  ASSERT_EQ(ply.size() - body, 8u * 4u * 8u + 12u * 13u);
  for (std::size_t i = 0; i < 8; ++i) {
    std::array<double, 4> row{};
    std::memcpy(row.data(), ply.data() + body + i * sizeof(row), sizeof(row));
    const Eigen::Index vertex = i;
    EXPECT_EQ(Eigen::RowVector3d(row[0], row[1], row[2]), part.points.row(vertex));
    EXPECT_EQ(row[3], part.points(vertex, 1));
  }
  std::array<std::int32_t, 3> last{};
  std::memcpy(last.data(), ply.data() + ply.size() - sizeof(last), sizeof(last));
  EXPECT_EQ(last[2], part.triangles(11, 2));
}

TEST(Export, GlbIsOneAnimationAVariant) {
  const TestFolder folder;
  make_fake_run(folder.path);
  export_run(OpenedRun(folder.path), "glb", folder.path / "out");
  EXPECT_EQ(count_files(folder.path / "out", ".glb"), 2);
  const std::string bytes = read_whole_file(folder.path / "out/default/first-box/surface.glb");
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
}

TEST(Export, GlbOfChangingTopologyIsOneFileAFrame) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  VariantRecord& variant = record.cases[0].variants[0];
  add_frame(variant, folder.path, 135,
            join(make_box({0, 0, 0}, {1, 1, 1}), make_box({2, 0, 0}, {3, 1, 1})));
  write_fake_run(record, folder.path);
  export_run(OpenedRun(folder.path), "glb", folder.path / "out");
  EXPECT_EQ(count_files(folder.path / "out/default/first-box", ".glb"), 4);
  EXPECT_EQ(count_files(folder.path / "out/default/second-box", ".glb"), 1);
}

TEST(Export, ForeignFolderIsRefusedAndLeftAlone) {
  const TestFolder folder;
  make_fake_run(folder.path);
  const fs::path out = folder.path / "mine";
  fs::create_directories(out);
  std::ofstream(out / "thesis.tex") << "years of work";
  EXPECT_THAT(test::error_of([&] { export_run(OpenedRun(folder.path), "obj", out); }),
              HasSubstr(out.string()));
  EXPECT_EQ(count_files(out, ".obj"), 0);
  EXPECT_EQ(read_whole_file(out / "thesis.tex"), "years of work");
}

TEST(Export, AnEarlierExportMayBeReplaced) {
  const TestFolder folder;
  make_fake_run(folder.path);
  export_run(OpenedRun(folder.path), "ply", folder.path / "out");
  EXPECT_NO_THROW(export_run(OpenedRun(folder.path), "ply", folder.path / "out"));
}

TEST(Export, UnknownFormatListsTheAllowedOnes) {
  const TestFolder folder;
  make_fake_run(folder.path);
  EXPECT_THAT(
      test::error_of([&] { export_run(OpenedRun(folder.path), "stl", folder.path / "out"); }),
      HasSubstr("obj, ply, glb"));
  EXPECT_FALSE(fs::exists(folder.path / "out"));
}

}  // namespace
}  // namespace geoprior
