#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "baselines/assembly/brute_force.h"
#include "experiments/assembly/files/assembly_file.h"
#include "models/assembly/exchange/replacement.h"
#include "models/assembly/graph/ported_graph.h"
#include "models/assembly/search/input.h"
#include "models/assembly/search/search.h"
#include "solvers/assembly/exact.h"
#include "tests/support/dice.h"
#include "tests/support/recording.h"

namespace geoprior::assembly {

/// Parts of one kind, and which are joined: each connection takes the next port of its two parts.
inline Assembly graph_of_pairs(int parts, const std::vector<std::array<int, 2>>& pairs) {
  Assembly out;
  out.parts.resize(parts);
  std::vector<int> used(parts, 0);
  for (const auto& [a, b] : pairs) {
    const PortRef first{a, used[a]++};
    out.connections.push_back({first, {b, used[b]++}});
  }
  return out;
}

inline Assembly path_graph(int parts) {
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i + 1 < parts; ++i) pairs.push_back({i, i + 1});
  return graph_of_pairs(parts, pairs);
}

inline Assembly ring_graph(int parts) {
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < parts; ++i) pairs.push_back({i, (i + 1) % parts});
  return graph_of_pairs(parts, pairs);
}

inline Assembly complete_graph(int parts) {
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < parts; ++i)
    for (int j = i + 1; j < parts; ++j) pairs.push_back({i, j});
  return graph_of_pairs(parts, pairs);
}

/// A kind of part of which only the number of ports counts.
inline PartType abstract_type(const std::string& label, int ports) {
  PartType out;
  out.label = label;
  for (int i = 0; i < ports; ++i) out.ports.push_back({"p" + std::to_string(i), Pose::Identity()});
  return out;
}

/// Kinds with one to four ports; that with two is alike both ways, that with four by half a turn.
inline std::vector<PartType> four_abstract_types() {
  std::vector<PartType> out;
  for (int ports = 1; ports <= 4; ++ports)
    out.push_back(abstract_type("t" + std::to_string(ports), ports));
  out[1].symmetries.push_back({{1, 0}, Pose::Identity()});
  out[3].symmetries.push_back({{2, 3, 0, 1}, Pose::Identity()});
  return out;
}

/// A graph of these kinds: ports drawn and joined until few are left, so that it may fall into
/// pieces, join a part with itself and two parts more than once.
inline Assembly random_graph(test::Dice& dice, const std::vector<PartType>& types, int least,
                             int most) {
  Assembly out;
  out.name = "random";
  std::vector<PortRef> open;
  const int parts = least + dice.below(most - least + 1);
  for (int i = 0; i < parts; ++i) {
    const int type = dice.below(static_cast<int>(types.size()));
    out.parts.push_back({type, Pose::Identity()});
    for (int k = 0; k < static_cast<int>(types[type].ports.size()); ++k) open.push_back({i, k});
  }
  dice.shuffle(open);
  while (open.size() > 1 && dice.below(30) != 0) {
    const PortRef a = open.back();
    open.pop_back();
    out.connections.push_back({a, open.back()});
    open.pop_back();
  }
  return out;
}

/// The same assembly with its parts in another order, and connections read from the other end.
inline Assembly renumbered(const Assembly& assembly, test::Dice& dice) {
  std::vector<int> number(assembly.parts.size());
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<int>(i);
  dice.shuffle(number);
  Assembly out = assembly;
  for (std::size_t i = 0; i < number.size(); ++i) out.parts[number[i]] = assembly.parts[i];
  for (Connection& c : out.connections) {
    c.a.part = number[c.a.part];
    c.b.part = number[c.b.part];
    std::swap(c.a, c.b);
  }
  dice.shuffle(out.connections);
  return out;
}

/// A frame in the plane z = `z` whose x axis has this heading (rad).
inline Pose plane_pose(double x, double y, double heading, double z = 0) {
  Pose out = Pose::Identity();
  out.translation() = Eigen::Vector3d(x, y, z);
  out.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return out;
}

/// Track along x, its second port at its end, with a way along it.
inline PartType straight_track(const std::string& label, double length) {
  PartType out;
  out.label = label;
  out.ports = {{"a", plane_pose(0, 0, std::numbers::pi)}, {"b", plane_pose(length, 0, 0)}};
  out.ways = {{0, 1, {{0, 0, 0}, {length, 0, 0}}}};
  return out;
}

/// Track that turns to the left.
inline PartType curved_track(const std::string& label, double radius, double turn) {
  PartType out;
  out.label = label;
  out.ports = {{"a", plane_pose(0, 0, std::numbers::pi)},
               {"b", plane_pose(radius * std::sin(turn), radius * (1 - std::cos(turn)), turn)}};
  return out;
}

