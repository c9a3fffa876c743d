#pragma once

struct lua_State;

namespace geoprior::grammar {

class LuaSandbox;

// Functions for scripts that go over tables (for `bound`): in a defined order, and counted as
// instructions by what they touch.

int ordered_pairs(lua_State* L, LuaSandbox& sandbox);
int ordered_next(lua_State* L, LuaSandbox& sandbox);
/// Merge sort: n log2 n comparisons; equal elements keep their order, whatever the comparison says.
int stable_sort(lua_State* L, LuaSandbox& sandbox);

// Lua's own functions, each the first upvalue.
int counted_concat(lua_State* L, LuaSandbox& sandbox);
int counted_insert(lua_State* L, LuaSandbox& sandbox);
int counted_move(lua_State* L, LuaSandbox& sandbox);
int counted_remove(lua_State* L, LuaSandbox& sandbox);
int counted_unpack(lua_State* L, LuaSandbox& sandbox);

}  // namespace geoprior::grammar
