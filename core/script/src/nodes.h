#pragma once
/// \file
/// Private to the script server: nodes as userdata of Lua.

#include <lua.hpp>

namespace spark {
class Leaf;
}

namespace spark::script {

/// Registers the metatables of nodes and subscriptions in a new state.
void openNodes(lua_State* L);
/// Pushes a node; nil for nullptr.
void pushNode(lua_State* L, Leaf* leaf);
/// The node at `index`, nullptr for any other value. Throws Error if the node has been deleted.
Leaf* toNode(lua_State* L, int index);
/// Removes a node from the tree. Throws Error for nodes of the kernel, and in untrusted scripts.
void deleteNode(lua_State* L, Leaf& node);
/// Implements on(channel, function), whose arguments are at `channelIndex` and above it. Pushes the subscription and
/// returns 1.
int subscribe(lua_State* L, Leaf& node, int channelIndex);

}  // namespace spark::script
