// Good .vtp, .pvtp, .pvd and .vtp.series files with what they leave open varied at random.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/sequence/find.h"
#include "tests/support/perturbed.h"
#include "tests/support/text_forms.h"
#include "tests/testbed/formats/perturbed/surface_sample.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::chance;
using test::SurfaceSample;

std::string base64_of(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[at + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

/// Writes polygonal data: ascii, base64 or appended raw; either byte order; header of 4 or 8 bytes;
/// points of either size; polygons and strips; ghost cells, vertex cells and lines besides.
class VtpWriter {
 public:
  VtpWriter(RandomStream& random, const SurfaceSample& sample) : random_(random), sample_(sample) {}

  /// Faces that another piece has.
  std::vector<std::vector<int>> ghosts;

  std::string write() {
    mode_ = random_.below(3);
    big_ = chance(random_, 0.3);
    wide_header_ = chance(random_, 0.5);
    const std::string inside = piece();
    std::string text = "<?xml version=\"1.0\"?>\n";
    if (chance(random_, 0.3)) text += "<!-- made by hand > -->\n";
    text += std::string("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"") +
            (big_ ? "BigEndian" : "LittleEndian") + "\" header_type=\"" +
            (wide_header_ ? "UInt64" : "UInt32") + "\">\n<PolyData>\n" + inside + "</PolyData>\n";
    if (mode_ == 2)
      text += "<AppendedData encoding=\"raw\">\n_" + appended_ + "\n</AppendedData>\n";
    return (chance(random_, 0.2) ? test::kByteOrderMark : "") + text + "</VTKFile>\n";
  }
  /// One piece of a file of several.
  std::string ascii_piece() {
    mode_ = 0;
    return piece();
  }
  [[nodiscard]] std::size_t notes() const {
    return (stray_ > 0) + (stray_lines_ > 0) + (ghosts.empty() ? 0U : 1U);
  }

 private:
  static std::string count(std::size_t n) { return std::to_string(n); }

  std::string piece() {
    split_faces();
    if (chance(random_, 0.4)) stray_ = 1 + random_.below(3);
    if (chance(random_, 0.4)) stray_lines_ = 1 + random_.below(3);
    const std::string inside = points() + cells() + cell_data() + point_data();
    return "<Piece NumberOfPoints=\"" + count(sample_.points.size()) + "\" NumberOfVerts=\"" +
           count(stray_) + "\" NumberOfLines=\"" + count(stray_lines_) + "\" NumberOfStrips=\"" +
           count(strips_.size()) + "\" NumberOfPolys=\"" + count(polygons_.size()) + "\">\n" +
           inside + "</Piece>\n";
  }

  void split_faces() {
    std::vector<std::pair<std::vector<int>, int>> all;
    for (const auto& face : sample_.faces) all.emplace_back(face, 0);
    for (const auto& face : ghosts) all.emplace_back(face, 1);
    test::shuffle(random_, all);
    const bool with_strips = chance(random_, 0.4);
    for (const auto& [face, ghost] : all) {
      const bool strip = with_strips && chance(random_, 0.3);
      (strip ? strip_ghosts_ : polygon_ghosts_).push_back(ghost);
      if (strip && face.size() == 4) {
        strips_.push_back({face[0], face[1], face[3], face[2]});
      } else {
        (strip ? strips_ : polygons_).push_back(face);
      }
    }
  }

  template <class T>
  void append(std::string& out, T value) const {
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (big_) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
  }

  template <class T>
  std::string array(const std::string& type, const std::string& name, int components,
                    const std::vector<T>& values) {
    std::string tag = "<DataArray type=\"" + type + "\" Name=\"" + name +
                      "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"";
    if (mode_ == 0) {
      std::string text;
      for (const T x : values) {
        text += (chance(random_, 0.1) ? "\n" : " ");
        text += std::is_floating_point_v<T> ? test::number_text(random_, static_cast<double>(x))
                                            : std::to_string(static_cast<long long>(x));
      }
      return tag + "ascii\">" + text + "\n</DataArray>\n";
    }
    std::string bytes, header;
    for (const T x : values) append(bytes, x);
    if (wide_header_) {
      append(header, static_cast<std::uint64_t>(bytes.size()));
    } else {
      append(header, static_cast<std::uint32_t>(bytes.size()));
    }
    if (mode_ == 1) return tag + "binary\">\n" + base64_of(header + bytes) + "\n</DataArray>\n";
    tag += "appended\" offset=\"" + count(appended_.size()) + "\"/>\n";
    appended_ += header + bytes;
    return tag;
  }

  std::string indices(const std::string& name, const std::vector<std::int64_t>& values) {
    if (chance(random_, 0.5)) return array("Int64", name, 1, values);
    return array("Int32", name, 1, std::vector<std::int32_t>(values.begin(), values.end()));
  }

  std::string points() {
    std::vector<double> values;
    for (const Eigen::Vector3d& x : sample_.points) values.insert(values.end(), x.begin(), x.end());
    return "<Points>\n" +
           (chance(random_, 0.5)
                ? array("Float64", "Points", 3, values)
                : array("Float32", "Points", 3, std::vector<float>(values.begin(), values.end()))) +
           "</Points>\n";
  }

  std::string cells() {
    const auto list = [&](const std::string& name, const std::vector<std::vector<int>>& faces) {
      std::vector<std::int64_t> connectivity, offsets;
      for (const std::vector<int>& face : faces) {
        connectivity.insert(connectivity.end(), face.begin(), face.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      }
      return "<" + name + ">\n" + indices("connectivity", connectivity) +
             indices("offsets", offsets) + "</" + name + ">\n";
    };
    std::vector<std::string> lists{
        list("Polys", polygons_), list("Strips", strips_),
        list("Verts", std::vector<std::vector<int>>(stray_, {0})),
        list("Lines", std::vector<std::vector<int>>(stray_lines_, {0, 1}))};
    test::shuffle(random_, lists);
    std::string text;
    for (const std::string& one : lists) text += one;
    return text;
  }

  /// Rows of cells go by kind: vertices, lines, polygons, strips.
  std::string cell_data() {
    if (ghosts.empty()) return "";
    // Duplicate, refined, hidden; none, or a connectivity that does not matter here.
    constexpr std::array<std::uint8_t, 3> kGone{1, 8, 32}, kStays{0, 2, 4};
    std::vector<std::uint8_t> types(stray_ + stray_lines_, 0);
    std::vector<float> ids(stray_ + stray_lines_ + polygons_.size() + strips_.size(), 1.5F);
    for (const auto& flags : {polygon_ghosts_, strip_ghosts_}) {
      for (const int ghost : flags)
        types.push_back((ghost != 0 ? kGone : kStays)[random_.below(3)]);
    }
    return "<CellData>\n" + array("Float32", "id", 1, ids) +
           array("UInt8", "vtkGhostType", 1, types) + "</CellData>\n";
  }

  std::string point_data() {
    if (!chance(random_, 0.5)) return "";
    const std::vector<double> ones(3 * sample_.points.size(), 0.25);
    return "<PointData Vectors=\"velocity\">\n" + array("Float64", "velocity", 3, ones) +
           "</PointData>\n";
  }

  RandomStream& random_;
  const SurfaceSample& sample_;
  std::uint32_t mode_ = 0;  ///< ascii, base64, appended
  bool big_ = false, wide_header_ = false;
  std::vector<std::vector<int>> polygons_, strips_;
  std::vector<int> polygon_ghosts_, strip_ghosts_;
  std::size_t stray_ = 0, stray_lines_ = 0;
  std::string appended_;
};

class LongPerturbedVtk : public test::ScratchFolder {};

TEST_F(LongPerturbedVtk, PolyDataAreReadRight) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "vtp");
    SurfaceSample sample = test::surface_sample(random, false);
    VtpWriter writer(random, sample);
    while (sample.faces.size() > 2 && chance(random, 0.4)) {
      writer.ghosts.push_back(sample.faces.back());
      sample.faces.pop_back();
    }
    const MeshFile read = read_mesh_file(write("a.vtp", writer.write()));
    test::expect_sample(read, sample);
    EXPECT_EQ(read.notes.size(), writer.notes());
    if (::testing::Test::HasFailure()) FAIL() << writer.write();
  }
}

// VTK's reader takes the arrays of the first piece: ghosts that only the second one has count too.
TEST_F(LongPerturbedVtk, GhostsOfSomePiecesAreLeftOut) {
  for (int seed = 0; seed < perturbed_files() / 4 + 1; ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "ghosts of pieces");
    std::string text =
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n";
    double area = 0;
    const std::uint32_t pieces = 2 + random.below(3), with_ghosts = random.below(pieces);
    for (std::uint32_t p = 0; p < pieces; ++p) {
      SurfaceSample sample = test::surface_sample(random, false);
      VtpWriter writer(random, sample);
      if (p == with_ghosts) {
        writer.ghosts.push_back(sample.faces.back());
        sample.faces.pop_back();
      }
      text += writer.ascii_piece();
      area += sample.area();
    }
    const MeshFile read = read_mesh_file(write("a.vtp", text + "</PolyData>\n</VTKFile>\n"));
    EXPECT_NEAR(test::triangles_area(read.mesh), area, 1e-12 * (1 + area));
    EXPECT_FALSE(read.notes.empty());
    if (::testing::Test::HasFailure()) FAIL() << text;
  }
}

