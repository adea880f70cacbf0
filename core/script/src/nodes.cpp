#include "nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "members.h"
#include "runtime.h"
#include "values.h"

namespace spark::script {

namespace {
constexpr const char* kNodeType = "node";
constexpr const char* kSubscriptionType = "subscription";

/// The userdata of a node. A cache by id makes sure that a node has one userdata only, so that == and table keys work.
struct NodeRef {
  Ref<Leaf> ref;
  std::string path;  ///< when the script got the node, for messages
};

using SubscriptionRef = std::weak_ptr<Subscription>;

/// The names that every node has in Lua.
const std::vector<std::string>& builtins() {
  static const std::vector<std::string> names{"name",     "path", "class",  "parent",       "alive",  "isA", "find",
                                              "children", "new",  "delete", "attachScript", "attach", "on"};
  return names;
}

bool isBuiltin(std::string_view name) {
  return std::find(builtins().begin(), builtins().end(), name) != builtins().end();
}

/// True if the class has a member of a built-in name, which then hides the built-in one: joints have a method attach,
/// file systems a property path.
bool hidesBuiltin(ClassObject& c, std::string_view name) {
  return name != "alive" && (c.property(name) || c.method(name));
}

/// The node in node:function(...), which is the first argument.
Leaf& self(lua_State* L, const char* function) {
  if (Leaf* leaf = toNode(L, 1)) return *leaf;
  throw Error(
      fmt::format("expected a node before {0}, found {1}: write node:{0}(...), with a colon", function, typeAt(L, 1)));
}

void mustBeTrusted(lua_State* L, const char* what) {
  if (!State::of(L).trusted()) throw Error(fmt::format("{} is not for untrusted scripts", what));
}

/// Pushes a node, or nil if the script must not use it.
int pushAllowed(lua_State* L, Leaf* leaf) {
  pushNode(L, leaf && State::of(L).allows(*leaf) ? leaf : nullptr);
  return 1;
}

int nodeIsA(lua_State* L) {
  const std::string name(checkString(L, 2, "the name of a class or interface"));
  lua_pushboolean(L, self(L, "isA").classObject()->isOrOffers(name));
  return 1;
}

int nodeFind(lua_State* L) {
  Leaf& node = self(L, "find");
  return pushAllowed(L, node.find(checkString(L, 2, "a path")));
}

int nodeChildren(lua_State* L) {
  Leaf& node = self(L, "children");
  lua_newtable(L);
  if (!node.asNode()) return 1;
  lua_Integer i = 0;
  for (const auto& child : node.asNode()->children()) {
    pushNode(L, child.get());
    lua_rawseti(L, -2, ++i);
  }
  return 1;
}

/// class:new(path) or node:new(class, name).
Leaf& create(lua_State* L, Leaf& node) {
  if (auto c = node.as<ClassObject>()) return node.kernel().create(c->name(), checkString(L, 2, "a path"));
  if (!node.asNode())
    throw Error(
        fmt::format("cannot make a child of {}: a {} cannot have children", node.path(), node.classObject()->name()));
  const std::string_view className = checkString(L, 2, "a class name");
  return node.asNode()->create(className, lua_isnoneornil(L, 3) ? std::string_view() : checkString(L, 3, "a name"));
}

int nodeNew(lua_State* L) {
  mustBeTrusted(L, "node:new");
  Ref<Leaf> alive(&create(L, self(L, "new")));  // a setter that apply() calls may remove it
  State::of(L).runtime().settings.apply();
  pushNode(L, alive.get());
  return 1;
}

int nodeDelete(lua_State* L) {
  deleteNode(L, self(L, "delete"));
  return 0;
}

/// node:attachScript, and node:attach unless the class has a method of that name.
int nodeAttachScript(lua_State* L) {
  mustBeTrusted(L, "node:attachScript");
  Leaf& node = self(L, "attachScript");
  const std::string file(checkString(L, 2, "a script file"));
  // The script runs in the same state, so it gets the other arguments as they are.
  std::vector<int> arguments;
  for (int i = 3, n = lua_gettop(L); i <= n; ++i)
    lua_pushvalue(L, i), arguments.push_back(luaL_ref(L, LUA_REGISTRYINDEX));
  const auto push = [&](lua_State* to) {
    luaL_checkstack(to, static_cast<int>(arguments.size()), "a script has too many arguments");
    for (const int argument : arguments) lua_rawgeti(to, LUA_REGISTRYINDEX, argument);
  };
  const std::shared_ptr<void> release(nullptr, [&](void*) {
    for (const int argument : arguments) luaL_unref(L, LUA_REGISTRYINDEX, argument);
  });
  State::of(L).runtime().attachFile(node, file, L, push);
  return 0;
}

int nodeOn(lua_State* L) { return subscribe(L, self(L, "on"), 2); }

/// Throws Error if a script file is passed to a method `attach` that hides the built-in one.
void refuseScript(const Leaf& node, const std::string& name, const std::vector<Value>& arguments) {
  if (name != "attach" || arguments.empty() || arguments[0].type() != Value::Type::string ||
      !arguments[0].toString().ends_with(".lua"))
    return;
  throw Error(
      fmt::format("attach is a method of class {} itself: write node:attachScript(\"{}\") to attach a script to {}",
                  node.classObject()->name(), arguments[0].toString(), node.path()));
}

/// True if a config calls a method that would set an overridden property or variable.
bool isShielded(Runtime& runtime, const Leaf& node, const std::string& method, const std::vector<Value>& arguments) {
  if (!runtime.inConfig) return false;
  if (isGroup(node) && method == "set" && !arguments.empty() && runtime.settings.shields(node, arguments[0].plain()))
    return true;
  const Property* property = node.classObject()->propertySetBy(method);
  return property && runtime.settings.shields(node, property->name);
}

/// Calls a method of a node. The upvalue is its name.
int callNodeMethod(lua_State* L) {
  const std::string name = lua_tostring(L, lua_upvalueindex(1));
  Leaf& node = self(L, name.c_str());
  std::vector<Value> arguments;
  for (int i = 2; i <= lua_gettop(L); ++i) arguments.push_back(toValue(L, i));
  refuseScript(node, name, arguments);
  if (isShielded(State::of(L).runtime(), node, name, arguments)) return 0;
  const Method* method = node.classObject()->method(name);
  const bool asTables = method && method->returns == Convert<TableValue>::typeName();
  const Value result = callMethod(node, name, arguments);
  asTables ? pushTables(L, result) : pushValue(L, result);
  return 1;
}

/// Pushes the function that calls a method of a node. Upvalue 2 of nodeIndex keeps these functions.
void pushMethod(lua_State* L, std::string_view name) {
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL) return;
  lua_pop(L, 1);
  pushText(L, name);
  lua_pushcclosure(L, guarded<callNodeMethod>, 1);
  lua_pushvalue(L, 2);
  lua_pushvalue(L, -2);
  lua_rawset(L, lua_upvalueindex(2));
}

[[noreturn]] void throwUnknown(const Leaf& leaf, std::string_view name, bool readable) {
  std::vector<std::string> names = memberNames(leaf);
  if (readable) {
    names.insert(names.end(), builtins().begin(), builtins().end());
    for (const Method* m : leaf.classObject()->methods()) names.push_back(m->name);
  }
  throw Error(fmt::format("{} (class {}) has no property{} '{}'.{}", leaf.path(), leaf.classObject()->name(),
                          readable ? " or method" : "", name, memberHint(leaf, name, names)));
}

/// node.key. Upvalues: the functions that every node has, and those of pushMethod(), both by name.
int nodeIndex(lua_State* L) {
  lua_settop(L, 2);
  const std::string_view key = checkString(L, 2, "the name of a property or method");
  if (key == "alive") {
    lua_pushboolean(L, static_cast<NodeRef*>(luaL_checkudata(L, 1, kNodeType))->ref.get() != nullptr);
    return 1;
  }
  Leaf& leaf = self(L, "find");
  // Built-in members first, unless the class hides them; then properties, methods, variables of a group.
  const bool own = isBuiltin(key) && hidesBuiltin(*leaf.classObject(), key);
  lua_pushvalue(L, 2);
  if (!own && lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) return 1;
  if (!own && key == "parent") return pushAllowed(L, leaf.parent());
  if (!own && key == "path")
    pushValue(L, leaf.path());
  else if (!own && key == "class")
    pushValue(L, leaf.classObject()->name());
  else if (const Property* p = leaf.classObject()->property(key))
    pushValue(L, p->get(leaf));
  else if (leaf.classObject()->method(key))
    pushMethod(L, key);
  else if (hasMember(leaf, key))
    pushValue(L, callMethod(leaf, "get", std::array<Value, 1>{Value(key)}));
  else
    throwUnknown(leaf, key, true);
  return 1;
}

/// node.key = value.
int nodeNewIndex(lua_State* L) {
  const std::string_view key = checkString(L, 2, "the name of a property");
  Leaf& leaf = self(L, "find");
  if (isBuiltin(key) && !leaf.classObject()->property(key))
    throw Error(fmt::format("cannot set {}.{}: it is read only", leaf.path(), key));
  Runtime& runtime = State::of(L).runtime();
  if (runtime.inConfig && runtime.settings.shields(leaf, key)) return 0;
  if (!isGroup(leaf) && !leaf.classObject()->property(key)) throwUnknown(leaf, key, false);
  setMember(leaf, key, toValue(L, 3));
  return 0;
}

int nodeText(lua_State* L) {
  const auto* n = static_cast<NodeRef*>(luaL_checkudata(L, 1, kNodeType));
  pushText(L, n->ref ? n->ref->path() : fmt::format("dead node (was {})", n->path));
  return 1;
}

int nodeFree(lua_State* L) {
  static_cast<NodeRef*>(lua_touserdata(L, 1))->~NodeRef();
  return 0;
}

int subscriptionRemove(lua_State* L) {
  if (const auto s = static_cast<SubscriptionRef*>(luaL_checkudata(L, 1, kSubscriptionType))->lock()) s->remove();
  return 0;
}

int subscriptionFree(lua_State* L) {
  static_cast<SubscriptionRef*>(lua_touserdata(L, 1))->~SubscriptionRef();
  return 0;
}

/// Adds the destructor to the metatable on top of the stack, lets scripts see `name` instead of it, and pops it.
void finishMetatable(lua_State* L, lua_CFunction destroy, const char* name) {
  lua_pushcfunction(L, destroy);
  lua_setfield(L, -2, "__gc");
  lua_pushstring(L, name);
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 1);
}
}  // namespace

