#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "solvers/grammar/engine/derivation.h"
#include "solvers/grammar/script/lua_rules.h"

namespace geoprior::grammar::script_test {

/// A wood with three trees (elements 1 to 3) of a leaf each, on a line.
inline Hierarchy wood(int trees = 3) {
  Hierarchy h({{.name = "wood"},
               {.name = "tree",
                .parameters = {{"height", "m", 0, 100}, {"girth", "m", 0, 10}},
                .keys =
                    [](std::span<const double> p, std::vector<Eigen::Vector3d>& out) {
                      out.insert(out.end(), {{0, 0, 0}, {0, 0, p[0]}});
                    }},
               {.name = "leaf", .parameters = {{"size", "1", 0, 1}}}});
  h.add(0, -1, {});
  for (int i = 0; i < trees; ++i) h.add(1, 0, {{2. * i, 0, 0}}, std::array{10. + i, 0.5});
  for (int i = 0; i < trees; ++i) h.add(2, 1 + i, {{2. * i, 0, 9}}, std::array{0.25});
  return h;
}

inline RuleSet rules_of(const std::string& text, const LuaLimits& limits = {},
                        std::uint64_t seed = 1,
                        const std::map<std::string, std::vector<double>>& constants = {}) {
  return lua_rules(text, "rules.lua", limits, seed, constants);
}

inline std::shared_ptr<const SpatialMap> shift(double x, double y = 0, double z = 0) {
  return std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Translation3d(x, y, z)));
}

/// Derives a shift by 1 m along x on the root. The text of the error, empty without one; then the
/// hierarchy must be what it was.
inline std::string failure(const std::string& text, const LuaLimits& limits = {}) {
  Hierarchy h = wood();
  Transaction undo(h);
  try {
    derive(h, undo, rules_of(text, limits), {0, Delta::free(shift(1))});
  } catch (const Error& e) {
    for (int i = 1; i <= 3; ++i)
      if (h.position(i) != Eigen::Vector3d(2. * i - 2, 0, 0) || h.size() != 7) return "not undone";
    return e.what();
  }
  return {};
}

/// A rule for the trees with such a body.
inline std::string tree_rule(const std::string& body) {
  return "rule{name = 'grow', type = 'tree', phase = 'down', apply = function(b)\n" + body +
         "\nend}\n";
}

/// What the trees' rule writes with `b:set_parameter(1, 'height', ...)`: a number out of the
/// script.
inline double value_of(const std::string& statements, const std::string& expression,
                       std::uint64_t seed = 1) {
  Hierarchy h = wood();
  Transaction undo(h);
  const std::string body = statements + "\nb:set_parameter(1, 'height', " + expression + ")";
  derive(h, undo, rules_of(tree_rule(body), {}, seed), {0, Delta::free(shift(1))});
  return h.parameter(1, 0);
}

}  // namespace geoprior::grammar::script_test
