#include <lua5.4/lua.hpp>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/methods.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

using NamedElement = int (*)(lua_State*, int);

int batch_number(lua_State* L, LuaSandbox&) {
  call_of(L);
  lua_pushinteger(L, batch_element(L, 2));
  return 1;
}

template <NamedElement named>
int position_before(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_point(L, call.pose_before(named(L, 2)).position);
}

template <NamedElement named>
int turn_before(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_turn(L, call.pose_before(named(L, 2)).turn);
}

template <NamedElement named>
int pose_before(lua_State* L, LuaSandbox&) {
  const Pose pose = call_of(L).pose_before(named(L, 2));
  push_point(L, pose.position);
  return 3 + push_turn(L, pose.turn);
}

template <NamedElement named>
int parameter_before(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const int element = named(L, 2);
  const int number = parameter_argument(L, 3, call.now().type_number(element));
  lua_pushnumber(L, call.parameter_before(element, number));
  return 1;
}

int position_now(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_point(L, call.now().position(any_element(L, 2)));
}

int turn_now(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_turn(L, call.now().turn(any_element(L, 2)));
}

int pose_now(lua_State* L, LuaSandbox&) {
  const Pose pose = call_of(L).now().pose(any_element(L, 2));
  push_point(L, pose.position);
  return 3 + push_turn(L, pose.turn);
}

int parameter_now(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const int element = any_element(L, 2);
  const int number = parameter_argument(L, 3, call.now().type_number(element));
  lua_pushnumber(L, call.now().parameter(element, number));
  return 1;
}

template <NamedElement named>
int parent_number(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const int parent = call.now().parent(named(L, 2));
  if (parent < 0) {
    lua_pushnil(L);
  } else {
    lua_pushinteger(L, parent);
  }
  return 1;
}

/// Those that are present, in order.
template <NamedElement named>
int child_numbers(lua_State* L, LuaSandbox& sandbox) {
  const Hierarchy& h = call_of(L).now();
  const std::vector<int>& children = h.children(named(L, 2));
  sandbox.charge(static_cast<double>(children.size()) / 4);
  lua_createtable(L, static_cast<int>(children.size()), 0);
  lua_Integer i = 0;
  for (const int child : children) {
    if (!h.present(child)) continue;
    lua_pushinteger(L, child);
    lua_rawseti(L, -2, ++i);
  }
  return 1;
}

/// All, those that are not present among them: what `restore` may show.
int absent_children(lua_State* L, LuaSandbox& sandbox) {
  const Hierarchy& h = call_of(L).now();
  const std::vector<int>& children = h.children(batch_element(L, 2));
  sandbox.charge(static_cast<double>(children.size()) / 4);
  lua_newtable(L);
  lua_Integer i = 0;
  for (const int child : children) {
    if (h.present(child)) continue;
    lua_pushinteger(L, child);
    lua_rawseti(L, -2, ++i);
  }
  return 1;
}

int type_of(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  lua_pushstring(L, call.now().type(any_element(L, 2)).name.c_str());
  return 1;
}

int is_present(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  lua_pushboolean(L, call.now().present(any_element(L, 2)) ? 1 : 0);
  return 1;
}

int label_of(lua_State* L, LuaSandbox& sandbox) {
  const RuleCall& call = call_of(L);
  const int element = any_element(L, 2);
  sandbox.charge(static_cast<double>(element) / 8);
  sandbox.binding->text = call.now().label(element);
  lua_pushstring(L, sandbox.binding->text.c_str());
  return 1;
}

int found_element(lua_State* L, LuaSandbox& sandbox) {
  const RuleCall& call = call_of(L);
  sandbox.charge(static_cast<double>(call.now().size()) / 8);
  lua_pushinteger(L, call.now().find(text_argument(L, 2), {}));
  return 1;
}

int tag_of(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const Tag* tag = call.now().tag(any_element(L, 2));
  if (tag == nullptr) {
    lua_pushnil(L);
  } else {
    lua_pushstring(L, tag->follow == Tag::Follow::rigid ? "rigid" : "stop");
  }
  return 1;
}