/// A time step of a collection and the files that hold it.
struct Step {
  double time = 0;
  std::vector<std::string> files;
};

/// Steps of one to three parts in the order in which nobody needs them.
std::vector<Step> some_steps(RandomStream& random, const std::string& stem) {
  std::vector<Step> steps;
  const std::uint32_t parts = 1 + random.below(3), count = 1 + random.below(6);
  double time = random.below(8) / 8.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    Step& step = steps.emplace_back();
    step.time = time;
    time += (1 + random.below(8)) / 8.0;
    for (std::uint32_t p = 0; p < parts; ++p)
      step.files.push_back(stem + std::to_string(i) + "_" + std::to_string(p) + ".vtp");
  }
  return steps;
}

std::string path_text(RandomStream& random, const std::string& file) {
  constexpr std::array<const char*, 4> kFolders{"", "./", ".\\", "sub\\..\\"};
  return kFolders[random.below(kFolders.size())] + file;
}

std::string collection_text(RandomStream& random, const std::vector<Step>& steps) {
  std::vector<std::string> lines;
  for (const Step& step : steps) {
    for (std::size_t part = 0; part < step.files.size(); ++part) {
      const std::string time = test::number_text(random, step.time);
      std::vector<std::string> attributes{"timestep=\"" + time + "\"", "group=\"\"",
                                          "part=\"" + std::to_string(part) + "\"",
                                          "file='" + path_text(random, step.files[part]) + "'"};
      test::shuffle(random, attributes);
      std::string line = "<DataSet";
      for (const std::string& attribute : attributes) line += " " + attribute;
      lines.push_back(line + (chance(random, 0.5) ? "/>\n" : "></DataSet>\n"));
    }
  }
  test::shuffle(random, lines);
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n";
  if (chance(random, 0.3)) text += "<!-- <DataSet timestep=\"9\" file=\"no.vtp\"/> -->\n";
  text += "<Collection>\n";
  for (const std::string& line : lines) text += line;
  return text + "</Collection>\n</VTKFile>\n";
}

