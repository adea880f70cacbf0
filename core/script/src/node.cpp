#include <algorithm>

#include "runtime.h"

namespace spark::script {

namespace {
constexpr const char* kNodeType = "node";
constexpr const char* kSubscriptionType = "subscription";

/// The userdata of a node. A cache by id makes one node one userdata, so that == and table keys go by identity.
struct NodeRef {
  Ref<Leaf> ref;
  std::string path;  ///< when the script got it, for messages
};

using SubscriptionRef = std::weak_ptr<Subscription>;

const std::vector<std::string>& builtins() {
  static const std::vector<std::string> names{"name",     "path", "class",  "parent",       "alive",  "find",
                                              "children", "new",  "delete", "attachScript", "attach", "on"};
  return names;
}

bool isBuiltin(std::string_view name) {
  return std::find(builtins().begin(), builtins().end(), name) != builtins().end();
}

/// True for a built-in name that the node's class uses itself: joints have a method attach, file systems a property
/// path. The class's counts.
bool hidesBuiltin(ClassObject& c, std::string_view name) {
  return name != "alive" && (c.property(name) || c.method(name));
}

/// The first argument of node:f(...).
Leaf& self(lua_State* L, const char* function) {
  if (Leaf* leaf = toNode(L, 1)) return *leaf;
  throw Error(std::string("expected a node before ") + function + ", found " + typeAt(L, 1) +
              ": write node:" + function + "(...), with a colon");
}

void mustBeTrusted(lua_State* L, const char* what) {
  if (!State::of(L).trusted()) throw Error(std::string(what) + " is not for untrusted scripts");
}

/// Pushes a node that may lie outside what the script may touch: nil then.
int pushAllowed(lua_State* L, Leaf* leaf) {
  pushNode(L, leaf && State::of(L).allows(*leaf) ? leaf : nullptr);
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

int nodeNew(lua_State* L) {
  mustBeTrusted(L, "node:new");
  Leaf& node = self(L, "new");
  if (!node.asNode())
    throw Error("cannot make a child of " + node.path() + ": a " + node.classObject()->name() +
                " cannot have children");
  const std::string_view className = checkString(L, 2, "a class name");
  Leaf& made =
      node.asNode()->create(className, lua_isnoneornil(L, 3) ? std::string_view() : checkString(L, 3, "a name"));
  Ref<Leaf> alive(&made);
  State::of(L).runtime().settings.apply();
  pushNode(L, alive.get());
  return 1;
}

int nodeDelete(lua_State* L) {
  deleteNode(L, self(L, "delete"));
  return 0;
}

/// node:attachScript, and node:attach where the class has no method of that name.
int nodeAttachScript(lua_State* L) {
  mustBeTrusted(L, "node:attachScript");
  Leaf& node = self(L, "attachScript");
  const std::string file(checkString(L, 2, "a script file"));
  // What follows is handed on as it is: the script runs in the same state.
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

/// A script's file given to a method that hides the built-in attach. Throws Error with the name that is never hidden.
void refuseScript(const Leaf& node, const std::string& name, const std::vector<Value>& arguments) {
  if (name != "attach" || arguments.empty() || arguments[0].type() != Value::Type::string ||
      !arguments[0].toString().ends_with(".lua"))
    return;
  throw Error("attach is a method of class " + node.classObject()->name() + " itself: write node:attachScript(\"" +
              arguments[0].toString() + "\") to attach a script to " + node.path());
}

/// A method as the script calls it; its name is the upvalue.
int callNodeMethod(lua_State* L) {
  const std::string name = lua_tostring(L, lua_upvalueindex(1));
  Leaf& node = self(L, name.c_str());
  std::vector<Value> arguments;
  for (int i = 2; i <= lua_gettop(L); ++i) arguments.push_back(toValue(L, i));
  refuseScript(node, name, arguments);
  Runtime& runtime = State::of(L).runtime();
  if (runtime.inConfig) {
    if (isGroup(node) && name == "set" && !arguments.empty() && runtime.settings.shields(node, arguments[0].plain()))
      return 0;
    if (name.size() > 3 && name.starts_with("set"))
      for (const Property* p : node.classObject()->properties())
        if (p->name.size() + 3 == name.size() && std::equal(p->name.begin() + 1, p->name.end(), name.begin() + 4) &&
            (p->name[0] | 32) == (name[3] | 32) && runtime.settings.shields(node, p->name))
          return 0;
  }
  pushValue(L, callMethod(node, name, arguments));
  return 1;
}

void pushMethod(lua_State* L, std::string_view name) {
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL) return;
  lua_pop(L, 1);
  lua_pushlstring(L, name.data(), name.size());
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
  throw Error(leaf.path() + " (class " + leaf.classObject()->name() + ") has no property" +
              (readable ? " or method '" : " '") + std::string(name) + "'." + didYouMean(name, names));
}

/// Upvalues: the functions that every node has, the methods used so far by name.
int nodeIndex(lua_State* L) {
  lua_settop(L, 2);
  const std::string_view key = checkString(L, 2, "the name of a property or method");
  if (key == "alive") {
    lua_pushboolean(L, static_cast<NodeRef*>(luaL_checkudata(L, 1, kNodeType))->ref.get() != nullptr);
    return 1;
  }
  Leaf& leaf = self(L, "find");
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

int nodeNewIndex(lua_State* L) {
  const std::string_view key = checkString(L, 2, "the name of a property");
  Leaf& leaf = self(L, "find");
  if (isBuiltin(key) && !leaf.classObject()->property(key))
    throw Error("cannot set " + leaf.path() + "." + std::string(key) + ": it is read only");
  Runtime& runtime = State::of(L).runtime();
  if (runtime.inConfig && runtime.settings.shields(leaf, key)) return 0;
  if (!isGroup(leaf) && !leaf.classObject()->property(key)) throwUnknown(leaf, key, false);
  setMember(leaf, key, toValue(L, 3));
  return 0;
}

int nodeText(lua_State* L) {
  const auto* n = static_cast<NodeRef*>(luaL_checkudata(L, 1, kNodeType));
  pushValue(L, n->ref ? n->ref->path() : "dead node (was " + n->path + ")");
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
}  // namespace

void openNodes(lua_State* L) {
  constexpr luaL_Reg kFunctions[] = {{"find", guarded<nodeFind>},
                                     {"children", guarded<nodeChildren>},
                                     {"new", guarded<nodeNew>},
                                     {"delete", guarded<nodeDelete>},
                                     {"attachScript", guarded<nodeAttachScript>},
                                     {"attach", guarded<nodeAttachScript>},
                                     {"on", guarded<nodeOn>},
                                     {nullptr, nullptr}};
  luaL_newmetatable(L, kNodeType);
  luaL_newlib(L, kFunctions);
  lua_newtable(L);
  lua_pushcclosure(L, guarded<nodeIndex>, 2);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, guarded<nodeNewIndex>);
  lua_setfield(L, -2, "__newindex");
  lua_pushcfunction(L, guarded<nodeText>);
  lua_setfield(L, -2, "__tostring");
  lua_pushcfunction(L, nodeFree);
  lua_setfield(L, -2, "__gc");
  lua_pushliteral(L, "node");
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 1);

  constexpr luaL_Reg kSubscription[] = {{"remove", guarded<subscriptionRemove>}, {nullptr, nullptr}};
  luaL_newmetatable(L, kSubscriptionType);
  luaL_newlib(L, kSubscription);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, subscriptionFree);
  lua_setfield(L, -2, "__gc");
  lua_pushliteral(L, "subscription");
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 1);