void openNodes(lua_State* L) {
  constexpr luaL_Reg kFunctions[] = {{"isA", guarded<nodeIsA>},
                                     {"find", guarded<nodeFind>},
                                     {"children", guarded<nodeChildren>},
                                     {"new", guarded<nodeNew>},
                                     {"delete", guarded<nodeDelete>},
                                     {"attachScript", guarded<nodeAttachScript>},
                                     {"attach", guarded<nodeAttachScript>},
                                     {"on", guarded<nodeOn>},
                                     {nullptr, nullptr}};
  // The metatable of nodes.
  luaL_newmetatable(L, kNodeType);
  luaL_newlib(L, kFunctions);
  lua_newtable(L);
  lua_pushcclosure(L, guarded<nodeIndex>, 2);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, guarded<nodeNewIndex>);
  lua_setfield(L, -2, "__newindex");
  lua_pushcfunction(L, guarded<nodeText>);
  lua_setfield(L, -2, "__tostring");
  finishMetatable(L, nodeFree, "node");

  constexpr luaL_Reg kSubscription[] = {{"remove", guarded<subscriptionRemove>}, {nullptr, nullptr}};
  // The metatable of subscriptions.
  luaL_newmetatable(L, kSubscriptionType);
  luaL_newlib(L, kSubscription);
  lua_setfield(L, -2, "__index");
  finishMetatable(L, subscriptionFree, "subscription");

  // The cache of nodes by id, with weak references.
  lua_newtable(L);
  lua_newtable(L);
  lua_pushliteral(L, "v");
  lua_setfield(L, -2, "__mode");
  lua_setmetatable(L, -2);
  lua_setfield(L, LUA_REGISTRYINDEX, "spark.nodes");
}

