// The rules of docs/architecture.md over folders, includes and functions, held against this clone.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "testbed/topic.h"
#include "tests/topics/structure/functions.h"
#include "tests/topics/structure/include_graph.h"
#include "tests/topics/structure/rooms.h"
#include "tests/topics/structure/source_tree.h"

namespace geoprior::test::structure {
namespace {

constexpr std::size_t kMostSources = 25;  // of a folder, headers and sources
constexpr int kMostLines = 60;            // of a function

const SourceTree& clone() {
  static const SourceTree tree = read_source_tree(GEOPRIOR_SOURCE_DIR);
  return tree;
}

const IncludeGraph& graph_of_clone() {
  static const IncludeGraph graph = include_graph(clone());
  return graph;
}

std::string lines_of(const std::vector<std::string>& complaints) {
  std::string text;
  for (const std::string& complaint : complaints) text += complaint + "\n";
  return text;
}

std::vector<MethodName> method_names() {
  std::vector<MethodName> names;
  for (const Topic& topic : all_topics()) {
    for (const MethodEntry& method : topic.methods) {
      if (method.make_at) continue;  // of every topic: testbed/external
      names.push_back({topic.name, method.name, method.is_baseline});
    }
  }
  return names;
}

TEST(Structure, IsReadWhole) {
  EXPECT_GT(clone().files.size(), 1000U);
  EXPECT_GT(graph_of_clone().at("testbed/runner/execute").size(), 1U);
  EXPECT_TRUE(clone().uses.contains("skinning"));
  EXPECT_GT(functions_of("int f() {\n}\n").size(), 0U);
  EXPECT_FALSE(method_names().empty());
}

TEST(Structure, NoFolderHoldsMoreThan25Sources) {
  EXPECT_EQ(lines_of(crowded_folders(clone(), kMostSources)), "");
}

TEST(Structure, NoCircleOfIncludesBetweenUnits) {
  EXPECT_EQ(lines_of(include_circles(graph_of_clone())), "");
}

TEST(Structure, EveryMethodHasAHeaderOfItsName) {
  EXPECT_EQ(lines_of(methods_without_header(clone(), method_names())), "");
}

TEST(Structure, ModelsServeMoreThanOneSide) {
  EXPECT_EQ(lines_of(models_of_one_side(graph_of_clone())), "");
}

TEST(Structure, ArrowsBetweenRoomsPointOneWay) { EXPECT_EQ(lines_of(arrows_back(clone())), ""); }

TEST(Structure, NoFunctionIsLongerThan60Lines) {
  EXPECT_EQ(lines_of(long_functions(clone(), kMostLines)), "");
}

}  // namespace
}  // namespace geoprior::test::structure
