// Good OBJ and OFF files with what the formats leave open varied at random.

#include <gtest/gtest.h>

#include "testbed/formats/mesh/obj_reader.h"
#include "testbed/formats/mesh/off_reader.h"
#include "tests/support/perturbed.h"
#include "tests/support/text_forms.h"
#include "tests/testbed/formats/perturbed/surface_sample.h"

namespace geoprior {
namespace {

using test::blank;
using test::chance;
using test::number_text;
using test::SurfaceSample;

std::string any_form(RandomStream& random, const std::string& text) {
  const std::vector<test::TextForm> forms = test::text_forms(text);
  return forms[random.below(static_cast<std::uint32_t>(forms.size()))].bytes;
}

/// Writes OBJ: numbering from either end, corners with and without further numbers, statements in
/// any order that keeps those of a kind, continued lines.
class ObjWriter {
 public:
  ObjWriter(RandomStream& random, const SurfaceSample& sample) : random_(random), sample_(sample) {}

  std::string write() {
    std::size_t face = 0;
    const bool mixed = chance(random_, 0.5);
    for (written_ = 0; written_ < sample_.points.size(); ++written_) {
      other_statement();
      vertex(sample_.points[written_]);
      while (mixed && face < sample_.faces.size() && may_follow(sample_.faces[face])) {
        add_face(sample_.faces[face++], written_ + 1);
      }
    }
    for (; face < sample_.faces.size(); ++face) {
      other_statement();
      add_face(sample_.faces[face], written_);
    }
    if (chance(random_, 0.5)) text_.pop_back();  // no line end at the end
    return text_;
  }
  /// Statements that a note must name.
  [[nodiscard]] bool has_lines() const { return has_lines_; }

 private:
  /// A face may come early where all it names is there.
  [[nodiscard]] bool may_follow(const std::vector<int>& face) const {
    return std::all_of(face.begin(), face.end(),
                       [&](int v) { return static_cast<std::size_t>(v) <= written_; });
  }

  void line(const std::vector<std::string>& words) {
    if (chance(random_, 0.1)) text_ += blank(random_);
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (i > 0) text_ += chance(random_, 0.05) ? blank(random_) + "\\\n" : blank(random_);
      text_ += words[i];
    }
    if (chance(random_, 0.1)) text_ += blank(random_);
    if (chance(random_, 0.1)) text_ += " # C:\\folder\\";
    text_ += "\n";
  }

  void vertex(const Eigen::Vector3d& x) {
    std::vector<std::string> words{"v"};
    for (const double c : x) words.push_back(number_text(random_, c));
    if (chance(random_, 0.2)) words.emplace_back("1.0");                        // weight
    if (chance(random_, 0.2)) words.insert(words.end(), {"0.5", "0.25", "1"});  // colour
    line(words);
  }

  void other_statement() {
    static const std::vector<std::vector<std::string>> kOthers{{"o", "name"},
                                                               {"g", "a", "b"},
                                                               {"s", "off"},
                                                               {"usemtl", "m"},
                                                               {"mtllib", "m.mtl"},
                                                               {"vt", "0.5", "0"},
                                                               {"vn", "0", "0", "1"},
                                                               {"#", "v", "9", "9", "9"},
                                                               {""},
                                                               {"vp", "1", "2"},
                                                               {"l", "1", "2"}};
    if (!chance(random_, 0.4)) return;
    const std::vector<std::string>& words =
        kOthers[random_.below(static_cast<std::uint32_t>(kOthers.size()))];
    if (words[0] == "l") has_lines_ = true;
    if (words[0] == "#") {
      text_ += "# v 9 9 9\\\n";
    } else {
      line(words);
    }
    if (words[0] == "vt") ++texture_;
    if (words[0] == "vn") ++normals_;
  }

