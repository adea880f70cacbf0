#include "requests.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <nlohmann/json.hpp>

#include "api/inputs.h"
#include "api/phases.h"
#include "api/removal.h"
#include "api/scene.h"
#include "spark/error.h"
#include "spark/in_use.h"
#include "spark/output_file.h"
#include "spark/script.h"
#include "spark/script_text.h"

namespace spark::control {

using Json = nlohmann::ordered_json;

namespace {
// Maximum number of nodes in a tree answer; less for clients that may not change anything (spectators).
constexpr std::size_t kMaxNodes = 100000, kMaxNodesForSpectators = 2000;
constexpr int kMaxDepth = 64;  // of lists in a value

Json toJson(const Value& v) {
  switch (v.type()) {
    case Value::Type::nil:
      return nullptr;
    case Value::Type::boolean:
      return v.toBool();
    case Value::Type::integer:
      return v.toInteger();
    case Value::Type::number:
      return std::isfinite(v.toNumber()) ? Json(v.toNumber()) : Json(v.text());
    case Value::Type::string:
      return v.toString();
    case Value::Type::list:
      break;
  }
  Json out = Json::array();
  for (const Value& e : v.toList()) out.push_back(toJson(e));
  return out;
}

Value fromJson(const Json& j, int depth = 0) {
  if (depth > kMaxDepth) throw Error(fmt::format("expected lists nested at most {} deep", kMaxDepth));
  if (j.is_boolean()) return j.get<bool>();
  if (j.is_number_integer()) return j.get<std::int64_t>();
  if (j.is_number()) return j.get<double>();
  if (j.is_string()) return Value::typed(j.get<std::string>());
  if (!j.is_array()) return {};
  List out;
  for (const Json& e : j) out.push_back(fromJson(e, depth + 1));
  return out;
}

std::string textOf(const Json& request, const char* key) {
  const auto at = request.find(key);
  if (at == request.end() || !at->is_string()) throw Error(fmt::format("the request lacks a text \"{}\"", key));
  return at->get<std::string>();
}

Leaf& nodeOf(Kernel& kernel, const Json& request) { return kernel.root().require<Leaf>(textOf(request, "path")); }

const Property& propertyOf(Leaf& leaf, const std::string& name) {
  if (const Property* p = leaf.classObject()->property(name)) return *p;
  std::vector<std::string> names;
  for (const Property* p : leaf.classObject()->properties()) names.push_back(p->name);
  throw Error(fmt::format("{} ({}) has no property '{}'.{}", leaf.path(), leaf.classObject()->name(), name,
                          didYouMean(name, names)));
}

Json describe(const Leaf& leaf, const Property& p) {
  const Value v = p.get(leaf);
  Json out{{"name", p.name}, {"value", toJson(v)}, {"text", v.plain()},
           {"type", p.type}, {"unit", p.unit},     {"doc", p.doc}};
  if (p.readOnly) out["readOnly"] = true;
  if (p.min) out["min"] = *p.min;
  if (p.max) out["max"] = *p.max;
  if (!p.choices.empty()) out["choices"] = p.choices;
  return out;
}

Json describeLinks(const Leaf& leaf) {
  Json out = Json::array();
  for (const LinkDescription* link : leaf.classObject()->links()) {
    Json paths = Json::array();
    for (const Found<void>& target : link->targets(leaf)) paths.push_back(target.leaf->path());
    out.push_back({{"to", link->route.text()}, {"paths", std::move(paths)}});
  }
  return out;
}

/// `left`: number of nodes that may still be listed. Children beyond it, or beyond `depth`, are only counted.
Json describeTree(const Leaf& leaf, int depth, bool links, std::size_t& left) {
  Json out{{"name", leaf.name()}, {"class", leaf.classObject()->name()}, {"doc", leaf.classObject()->doc()}};
  if (links && !leaf.classObject()->links().empty()) out["links"] = describeLinks(leaf);
  const Node* node = leaf.asNode();
  if (!node || node->children().empty()) return out;
  Json& children = out["children"] = Json::array();
  if (depth == 0 || node->children().size() > left) return out["more"] = node->children().size(), out;
  left -= node->children().size();
  for (const auto& c : node->children()) children.push_back(describeTree(*c, depth - 1, links, left));
  return out;
}

Json tree(Kernel& kernel, const Json& request, std::size_t maxNodes) {
  const Leaf& top = nodeOf(kernel, request);
  // The children of the requested node are listed in any case.
  std::size_t left = std::max(maxNodes, top.asNode() ? top.asNode()->children().size() : 0);
  return {{"ok", true}, {"tree", describeTree(top, request.value("depth", -1), request.value("links", false), left)}};
}

Json propertiesOf(Leaf& leaf, const Json& request) {
  Json properties = Json::array();
  if (request.contains("property"))
    properties.push_back(describe(leaf, propertyOf(leaf, textOf(request, "property"))));
  else
    for (const Property* p : leaf.classObject()->properties()) properties.push_back(describe(leaf, *p));
  return {{"ok", true}, {"path", leaf.path()}, {"class", leaf.classObject()->name()}, {"properties", properties}};
}

Json get(Kernel& kernel, const Json& request) { return propertiesOf(nodeOf(kernel, request), request); }

Json set(Kernel& kernel, const Json& request) {
  if (!request.contains("value")) throw Error("the request lacks a \"value\"");
  Leaf& leaf = nodeOf(kernel, request);
  setProperty(leaf, textOf(request, "property"), fromJson(request["value"]));
  return propertiesOf(leaf, request);  // by reference: the name may have been set
}

Json call(Kernel& kernel, const Leaf& self, const Json& request) {
  Leaf& leaf = nodeOf(kernel, request);
  const std::string method = textOf(request, "method");
  refuseRemovingServers(leaf, method, self);
  std::vector<Value> arguments;
  if (const auto at = request.find("arguments"); at != request.end() && at->is_array())
    for (const Json& a : *at) arguments.push_back(fromJson(a));
  const Value v = callMethod(leaf, method, arguments);
  return {{"ok", true}, {"value", toJson(v)}, {"text", v.isNil() ? "" : v.plain()}};
}

Json plugins(Kernel& kernel) {
  std::vector<Plugin*> all;
  kernel.root().require<Node>("/plugins").collect(all);
  std::sort(all.begin(), all.end(), [](Plugin* a, Plugin* b) { return a->name() < b->name(); });
  Json list = Json::array();
  for (const Plugin* p : all)
    list.push_back({{"name", p->name()},
                    {"version", p->version()},
                    {"doc", p->doc()},
                    {"file", p->file()},
                    {"registered", p->registered()},
                    {"classes", p->classes()}});
  return {{"ok", true}, {"plugins", list}};
}

Json load(Kernel& kernel, const Json& request) {
  const std::string& name = textOf(request, "name");
  if (const Plugin& p = kernel.plugins().use(name); p.hasOtherCode()) {
    const std::string file = p.file();
    try {
      kernel.plugins().unload(name);
    } catch (const Error& e) {
      throw Error(fmt::format("plugin '{}' runs code of before: {} is newer", name, file), e);
    }
  }
  const Plugin& p = kernel.plugins().use(name);
  std::string text = fmt::format("{} {} from {}:", p.name(), p.version(), p.file());
  for (const std::string& c : p.classes()) text += " " + c;
  return {{"ok", true}, {"text", text}};
}

Json make(Kernel& kernel, const Json& request) {
  const Leaf& made = kernel.create(textOf(request, "class"), textOf(request, "path"));
  if (auto* const scenes = kernel.root().find<ISceneServer>()) scenes->markModified();
  return {{"ok", true}, {"text", made.path()}};
}

/// The server that answers, and perhaps one that asks, are on the call stack while the script runs: all servers stay.
Json attach(Kernel& kernel, const Leaf& self, const Json& request) {
  std::list<InUse> servers;
  for (const auto& server : self.parent()->children())
    servers.emplace_back(*server, "a script from outside runs", InUse::kAllBelow);
  const std::string name = request.value("name", std::string("sparkctl"));
  const List results = kernel.root()
                           .require<IScriptText>(IScriptServer::kPath)
                           .attachText(nodeOf(kernel, request), textOf(request, "text"), name, true);
  if (auto* const scenes = kernel.root().find<ISceneServer>()) scenes->markModified();
  const bool isNothing = results.empty() || (results.size() == 1 && results[0].isNil());
  std::string text;
  for (const Value& v : results) text.append(text.empty() ? "" : "\n").append(v.plain());
  return {{"ok", true},
          {"value", results.empty() ? Json() : toJson(results[0])},
          {"values", toJson(results)},
          {"text", isNothing ? "" : text}};
}

Json unload(Kernel& kernel, const Json& request) {
  kernel.plugins().unload(textOf(request, "name"));
  return {{"ok", true}, {"text", ""}};
}

std::string dump(const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace); }
std::string failure(const std::exception& e) { return dump({{"ok", false}, {"error", e.what()}}); }

std::string watchLine(Kernel& kernel, const Watch& watch) {
  Json out{{"ok", true}, {"text", watch.last.plain()}, {"value", toJson(watch.last)}, {"unit", watch.unit}};
  if (const auto* clock = kernel.root().find<ISimulation>()) {
    out["cycle"] = clock->cycle();
    out["time"] = clock->time();
  }
  return dump(out);
}

std::string startWatch(Kernel& kernel, const Json& request, Watch& watch) {
  Leaf& leaf = nodeOf(kernel, request);
  const Property& p = propertyOf(leaf, textOf(request, "property"));
  watch = {leaf.path(), p.name, p.unit, &leaf, p.get(leaf), true};
  return watchLine(kernel, watch);
}

/// The names of all requests, as part of a sentence.
std::string knownRequests(const Node& self) {
  std::string out = "tree, get, set, call, make, attach, watch, plugins, load, unload";
  for (const auto& child : self.children())
    if (const auto handler = child->as<IRequestHandler>())
      for (const std::string_view name : handler->requests()) out.append(", ").append(name);
  return out.insert(out.rfind(", ") + 2, "or ");
}

/// The handler that answers a request; nullptr if there is none.
IRequestHandler* handlerOf(const Node& self, std::string_view what) {
  for (const auto& child : self.children())
    if (auto handler = child->as<IRequestHandler>())
      if (const auto names = handler->requests(); std::find(names.begin(), names.end(), what) != names.end())
        return handler;
  return nullptr;
}

bool changesSomething(std::string_view what) {
  constexpr std::string_view kAll[] = {"set", "call", "make", "attach", "load", "unload"};
  return std::find(std::begin(kAll), std::end(kAll), what) != std::end(kAll);
}

std::string dispatch(Kernel& kernel, const Node& self, std::string_view line, Watch& watch, bool mayChange) {
  const Json request = Json::parse(line);
  if (!request.is_object()) throw Error("expected one JSON object a line");
  const std::string what = textOf(request, "do");
  if (!mayChange && changesSomething(what))
    throw Error(fmt::format(
        "'{}' changes the match, which only the referee may: log in with the token that the host printed at its start",
        what));
  auto* const tape = kernel.root().find<IInputTape>();
  if (tape && changesSomething(what) && !tape->put({.kind = Input::Kind::request, .text = line}))
    throw Error("a recording is played: nothing can be changed in it");
  std::optional<outputs::ByUser> byUser;  // a request that changes something is the user's own, unless it is played
  if (changesSomething(what) && !(tape && tape->playing())) byUser.emplace();
  if (what == "tree") return dump(tree(kernel, request, mayChange ? kMaxNodes : kMaxNodesForSpectators));
  if (what == "get") return dump(get(kernel, request));
  if (what == "set") return dump(set(kernel, request));
  if (what == "call") return dump(call(kernel, self, request));
  if (what == "make") return dump(make(kernel, request));
  if (what == "attach") return dump(attach(kernel, self, request));
  if (what == "load") return dump(load(kernel, request));
  if (what == "unload") return dump(unload(kernel, request));
  if (what == "plugins") return dump(plugins(kernel));
  if (what == "watch") return startWatch(kernel, request, watch);
  if (auto* handler = handlerOf(self, what)) return handler->answer(line);
  throw Error(fmt::format("expected {}, found '{}'", knownRequests(self), what));
}
}  // namespace

std::string answer(Kernel& kernel, const Node& self, std::string_view line, Watch& watch, bool mayChange) {
  try {
    return dispatch(kernel, self, line, watch, mayChange);
  } catch (const std::exception& e) {
    return failure(e);
  }
}

std::string nextOf(Kernel& kernel, Watch& watch, bool& done) {
  try {
    if (!watch.leaf) throw Error(fmt::format("there is no {} any more", watch.path));
    Value now = getProperty(*watch.leaf, watch.property);
    if (now == watch.last) return {};
    watch.last = std::move(now);
    return watchLine(kernel, watch);
  } catch (const std::exception& e) {
    done = true;
    return failure(e);
  }
}

}  // namespace spark::control