/// Parts of these kinds in a row, second port to first port.
inline Assembly track_row(const std::vector<int>& kinds, const std::vector<PartType>& types,
                          bool is_closed) {
  Assembly out;
  out.name = "row";
  const int n = static_cast<int>(kinds.size());
  for (const int kind : kinds) out.parts.push_back({kind, Pose::Identity()});
  for (int i = 0; i + 1 < n; ++i) out.connections.push_back({{i, 1}, {i + 1, 0}});
  if (is_closed) out.connections.push_back({{n - 1, 1}, {0, 0}});
  place_parts(out, types);
  return out;
}

/// Kinds of `oval`: 0 a curve, of which so many make a ring, 1 a straight of 0.2 m, 2 one of 0.1 m.
inline std::vector<PartType> oval_types(int curves = 16) {
  return {curved_track("curve", 0.5, 2 * std::numbers::pi / curves),
          straight_track("straight", 0.2), straight_track("half", 0.1)};
}

/// Two half circles of curves and two rows of straights.
inline Assembly oval(const std::vector<PartType>& types, const std::vector<int>& one_side,
                     const std::vector<int>& other_side, int curves = 16) {
  std::vector<int> kinds(curves / 2, 0);
  kinds.insert(kinds.end(), one_side.begin(), one_side.end());
  kinds.insert(kinds.end(), curves / 2, 0);
  kinds.insert(kinds.end(), other_side.begin(), other_side.end());
  return track_row(kinds, types, true);
}

/// Two ovals of quarter turns that differ in what their sides are made of.
inline AssemblyInput oval_input() {
  AssemblyInput out;
  out.set.types = oval_types(4);
  for (int i = 1; i <= 2; ++i)
    out.set.types[i].symmetries = find_symmetries(out.set.types[i], 1e-6);
  out.set.models = {oval(out.set.types, {1, 2, 2}, {1, 1}, 4),
                    oval(out.set.types, {2, 1}, {2, 2, 2}, 4)};
  out.set.models[0].name = "long";
  out.set.models[1].name = "short";
  return out;
}

/// The marble run of the experiments and its rules.
inline const AssemblyInput& marble_run() {
  static const AssemblyInput input = [] {
    AssemblyInput out;
    out.set = read_assembly_file(std::filesystem::path(GEOPRIOR_SOURCE_DIR) /
                                 "experiments/assembly/models/marble-run.assembly.toml")
                  .set;
    out.rules.grounded = {"pillar-*", "basin"};
    out.rules.entries = PartCount{{"funnel"}, 1, 1};
    out.rules.exits = PartCount{{"basin"}, 1, 1000};
    out.rules.rise = 0.002;
    return out;
  }();
  return input;
}

/// Parts, by their numbers.
inline PartSet part_set(int of, std::initializer_list<int> parts) {
  PartSet out(of);
  for (const int part : parts) out.add(part);
  return out;
}

/// A replacement that can be kept: what was taken out, what was put in, the match.
using Swap = std::tuple<Substructure, int, Substructure, std::vector<int>>;

inline std::vector<Swap> swaps_of(ReplacementFinder& finder, const Assembly& host) {
  std::vector<Swap> out;
  finder.find(host, [&](const Replacement& r) {
    out.emplace_back(r.removed, r.donor, r.inserted,
                     std::vector<int>(r.match.begin(), r.match.end()));
    return true;
  });
  return out;
}

/// All models of a set give substructures.
inline DonorSet all_donors(const AssemblySet& set, const Compatibility& compatibility) {
  DonorSet out{&set, &compatibility, {}};
  for (std::size_t i = 0; i < set.models.size(); ++i) out.donors.push_back(static_cast<int>(i));
  return out;
}

/// What a process makes.
inline test::Recording recorded(Process& process, std::uint64_t seed = 1,
                                const std::optional<State>& resumed = {}) {
  test::Recording out;
  RunContext context(seed);
  process.run(out, context, resumed);
  return out;
}

/// The exact method with boundaries of at most so many connections.
inline FinderFactory exact_factory(int boundary) {
  return [boundary](const DonorSet& donors, bool keep_alike, RunContext&) {
    ExactOptions options;
    options.match.boundary = boundary;
    return make_exact_finder(donors, options, keep_alike);
  };
}

inline FinderFactory brute_force_factory(int boundary) {
  return [boundary](const DonorSet& donors, bool, RunContext&) {
    BruteForceOptions options;
    options.match.boundary = boundary;
    return make_brute_force(donors, options);
  };
}

inline void expect_same_frame(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.parameter, b.parameter);
  EXPECT_EQ(a.diagnostics, b.diagnostics);
  ASSERT_EQ(a.tables.size(), b.tables.size());
  for (const auto& [name, table] : a.tables) {
    const Eigen::MatrixXd& other = b.require_table(name).rows;
    ASSERT_EQ(table.rows.rows(), other.rows()) << name;
    EXPECT_TRUE(table.rows == other) << name;
  }
  for (const auto& [name, part] : a.parts) {
    const Eigen::MatrixX3d& other = b.require_part(name).points;
    ASSERT_EQ(part.points.rows(), other.rows()) << name;
    EXPECT_TRUE(part.points == other) << name;
  }
}

}  // namespace geoprior::assembly
