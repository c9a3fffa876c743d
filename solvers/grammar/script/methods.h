#pragma once

struct lua_State;

namespace geoprior::grammar {

// Methods of a batch by what they are for, put into the table on top of the stack. Places in the
// batch count from 1; numbers of elements, points and triangles are the program's, from 0.

/// State, as it was when the derivation began and by now.
void add_reading_methods(lua_State* L);
/// What the deformation that is asked for does to points.
void add_map_methods(lua_State* L);
/// Terminals.
void add_writing_methods(lua_State* L);
/// Symbols for children and parents.
void add_asking_methods(lua_State* L);

}  // namespace geoprior::grammar
