#pragma once

#include <array>
#include <string>
#include <vector>

#include "solvers/grammar/engine/rule.h"

struct lua_State;

namespace geoprior::grammar {

/// What the functions of the language work on: the batch of the call of a rule, through RuleCall
/// only.
struct RuleBinding {
  RuleCall* call = nullptr;  ///< null outside of a rule
  void* userdata = nullptr;  ///< what scripts have for it
  int current = -1;          ///< element that the script named last: for messages
  std::vector<int> added;    ///< elements that the call spawned or restored

  /// Symbols for children of one element that are sent as one batch.
  struct Pending {
    int parent = -1;
    DeltaKind kind = DeltaKind::identity;
    std::vector<int> children;
    std::vector<Eigen::Affine3d> transforms;
  };
  Pending pending;

  /// Numbers of parameters by type and name: looked up once.
  struct Parameter {
    int type = -1;
    int number = 0;
  };
  std::array<Parameter, 64> parameters = {};

  // Kept here because errors of Lua skip destructors.
  std::string text;
  std::vector<Eigen::Vector3d> points;

  void begin(RuleCall& next);
  /// Sends what is pending. @throws Error  of the engine
  void flush();
  void end();
};

/// Defines the type of batches and leaves its methods in the registry. Raises errors of Lua.
void open_rule_batch(lua_State* L);

/// Defines the libraries `delta` and `rotation`. Raises errors of Lua.
void open_deltas(lua_State* L);
void open_rotations(lua_State* L);

/// A deformation as scripts make it. Without a destructor: Lua owns it.
struct ScriptDelta {
  DeltaKind kind = DeltaKind::identity;
  double rows[12] = {};  ///< linear part and shift, by rows
  double value = 0;
  char parameter[64] = {};
};
/// @param index  of an argument. @throws Error  when it is none
const ScriptDelta& delta_argument(lua_State* L, int index);
/// The same for elements of a type. @throws Error  naming the type, without such a parameter
Delta delta_for(const ScriptDelta& delta, const ElementType& type);
/// x -> q x + t, of seven arguments from `index` on: t, then q (x, y, z, w).
Eigen::Affine3d motion_argument(lua_State* L, int index);
/// A unit quaternion of four arguments (x, y, z, w); round-off is set right.
Eigen::Quaterniond turn_argument(lua_State* L, int index);
Eigen::Vector3d point_argument(lua_State* L, int index);

// Results: they never raise.
int push_point(lua_State* L, const Eigen::Vector3d& x);
int push_turn(lua_State* L, const Eigen::Quaterniond& q);

// Of a batch's methods: what they name. The first argument is the batch.
RuleCall& call_of(lua_State* L);
/// A place in the batch, counted from 1; behind the batch come elements that the call added.
int batch_element(lua_State* L, int index);
/// Any element, by its number.
int any_element(lua_State* L, int index);
int parameter_argument(lua_State* L, int index, int type);

}  // namespace geoprior::grammar
