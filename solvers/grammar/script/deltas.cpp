#include <cmath>
#include <cstring>
#include <lua5.4/lua.hpp>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/library.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

/// A new delta on top of the stack. Raises errors of Lua.
int push_delta(lua_State* L, const ScriptDelta& delta) {
  *static_cast<ScriptDelta*>(lua_newuserdatauv(L, sizeof(ScriptDelta), 0)) = delta;
  return 1;
}

ScriptDelta with_transform(DeltaKind kind, const Eigen::Affine3d& transform) {
  ScriptDelta delta{kind};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      delta.rows[4 * row + column] = transform(row, column);
  return delta;
}

int delta_identity(lua_State* L, LuaSandbox&) { return push_delta(L, {}); }

int delta_translate(lua_State* L, LuaSandbox&) {
  const Eigen::Affine3d shift{Eigen::Translation3d(point_argument(L, 1))};
  return push_delta(L, with_transform(DeltaKind::translate, shift));
}

int delta_rigid(lua_State* L, LuaSandbox&) {
  return push_delta(L, with_transform(DeltaKind::rigid, motion_argument(L, 1)));
}

/// About a point: x -> p + q (x - p).
int delta_turn(lua_State* L, LuaSandbox&) {
  const Eigen::Vector3d p = point_argument(L, 1);
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  turn.linear() = turn_argument(L, 4).toRotationMatrix();
  turn.translation() = p - turn.linear() * p;
  return push_delta(L, with_transform(DeltaKind::rigid, turn));
}

int delta_affine(lua_State* L, LuaSandbox&) {
  ScriptDelta delta{DeltaKind::affine};
  for (int i = 0; i < 12; ++i) delta.rows[i] = finite_argument(L, i + 1);
  return push_delta(L, delta);
}

int of_parameter(lua_State* L, DeltaKind kind) {
  const char* name = text_argument(L, 1);
  ScriptDelta delta{kind};
  if (std::strlen(name) >= sizeof(delta.parameter)) wrong_argument(L, 1, "name of a parameter");
  std::strcpy(delta.parameter, name);
  delta.value = finite_argument(L, 2);
  return push_delta(L, delta);
}

int delta_set(lua_State* L, LuaSandbox&) { return of_parameter(L, DeltaKind::set_parameter); }
int delta_extrude(lua_State* L, LuaSandbox&) { return of_parameter(L, DeltaKind::extrude); }

int delta_children(lua_State* L, LuaSandbox&) {
  ScriptDelta delta{DeltaKind::children};
  delta.value = integer_argument(L, 1);
  return push_delta(L, delta);
}

}  // namespace

const ScriptDelta& delta_argument(lua_State* L, int index) {
  // Scripts have two kinds of userdata, of different sizes.
  if (lua_type(L, index) != LUA_TUSERDATA || lua_rawlen(L, index) != sizeof(ScriptDelta))
    wrong_argument(L, index, "a deformation (delta.…)");
  return *static_cast<const ScriptDelta*>(lua_touserdata(L, index));
}

Delta delta_for(const ScriptDelta& delta, const ElementType& type) {
  Delta out{delta.kind};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      if (delta.kind == DeltaKind::rigid || delta.kind == DeltaKind::affine ||
          delta.kind == DeltaKind::translate)
        out.transform(row, column) = delta.rows[4 * row + column];
  out.value = delta.value;
  if (delta.parameter[0] != 0) out.parameter = type.parameter(delta.parameter);
  return out;
}

Eigen::Vector3d point_argument(lua_State* L, int index) {
  return {finite_argument(L, index), finite_argument(L, index + 1), finite_argument(L, index + 2)};
}

Eigen::Quaterniond turn_argument(lua_State* L, int index) {
  constexpr double kRoundOff = 1e-14, kCareless = 1e-6;
  Eigen::Quaterniond q(finite_argument(L, index + 3), finite_argument(L, index),
                       finite_argument(L, index + 1), finite_argument(L, index + 2));
  const double off = std::abs(q.squaredNorm() - 1);
  if (off > kCareless)
    throw Error("the quaternion has the norm " + std::to_string(q.norm()), {}, "1");
  if (off > kRoundOff) q.normalize();
  return q;
}

Eigen::Affine3d motion_argument(lua_State* L, int index) {
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.translation() = point_argument(L, index);
  motion.linear() = turn_argument(L, index + 3).toRotationMatrix();
  return motion;
}

int push_point(lua_State* L, const Eigen::Vector3d& x) {
  for (int k = 0; k < 3; ++k) lua_pushnumber(L, x[k]);
  return 3;
}

int push_turn(lua_State* L, const Eigen::Quaterniond& q) {
  for (int k = 0; k < 4; ++k) lua_pushnumber(L, q.coeffs()[k]);
  return 4;
}

void open_deltas(lua_State* L) {
  lua_newtable(L);
  const luaL_Reg functions[] = {{"identity", &bound<delta_identity>},
                                {"translate", &bound<delta_translate>},
                                {"rigid", &bound<delta_rigid>},
                                {"turn", &bound<delta_turn>},
                                {"affine", &bound<delta_affine>},
                                {"set", &bound<delta_set>},
                                {"extrude", &bound<delta_extrude>},
                                {"children", &bound<delta_children>},
                                {nullptr, nullptr}};
  luaL_setfuncs(L, functions, 0);
  add_script_library(L, "delta");
}

}  // namespace geoprior::grammar
