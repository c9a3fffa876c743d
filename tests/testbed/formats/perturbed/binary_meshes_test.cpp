// Good PLY and STL files with what the formats leave open varied at random.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>

#include "testbed/formats/mesh/ply_reader.h"
#include "testbed/formats/mesh/stl_reader.h"
#include "tests/support/perturbed.h"
#include "tests/support/text_forms.h"
#include "tests/testbed/formats/perturbed/surface_sample.h"

namespace geoprior {
namespace {

using test::blank;
using test::chance;
using test::number_text;
using test::SurfaceSample;

/// Types of PLY by their old and new names, and how many bytes they have.
struct PlyType {
  const char *old_name, *new_name;
  std::size_t bytes;
  bool real;
};
constexpr std::array<PlyType, 8> kPlyTypes{{{"char", "int8", 1, false},
                                            {"uchar", "uint8", 1, false},
                                            {"short", "int16", 2, false},
                                            {"ushort", "uint16", 2, false},
                                            {"int", "int32", 4, false},
                                            {"uint", "uint32", 4, false},
                                            {"float", "float32", 4, true},
                                            {"double", "float64", 8, true}}};

class PlyWriter {
 public:
  PlyWriter(RandomStream& random, const SurfaceSample& sample) : random_(random), sample_(sample) {}

  std::string write() {
    format_ = random_.below(3);
    strips_ = chance(random_, 0.3);
    head_ = std::string("ply\nformat ") +
            std::array{"ascii", "binary_little_endian", "binary_big_endian"}[format_] + " 1.0\n";
    if (chance(random_, 0.5)) head_ += "comment # end_header is not here\nobj_info n\n";
    if (chance(random_, 0.3)) other_element("camera");
    vertices();
    if (chance(random_, 0.3)) other_element("edge");
    if (strips_) {
      strips();
    } else {
      faces();
    }
    if (chance(random_, 0.3)) other_element("material");
    head_ += "end_header\n";
    constexpr std::array<const char*, 4> kEnds{"\n", "\r\n", "\r", "\n"};
    const std::string head = test::with_line_ends(head_, kEnds[random_.below(kEnds.size())]);
    const std::string data =
        format_ == 0 && chance(random_, 0.3) ? test::with_line_ends(data_, "\r\n") : data_;
    return (chance(random_, 0.2) ? test::kByteOrderMark : "") + head + data;
  }
  [[nodiscard]] std::size_t other_elements() const { return other_elements_; }
  [[nodiscard]] bool moving() const { return moving_; }

 private:
  const PlyType& integer_type(std::size_t largest) {
    const std::size_t first = largest < 128 ? 0 : largest < 32768 ? 2 : 4;
    return kPlyTypes[first + random_.below(static_cast<std::uint32_t>(6 - first))];
  }
  const PlyType& real_type() { return kPlyTypes[6 + random_.below(2)]; }
  std::string name_of(const PlyType& type) {
    return chance(random_, 0.5) ? type.old_name : type.new_name;
  }

  void element(const std::string& name, std::size_t count) {
    head_ += "element " + name + blank(random_) + std::to_string(count) + "\n";
  }
  const PlyType& property(const std::string& name, const PlyType& type) {
    head_ += "property " + name_of(type) + blank(random_) + name + "\n";
    return type;
  }

  void put(double x, const PlyType& type) {
    if (format_ == 0) {
      const bool fresh = data_.empty() || data_.ends_with('\n');
      data_ += (fresh                   ? ""
                : chance(random_, 0.05) ? "\n"
                                        : blank(random_)) +
               (type.real ? number_text(random_, x) : std::to_string(static_cast<int>(x)));
      return;
    }
    std::array<char, 8> bytes{};
    if (type.real && type.bytes == 4) {
      const auto value = static_cast<float>(x);
      std::memcpy(bytes.data(), &value, 4);
    } else if (type.real) {
      std::memcpy(bytes.data(), &x, 8);
    } else {
      const auto value = static_cast<std::int32_t>(x);
      std::memcpy(bytes.data(), &value, 4);
    }
    if (format_ == 2)
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.bytes));
    data_.append(bytes.data(), type.bytes);
  }
  void end_row() {
    if (format_ == 0) data_ += "\n";
  }

