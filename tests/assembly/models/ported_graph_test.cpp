// Ported graphs: what is refused, what hangs together, where parts come to.

#include "models/assembly/graph/ported_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "models/assembly/exchange/embedding.h"
#include "models/assembly/graph/compatibility.h"
#include "tests/assembly/assemblies.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

using ::testing::ElementsAre;

AssemblySet two_straights() {
  AssemblySet out;
  out.types = oval_types();
  out.models = {track_row({1, 1}, out.types, false)};
  return out;
}

TEST(PortedGraph, RefusesWhatIsNoAssembly) {
  EXPECT_NO_THROW(require_valid(two_straights()));
  const auto refuse = [](const auto& spoil, std::initializer_list<std::string> parts) {
    AssemblySet set = two_straights();
    spoil(set, set.models[0]);
    test::expect_error([&] { require_valid(set); }, parts);
  };
  refuse([](auto&, auto& model) { model.parts[1].type = 3; },
         {"model 'row', part 1", "type 3", "0 to 2"});
  refuse([](auto&, auto& model) { model.connections[0].b.part = 2; },
         {"connection 0", "part 2", "0 to 1"});
  refuse([](auto&, auto& model) { model.connections[0].b.port = 2; },
         {"connection 0", "port 2", "0 to 1"});
  refuse(
      [](auto&, auto& model) {
        model.connections.push_back({{0, 1}, {1, 1}});
      },
      {"connection 1", "port 'b' of part 0", "connection 0"});
  refuse(
      [](auto&, auto& model) {
        model.connections.push_back({{1, 1}, {1, 1}});
      },
      {"connection 1", "joined with itself"});
  refuse(
      [](auto&, auto& model) {
        model.parts[1].pose.translation().x() = std::numeric_limits<double>::infinity();
      },
      {"part 1", "not finite"});
  refuse([](auto&, auto& model) { model.parts[1].pose = model.parts[0].pose; },
         {"part 1", "on the place of part 0"});
  refuse([](auto& set, auto&) { set.types[2].label = "straight"; }, {"part 'straight'"});
}

TEST(PortedGraph, LinksAreConnectionsByPort) {
  const AssemblySet set = two_straights();
  const Links links(set.models[0], set.types);
  EXPECT_EQ(links.port_count(1), 2);
  EXPECT_EQ(links.connection({0, 0}), -1);
  EXPECT_EQ(links.connection({0, 1}), 0);
  EXPECT_EQ(links.connection({1, 0}), 0);
  EXPECT_EQ(other_end(set.models[0].connections[0], {0, 1}), (PortRef{1, 0}));
  EXPECT_EQ(other_end(set.models[0].connections[0], {1, 0}), (PortRef{0, 1}));
}

TEST(PortedGraph, ComponentsAreNumberedByTheirFirstPart) {
  const Components found = components(graph_of_pairs(6, {{4, 1}, {5, 2}, {2, 2}}));
  EXPECT_EQ(found.count, 4);
  EXPECT_THAT(found.of_part, ElementsAre(0, 1, 2, 3, 1, 2));
}

TEST(PortedGraph, OvalOfSixteenCurvesClosesToRoundOff) {
  const std::vector<PartType> types = oval_types();
  for (const Assembly& track : {oval(types, {}, {}), oval(types, {1, 1}, {1, 2, 2})}) {
    const Misfit worst = largest(joint_misfits(track, types));
    EXPECT_LT(worst.translation, 1e-14);
    EXPECT_LT(worst.angle, 1e-14);
  }
  // The ring's diameter, from a port to the eighth after it.
  const Assembly ring = oval(types, {}, {});
  EXPECT_NEAR(
      (port_pose(ring, types, {0, 0}).translation() - port_pose(ring, types, {8, 0}).translation())
          .norm(),
      1, 1e-14);
}

TEST(PortedGraph, OvalOfUnequalSidesIsOpenByTheirDifference) {
  const std::vector<PartType> types = oval_types();
  const Misfit worst = largest(joint_misfits(oval(types, {1, 1}, {1, 2}), types));
  EXPECT_NEAR(worst.translation, 0.1, 1e-14);
  EXPECT_LT(worst.angle, 1e-14);
}

TEST(Compatibility, MakesPortsThatASymmetryExchangesOneClass) {
  AssemblySet set;
  set.types = four_abstract_types();
  const Compatibility alike(set, true), apart(set, false);
  EXPECT_EQ(apart.class_count(), 10);
  // One of two ports and two of four are gone.
  EXPECT_EQ(alike.class_count(), 7);
  EXPECT_EQ(alike.port_class(1, 0), alike.port_class(1, 1));
  EXPECT_EQ(alike.port_class(3, 0), alike.port_class(3, 2));
  EXPECT_NE(alike.port_class(3, 0), alike.port_class(3, 1));
  EXPECT_NE(apart.port_class(1, 0), apart.port_class(1, 1));
}

TEST(Compatibility, HasSeenWhatSomeModelJoins) {
  const AssemblySet set = two_straights();
  const Compatibility seen(set, false);
  const int a = seen.port_class(1, 0), b = seen.port_class(1, 1);
  EXPECT_TRUE(seen.observed(a, b));
  EXPECT_TRUE(seen.observed(b, a));
  EXPECT_FALSE(seen.observed(a, a));
  EXPECT_FALSE(seen.observed(a, seen.port_class(2, 1)));
}

}  // namespace
}  // namespace geoprior::assembly