  void add_face(std::vector<int> face, std::size_t so_far) {
    std::rotate(face.begin(), face.begin() + random_.below(static_cast<std::uint32_t>(face.size())),
                face.end());
    std::vector<std::string> words{"f"};
    const bool backwards = chance(random_, 0.3);
    for (const int v : face) {
      std::string word = std::to_string(backwards ? v - static_cast<int>(so_far) : v + 1);
      const bool textured = texture_ > 0 && chance(random_, 0.5);
      if (textured) word += "/" + std::to_string(1 + random_.below(texture_));
      if (normals_ > 0 && chance(random_, 0.5))
        word += (textured ? "/" : "//") + std::to_string(1 + random_.below(normals_));
      words.push_back(word);
    }
    line(words);
  }

  RandomStream& random_;
  const SurfaceSample& sample_;
  std::string text_;
  std::size_t written_ = 0;
  std::uint32_t texture_ = 0, normals_ = 0;
  bool has_lines_ = false;
};

TEST(LongPerturbedFiles, OfObjAreReadRight) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "obj");
    const SurfaceSample sample = test::surface_sample(random, false);
    ObjWriter writer(random, sample);
    const std::string text = any_form(random, writer.write());
    const MeshFile read = parse_obj(text, "a.obj");
    test::expect_sample(read, sample);
    EXPECT_EQ(read.notes.size(), writer.has_lines() ? 1U : 0U);
    if (::testing::Test::HasFailure()) FAIL() << text;
  }
}

/// Writes OFF: with and without its word, glued, prefixed, edges counted or not, a vertex and a
/// face a line or any lines, colours of faces.
class OffWriter {
 public:
  OffWriter(RandomStream& random, const SurfaceSample& sample) : random_(random), sample_(sample) {}

  std::string write() {
    constexpr std::array<const char*, 6> kKinds{"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "NCSTOFF"};
    kind_ = kKinds[random_.below(kKinds.size())];
    free_ = chance(random_, 0.4);
    head();
    for (const Eigen::Vector3d& x : sample_.points) {
      for (const double c : x) word(number_text(random_, c));
      if (kind_.find("ST") != std::string::npos) further({"0.5", "0.25"});
      if (kind_.find('N') != std::string::npos) further({"0", "0", "1"});
      if (kind_.find("C") != std::string::npos) further({"10", "20", "30", "255"});
      end_line();
    }
    const bool coloured = !free_ && chance(random_, 0.5);
    for (std::vector<int> face : sample_.faces) {
      word(std::to_string(face.size()));
      for (const int v : face) word(std::to_string(v));
      if (coloured) further({"0.5", "0.5", "0.25"});
      end_line();
    }
    return text_ + (chance(random_, 0.5) ? "\n" : "");
  }

 private:
  void head() {
    if (chance(random_, 0.2)) text_ += "# made by hand\n";
    std::string counts = std::to_string(sample_.points.size());
    counts += blank(random_) + std::to_string(sample_.faces.size());
    const bool edges = free_ || chance(random_, 0.7);
    if (edges) counts += blank(random_) + "0";
    const bool has_word = kind_ != "OFF" || free_ || chance(random_, 0.8);
    const std::string between = chance(random_, 0.3) ? "" : chance(random_, 0.5) ? " " : "\n\n";
    if (has_word) text_ += kind_ + between;
    text_ += counts + "\n";
  }

  void word(const std::string& word) {
    if (!text_.ends_with('\n')) text_ += free_ && chance(random_, 0.2) ? "\n" : blank(random_);
    text_ += word;
  }
  void further(const std::vector<std::string>& words) {
    for (const std::string& w : words) word(w);
  }
  void end_line() {
    if (free_) return;
    if (chance(random_, 0.1)) text_ += " # 1 2 3";
    text_ += "\n";
    if (chance(random_, 0.1)) text_ += "\n# a comment\n";
  }

  RandomStream& random_;
  const SurfaceSample& sample_;
  std::string kind_, text_;
  bool free_ = false;
};

TEST(LongPerturbedFiles, OfOffAreReadRight) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "off");
    const SurfaceSample sample = test::surface_sample(random, false);
    const std::string text = any_form(random, OffWriter(random, sample).write());
    const MeshFile read = parse_off(text, "a.off");
    test::expect_sample(read, sample);
    EXPECT_TRUE(read.notes.empty());
    if (::testing::Test::HasFailure()) FAIL() << text;
  }
}

}  // namespace
}  // namespace geoprior