const Eigen::Vector3d& point_of_span(lua_State* L, std::span<const Eigen::Vector3d> points) {
  const int number = integer_argument(L, 3);
  if (number < 0 || number >= static_cast<int>(points.size()))
    throw Error("there is no point " + std::to_string(number), {},
                points.empty() ? "an element that has points"
                               : "0 to " + std::to_string(points.size() - 1));
  return points[number];
}

int point_before(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_point(L, point_of_span(L, call.points_before(any_element(L, 2))));
}

int point_now(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_point(L, point_of_span(L, call.now().points(any_element(L, 2))));
}

int point_count(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  lua_pushinteger(L, static_cast<lua_Integer>(call.now().points(any_element(L, 2)).size()));
  return 1;
}

int triangle_of(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const Eigen::MatrixX3i& triangles = call.now().type(any_element(L, 2)).triangles;
  const int number = integer_argument(L, 3);
  if (number < 0 || number >= triangles.rows())
    throw Error("there is no triangle " + std::to_string(number), {},
                triangles.rows() == 0 ? "an element whose type has triangles"
                                      : "0 to " + std::to_string(triangles.rows() - 1));
  for (int k = 0; k < 3; ++k) lua_pushinteger(L, triangles(number, k));
  return 3;
}

/// Key points as one list of coordinates.
int push_keys(lua_State* L, LuaSandbox& sandbox) {
  const auto& points = sandbox.binding->points;
  sandbox.charge(static_cast<double>(points.size()));
  lua_createtable(L, static_cast<int>(3 * points.size()), 0);
  lua_Integer i = 0;
  for (const Eigen::Vector3d& x : points)
    for (int k = 0; k < 3; ++k) {
      lua_pushnumber(L, x[k]);
      lua_rawseti(L, -2, ++i);
    }
  return 1;
}

int keys_before(lua_State* L, LuaSandbox& sandbox) {
  const RuleCall& call = call_of(L);
  sandbox.binding->points.clear();
  call.keys_before(any_element(L, 2), sandbox.binding->points);
  return push_keys(L, sandbox);
}

int keys_now(lua_State* L, LuaSandbox& sandbox) {
  const RuleCall& call = call_of(L);
  sandbox.binding->points.clear();
  call.now().keys(any_element(L, 2), sandbox.binding->points);
  return push_keys(L, sandbox);
}

}  // namespace

void add_reading_methods(lua_State* L) {
  const luaL_Reg methods[] = {{"element", &bound<batch_number>},
                              {"position", &bound<position_before<batch_element>>},
                              {"position_of", &bound<position_before<any_element>>},
                              {"position_now", &bound<position_now>},
                              {"turn", &bound<turn_before<batch_element>>},
                              {"turn_of", &bound<turn_before<any_element>>},
                              {"turn_now", &bound<turn_now>},
                              {"pose", &bound<pose_before<batch_element>>},
                              {"pose_of", &bound<pose_before<any_element>>},
                              {"pose_now", &bound<pose_now>},
                              {"parameter", &bound<parameter_before<batch_element>>},
                              {"parameter_of", &bound<parameter_before<any_element>>},
                              {"parameter_now", &bound<parameter_now>},
                              {"parent", &bound<parent_number<batch_element>>},
                              {"parent_of", &bound<parent_number<any_element>>},
                              {"children", &bound<child_numbers<batch_element>>},
                              {"children_of", &bound<child_numbers<any_element>>},
                              {"absent_children", &bound<absent_children>},
                              {"type_of", &bound<type_of>},
                              {"present", &bound<is_present>},
                              {"label", &bound<label_of>},
                              {"find", &bound<found_element>},
                              {"tag", &bound<tag_of>},
                              {"point_count", &bound<point_count>},
                              {"point_of", &bound<point_before>},
                              {"point_now", &bound<point_now>},
                              {"triangle_of", &bound<triangle_of>},
                              {"keys_of", &bound<keys_before>},
                              {"keys_now", &bound<keys_now>},
                              {nullptr, nullptr}};
  luaL_setfuncs(L, methods, 0);
}

}  // namespace geoprior::grammar