void pushNode(lua_State* L, Leaf* leaf) {
  if (!leaf) return lua_pushnil(L);
  lua_getfield(L, LUA_REGISTRYINDEX, "spark.nodes");
  const auto id = static_cast<lua_Integer>(leaf->id());
  if (lua_rawgeti(L, -1, id) == LUA_TNIL) {
    lua_pop(L, 1);
    std::string path = leaf->path();
    void* memory = lua_newuserdatauv(L, sizeof(NodeRef), 0);
    new (memory) NodeRef{Ref<Leaf>(leaf), std::move(path)};
    luaL_setmetatable(L, kNodeType);
    lua_pushvalue(L, -1);
    lua_rawseti(L, -3, id);
  }
  lua_remove(L, -2);
}

Leaf* toNode(lua_State* L, int index) {
  const auto* n = static_cast<NodeRef*>(luaL_testudata(L, index, kNodeType));
  if (!n) return nullptr;
  if (Leaf* leaf = n->ref.get()) return leaf;
  throw Error(
      fmt::format("this node is gone: it was {} and has been deleted. Ask node.alive before you use a node that "
                  "may die.",
                  n->path));
}

void deleteNode(lua_State* L, Leaf& node) {
  mustBeTrusted(L, "delete");
  const Leaf* top = &node;
  while (top->parent() && top->parent()->parent()) top = top->parent();
  if (!node.parent() || (node.isLinked() && (top->name() == "classes" || top->name() == "plugins")))
    throw Error(fmt::format("cannot delete {}: it belongs to the kernel", node.path()));
  node.parent()->remove(node);
}

int subscribe(lua_State* L, Leaf& node, int channelIndex) {
  const std::string channel(checkString(L, channelIndex, "a channel"));
  if (!lua_isfunction(L, channelIndex + 1))
    throw Error(
        fmt::format("expected a function(self, event) to handle '{}', found {}", channel, typeAt(L, channelIndex + 1)));
  lua_settop(L, channelIndex + 1);
  const std::shared_ptr<Subscription> made = State::of(L).runtime().subscribe(L, node, channel);
  new (lua_newuserdatauv(L, sizeof(SubscriptionRef), 0)) SubscriptionRef(made);
  luaL_setmetatable(L, kSubscriptionType);
  return 1;
}

}  // namespace spark::script
