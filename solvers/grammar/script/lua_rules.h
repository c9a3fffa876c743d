#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "solvers/grammar/engine/rule.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {

/// Rules that are written in Lua 5.4 (docs/writing-rules.md): a script calls `rule` and `bounds`.
///
/// The script runs once here, and again before the first of its rules in each derivation: what it
/// keeps in variables, and the numbers it draws, are the same at the begin of each. Hence results
/// do not depend on derivations before, and repeat byte by byte.
///
/// The rules, and copies of them, share one state of Lua: they serve one derivation at a time, and
/// an error says so where two threads try.
///
/// @param text       of the script; source, no byte code
/// @param name       of its file, for messages
/// @param seed       of math.random
/// @param constants  lists that the script reads as `constants.<name>`
/// @throws Error  "file:line: …": the text is wrong, or what it does raises, loops, needs too much.
///                The rules throw the same, with rule and element, and the derivation is taken back
RuleSet lua_rules(const std::string& text, const std::string& name, const LuaLimits& limits,
                  std::uint64_t seed, const std::map<std::string, std::vector<double>>& constants);

}  // namespace geoprior::grammar