  lua_newtable(L);  // nodes by id, kept as long as a script holds them
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
  throw Error("this node is gone: it was " + n->path +
              " and has been deleted. Ask node.alive before you use a node that may die.");
}

void deleteNode(lua_State* L, Leaf& node) {
  mustBeTrusted(L, "delete");
  const Leaf* top = &node;
  while (top->parent() && top->parent()->parent()) top = top->parent();
  if (!node.parent() || (node.isLinked() && (top->name() == "classes" || top->name() == "plugins")))
    throw Error("cannot delete " + node.path() + ": it belongs to the kernel");
  node.parent()->remove(node);
}

int subscribe(lua_State* L, Leaf& node, int channelIndex) {
  const std::string channel(checkString(L, channelIndex, "a channel"));
  if (!lua_isfunction(L, channelIndex + 1))
    throw Error("expected a function(self, event) to handle '" + channel + "', found " + typeAt(L, channelIndex + 1));
  lua_settop(L, channelIndex + 1);
  const std::shared_ptr<Subscription> made = State::of(L).runtime().subscribe(L, node, channel);
  new (lua_newuserdatauv(L, sizeof(SubscriptionRef), 0)) SubscriptionRef(made);
  luaL_setmetatable(L, kSubscriptionType);
  return 1;
}

bool isGroup(const Leaf& leaf) {
  ClassObject& c = *leaf.classObject();
  return c.method("get") && c.method("set") && c.property("names");
}

bool hasMember(const Leaf& leaf, std::string_view name) {
  if (leaf.classObject()->property(name)) return true;
  if (!isGroup(leaf)) return false;
  const std::vector<std::string> names = memberNames(leaf);
  return std::find(names.begin(), names.end(), name) != names.end();
}

void setMember(Leaf& leaf, std::string_view name, const Value& value) {
  if (!leaf.classObject()->property(name) && isGroup(leaf))
    callMethod(leaf, "set", std::array<Value, 2>{Value(name), value});
  else
    setProperty(leaf, name, value);
}

std::vector<std::string> memberNames(const Leaf& leaf) {
  std::vector<std::string> names;
  for (const Property* p : leaf.classObject()->properties()) names.push_back(p->name);
  if (isGroup(leaf)) {
    const Value variables = getProperty(leaf, "names");
    for (const Value& n : variables.toList()) names.push_back(n.plain());
  }
  return names;
}

}  // namespace spark::script
