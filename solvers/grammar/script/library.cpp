#include "solvers/grammar/script/library.h"

#include <lua5.4/lua.hpp>
#include <string>

#include "core/error.h"
#include "solvers/grammar/script/ordered_tables.h"
#include "solvers/grammar/script/sandbox.h"

namespace geoprior::grammar {
namespace {

/// Registry key of the globals that every script has.
constexpr const char* kSharedGlobals = "geoprior.globals";

int text_of(lua_State* L, LuaSandbox&) {
  switch (lua_type(L, 1)) {
    case LUA_TNONE:
      wrong_argument(L, 1, "any value");
    case LUA_TNIL:
      lua_pushliteral(L, "nil");
      break;
    case LUA_TBOOLEAN:
      lua_pushstring(L, lua_toboolean(L, 1) != 0 ? "true" : "false");
      break;
    case LUA_TNUMBER:
    case LUA_TSTRING:
      lua_pushvalue(L, 1);
      lua_tolstring(L, -1, nullptr);
      break;
    default:
      lua_pushstring(L, luaL_typename(L, 1));
  }
  return 1;
}

/// Metamethods that a script may give a table.
bool allowed_metamethod(std::string_view name) {
  for (const char* known :
       {"__index", "__newindex", "__call", "__add", "__sub", "__mul", "__div", "__mod", "__pow",
        "__unm", "__idiv", "__concat", "__eq", "__lt", "__le"})
    if (name == known) return true;
  return false;
}

int set_metatable(lua_State* L, LuaSandbox& sandbox) {
  if (lua_type(L, 1) != LUA_TTABLE) wrong_argument(L, 1, "a table");
  if (lua_type(L, 2) != LUA_TTABLE && lua_type(L, 2) != LUA_TNIL)
    wrong_argument(L, 2, "a table or nil");
  if (luaL_getmetafield(L, 1, "__metatable") != LUA_TNIL)
    throw Error("argument 1 is a library", {}, "a table of the script");
  lua_settop(L, 2);
  if (lua_type(L, 2) == LUA_TTABLE) {
    lua_newtable(L);
    lua_pushnil(L);
    while (lua_next(L, 2) != 0) {
      sandbox.charge(1);
      const char* name = lua_type(L, 4) == LUA_TSTRING ? lua_tostring(L, 4) : "";
      if (name[0] == '_' && name[1] == '_') {
        if (!allowed_metamethod(name))
          throw Error("a metatable may not have '" + std::string(name) + "'", {},
                      "__index, __newindex, __call, arithmetic, __concat, comparisons");
        lua_pushvalue(L, 4);
        lua_pushvalue(L, 5);
        lua_rawset(L, 3);
      }
      lua_pop(L, 1);
    }
  }
  lua_setmetatable(L, 1);
  lua_settop(L, 1);
  return 1;
}

int random_number(lua_State* L, LuaSandbox& sandbox) {
  if (lua_gettop(L) == 0) {
    lua_pushnumber(L, sandbox.random().uniform());
    return 1;
  }
  const std::int64_t low = lua_gettop(L) > 1 ? integer_argument(L, 1) : 1;
  const std::int64_t high = integer_argument(L, lua_gettop(L) > 1 ? 2 : 1);
  if (high < low || high - low >= 0xffffffff) throw Error("there is no number to draw from");
  const std::uint32_t drawn = sandbox.random().below(static_cast<std::uint32_t>(high - low + 1));
  lua_pushinteger(L, low + drawn);
  return 1;
}

/// Calls Lua's own function, the first upvalue, with the arguments.
int call_original(lua_State* L) {
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

int plain_find(lua_State* L, LuaSandbox& sandbox) {
  text_argument(L, 1);
  text_argument(L, 2);
  sandbox.charge(static_cast<double>(lua_rawlen(L, 1) * lua_rawlen(L, 2)) / 16);
  lua_settop(L, 3);
  if (lua_isnil(L, 3)) {
    lua_pushinteger(L, 1);
    lua_replace(L, 3);
  }
  lua_pushboolean(L, 1);
  return call_original(L);
}

int repeat_text(lua_State* L, LuaSandbox&) {
  text_argument(L, 1);
  const double bytes =
      static_cast<double>(lua_rawlen(L, 1) + (lua_isstring(L, 3) != 0 ? lua_rawlen(L, 3) : 0));
  if (bytes * number_argument(L, 2) > static_cast<double>(LuaSandbox::kLongestText))
    throw Error("makes a text of more than " + std::to_string(LuaSandbox::kLongestText) + " bytes");
  return call_original(L);
}

int one_byte(lua_State* L, LuaSandbox&) {
  text_argument(L, 1);
  const auto size = static_cast<std::int64_t>(lua_rawlen(L, 1));
  std::int64_t at = lua_isnoneornil(L, 2) ? 1 : integer_argument(L, 2);
  if (at < 0) at += size + 1;
  if (at < 1 || at > size) return 0;
  lua_pushinteger(L, static_cast<unsigned char>(lua_tostring(L, 1)[at - 1]));
  return 1;
}

/// Refuses conversions that show addresses: %p, and %s of what is no text.
int format_text(lua_State* L, LuaSandbox&) {
  const char* c = text_argument(L, 1);
  int argument = 1;
  for (; *c != 0; ++c) {
    if (*c != '%') continue;
    if (*++c == '%') continue;
    while (*c != 0 && std::string_view("-+ #0123456789.").find(*c) != std::string_view::npos) ++c;
    ++argument;
    if (*c == 0 || std::string_view("cdiouxXaAeEfgGs").find(*c) == std::string_view::npos)
      throw Error(std::string("the format has '%") + (*c == 0 ? "" : std::string(1, *c)) + "'", {},
                  "%c, %d, %i, %o, %x, %a, %e, %f, %g, %s");
    const int type = lua_type(L, argument);
    if (type != LUA_TNUMBER && type != LUA_TSTRING)
      wrong_argument(L, argument, "a number or a text");
  }
  return call_original(L);
}

/// Puts functions of the table on top of the stack into that below it, by the same names.
void copy_functions(lua_State* L, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    lua_getfield(L, -1, name);
    lua_setfield(L, -3, name);
  }
}

void wrap_function(lua_State* L, const char* name, lua_CFunction function) {
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, function, 1);
  lua_setfield(L, -3, name);
}

/// An empty table above Lua's own library of that name.
void begin_library(lua_State* L, const char* name, lua_CFunction open) {
  lua_newtable(L);
  luaL_requiref(L, name, open, 0);
}

void open_texts(lua_State* L) {
  begin_library(L, LUA_STRLIBNAME, luaopen_string);
  copy_functions(L, {"char", "len", "lower", "reverse", "sub", "upper"});
  wrap_function(L, "find", &bound<plain_find>);
  wrap_function(L, "rep", &bound<repeat_text>);
  wrap_function(L, "byte", &bound<one_byte>);
  wrap_function(L, "format", &bound<format_text>);
  lua_pop(L, 1);
  // Methods of texts are the same few functions.
  lua_pushliteral(L, "");
  lua_newtable(L);
  lua_pushvalue(L, -3);
  lua_setfield(L, -2, "__index");
  lua_setmetatable(L, -2);
  lua_pop(L, 1);
  add_script_library(L, "string");
}

void open_numbers(lua_State* L) {
  begin_library(L, LUA_MATHLIBNAME, luaopen_math);
  copy_functions(
      L, {"abs",  "acos", "asin", "atan", "ceil",       "cos",  "deg",        "exp",  "floor",
          "fmod", "huge", "log",  "max",  "maxinteger", "min",  "mininteger", "modf", "pi",
          "rad",  "sin",  "sqrt", "tan",  "tointeger",  "type", "ult"});
  lua_pushcfunction(L, &bound<random_number>);
  lua_setfield(L, -3, "random");
  lua_pop(L, 1);
  add_script_library(L, "math");
}

void open_tables(lua_State* L) {
  begin_library(L, LUA_TABLIBNAME, luaopen_table);
  copy_functions(L, {"pack"});
  wrap_function(L, "concat", &bound<counted_concat>);
  wrap_function(L, "insert", &bound<counted_insert>);
  wrap_function(L, "move", &bound<counted_move>);
  wrap_function(L, "remove", &bound<counted_remove>);
  wrap_function(L, "unpack", &bound<counted_unpack>);
  lua_pushcfunction(L, &bound<stable_sort>);
  lua_setfield(L, -3, "sort");
  lua_pop(L, 1);
  add_script_library(L, "table");
}

void open_base(lua_State* L) {
  lua_getfield(L, LUA_REGISTRYINDEX, kSharedGlobals);
  luaL_requiref(L, LUA_GNAME, luaopen_base, 0);
  copy_functions(L, {"assert", "error", "ipairs", "rawequal", "rawget", "rawlen", "select",
                     "tonumber", "type"});
  lua_pop(L, 2);
  add_script_function(L, "tostring", &bound<text_of>);
  add_script_function(L, "setmetatable", &bound<set_metatable>);
  add_script_function(L, "pairs", &bound<ordered_pairs>);
  add_script_function(L, "next", &bound<ordered_next>);
}

int refuse_library_write(lua_State* L, LuaSandbox&) {
  const bool named = lua_type(L, 2) == LUA_TSTRING;
  throw Error("a library may not be written" +
              (named ? " ('" + std::string(lua_tostring(L, 2)) + "')" : std::string()));
}

std::string global_name(lua_State* L) {
  return lua_type(L, 2) == LUA_TSTRING ? "'" + std::string(lua_tostring(L, 2)) + "'" : "such";
}

int unknown_global(lua_State* L, LuaSandbox&) {
  throw Error("there is no global " + global_name(L));
}

int new_global(lua_State* L, LuaSandbox&) {
  throw Error("a rule may make no new global " + global_name(L), {},
              "locals, globals that the script has set before");
}

}  // namespace

