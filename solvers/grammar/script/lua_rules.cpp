#include "solvers/grammar/script/lua_rules.h"

#include <atomic>
#include <cstring>
#include <lua5.4/lua.hpp>
#include <memory>
#include <utility>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/library.h"

namespace geoprior::grammar {
namespace {

using ScriptConstants = std::map<std::string, std::vector<double>>;

/// What a script declares while it runs.
struct Declared {
  std::vector<Rule> rules;  ///< without `apply`
  std::vector<std::string> bounds;
};

/// A script with its state of Lua.
class RuleScript {
 public:
  RuleScript(const std::string& text, const std::string& name, const LuaLimits& limits,
             std::uint64_t seed, ScriptConstants constants);

  /// Runs the script anew.
  void load();
  void apply(std::size_t rule, const std::string& name, RuleCall& call);
  [[nodiscard]] const Declared& declared() const { return declared_; }

  static RuleScript& of(lua_State* L) {
    return *static_cast<RuleScript*>(lua_touserdata(L, lua_upvalueindex(1)));
  }
  static int declare_rule(lua_State* L, LuaSandbox& sandbox);
  static int declare_bounds(lua_State* L, LuaSandbox& sandbox);

 private:
  static int open(lua_State* L);
  static int prepare(lua_State* L);
  void call_rule(std::size_t rule, RuleCall& call);

