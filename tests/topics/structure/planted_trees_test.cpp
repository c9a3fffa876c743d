// Each check of the structure finds what is planted, and nothing in a tree that keeps the rules.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "tests/testbed/scratch_folder.h"
#include "tests/topics/structure/functions.h"
#include "tests/topics/structure/include_graph.h"
#include "tests/topics/structure/rooms.h"
#include "tests/topics/structure/source_tree.h"

namespace geoprior::test::structure {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class PlantedTree : public ScratchFolder {
 protected:
  /// A file with these includes.
  void plant(const std::string& path, std::initializer_list<std::string> includes) const {
    std::string text = "#pragma once\n";
    for (const std::string& include : includes) text += "#include \"" + include + "\"\n";
    write(path, text);
  }
  /// Two topics that keep all rules; sound uses paper.
  void plant_orderly() const {
    write(
        "CMakeLists.txt",
        "# geoprior_topic(none USES sound)\n"
        "geoprior_topic(paper DEPS cgal)\ngeoprior_topic(sound DEPS fftw USES paper DEPS cgal)\n");
    plant("core/mesh.h", {});
    plant("metrics/volume.h", {"core/mesh.h"});
    plant("testbed/runner.h", {"core/mesh.h"});
    plant("models/paper/elements.h", {"core/mesh.h"});
    plant("models/paper/shell.h", {"models/paper/elements.h"});
    plant("baselines/paper/dense.h", {"models/paper/shell.h"});
    plant("solvers/paper/hybrid.h", {"models/paper/shell.h", "baselines/paper/dense.h"});
    plant("experiments/paper/scene/clip.h", {"testbed/runner.h"});
    plant("experiments/paper/methods.cpp",
          {"experiments/paper/scene/clip.h", "experiments/paper/topic.h", "metrics/volume.h"});
    plant("experiments/paper/topic.h", {"solvers/paper/hybrid.h"});
    plant("experiments/sound/topic.cpp",
          {"experiments/paper/scene/clip.h", "solvers/paper/hybrid.h"});
    plant("tests/paper/hybrid_test.cpp", {"experiments/paper/topic.h"});
  }
  [[nodiscard]] SourceTree tree() const { return read_source_tree(folder()); }
  [[nodiscard]] IncludeGraph graph() const { return include_graph(tree()); }
};

TEST_F(PlantedTree, OrderlyOnePassesEveryCheck) {
  plant_orderly();
  EXPECT_EQ(tree().files.size(), 12U);
  EXPECT_THAT(tree().uses.at("sound"), ElementsAre("paper"));
  EXPECT_THAT(tree().uses.at("paper"), IsEmpty());
  EXPECT_FALSE(tree().uses.contains("none"));
  EXPECT_THAT(crowded_folders(tree(), 3), IsEmpty());
  EXPECT_THAT(include_circles(graph()), IsEmpty());
  EXPECT_THAT(models_of_one_side(graph()), IsEmpty());
  EXPECT_THAT(arrows_back(tree()), IsEmpty());
  EXPECT_THAT(methods_without_header(tree(), {{"paper", "dense", true}, {"paper", "hybrid"}}),
              IsEmpty());
}

TEST_F(PlantedTree, CrowdedFolderIsCountedWithoutWhatIsBelowIt) {
  for (int i = 0; i < 26; ++i) plant("tests/core/case_" + std::to_string(i) + "_test.cpp", {});
  plant("tests/core/geometry/case_test.cpp", {});
  EXPECT_THAT(crowded_folders(tree(), 25), ElementsAre("tests/core: 26 sources"));
  EXPECT_THAT(crowded_folders(tree(), 26), IsEmpty());
}

TEST_F(PlantedTree, CirclesGoThroughHeadersAndSources) {
  plant("core/a.h", {});
  plant("core/a.cpp", {"core/a.h", "core/b.h"});
  plant("core/b.h", {"core/c.h"});
  plant("core/c.h", {"core/a.h"});
  plant("core/d.h", {"core/a.h"});
  plant("core/e.h", {"core/f.h"});
  plant("core/f.cpp", {"core/e.h", "core/d.h", "core/none.h"});
  plant("core/f.h", {});
  EXPECT_THAT(include_circles(graph()), ElementsAre("core/a, core/b, core/c", "core/e, core/f"));
}

TEST_F(PlantedTree, ModelOfOneSideIsFoundThroughOtherModels) {
  plant_orderly();
  plant("models/paper/strips.h", {});
  plant("models/paper/sheet.h", {"models/paper/strips.h"});
  plant("models/paper/unused.h", {});
  plant("solvers/paper/sheet_user.h", {"models/paper/sheet.h"});
  plant("tests/paper/sheet_test.cpp", {"models/paper/sheet.h", "models/paper/unused.h"});
  EXPECT_THAT(models_of_one_side(graph()), ElementsAre("models/paper/sheet: used by solvers alone",
                                                       "models/paper/strips: used by solvers alone",
                                                       "models/paper/unused: used by nobody"));
}

TEST_F(PlantedTree, ArrowsThatPointBackAreFound) {
  plant_orderly();
  plant("core/back.h", {"metrics/volume.h"});
  plant("metrics/back.h", {"models/paper/shell.h"});
  plant("models/paper/back.h", {"baselines/paper/dense.h"});
  plant("baselines/paper/back.h", {"solvers/paper/hybrid.h"});
  plant("solvers/paper/back.h", {"experiments/paper/scene/clip.h"});
  plant("testbed/back.cpp", {"experiments/paper/topic.h"});
  EXPECT_THAT(
      arrows_back(tree()),
      ElementsAre("baselines/paper/back.h -> solvers/paper/hybrid.h: baselines does not see "
                  "solvers",
                  "core/back.h -> metrics/volume.h: core does not see metrics",
                  "metrics/back.h -> models/paper/shell.h: metrics does not see models",
                  "models/paper/back.h -> baselines/paper/dense.h: models does not see "
                  "baselines",
                  "solvers/paper/back.h -> experiments/paper/scene/clip.h: solvers does not "
                  "see experiments",
                  "testbed/back.cpp -> experiments/paper/topic.h: testbed does not see "
                  "experiments"));
}

TEST_F(PlantedTree, TopicsSeeWhatTheyUseAndNoTables) {
  plant_orderly();
  plant("experiments/paper/scene/back.h", {"experiments/paper/topic.h"});
  plant("experiments/sound/tables.cpp", {"experiments/paper/topic.h"});
  plant("solvers/paper/unsaid.h", {"solvers/sound/sound.h"});
  EXPECT_THAT(
      arrows_back(tree()),
      ElementsAre("experiments/paper/scene/back.h -> experiments/paper/topic.h: a folder "
                  "below the tables includes a table",
                  "experiments/sound/tables.cpp -> experiments/paper/topic.h: the tables of "
                  "paper are its own",
                  "solvers/paper/unsaid.h -> solvers/sound/sound.h: CMakeLists.txt does not "
                  "say paper USES sound"));
}

TEST_F(PlantedTree, MethodsWithoutHeaderAreFound) {
  plant("baselines/paper/adaptive/adaptive.h", {});
  plant("baselines/paper/parts/visual_hull.h", {});
  plant("baselines/paper/re_scatter.cpp", {});
  plant("solvers/paper/drawing/one_view.h", {});
  plant("experiments/paper/flattened.h", {});
  plant("experiments/paper/scene/lloyd.h", {});
  EXPECT_THAT(methods_without_header(tree(), {{"paper", "adaptive", true},
                                              {"paper", "visual-hull", true},
                                              {"paper", "re-scatter", true},
                                              {"paper", "flattened", true},
                                              {"paper", "lloyd", true},
                                              {"paper", "one-view", false},
                                              {"paper", "adaptive", false}}),
              ElementsAre("paper/visual-hull: no baselines/paper/visual_hull.h",
                          "paper/re-scatter: no baselines/paper/re_scatter.h",
                          "paper/lloyd: no baselines/paper/lloyd.h",
                          "paper/adaptive: no solvers/paper/adaptive.h"));
}

std::string function_of_lines(const std::string& head, int lines) {
  std::string text = head + " {\n";
  for (int i = 2; i < lines; ++i) text += "  call(\"}\", '{');  // }\n";
  return text + "}\n";
}

TEST_F(PlantedTree, LongFunctionIsFound) {
  write("core/a.cpp", function_of_lines("int f()", 60) + function_of_lines("int g()", 61));
  EXPECT_THAT(long_functions(tree(), 60), ElementsAre("core/a.cpp:61: 61 lines: int g() {"));
}

/// "line+lines head" of each function.
std::vector<std::string> found_in(const std::string& source) {
  std::vector<std::string> found;
  for (const Function& f : functions_of(source)) {
    found.push_back(std::to_string(f.line) + "+" + std::to_string(f.lines) + " " + f.head);
  }
  return found;
}

TEST(Functions, AreToldFromOtherBraces) {
  EXPECT_THAT(found_in("namespace a {\n"
                       "struct B : C<decltype(d())> {\n"
                       "  int e = f(1);\n"
                       "  std::vector<int> g{h(1), {2}};\n"
                       "  static constexpr int i[] = {j(1), 2};\n"
                       "};\n"
                       "enum class K { l, m };\n"
                       "template <class N>\n"
                       "struct O {};\n"
                       "const P q = {r(1), {s(2)}};\n"
                       "int t(int u = 1);\n"
                       "}  // namespace a\n"),
              IsEmpty());
}

TEST(Functions, OfAllFormsAreFound) {
  EXPECT_THAT(found_in("#define M(x) \\\n"
                       "  void x() {\n"
                       "class A {\n"
                       " public:\n"
                       "  explicit A(int b)\n"
                       "      : b_{b}, c_(1) {\n"
                       "    d();\n"
                       "  }\n"
                       "  int e() const { return b_; }\n"
                       " private:\n"
                       "  int b_;\n"
                       "};\n"
                       "template <class T>\n"
                       "T f(T x = {}, int y = 0xF'000) noexcept {\n"
                       "  return R\"({)\" + U'{';\n"
                       "}\n"
                       "TEST(Suite, Test) {\n"
                       "  for (;;) {\n"
                       "  }\n"
                       "}\n"
                       "const int k = [] {\n"
                       "  return 1;\n"
                       "}();\n"),
              ElementsAre("5+4 explicit A(int b)", "9+1 int e() const { return b_; }",
                          "14+3 , int y = 0xF'000) noexcept {", "17+4 TEST(Suite, Test) {",
                          "21+3 const int k = [] {"));
}

}  // namespace
}  // namespace geoprior::test::structure
