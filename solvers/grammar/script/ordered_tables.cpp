#include "solvers/grammar/script/ordered_tables.h"

#include <algorithm>
#include <cstring>
#include <lua5.4/lua.hpp>
#include <string>
#include <utility>

#include "core/error.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

constexpr int kMostUnpacked = 200;

/// A key of a table as it is ordered. Without a destructor: it may lie in memory of Lua's.
struct TableKey {
  int kind;            ///< 0: number, 1: text, 2: boolean
  long double number;  ///< holds integers of 64 bits and doubles alike
  const char* text;
  std::size_t size;
  lua_Integer slot;

  bool operator<(const TableKey& other) const {
    if (kind != other.kind) return kind < other.kind;
    if (kind != 1) return number < other.number;
    const int order = std::memcmp(text, other.text, std::min(size, other.size));
    return order != 0 ? order < 0 : size < other.size;
  }
};

TableKey table_key(lua_State* L, int index, lua_Integer slot) {
  switch (lua_type(L, index)) {
    case LUA_TNUMBER: {
      const long double value = lua_isinteger(L, index) != 0
                                    ? static_cast<long double>(lua_tointeger(L, index))
                                    : static_cast<long double>(lua_tonumber(L, index));
      return {0, value, nullptr, 0, slot};
    }
    case LUA_TSTRING: {
      std::size_t size = 0;
      const char* text = lua_tolstring(L, index, &size);
      return {1, 0, text, size, slot};
    }
    case LUA_TBOOLEAN:
      return {2, static_cast<long double>(lua_toboolean(L, index)), nullptr, 0, slot};
    default:
      throw Error(std::string("a key of the table is a ") + luaL_typename(L, index), {},
                  "numbers, texts, booleans: others have no order");
  }
}

void require_table(lua_State* L) {
  if (lua_type(L, 1) != LUA_TTABLE) wrong_argument(L, 1, "a table");
}

/// Upvalues: the table, its keys in order, how many of them are done.
int next_pair(lua_State* L, LuaSandbox&) {
  lua_Integer done = lua_tointeger(L, lua_upvalueindex(3));
  while (true) {
    lua_settop(L, 0);
    if (lua_rawgeti(L, lua_upvalueindex(2), ++done) == LUA_TNIL) return 1;
    lua_pushvalue(L, 1);
    // Keys that were removed on the way are left out.
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) break;
  }
  lua_pushinteger(L, done);
  lua_replace(L, lua_upvalueindex(3));
  return 2;
}

/// Whether the value at `a` comes before that at `b`, by the function at 2 if there is one.
bool comes_before(lua_State* L, int a, int b) {
  if (lua_isnil(L, 2)) return lua_compare(L, a, b, LUA_OPLT) != 0;
  lua_pushvalue(L, 2);
  lua_pushvalue(L, a);
  lua_pushvalue(L, b);
  lua_call(L, 2, 1);
  const bool before = lua_toboolean(L, -1) != 0;
  lua_pop(L, 1);
  return before;
}

/// Merges the runs [first, middle) and [middle, last) of the table at `from` into that at `to`.
void merge_runs(lua_State* L, int from, int to, lua_Integer first, lua_Integer middle,
                lua_Integer last) {
  lua_Integer left = first, right = middle;
  for (lua_Integer out = first; out < last; ++out) {
    bool take_right = left >= middle;
    if (left < middle && right < last) {
      lua_rawgeti(L, from, left);
      lua_rawgeti(L, from, right);
      const int top = lua_gettop(L);
      take_right = comes_before(L, top, top - 1);
      lua_pop(L, 2);
    }
    lua_rawgeti(L, from, take_right ? right++ : left++);
    lua_rawseti(L, to, out);
  }
}

/// Calls Lua's own function with the arguments.
int call_table_function(lua_State* L) {
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

}  // namespace

