#include <cmath>
#include <limits>
#include <lua5.4/lua.hpp>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/methods.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

/// Coordinates as they are: the engine says which rule put which element nowhere.
Eigen::Vector3d place_argument(lua_State* L, int index) {
  return {number_argument(L, index), number_argument(L, index + 1), number_argument(L, index + 2)};
}

/// What is the same number stays the same bits: -0 is not made 0.
int put_element(RuleCall& call, int element, const Pose& pose) {
  const Pose now = call.now().pose(element);
  if (pose.position != now.position || pose.turn.coeffs() != now.turn.coeffs())
    call.set_pose(element, pose);
  return 0;
}

int set_position(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  const int element = batch_element(L, 2);
  return put_element(call, element, {place_argument(L, 3), call.now().turn(element)});
}

int set_turn(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  const int element = batch_element(L, 2);
  return put_element(call, element, {call.now().position(element), turn_argument(L, 3)});
}

int set_pose(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  const int element = batch_element(L, 2);
  return put_element(call, element, {place_argument(L, 3), turn_argument(L, 6)});
}

int set_parameter(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  const int element = batch_element(L, 2);
  const int number = parameter_argument(L, 3, call.now().type_number(element));
  call.set_parameter(element, number, number_argument(L, 4));
  return 0;
}

int set_point(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  const auto points = call.points(batch_element(L, 2));
  const int number = integer_argument(L, 3);
  if (number < 0 || number >= static_cast<int>(points.size()))
    throw Error("there is no point " + std::to_string(number), {},
                points.empty() ? "an element that has points"
                               : "0 to " + std::to_string(points.size() - 1));
  points[number] = point_argument(L, 4);
  return 0;
}

/// Values of all parameters, from a table by names.
std::vector<double> parameter_table(lua_State* L, int index, const ElementType& type) {
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values(type.parameters.size(), kMissing);
  if (lua_type(L, index) == LUA_TTABLE) {
    lua_pushnil(L);
    while (lua_next(L, index) != 0) {
      if (lua_type(L, -2) != LUA_TSTRING) wrong_argument(L, -2, "name of a parameter");
      values[type.parameter(lua_tostring(L, -2))] = finite_argument(L, -1);
      lua_pop(L, 1);
    }
  } else if (!lua_isnoneornil(L, index)) {
    wrong_argument(L, index, "a table of parameters");
  }
  for (std::size_t p = 0; p < values.size(); ++p)
    if (std::isnan(values[p]))
      throw Error("a new '" + type.name + "' needs the parameter '" + type.parameters[p].name +
                  "'");
  return values;
}

int spawn_element(lua_State* L, LuaSandbox& sandbox) {
  RuleCall& call = call_of(L);
  const int parent = batch_element(L, 2);
  const std::string name = text_argument(L, 3);
  const int type = call.now().find_type(name);
  if (type < 0) {
    std::string names;
    for (const ElementType& t : call.now().types()) names += (names.empty() ? "" : ", ") + t.name;
    throw Error("there is no type '" + name + "'", {}, names);
  }
  const Pose pose{point_argument(L, 4), turn_argument(L, 7)};
  const std::vector<double> values = parameter_table(L, 11, call.now().types()[type]);
  const int element = call.spawn(type, parent, pose, values);
  // Ranges are checked by what writes.
  for (std::size_t p = 0; p < values.size(); ++p)
    call.set_parameter(element, static_cast<int>(p), values[p]);
  auto& added = sandbox.binding->added;
  added.push_back(element);
  lua_pushinteger(L, static_cast<lua_Integer>(call.elements().size() + added.size()));
  return 1;
}

int remove_element(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  call.remove(batch_element(L, 2));
  return 0;
}

int child_argument(lua_State* L, const RuleCall& call, int parent) {
  const int child = any_element(L, 3);
  if (call.now().parent(child) != parent)
    throw Error("element '" + call.now().label(child) + "' is no child of '" +
                call.now().label(parent) + "'");
  return child;
}

int remove_child(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  call.remove(child_argument(L, call, batch_element(L, 2)));
  return 0;
}

int restore_child(lua_State* L, LuaSandbox& sandbox) {
  RuleCall& call = call_of(L);
  const int child = child_argument(L, call, batch_element(L, 2));
  if (call.now().present(child))
    throw Error("element '" + call.now().label(child) + "' is present", {}, "one that is not");
  call.restore(child);
  auto& added = sandbox.binding->added;
  added.push_back(child);
  lua_pushinteger(L, static_cast<lua_Integer>(call.elements().size() + added.size()));
  return 1;
}

}  // namespace

void add_writing_methods(lua_State* L) {
  const luaL_Reg methods[] = {
      {"set_position", &bound<set_position>}, {"set_turn", &bound<set_turn>},
      {"set_pose", &bound<set_pose>},         {"set_parameter", &bound<set_parameter>},
      {"set_point", &bound<set_point>},       {"spawn", &bound<spawn_element>},
      {"remove", &bound<remove_element>},     {"remove_child", &bound<remove_child>},
      {"restore", &bound<restore_child>},     {nullptr, nullptr}};
  luaL_setfuncs(L, methods, 0);
}

}  // namespace geoprior::grammar
