#include <lua5.4/lua.hpp>
#include <map>

#include "core/error.h"
#include "solvers/grammar/script/binding.h"
#include "solvers/grammar/script/methods.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

void require_asking_phase(const RuleCall& call, Phase phase, const char* what) {
  if (call.phase() != phase)
    throw Error(std::string(what) + " in the phase " + std::string(name_of(call.phase())), {},
                "in the phase " + std::string(name_of(phase)));
}

void require_child_of(const Hierarchy& h, int child, int parent) {
  if (child < 0 || child >= h.size())
    throw Error("there is no element of the number " + std::to_string(child), {},
                "0 to " + std::to_string(h.size() - 1));
  if (h.parent(child) != parent)
    throw Error("element '" + h.label(child) + "' is no child of '" + h.label(parent) + "'");
}

/// All children, or those that are named: by one number or a list of them.
std::vector<int> children_argument(lua_State* L, int index, const Hierarchy& h, int parent) {
  if (lua_isnoneornil(L, index)) return h.children(parent);
  std::vector<int> children;
  if (lua_type(L, index) != LUA_TTABLE) {
    children.push_back(integer_argument(L, index));
  } else {
    const auto count = static_cast<lua_Integer>(lua_rawlen(L, index));
    for (lua_Integer i = 1; i <= count; ++i) {
      lua_rawgeti(L, index, i);
      children.push_back(integer_argument(L, -1));
      lua_pop(L, 1);
    }
  }
  for (const int child : children) require_child_of(h, child, parent);
  return children;
}

/// down(i [, delta [, children]])
int ask_down(lua_State* L, LuaSandbox& sandbox) {
  RuleCall& call = call_of(L);
  require_asking_phase(call, Phase::down, "asks children");
  sandbox.binding->flush();
  const int parent = batch_element(L, 2);
  std::vector<int> children = children_argument(L, 4, call.now(), parent);
  if (children.empty()) return 0;
  sandbox.charge(static_cast<double>(children.size()) / 4);
  if (lua_isnoneornil(L, 3)) {
    Delta delta = call.delta();
    const int place = integer_argument(L, 2);
    if (place <= static_cast<int>(call.elements().size()))
      delta.transform = call.transform(static_cast<std::size_t>(place - 1));
    call.down(parent, std::move(children), delta);
    return 0;
  }
  const ScriptDelta& delta = delta_argument(L, 3);
  if (delta.parameter[0] == 0) {
    call.down(parent, std::move(children), delta_for(delta, call.now().type(parent)));
    return 0;
  }
  // Types number their parameters each in its own way.
  std::map<int, std::vector<int>> by_type;
  for (const int child : children) by_type[call.now().type_number(child)].push_back(child);
  for (auto& [type, some] : by_type)
    call.down(parent, std::move(some), delta_for(delta, call.now().types()[type]));
  return 0;
}

/// One child among those that are asked the same kind together.
void ask_child(lua_State* L, LuaSandbox& sandbox, DeltaKind kind,
               const Eigen::Affine3d& transform) {
  RuleCall& call = call_of(L);
  require_asking_phase(call, Phase::down, "asks a child");
  RuleBinding::Pending& pending = sandbox.binding->pending;
  const int parent = batch_element(L, 2);
  const int child = integer_argument(L, 3);
  require_child_of(call.now(), child, parent);
  if (pending.parent != parent || pending.kind != kind) sandbox.binding->flush();
  pending.parent = parent;
  pending.kind = kind;
  pending.children.push_back(child);
  pending.transforms.push_back(transform);
}

int ask_down_translate(lua_State* L, LuaSandbox& sandbox) {
  const Eigen::Affine3d shift{Eigen::Translation3d(point_argument(L, 4))};
  ask_child(L, sandbox, DeltaKind::translate, shift);
  return 0;
}

int ask_down_rigid(lua_State* L, LuaSandbox& sandbox) {
  ask_child(L, sandbox, DeltaKind::rigid, motion_argument(L, 4));
  return 0;
}

/// The batch's own deformation, or the one that is given, for an element.
Delta up_delta(lua_State* L, const RuleCall& call, int element) {
  if (lua_isnoneornil(L, 2)) return call.delta();
  return delta_for(delta_argument(L, 2), call.now().type(element));
}

int ask_up(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  require_asking_phase(call, Phase::up, "asks the parent");
  const int element = call.elements().front();
  const int parent = call.now().parent(element);
  call.up(up_delta(L, call, parent < 0 ? element : parent));
  return 0;
}

int absorb_here(lua_State* L, LuaSandbox&) {
  RuleCall& call = call_of(L);
  require_asking_phase(call, Phase::up, "bounds the locality");
  call.absorb(up_delta(L, call, call.elements().front()));
  return 0;
}

}  // namespace

void add_asking_methods(lua_State* L) {
  const luaL_Reg methods[] = {{"down", &bound<ask_down>},
                              {"down_translate", &bound<ask_down_translate>},
                              {"down_rigid", &bound<ask_down_rigid>},
                              {"up", &bound<ask_up>},
                              {"absorb", &bound<absorb_here>},
                              {nullptr, nullptr}};
  luaL_setfuncs(L, methods, 0);
}

}  // namespace geoprior::grammar
