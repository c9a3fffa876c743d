// Variations: valid, distinct, in one order, and the same after a run was stopped.

#include "models/assembly/search/search.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "experiments/assembly/processes/process.h"
#include "experiments/assembly/processes/survey.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

SearchOptions searching(int count, int generations, Order order) {
  SearchOptions out;
  out.count = count;
  out.generations = generations;
  out.order = order;
  return out;
}

AssemblyInput guided_marble_run() {
  AssemblyInput out = marble_run();
  out.guide.target = Target{Target::Kind::outline, {0, 1, 1, 0}, {-0.6, -0.6, 0.6, 0.6}, 0.05};
  return out;
}

TEST(VariationSearch, MakesValidDistinctVariationsThatAreNoInputs) {
  const AssemblyInput& input = marble_run();
  for (const Order order : {Order::varied, Order::found}) {
    const auto run =
        recorded(*replacement_process(input, exact_factory(2), true, searching(8, 2, order)));
    ASSERT_EQ(run.frames.size(), 9);
    std::set<CanonicalKey> keys;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
      const Frame& frame = run.frames[i];
      EXPECT_EQ(frame.parameter, static_cast<double>(i));
      Assembly made = variation_of(frame).assembly;
      EXPECT_EQ(first_broken(made, input.set.types, input.rules), Filter::none);
      EXPECT_TRUE(keys.insert(canonical_key(made, input.set.types, true)).second);
    }
  }
}

TEST(VariationSearch, InputsAreTheFramesUpToZero) {
  const AssemblyInput input = oval_input();
  const auto run =
      recorded(*replacement_process(input, exact_factory(2), true, searching(3, 1, Order::found)));
  ASSERT_EQ(run.frames.size(), 5);
  EXPECT_EQ(run.frames[0].parameter, -1);
  EXPECT_EQ(run.frames[4].parameter, 3);
  for (int i = 0; i < 2; ++i) {
    const Variation shown = variation_of(run.frames[i]);
    EXPECT_EQ(canonical_key(shown.assembly, input.set.types, true),
              canonical_key(input.set.models[i], input.set.types, true));
    for (const int origin : shown.origin) EXPECT_EQ(origin, Variation::kKept);
  }
}

TEST(VariationSearch, MakesTheSameFramesAgainAndFromEachCheckpoint) {
  AssemblyInput input = oval_input();
  input.guide.target = Target{Target::Kind::outline, {0, 0.3, 0.3, 0}, {0, 0, 1, 1}, 0.05};
  for (const Order order : {Order::varied, Order::found, Order::best}) {
    const auto process = replacement_process(input, exact_factory(2), true, searching(5, 2, order));
    const auto whole = recorded(*process);
    ASSERT_EQ(whole.checkpoints.size(), whole.frames.size());
    ASSERT_GT(whole.frames.size(), 3);
    const auto again = recorded(*process);
    ASSERT_EQ(again.frames.size(), whole.frames.size());
    for (std::size_t i = 0; i < whole.frames.size(); ++i)
      expect_same_frame(again.frames[i], whole.frames[i]);
    for (std::size_t done = 1; done <= whole.frames.size(); ++done) {
      const auto rest = recorded(*process, 1, whole.checkpoints[done - 1]);
      ASSERT_EQ(rest.frames.size() + done, whole.frames.size());
      for (std::size_t i = 0; i < rest.frames.size(); ++i)
        expect_same_frame(rest.frames[i], whole.frames[done + i]);
    }
  }
}

TEST(VariationSearch, EachIsBetterThanTheLastWhereTheBestIsAskedFor) {
  const AssemblyInput input = guided_marble_run();
  const auto run =
      recorded(*replacement_process(input, exact_factory(2), true, searching(6, 3, Order::best)));
  const Objective objective(input.guide, input.set.types);
  ASSERT_GE(run.frames.size(), 3);
  double last = std::numeric_limits<double>::infinity();
  for (const Frame& frame : run.frames) {
    const double value = objective(variation_of(frame).assembly);
    EXPECT_LT(value, last);
    last = value;
  }
}

TEST(VariationSearch, FindsTheSameWithAndWithoutThePrefilter) {
  const AssemblyInput input = oval_input();
  SearchOptions options = searching(1000, 1, Order::found);
  options.pool = 1000;
  const auto outputs = [&](bool prefilter) {
    options.prefilter = prefilter;
    std::set<CanonicalKey> out;
    for (const Frame& frame :
         recorded(*replacement_process(input, exact_factory(2), true, options)).frames)
      out.insert(canonical_key(variation_of(frame).assembly, input.set.types, true));
    return out;
  };
  EXPECT_GT(outputs(true).size(), 5);
  EXPECT_EQ(outputs(true), outputs(false));
}

TEST(VariationSearch, RemovesNothingThatTheGuideKeeps) {
  AssemblyInput input = marble_run();
  input.guide.keep = {"curve-*"};
  const auto run =
      recorded(*replacement_process(input, exact_factory(2), true, searching(4, 1, Order::found)));
  ASSERT_GT(run.frames.size(), 1);
  const auto kept_curves = [&](const Frame& frame) {
    const Variation v = variation_of(frame);
    int count = 0;
    for (std::size_t i = 0; i < v.origin.size(); ++i)
      if (v.origin[i] == Variation::kKept &&
          input.set.types[v.assembly.parts[i].type].label.starts_with("curve-"))
        ++count;
    return count;
  };
  for (const Frame& frame : run.frames) EXPECT_EQ(kept_curves(frame), kept_curves(run.frames[0]));
}