  void vertices() {
    element("vertex", sample_.points.size());
    std::vector<std::string> names{"x", "y", "z"};
    if (chance(random_, 0.5)) names.insert(names.end(), {"red", "quality"});
    moving_ = chance(random_, 0.3);
    if (moving_) names.insert(names.end(), {"vx", "vy", "vz"});
    test::shuffle(random_, names);
    std::vector<const PlyType*> types;
    for (const std::string& name : names) types.push_back(&property(name, real_type()));
    for (const Eigen::Vector3d& x : sample_.points) {
      const std::map<std::string, double> values{{"x", x.x()},   {"y", x.y()},    {"z", x.z()},
                                                 {"vx", -x.x()}, {"vy", -x.y()},  {"vz", -x.z()},
                                                 {"red", 9},     {"quality", 0.5}};
      for (std::size_t i = 0; i < names.size(); ++i) put(values.at(names[i]), *types[i]);
      end_row();
    }
  }

  void faces() {
    element("face", sample_.faces.size());
    const bool flags_first = chance(random_, 0.3), colour_last = chance(random_, 0.3);
    if (flags_first) property("flags", kPlyTypes[1]);
    const PlyType &count = integer_type(4), &index = integer_type(sample_.points.size());
    head_ += "property list " + name_of(count) + " " + name_of(index) + " " +
             (chance(random_, 0.5) ? "vertex_indices" : "vertex_index") + "\n";
    if (colour_last) property("red", kPlyTypes[1]);
    for (const std::vector<int>& face : sample_.faces) {
      if (flags_first) put(3, kPlyTypes[1]);
      put(static_cast<double>(face.size()), count);
      for (const int v : face) put(v, index);
      if (colour_last) put(200, kPlyTypes[1]);
      end_row();
    }
  }

  /// One list for all, its strips parted by -1: a quadrangle is one of four, a triangle of three.
  void strips() {
    std::vector<int> list;
    for (const std::vector<int>& f : sample_.faces) {
      if (!list.empty()) list.push_back(-1);
      if (f.size() == 3) list.insert(list.end(), f.begin(), f.end());
      if (f.size() == 4) list.insert(list.end(), {f[0], f[1], f[3], f[2]});
    }
    const bool two_lists = chance(random_, 0.3);
    if (chance(random_, 0.3)) {
      element("face", 0);
      head_ += "property list uchar int vertex_indices\n";
    }
    element("tristrips", two_lists ? 2 : 1);
    head_ += "property list int int vertex_indices\n";
    put(static_cast<double>(list.size()), kPlyTypes[4]);
    for (const int v : list) put(v, kPlyTypes[4]);
    end_row();
    if (two_lists) put(0, kPlyTypes[4]);
    end_row();
  }

  void other_element(const std::string& name) {
    ++other_elements_;
    element(name, 2);
    property("a", kPlyTypes[7]);
    head_ += "property list uchar short words\n";
    for (int i = 0; i < 2; ++i) {
      put(0.5, kPlyTypes[7]);
      put(i, kPlyTypes[1]);
      for (int k = 0; k < i; ++k) put(13, kPlyTypes[2]);
      end_row();
    }
  }

  RandomStream& random_;
  const SurfaceSample& sample_;
  std::string head_, data_;
  std::uint32_t format_ = 0;  ///< ascii, little, big
  bool strips_ = false, moving_ = false;
  std::size_t other_elements_ = 0;
};

TEST(LongPerturbedFiles, OfPlyAreReadRight) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "ply");
    const SurfaceSample sample = test::surface_sample(random, false);
    PlyWriter writer(random, sample);
    const MeshFile read = parse_ply(writer.write(), "a.ply");
    test::expect_sample(read, sample);
    EXPECT_EQ(read.velocity, writer.moving() ? Eigen::MatrixX3d(-read.mesh.V)
                                             : Eigen::MatrixX3d(Eigen::MatrixX3d::Zero(0, 3)));
    EXPECT_EQ(read.notes.size(), writer.other_elements());
    if (::testing::Test::HasFailure()) return;
  }
}