void open_script_library(lua_State* L) {
  lua_newtable(L);
  lua_setfield(L, LUA_REGISTRYINDEX, kSharedGlobals);
  open_base(L);
  open_texts(L);
  open_numbers(L);
  open_tables(L);
}

void push_script_globals(lua_State* L) {
  lua_newtable(L);
  lua_getfield(L, LUA_REGISTRYINDEX, kSharedGlobals);
  lua_pushnil(L);
  while (lua_next(L, -2) != 0) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, -5);
  }
  lua_pop(L, 1);
  lua_newtable(L);
  lua_pushcfunction(L, &bound<unknown_global>);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
}

void add_script_library(lua_State* L, const char* name) {
  lua_newtable(L);
  lua_newtable(L);
  lua_rotate(L, -3, -1);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, &bound<refuse_library_write>);
  lua_setfield(L, -2, "__newindex");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
  lua_getfield(L, LUA_REGISTRYINDEX, kSharedGlobals);
  lua_insert(L, -2);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

void add_script_function(lua_State* L, const char* name, int (*function)(lua_State*)) {
  lua_getfield(L, LUA_REGISTRYINDEX, kSharedGlobals);
  lua_pushcfunction(L, function);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

void close_script_globals(lua_State* L) {
  lua_getmetatable(L, -1);
  lua_pushcfunction(L, &bound<new_global>);
  lua_setfield(L, -2, "__newindex");
  lua_pop(L, 1);
}

}  // namespace geoprior::grammar
