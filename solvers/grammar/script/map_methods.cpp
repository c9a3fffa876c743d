#include <lua5.4/lua.hpp>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/methods.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

/// Where the deformation that is asked of an element takes a point.
Eigen::Vector3d asked_image(const RuleCall& call, std::size_t place, const Eigen::Vector3d& x) {
  switch (call.kind()) {
    case DeltaKind::free:
      return call.delta().map->at(x);
    case DeltaKind::rigid:
    case DeltaKind::affine:
    case DeltaKind::translate:
      return call.transform(place) * x;
    default:
      return x;
  }
}

MappedPoint asked_frame(const RuleCall& call, std::size_t place, const Eigen::Vector3d& x) {
  switch (call.kind()) {
    case DeltaKind::free:
      return call.delta().map->with_jacobian(x);
    case DeltaKind::rigid:
    case DeltaKind::affine:
    case DeltaKind::translate: {
      const Eigen::Affine3d& t = call.transform(place);
      return {t * x, t.linear()};
    }
    default:
      return {x, Eigen::Matrix3d::Identity()};
  }
}

/// A place in the batch itself: what is added in a call is asked for nothing.
std::size_t asked_place(lua_State* L, const RuleCall& call) {
  const int place = integer_argument(L, 2);
  const int count = static_cast<int>(call.elements().size());
  if (place < 1 || place > count)
    throw Error("there is no element " + std::to_string(place) + " in the batch", {},
                "1 to " + std::to_string(count));
  batch_element(L, 2);
  return static_cast<std::size_t>(place - 1);
}

int batch_map(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_point(L, asked_image(call, asked_place(L, call), point_argument(L, 3)));
}

/// The point, then the derivative by rows.
int batch_jacobian(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const MappedPoint m = asked_frame(call, asked_place(L, call), point_argument(L, 3));
  push_point(L, m.position);
  for (int i = 0; i < 9; ++i) lua_pushnumber(L, m.jacobian(i / 3, i % 3));
  return 12;
}

/// The point, then the rotation of the polar decomposition.
int push_moved(lua_State* L, const MappedPoint& m) {
  push_point(L, m.position);
  return 3 + push_turn(L, m.jacobian.isIdentity(0) ? Eigen::Quaterniond::Identity()
                                                   : rotation_of(m.jacobian));
}

int batch_mapped(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const std::size_t place = asked_place(L, call);
  return push_moved(L, asked_frame(call, place, call.pose_before(call.elements()[place]).position));
}

int batch_moved(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  return push_moved(L, asked_frame(call, asked_place(L, call), point_argument(L, 3)));
}

/// Linear part and shift, by rows.
int batch_transform(lua_State* L, LuaSandbox&) {
  const RuleCall& call = call_of(L);
  const Eigen::Affine3d& t = call.transform(asked_place(L, call));
  for (int i = 0; i < 12; ++i) lua_pushnumber(L, t(i / 4, i % 4));
  return 12;
}

}  // namespace

void add_map_methods(lua_State* L) {
  const luaL_Reg methods[] = {{"map", &bound<batch_map>},
                              {"map_jacobian", &bound<batch_jacobian>},
                              {"map_rotation", &bound<batch_moved>},
                              {"mapped", &bound<batch_mapped>},
                              {"transform", &bound<batch_transform>},
                              {nullptr, nullptr}};
  luaL_setfuncs(L, methods, 0);
}

}  // namespace geoprior::grammar
