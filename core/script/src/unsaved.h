#pragma once
/// \file
/// Private to the script server: finds what handlers keep where it is not saved.

#include <lua.hpp>
#include <set>
#include <string>
#include <vector>

namespace spark::script {

/// Looks through the Lua function at `index` and those that it calls, as far as they can be told without running it.
/// Returns a line "file:line: sets the global 'n'" for each thing that outlasts the call and is not in the table
/// `state`: globals, locals outside the function, and fields of tables in them but `saved` ones. Empty for C functions.
std::vector<std::string> unsavedWrites(lua_State* L, int index, const std::set<const void*>& saved);

}  // namespace spark::script