TEST(VariationSearch, TakesAnAssemblyOnce) {
  const AssemblyInput input = oval_input();
  VariationSearch search(input, true, {});
  Variation known = unchanged(input.set.models[0]);
  EXPECT_FALSE(search.accept(known));
  Variation made = unchanged(oval(input.set.types, {1}, {2, 2}, 4));
  EXPECT_TRUE(search.accept(made));
  EXPECT_FALSE(search.accept(made));
  Variation open = unchanged(oval(input.set.types, {1}, {2}, 4));
  EXPECT_FALSE(search.accept(open));
  EXPECT_EQ(search.counts().valid, 1);
  EXPECT_EQ(search.counts().duplicates, 2);
  EXPECT_EQ(search.counts().broken[static_cast<std::size_t>(Filter::closure)], 1);
}

TEST(VariationFrame, HoldsTheAssemblyAndWhereItsPartsComeFrom) {
  const AssemblyInput& input = marble_run();
  const auto run =
      recorded(*replacement_process(input, exact_factory(2), true, searching(2, 1, Order::found)));
  for (const Frame& frame : run.frames) {
    const Variation v = variation_of(frame);
    const Frame again = assembly_frame(frame.parameter, v, input.set.types, nullptr);
    const Variation w = variation_of(again);
    EXPECT_EQ(w.origin, v.origin);
    ASSERT_EQ(w.assembly.parts.size(), v.assembly.parts.size());
    for (std::size_t i = 0; i < v.assembly.parts.size(); ++i) {
      EXPECT_EQ(w.assembly.parts[i].type, v.assembly.parts[i].type);
      EXPECT_TRUE(w.assembly.parts[i].pose.isApprox(v.assembly.parts[i].pose, 0));
    }
    ASSERT_EQ(w.assembly.connections.size(), v.assembly.connections.size());
    for (std::size_t c = 0; c < v.assembly.connections.size(); ++c) {
      EXPECT_EQ(w.assembly.connections[c].a, v.assembly.connections[c].a);
      EXPECT_EQ(w.assembly.connections[c].b, v.assembly.connections[c].b);
    }
    EXPECT_TRUE(again.require_part("surface").points == frame.require_part("surface").points);
  }
}

TEST(VariationFrame, HasACellAPartsTriangleALineAConnectionAndAPointAJoint) {
  const AssemblyInput& input = marble_run();
  const Assembly& run = input.set.models[0];
  const Frame frame = assembly_frame(0, unchanged(run), input.set.types, nullptr);
  Eigen::Index triangles = 0;
  for (const PlacedPart& part : run.parts) triangles += input.set.types[part.type].mesh.F.rows();
  EXPECT_GT(triangles, 0);
  EXPECT_EQ(frame.require_part("surface").triangles.rows(), triangles);
  EXPECT_EQ(frame.require_part("graph").lines.size(), run.connections.size());
  EXPECT_EQ(frame.require_part("joints").points.rows(), run.connections.size());
  EXPECT_EQ(frame.require_part("ways").lines.size(), 3);
  const auto& gaps =
      frame.require_part("joints").require_array("translation", NamedArray::On::points, 1);
  EXPECT_LT(gaps.values.maxCoeff(), 1e-12);
}

/// A survey of three small random graphs.
AssemblyInput surveyed_graphs() {
  AssemblyInput out;
  out.set.types = four_abstract_types();
  test::Dice dice(4, "survey");
  for (int i = 0; i < 3; ++i) out.set.models.push_back(random_graph(dice, out.set.types, 5, 8));
  out.survey = Survey{true, true, true, false};
  return out;
}

TEST(Survey, OfThePathOfFourPartsHasItsNineRuns) {
  AssemblyInput input;
  input.set.types = {abstract_type("link", 2)};
  input.set.models = {path_graph(4)};
  input.survey = Survey{false, false, false, false};
  const auto run = recorded(*replacement_process(input, exact_factory(2), true, {}));
  ASSERT_EQ(run.frames.size(), 1);
  EXPECT_EQ(run.frames[0].require_table("substructures").rows.rows(), 9);
}

TEST(Survey, OfTheExactMethodIsThatOfBruteForce) {
  const AssemblyInput input = surveyed_graphs();
  SearchOptions options;
  options.candidates = 1e9;
  const auto exact = recorded(*replacement_process(input, exact_factory(2), true, options));
  const auto oracle = recorded(*replacement_process(input, brute_force_factory(2), true, options));
  ASSERT_EQ(exact.frames.size(), 3);
  for (int i = 0; i < 3; ++i)
    for (const char* name : {"substructures", "outputs"}) {
      const Eigen::MatrixXd& a = exact.frames[i].require_table(name).rows;
      const Eigen::MatrixXd& b = oracle.frames[i].require_table(name).rows;
      ASSERT_EQ(a.rows(), b.rows());
      EXPECT_GT(a.rows(), 5);
      EXPECT_TRUE(a == b) << name;
    }
}

}  // namespace
}  // namespace geoprior::assembly
