#pragma once
/// \file
/// Private to the script server: values on the stack of a Lua state.

#include <lua.hpp>
#include <string>
#include <string_view>

#include "spark/value.h"

namespace spark::script {

/// Pushes a string.
void pushText(lua_State* L, std::string_view text);
/// Pushes a value. A list becomes a sequence.
void pushValue(lua_State* L, const Value& value);
/// As pushValue(), but a list of pairs whose keys are strings becomes a table with these keys, at any depth.
void pushTables(lua_State* L, const Value& value);
/// Pushes the arguments of a script by pushTables(); nothing for nil.
void pushArguments(lua_State* L, const Value& arguments);

/// Reads the value at `index`. A node becomes its path, and a table that is no sequence a list of pairs in order of
/// key. Throws Error for a function, for a table that is nested too deeply, and for keys without an order.
Value toValue(lua_State* L, int index);
/// The string or number at `index` as text, "" for other types. Valid while it is on the stack.
std::string_view textAt(lua_State* L, int index);
/// The string at `index`, valid while it is on the stack. Throws Error that says that `what` was expected if it is not
/// a string.
std::string_view checkString(lua_State* L, int index, const char* what);
/// The type of the value at `index` for messages: "table", "function", "node", ...
std::string typeAt(lua_State* L, int index);
/// Appends the text that print shows for the value at `index`, without addresses.
void appendText(lua_State* L, int index, std::string& out);

/// Pushes a sequence of a table's keys in order and returns their number. Throws Error for keys without an order.
lua_Integer pushSortedKeys(lua_State* L, int table);
/// Pushes the key that follows the one at `after` in order, or the first one if `after` is 0; nil if there is none.
void pushNextKey(lua_State* L, int table, int after);

}  // namespace spark::script