int ordered_pairs(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  lua_settop(L, 1);
  lua_Integer count = 0;
  lua_pushnil(L);
  while (lua_next(L, 1) != 0) {
    lua_pop(L, 1);
    ++count;
  }
  sandbox.charge(static_cast<double>(4 * count));
  lua_newtable(L);  // 2: the keys as they come
  auto* keys = static_cast<TableKey*>(
      lua_newuserdatauv(L, static_cast<std::size_t>(count + 1) * sizeof(TableKey), 0));
  lua_Integer slot = 0;
  lua_pushnil(L);
  while (lua_next(L, 1) != 0) {
    lua_pop(L, 1);
    keys[slot] = table_key(L, -1, slot + 1);
    lua_pushvalue(L, -1);
    lua_rawseti(L, 2, ++slot);
  }
  std::sort(keys, keys + slot);
  lua_pushvalue(L, 1);
  lua_createtable(L, static_cast<int>(std::min<lua_Integer>(slot, 1 << 20)), 0);
  for (lua_Integer i = 0; i < slot; ++i) {
    lua_rawgeti(L, 2, keys[i].slot);
    lua_rawseti(L, -2, i + 1);
  }
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, &bound<next_pair>, 3);
  return 1;
}

int ordered_next(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  lua_settop(L, 2);
  const bool first = lua_isnil(L, 2);
  const TableKey after = first ? TableKey{} : table_key(L, 2, 0);
  lua_pushnil(L);  // 3: the best key so far
  TableKey best{};
  bool found = false;
  lua_pushnil(L);
  while (lua_next(L, 1) != 0) {
    lua_pop(L, 1);
    sandbox.charge(1);
    const TableKey key = table_key(L, -1, 0);
    if ((!first && !(after < key)) || (found && !(key < best))) continue;
    best = key;
    found = true;
    lua_copy(L, -1, 3);
  }
  lua_settop(L, 3);
  if (!found) return 1;
  lua_pushvalue(L, 3);
  lua_rawget(L, 1);
  return 2;
}

int stable_sort(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  lua_settop(L, 2);
  if (!lua_isnil(L, 2) && lua_type(L, 2) != LUA_TFUNCTION) wrong_argument(L, 2, "a function");
  const auto count = static_cast<lua_Integer>(lua_rawlen(L, 1));
  lua_newtable(L);  // 3: where runs are merged to
  int from = 1, to = 3;
  for (lua_Integer width = 1; width < count; width *= 2) {
    sandbox.charge(static_cast<double>(4 * count));
    for (lua_Integer first = 1; first <= count; first += 2 * width)
      merge_runs(L, from, to, first, std::min(first + width, count + 1),
                 std::min(first + 2 * width, count + 1));
    std::swap(from, to);
  }
  if (from == 1) return 0;
  for (lua_Integer i = 1; i <= count; ++i) {
    lua_rawgeti(L, 3, i);
    lua_rawseti(L, 1, i);
  }
  return 0;
}

int counted_concat(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  sandbox.charge(static_cast<double>(lua_rawlen(L, 1)));
  return call_table_function(L);
}

int counted_insert(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  if (lua_gettop(L) > 2) sandbox.charge(static_cast<double>(lua_rawlen(L, 1)));
  return call_table_function(L);
}

int counted_remove(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  if (lua_gettop(L) > 1) sandbox.charge(static_cast<double>(lua_rawlen(L, 1)));
  return call_table_function(L);
}

int counted_move(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  sandbox.charge(std::max(0., number_argument(L, 3) - number_argument(L, 2)) + 1);
  return call_table_function(L);
}

int counted_unpack(lua_State* L, LuaSandbox& sandbox) {
  require_table(L);
  const double first = lua_isnoneornil(L, 2) ? 1 : number_argument(L, 2);
  const double last =
      lua_isnoneornil(L, 3) ? static_cast<double>(lua_rawlen(L, 1)) : number_argument(L, 3);
  if (last - first >= kMostUnpacked)
    throw Error("unpacks more than " + std::to_string(kMostUnpacked) + " values");
  sandbox.charge(std::max(0., last - first));
  return call_table_function(L);
}

}  // namespace geoprior::grammar
