#pragma once

#include <memory>
#include <string>

#include "baselines/grammar/rigid_as_possible.h"
#include "experiments/grammar/processes/deformer.h"
#include "solvers/grammar/grammar.h"
#include "solvers/grammar/script/lua_rules.h"

namespace geoprior::grammar {

/// Options of the method `grammar`: how it derives, and by which rules.
struct GrammarMethodOptions {
  enum class Rules { native, script, both };
  GrammarOptions grammar;
  Rules rules = Rules::native;
  LuaLimits limits;
  bool trace = false;
};
void describe(OptionVisitor& v, GrammarMethodOptions& options);

/// The rules that a method has in a scene: those in C++, those of the scene's script, or the
/// script's and where these have none those in C++.
/// @throws Error  when the scene has no script that is asked for, and what the script throws
RuleSet scene_rules(const GrammarScene& scene, GrammarMethodOptions::Rules rules,
                    const LuaLimits& limits, std::uint64_t seed);

std::unique_ptr<Deformer> grammar_deformer(const GrammarScene& scene,
                                           const GrammarMethodOptions& options,
                                           RunContext& context);
/// Baselines. Edits of elements are made as they are asked for, on the element and what is below
/// it.
std::unique_ptr<Deformer> nothing_deformer(const GrammarScene& scene);
std::unique_ptr<Deformer> free_form_deformer(const GrammarScene& scene);
std::unique_ptr<Deformer> frames_deformer(const GrammarScene& scene);
std::unique_ptr<Deformer> rigid_deformer(const GrammarScene& scene,
                                         const RigidAsPossibleOptions& options);
/// @throws Error  for an object without a procedure
std::unique_ptr<Deformer> regenerating_deformer(const GrammarScene& scene);
/// The code of other topics for what the rules in Lua of reformulated.toml do: an arm's joints by
/// skinning, items on a surface as details, anything else free-form by a lattice.
/// @throws Error  for an object and a gesture that there is no such code for
std::unique_ptr<Deformer> direct_deformer(const GrammarScene& scene);
/// Begins with what the grammar makes, whose children it keeps.
/// @throws Error  for an object that no optimum is written for
std::unique_ptr<Deformer> optimum_deformer(const GrammarScene& scene);

}  // namespace geoprior::grammar
