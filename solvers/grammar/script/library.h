#pragma once

struct lua_State;

namespace geoprior::grammar {

/// Makes what scripts have of Lua's library: base functions that are safe, math, string and table.
///
/// Left out is what reaches outside (io, os, require, package, debug, load, print), what could
/// catch a limit (pcall, coroutines), patterns, and what depends on addresses or the clock.
/// Different from Lua's are:
/// - `pairs` and `next`: numbers ascending, then texts by bytes, then booleans; other keys are
///   errors;
/// - `table.sort`: stable; Lua's takes pivots by the clock;
/// - `math.random`: the sandbox's stream;
/// - `setmetatable`: keeps a copy of the metamethods, without those of garbage and length;
/// - `tostring`, `string.format`: no addresses; `string.find`: plain text.
/// Raises errors of Lua: to be called protected.
void open_script_library(lua_State* L);

/// Puts a fresh table of globals on the stack, with the library in it. Reading one that is not
/// there is an error. Libraries themselves are shared and cannot be written.
void push_script_globals(lua_State* L);

/// Makes the table of functions on top of the stack a library of that name, which globals have.
void add_script_library(lua_State* L, const char* name);

/// The same for one function.
void add_script_function(lua_State* L, const char* name, int (*function)(lua_State*));

/// From now on, setting new globals in the table on top of the stack is an error, too.
void close_script_globals(lua_State* L);

}  // namespace geoprior::grammar
