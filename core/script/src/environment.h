#pragma once
/// \file
/// Private to the script server: the libraries of a state, and the environments of scripts.

#include <lua.hpp>

namespace spark {
class Leaf;
}

namespace spark::script {

/// Fills the globals of a new state with the library that needs no tree (library.cpp).
void openLibrary(lua_State* L, bool trusted);
/// Replaces find, match, gmatch and gsub in the table on top of the stack by functions that charge for each comparison
/// (patterns.cpp).
void openPatterns(lua_State* L);
/// Pushes a new environment for scripts of `node`: a copy of the library, and functions that use the tree. `config`: it
/// is the environment of configs.
void pushEnvironment(lua_State* L, Leaf& node, bool config);
/// Adds the functions that use the tree (plugin, new, get, ...) to the table on top of the stack (globals.cpp).
void addGlobals(lua_State* L, Leaf& node, bool config);

}  // namespace spark::script