class StlWriter {
 public:
  StlWriter(RandomStream& random, const SurfaceSample& sample) : random_(random), sample_(sample) {}

  std::string binary() {
    std::string out(chance(random_, 0.5) ? "solid made by hand" : "COLOR=");
    out.resize(80, chance(random_, 0.5) ? ' ' : '\0');
    const auto triangles = static_cast<std::uint32_t>(sample_.faces.size());
    append(out, triangles);
    for (const std::vector<int>& face : sample_.faces) {
      for (int i = 0; i < 3; ++i) append(out, chance(random_, 0.5) ? 0.0F : 1.0F);  // no normal
      for (const int v : turned(face)) {
        for (const double c : sample_.points[v]) append(out, static_cast<float>(c));
      }
      append(out, static_cast<std::uint16_t>(random_.below(65536)));
    }
    return out;
  }

  std::string text() {
    upper_ = chance(random_, 0.2);
    std::size_t in_solid = 0;
    begin_solid();
    for (const std::vector<int>& face : sample_.faces) {
      if (in_solid++ > 0 && chance(random_, 0.1)) {
        line("endsolid");
        begin_solid();
      }
      line("facet normal 0 0 0");
      line("outer loop");
      for (const int v : turned(face)) {
        const Eigen::Vector3d& x = sample_.points[v];
        std::string numbers = "vertex";
        for (const double c : x) numbers += blank(random_) + number_text(random_, c);
        line(numbers);
      }
      line("endloop");
      line("endfacet");
    }
    line("endsolid name");
    return text_;
  }
  [[nodiscard]] int solids() const { return solids_; }

 private:
  template <class T>
  static void append(std::string& out, T value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::vector<int> turned(std::vector<int> face) {
    std::rotate(face.begin(), face.begin() + random_.below(3), face.end());
    return face;
  }
  void begin_solid() {
    ++solids_;
    line(chance(random_, 0.5) ? "solid" : "solid part facet");
  }
  void line(std::string words) {
    for (char& c : words) {
      if (upper_ && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    }
    text_ += (chance(random_, 0.5) ? blank(random_) : "") + words + "\n";
    if (chance(random_, 0.05)) text_ += "\n";
  }

  RandomStream& random_;
  const SurfaceSample& sample_;
  std::string text_;
  bool upper_ = false;
  int solids_ = 0;
};

/// The same triangles in the same order, whatever numbers their corners have.
void expect_same_triangles(const TriMesh& mesh, const SurfaceSample& sample) {
  ASSERT_EQ(mesh.F.rows(), std::ssize(sample.faces));
  EXPECT_EQ(mesh.V.rows(), std::ssize(sample.points)) << "corners in one place are one vertex";
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    bool found = false;
    for (int turn = 0; turn < 3; ++turn) {
      bool same = true;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d x = mesh.V.row(mesh.F(t, (k + turn) % 3));
        same = same && x == sample.points[sample.faces[t][k]];
      }
      found = found || same;
    }
    EXPECT_TRUE(found) << "triangle " << t;
  }
}

TEST(LongPerturbedFiles, OfStlAreReadRight) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "stl");
    const SurfaceSample sample = test::surface_sample(random, true);
    StlWriter writer(random, sample);
    if (chance(random, 0.5)) {
      const MeshFile read = parse_stl(writer.binary(), "a.stl");
      expect_same_triangles(read.mesh, sample);
      EXPECT_TRUE(read.notes.empty());
    } else {
      const std::vector<test::TextForm> forms = test::text_forms(writer.text());
      const MeshFile read = parse_stl(forms[random.below(5)].bytes, "a.stl");
      expect_same_triangles(read.mesh, sample);
      EXPECT_EQ(read.notes.size(), writer.solids() > 1 ? 1U : 0U);
    }
    if (::testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace geoprior
