#include <cmath>
#include <lua5.4/lua.hpp>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/library.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

/// First b, then a.
int rotation_product(lua_State* L, LuaSandbox&) {
  return push_turn(L, turn_argument(L, 1) * turn_argument(L, 5));
}

int rotation_inverse(lua_State* L, LuaSandbox&) {
  return push_turn(L, turn_argument(L, 1).conjugate());
}

int rotation_apply(lua_State* L, LuaSandbox&) {
  return push_point(L, turn_argument(L, 1) * point_argument(L, 5));
}

int rotation_about(lua_State* L, LuaSandbox&) {
  const Eigen::Vector3d axis = point_argument(L, 1);
  if (!(axis.norm() > 0)) throw Error("the axis has no direction", {}, "a vector that is not 0");
  return push_turn(L,
                   Eigen::Quaterniond(Eigen::AngleAxisd(finite_argument(L, 4), axis.normalized())));
}

/// The rotation about an axis that is in q: q = swing * twist, the swing about an axis across.
int rotation_twist(lua_State* L, LuaSandbox&) {
  const Eigen::Quaterniond q = turn_argument(L, 1);
  const Eigen::Vector3d axis = point_argument(L, 5).normalized();
  const double along = q.vec().dot(axis);
  const double norm = std::hypot(along, q.w());
  // A half turn about an axis across has no twist.
  if (!(norm > 1e-12)) return push_turn(L, Eigen::Quaterniond::Identity());
  Eigen::Quaterniond twist;
  twist.w() = q.w() / norm;
  twist.vec() = axis * (along / norm);
  return push_turn(L, twist);
}

/// Nearest to a matrix, by rows.
int rotation_of_matrix(lua_State* L, LuaSandbox&) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = finite_argument(L, i + 1);
  if (!(m.determinant() > 0))
    throw Error("the matrix has the determinant " + std::to_string(m.determinant()), {},
                "a positive one");
  return push_turn(L, rotation_of(m));
}

}  // namespace

void open_rotations(lua_State* L) {
  lua_newtable(L);
  const luaL_Reg functions[] = {{"product", &bound<rotation_product>},
                                {"inverse", &bound<rotation_inverse>},
                                {"apply", &bound<rotation_apply>},
                                {"about", &bound<rotation_about>},
                                {"twist", &bound<rotation_twist>},
                                {"of_matrix", &bound<rotation_of_matrix>},
                                {nullptr, nullptr}};
  luaL_setfuncs(L, functions, 0);
  add_script_library(L, "rotation");
}

}  // namespace geoprior::grammar