std::string series_text(RandomStream& random, const std::vector<Step>& steps) {
  std::vector<std::string> entries;
  for (const Step& step : steps) {
    std::string path = path_text(random, step.files.front());
    for (std::size_t at = path.find('\\'); at != std::string::npos; at = path.find('\\', at + 2))
      path.insert(at, "\\");
    const std::string name = "\"name\" : \"" + path + "\"",
                      time = "\"time\" : " + std::to_string(step.time);
    entries.push_back(chance(random, 0.5) ? name + ", " + time : time + ",\n" + name);
  }
  test::shuffle(random, entries);
  std::string text = "{\n  \"file-series-version\" : \"1.0\",\n  \"files\" : [\n";
  for (std::size_t i = 0; i < entries.size(); ++i)
    text += "    { " + entries[i] + (i + 1 < entries.size() ? " },\n" : " }\n");
  return text + "  ]\n}\n";
}

void expect_steps(const FoundFiles& found, const std::vector<Step>& steps,
                  const std::filesystem::path& folder, bool all_parts) {
  ASSERT_EQ(found.files.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const FoundFile& frame = found.files[i];
    EXPECT_EQ(frame.time, steps[i].time);
    EXPECT_EQ(frame.number, static_cast<int>(i));
    std::vector<std::filesystem::path> files{frame.file};
    files.insert(files.end(), frame.further.begin(), frame.further.end());
    ASSERT_EQ(files.size(), all_parts ? steps[i].files.size() : 1U);
    for (std::size_t part = 0; part < files.size(); ++part)
      EXPECT_TRUE(std::filesystem::equivalent(files[part], folder / steps[i].files[part]));
  }
}