  RuleBinding binding_;
  LuaSandbox sandbox_;
  ScriptConstants constants_;
  Declared declared_;
  bool loading_ = false;
  // The rules as Lua has them: by their place in a table of the registry.
  const Hierarchy* last_object_ = nullptr;
  std::uint64_t last_derivation_ = 0;
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
};

constexpr const char* kRuleFunctions = "geoprior.rules";
constexpr const char* kRuleChunk = "geoprior.chunk";

template <class Value>
std::optional<Value> named_value(const char* given, const char* key, int count) {
  if (given == nullptr) return {};
  std::string names;
  for (int i = 0; i < count; ++i) {
    const auto name = name_of(static_cast<Value>(i));
    if (name == given) return static_cast<Value>(i);
    names += (i > 0 ? ", " : "") + std::string(name);
  }
  throw Error(std::string("'") + key + "' is '" + given + "'", {}, names);
}

/// What the table of a rule says; texts live as long as the table.
struct RuleTable {
  const char* name = nullptr;
  const char* type = nullptr;
  const char* on = nullptr;
  const char* from = nullptr;
  const char* phase = nullptr;
  int follows = -1;
  int line = 0;
  bool applies = false;
};

void read_rule_field(lua_State* L, RuleTable& table) {
  const std::pair<const char*, const char**> texts[] = {{"name", &table.name},
                                                        {"type", &table.type},
                                                        {"on", &table.on},
                                                        {"from", &table.from},
                                                        {"phase", &table.phase}};
  const char* key = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : "";
  for (const auto& [name, text] : texts) {
    if (std::strcmp(name, key) != 0) continue;
    if (lua_type(L, -1) != LUA_TSTRING)
      throw Error(std::string("'") + name + "' is a " + luaL_typename(L, -1), {}, "a text");
    *text = lua_tostring(L, -1);
    return;
  }
  if (std::strcmp(key, "follows") == 0) {
    if (lua_type(L, -1) != LUA_TBOOLEAN)
      throw Error(std::string("'follows' is a ") + luaL_typename(L, -1), {}, "true, false");
    table.follows = lua_toboolean(L, -1);
  } else if (std::strcmp(key, "apply") == 0) {
    if (lua_type(L, -1) != LUA_TFUNCTION || lua_iscfunction(L, -1) != 0)
      throw Error(std::string("'apply' is a ") + luaL_typename(L, -1), {},
                  "a function of the script");
    table.applies = true;
  } else {
    throw Error(std::string("a rule has no field '") + key + "'", {},
                "name, type, on, from, phase, follows, apply");
  }
}

Rule rule_of(const RuleTable& table, const std::string& file) {
  if (table.name == nullptr) throw Error("a rule has no name");
  if (!table.applies)
    throw Error(std::string("rule '") + table.name + "': 'apply' is missing", {}, "a function");
  Rule rule;
  rule.name = table.name;
  if (table.type != nullptr) rule.guard.type = table.type;
  rule.guard.kind = named_value<DeltaKind>(table.on, "on", 8);
  rule.guard.origin = named_value<Origin>(table.from, "from", 4);
  rule.guard.phase = named_value<Phase>(table.phase, "phase", 2);
  if (table.follows >= 0) rule.guard.follows = table.follows != 0;
  rule.where = file + ":" + std::to_string(table.line);
  return rule;
}

int RuleScript::declare_rule(lua_State* L, LuaSandbox& sandbox) {
  RuleScript& script = of(L);
  if (!script.loading_) throw Error("a rule is declared within a rule");
  if (lua_type(L, 1) != LUA_TTABLE) wrong_argument(L, 1, "a table: rule{...}");
  lua_settop(L, 1);
  RuleTable table;
  lua_pushnil(L);  // 2: becomes the function
  lua_pushnil(L);
  while (lua_next(L, 1) != 0) {
    read_rule_field(L, table);
    if (lua_type(L, -1) == LUA_TFUNCTION) lua_copy(L, -1, 2);
    lua_pop(L, 1);
  }
  if (table.applies) {
    lua_Debug info;
    lua_pushvalue(L, 2);
    lua_getinfo(L, ">S", &info);
    table.line = info.linedefined;
  }
  script.declared_.rules.push_back(rule_of(table, sandbox.name()));
  lua_getfield(L, LUA_REGISTRYINDEX, kRuleFunctions);
  lua_pushvalue(L, 2);
  lua_rawseti(L, -2, static_cast<lua_Integer>(script.declared_.rules.size()));
  return 0;
}

int RuleScript::declare_bounds(lua_State* L, LuaSandbox&) {
  RuleScript& script = of(L);
  if (!script.loading_) throw Error("the locality is bounded within a rule");
  script.declared_.bounds.emplace_back(text_argument(L, 1));
  return 0;
}

/// Once: the language, and the functions that declare.
int RuleScript::open(lua_State* L) {
  RuleScript& script = *static_cast<RuleScript*>(lua_touserdata(L, 1));
  open_rule_batch(L);
  open_deltas(L);
  open_rotations(L);
  lua_pushlightuserdata(L, &script);
  lua_pushcclosure(L, &bound<declare_rule>, 1);
  lua_setfield(L, LUA_REGISTRYINDEX, "geoprior.rule");
  lua_pushlightuserdata(L, &script);
  lua_pushcclosure(L, &bound<declare_bounds>, 1);
  lua_setfield(L, LUA_REGISTRYINDEX, "geoprior.bounds");
  return 0;
}

/// Runs the chunk with fresh globals and constants.
int RuleScript::prepare(lua_State* L) {
  const RuleScript& script = *static_cast<RuleScript*>(lua_touserdata(L, 1));
  lua_newtable(L);
  lua_setfield(L, LUA_REGISTRYINDEX, kRuleFunctions);
  lua_getfield(L, LUA_REGISTRYINDEX, kRuleChunk);
  push_script_globals(L);
  lua_getfield(L, LUA_REGISTRYINDEX, "geoprior.rule");
  lua_setfield(L, -2, "rule");
  lua_getfield(L, LUA_REGISTRYINDEX, "geoprior.bounds");
  lua_setfield(L, -2, "bounds");
  lua_newtable(L);
  for (const auto& [name, values] : script.constants_) {
    lua_createtable(L, static_cast<int>(values.size()), 0);
    lua_Integer i = 0;
    for (const double value : values) {
      lua_pushnumber(L, value);
      lua_rawseti(L, -2, ++i);
    }
    lua_setfield(L, -2, name.c_str());
  }
  lua_setfield(L, -2, "constants");
  lua_pushvalue(L, -1);
  lua_insert(L, -3);
  lua_setupvalue(L, -2, 1);
  lua_call(L, 0, 0);
  close_script_globals(L);
  return 0;
}

RuleScript::RuleScript(const std::string& text, const std::string& name, const LuaLimits& limits,
                       std::uint64_t seed, ScriptConstants constants)
    : sandbox_(name, limits, seed, &open_script_library), constants_(std::move(constants)) {
  sandbox_.binding = &binding_;
  lua_State* L = sandbox_.state();
  try {
    lua_pushcfunction(L, &RuleScript::open);
    lua_pushlightuserdata(L, this);
    sandbox_.call(1, 0, limits.instructions);
    sandbox_.compile(text);
    lua_setfield(L, LUA_REGISTRYINDEX, kRuleChunk);
    load();
  } catch (const ScriptFailure& failure) {
    throw Error(failure.what, failure.where);
  }
}

void RuleScript::load() {
  const std::size_t rules_before = declared_.rules.size();
  declared_ = {};
  sandbox_.restart_random();
  loading_ = true;
  lua_State* L = sandbox_.state();
  lua_pushcfunction(L, &RuleScript::prepare);
  lua_pushlightuserdata(L, this);
  try {
    sandbox_.call(1, 0, sandbox_.limits().instructions);
  } catch (...) {
    loading_ = false;
    throw;
  }
  loading_ = false;
  if (rules_before > 0 && declared_.rules.size() != rules_before)
    throw ScriptFailure{sandbox_.name(), "declares other rules each time"};
}

void RuleScript::call_rule(std::size_t rule, RuleCall& call) {
  if (&call.now() != last_object_ || call.derivation() != last_derivation_) {
    load();
    last_object_ = &call.now();
    last_derivation_ = call.derivation();
  }
  binding_.begin(call);
  lua_State* L = sandbox_.state();
  lua_getfield(L, LUA_REGISTRYINDEX, kRuleFunctions);
  lua_rawgeti(L, -1, static_cast<lua_Integer>(rule + 1));
  lua_remove(L, -2);
  lua_rawgetp(L, LUA_REGISTRYINDEX, &binding_);
  const LuaLimits& limits = sandbox_.limits();
  sandbox_.call(1, 0,
                limits.instructions + static_cast<double>(limits.instructions_per_element) *
                                          static_cast<double>(call.elements().size()));
  binding_.flush();
}

void RuleScript::apply(std::size_t rule, const std::string& name, RuleCall& call) {
  if (busy_.test_and_set())
    throw Error("serves another derivation at the same time", sandbox_.name(),
                "rules of its own for each thread");
  struct Release {
    RuleScript& script;
    ~Release() {
      script.binding_.end();
      script.busy_.clear();
    }
  } const release{*this};
  binding_.current = call.elements().front();
  try {
    call_rule(rule, call);
  } catch (const ScriptFailure& failure) {
    // What the engine throws names rule and element already.
    const bool named = failure.what.find("rule '") != std::string::npos;
    throw Error(named ? failure.what
                      : "rule '" + name + "', element '" + call.now().label(binding_.current) +
                            "': " + failure.what,
                failure.where);
  }
}

}  // namespace

RuleSet lua_rules(const std::string& text, const std::string& name, const LuaLimits& limits,
                  std::uint64_t seed, const std::map<std::string, std::vector<double>>& constants) {
  const auto script = std::make_shared<RuleScript>(text, name, limits, seed, constants);
  RuleSet out;
  const Declared declared = script->declared();
  for (std::size_t i = 0; i < declared.rules.size(); ++i) {
    Rule rule = declared.rules[i];
    rule.apply = [script, i, name = rule.name](RuleCall& call) { script->apply(i, name, call); };
    out.add(std::move(rule));
  }
  for (const std::string& type : declared.bounds) out.bound_locality(type);
  return out;
}

}  // namespace geoprior::grammar
