#include <cmath>
#include <cstring>
#include <lua5.4/lua.hpp>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/methods.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {

void RuleBinding::begin(RuleCall& next) {
  call = &next;
  current = next.elements().front();
  added.clear();
  pending.children.clear();
  pending.transforms.clear();
}

void RuleBinding::flush() {
  if (pending.children.empty()) return;
  Delta delta{pending.kind};
  call->down(pending.parent, std::move(pending.children), delta, std::move(pending.transforms));
  pending.children.clear();
  pending.transforms.clear();
}

void RuleBinding::end() { call = nullptr; }

RuleCall& call_of(lua_State* L) {
  RuleBinding& binding = *LuaSandbox::of(L).binding;
  if (lua_touserdata(L, 1) != binding.userdata)
    throw Error("a method of the batch is called without it", {}, "b:method(...)");
  if (binding.call == nullptr) throw Error("the batch is used outside of a rule");
  return *binding.call;
}

int batch_element(lua_State* L, int index) {
  RuleBinding& binding = *LuaSandbox::of(L).binding;
  const auto elements = binding.call->elements();
  const int place = integer_argument(L, index);
  const int count = static_cast<int>(elements.size());
  const int all = count + static_cast<int>(binding.added.size());
  if (place < 1 || place > all)
    throw Error("there is no element " + std::to_string(place) + " in the batch", {},
                "1 to " + std::to_string(all));
  binding.current = place <= count ? elements[place - 1] : binding.added[place - count - 1];
  return binding.current;
}

int any_element(lua_State* L, int index) {
  RuleBinding& binding = *LuaSandbox::of(L).binding;
  const int element = integer_argument(L, index);
  const int size = binding.call->now().size();
  if (element < 0 || element >= size)
    throw Error("there is no element of the number " + std::to_string(element), {},
                "0 to " + std::to_string(size - 1));
  return element;
}

int parameter_argument(lua_State* L, int index, int type) {
  RuleBinding& binding = *LuaSandbox::of(L).binding;
  const char* name = text_argument(L, index);
  const ElementType& t = binding.call->now().types()[type];
  // Lua keeps a short text once: its address tells it well enough to look at one place first.
  const auto slot = (reinterpret_cast<std::uintptr_t>(name) >> 4) % binding.parameters.size();
  RuleBinding::Parameter& known = binding.parameters[slot];
  if (known.type == type && known.number < static_cast<int>(t.parameters.size()) &&
      t.parameters[known.number].name == name)
    return known.number;
  const int number = t.parameter(name);
  known = {type, number};
  return number;
}

namespace {

int batch_count(lua_State* L, LuaSandbox&) {
  lua_pushinteger(L, static_cast<lua_Integer>(call_of(L).elements().size()));
  return 1;
}

int batch_kind(lua_State* L, LuaSandbox&) {
  lua_pushstring(L, name_of(call_of(L).kind()).data());
  return 1;
}

int batch_origin(lua_State* L, LuaSandbox&) {
  lua_pushstring(L, name_of(call_of(L).origin()).data());
  return 1;
}

int batch_phase(lua_State* L, LuaSandbox&) {
  lua_pushstring(L, name_of(call_of(L).phase()).data());
  return 1;
}

int batch_follows(lua_State* L, LuaSandbox&) {
  lua_pushboolean(L, call_of(L).follows() ? 1 : 0);
  return 1;
}

int batch_value(lua_State* L, LuaSandbox&) {
  lua_pushnumber(L, call_of(L).delta().value);
  return 1;
}

int batch_asked_parameter(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  const auto& parameters = call.now().type(call.elements().front()).parameters;
  const int number = call.delta().parameter;
  const bool has = call.kind() == DeltaKind::extrude || call.kind() == DeltaKind::set_parameter;
  if (!has || number < 0 || number >= static_cast<int>(parameters.size())) {
    lua_pushnil(L);
  } else {
    lua_pushstring(L, parameters[number].name.c_str());
  }
  return 1;
}

int batch_sender(lua_State* L, LuaSandbox&) {
  const int sender = call_of(L).sender();
  if (sender < 0) {
    lua_pushnil(L);
  } else {
    lua_pushinteger(L, sender);
  }
  return 1;
}

int batch_edited(lua_State* L, LuaSandbox&) {
  lua_pushinteger(L, call_of(L).edited());
  return 1;
}

int batch_derivation(lua_State* L, LuaSandbox&) {
  lua_pushinteger(L, static_cast<lua_Integer>(call_of(L).derivation()));
  return 1;
}

int batch_type(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  lua_pushstring(L, call.now().type(call.elements().front()).name.c_str());
  return 1;
}

}  // namespace

void open_rule_batch(lua_State* L) {
  RuleBinding& binding = *LuaSandbox::of(L).binding;
  binding.userdata = lua_newuserdatauv(L, 1, 0);
  lua_newtable(L);
  lua_newtable(L);
  const luaL_Reg methods[] = {{"count", &bound<batch_count>},
                              {"kind", &bound<batch_kind>},
                              {"origin", &bound<batch_origin>},
                              {"phase", &bound<batch_phase>},
                              {"follows", &bound<batch_follows>},
                              {"value", &bound<batch_value>},
                              {"asked_parameter", &bound<batch_asked_parameter>},
                              {"sender", &bound<batch_sender>},
                              {"edited", &bound<batch_edited>},
                              {"derivation", &bound<batch_derivation>},
                              {"type", &bound<batch_type>},
                              {nullptr, nullptr}};
  luaL_setfuncs(L, methods, 0);
  add_reading_methods(L);
  add_map_methods(L);
  add_writing_methods(L);
  add_asking_methods(L);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, &bound<batch_count>);
  lua_setfield(L, -2, "__len");
  lua_setmetatable(L, -2);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &binding);
}

}  // namespace geoprior::grammar