TEST_F(LongPerturbedVtk, CollectionsAndSeriesAreReadRight) {
  std::filesystem::create_directory(folder() / "sub");
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "pvd");
    const std::vector<Step> steps = some_steps(random, "s");
    for (const Step& step : steps) {
      for (const std::string& file : step.files) write(file, "");
    }
    const auto form = [&](const std::string& text) {
      return test::text_forms(text)[random.below(5)].bytes;
    };
    const auto pvd = write("a.pvd", form(collection_text(random, steps)));
    const FoundFiles found = find_in_collection(pvd, "surface");
    expect_steps(found, steps, folder(), true);
    EXPECT_EQ(found.warnings.size(), steps.front().files.size() > 1 ? 1U : 0U);
    const auto series = write("a.vtp.series", form(series_text(random, steps)));
    expect_steps(find_in_collection(series, "surface"), steps, folder(), false);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST_F(LongPerturbedVtk, PiecesAreJoinedInTheirOrder) {
  for (int seed = 0; seed < perturbed_files() / 4 + 1; ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "pvtp");
    std::string text =
        "<VTKFile type=\"PPolyData\" version=\"0.1\">\n<PPolyData GhostLevel=\"1\">\n";
    double area = 0;
    Eigen::Index points = 0, triangles = 0;
    const std::uint32_t pieces = 1 + random.below(3);
    for (std::uint32_t p = 0; p < pieces; ++p) {
      SurfaceSample sample = test::surface_sample(random, false);
      VtpWriter writer(random, sample);
      writer.ghosts.push_back(sample.faces.back());
      sample.faces.pop_back();
      const std::string name = "a_" + std::to_string(p) + ".vtp";
      write(name, writer.write());
      text += "<Piece Source=\"" + path_text(random, name) + "\"/>\n";
      area += sample.area();
      points += std::ssize(sample.points);
      triangles += static_cast<Eigen::Index>(sample.triangle_count());
    }
    std::filesystem::create_directories(folder() / "sub");
    const MeshFile read = read_mesh_file(write("a.pvtp", text + "</PPolyData>\n</VTKFile>\n"));
    EXPECT_EQ(read.mesh.V.rows(), points);
    EXPECT_EQ(read.mesh.F.rows(), triangles);
    EXPECT_NEAR(test::triangles_area(read.mesh), area, 1e-12 * (1 + area));
    EXPECT_EQ(files_of_mesh(folder() / "a.pvtp").size(), 1 + pieces);
    if (::testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace geoprior
