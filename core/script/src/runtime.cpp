#include "runtime.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "environment.h"
#include "restore.h"
#include "spark/output_file.h"
#include "unsaved.h"
#include "values.h"

namespace fs = std::filesystem;

namespace spark::script {

Runtime::Runtime(Kernel& k)
    : kernel(k), settings(k), trusted(std::make_shared<State>(*this, nullptr)), scriptNode(&k.root()) {}

Runtime::~Runtime() { close(); }

void Runtime::close() {
  trusted->close();
  for (const auto& weak : sandboxes)
    if (const auto state = weak.lock()) state->close();
}

// The user chooses the config, so the working folder is searched first.
Script Runtime::readConfig(std::string_view file) {
  std::vector<fs::path> places{userFolder()};
  if (inConfig) places.push_back(configFolder);
  places.insert(places.end(), folders.begin(), folders.end());
  return read(file, "config", places);
}

// Included files are not searched in the working folder, whose files may belong to another user, unless the config
// itself is in it.
Script Runtime::readInclude(std::string_view file, lua_State* includer) {
  std::vector<fs::path> places;
  if (const auto beside = folderOf(includer); !beside.empty()) places.push_back(beside);
  if (!configFolder.empty() && std::find(places.begin(), places.end(), configFolder) == places.end())
    places.push_back(configFolder);
  places.insert(places.end(), folders.begin(), folders.end());
  return read(file, "script", places);
}

fs::path Runtime::userFolder() const { return workingFolder.empty() ? fs::current_path() : workingFolder; }

/// The folder of the script that called the running C function; empty if there is none, or the script is not a file.
fs::path Runtime::folderOf(lua_State* L) const {
  lua_Debug ar{};
  if (!L || !lua_getstack(L, 1, &ar) || !lua_getinfo(L, "S", &ar)) return {};
  const auto known = origins_.find(ar.source);
  return known == origins_.end() ? fs::path() : known->second;
}

/// Reads the first file of that name in the folders `places`. `what` names its kind in errors.
Script Runtime::read(std::string_view file, std::string_view what, std::vector<fs::path> places) {
  if (fs::path(file).is_absolute()) places = {fs::path(file).parent_path()};
  std::vector<std::string> looked, names;  // for the error: the searched folders, and the scripts in them
  for (const fs::path& place : places) {
    const fs::path path = place / file;  // the file itself if it is absolute
    std::error_code ec;
    if (fs::is_directory(path, ec))
      throw Error(fmt::format("cannot read {} '{}': {} is a folder", what, file, path.string()));
    if (fs::exists(path, ec)) {
      std::ifstream in(path, std::ios::binary);
      std::string text{std::istreambuf_iterator<char>(in), {}};
      if (!in) throw Error(fmt::format("cannot read {} {}: no permission?", what, path.string()));
      origins_[fmt::format("@{}", file)] = path.parent_path();
      outputs::keep(path.string());
      return {path, std::move(text)};
    }
    looked.push_back(place.string());
    for (fs::directory_iterator it(path.parent_path(), ec), end; !ec && it != end; it.increment(ec))
      if (it->path().extension() == ".lua") names.push_back(it->path().filename().string());
  }
  throw Error(fmt::format("there is no {} '{}'. Looked in: {}.{}", what, file, fmt::join(looked, ", "),
                          didYouMean(fs::path(file).filename().string(), names)));
}

void Runtime::load(lua_State* L, std::string_view text, std::string_view chunkName, int environment) {
  constexpr const char* kTextOnly = "t";                   // binary chunks could crash Lua
  constexpr std::string_view kByteOrder = "\xEF\xBB\xBF";  // some editors put it in front of UTF-8
  State::of(L).runtime().kernel.sources().add("script", chunkName.substr(1), text);  // without Lua's mark of its kind
  if (text.starts_with(LUA_SIGNATURE))
    throw Error(fmt::format("{}: expected text, found compiled code", chunkName.substr(1)));
  if (text.starts_with(kByteOrder)) text.remove_prefix(kByteOrder.size());
  if (luaL_loadbufferx(L, text.data(), text.size(), std::string(chunkName).c_str(), kTextOnly) != LUA_OK) lua_error(L);
  lua_pushvalue(L, environment);
  lua_setupvalue(L, -2, 1);  // the first upvalue of a chunk is _ENV
}

void Runtime::pushConfigEnvironment(lua_State* L) {
  if (configEnvironment_ == LUA_NOREF) {
    pushEnvironment(L, kernel.root(), true);
    configEnvironment_ = luaL_ref(L, LUA_REGISTRYINDEX);
  }
  lua_rawgeti(L, LUA_REGISTRYINDEX, configEnvironment_);
}

Value Runtime::run(std::string_view text, std::string_view chunkName) {
  const Restore asConfig(scriptNode, Ref<Leaf>(&kernel.root()));
  Value result;
  const auto failure = trusted->run(kUnlimited, [&](lua_State* L) {
    pushConfigEnvironment(L);
    load(L, text, chunkName, lua_gettop(L));
    lua_call(L, 0, 1);
    result = toValue(L, -1);
  });
  if (failure) throw Error(failure->text);
  return result;
}

void Runtime::setGlobal(std::string_view name, const Value& value) {
  const auto failure = trusted->run(kUnlimited, [&](lua_State* L) {
    pushConfigEnvironment(L);
    pushText(L, name);
    pushTables(L, value);
    lua_settable(L, -3);
  });
  if (failure) throw Error(failure->text);
}

namespace {
/// A result of a script. Throws Error if it is no value.
Value resultAt(lua_State* L, int index, std::string_view chunkName) {
  try {
    return toValue(L, index);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: what it returned: {}", chunkName.substr(1), e.what()));
  }
}
}  // namespace

List Runtime::attach(Leaf& node, std::string_view text, std::string_view chunkName, bool isTrusted,
                     const State::Body& pushArguments) {
  const std::string path = node.path();
  if (!node.isLinked()) throw Error(fmt::format("cannot attach a script to {}: it is not linked into the tree", path));
  std::shared_ptr<State> state = trusted;
  if (!isTrusted) {
    state = std::make_shared<State>(*this, &node);
    std::erase_if(sandboxes, [](const auto& weak) { return weak.expired(); });
    sandboxes.push_back(state);
  }

  std::vector<std::weak_ptr<Subscription>> subscribed;
  std::optional<Failure> failure;
  List results;
  {
    const Restore running(scriptNode, Ref<Leaf>(&node));
    const Restore collecting(made, &subscribed);
    failure = state->run(isTrusted ? kHandlerBudget : kSandboxBudget, [&](lua_State* L) {
      pushEnvironment(L, node, false);
      load(L, text, chunkName, lua_gettop(L));
      const int function = lua_gettop(L);
      if (pushArguments) pushArguments(L);
      lua_call(L, lua_gettop(L) - function, LUA_MULTRET);
      for (int i = function; i <= lua_gettop(L); ++i) results.push_back(resultAt(L, i, chunkName));
    });
  }
  if (!failure) return results;
  for (const auto& weak : subscribed)
    if (const auto s = weak.lock()) s->remove();
  throw Error(fmt::format("the script attached to {} failed: {}", path, failure->text));
}

// Scripts to attach are also searched in the working folder, because they are named by the user or by a config that
// expects them there.
void Runtime::attachFile(Leaf& node, std::string_view file, lua_State* from, const State::Body& pushArguments) {
  std::vector<fs::path> places;
  if (const auto beside = folderOf(from); !beside.empty()) places.push_back(beside);
  if (!configFolder.empty()) places.push_back(configFolder);
  places.insert(places.end(), folders.begin(), folders.end());
  places.push_back(userFolder());
  attach(node, read(file, "script", places).text, fmt::format("@{}", file), true, pushArguments);
}

/// True if a channel of that name is defined.
bool Runtime::isChannel(std::string_view name) const {
  for (const Channel* c : kernel.events().all())
    if (c->name() == name) return !c->doc().empty();
  return false;
}

/// The names most similar to that of an undefined channel, as a sentence. "" if the channel is defined or no name is
/// similar.
std::string Runtime::nearChannels(std::string_view name) const {
  std::vector<std::string> names;
  if (isChannel(name)) return {};
  for (const Channel* c : kernel.events().all())
    if (!c->doc().empty()) names.push_back(c->name());
  return didYouMean(name, names);
}

// A config may add handlers before a channel is defined. At the end of the config the channel is defined, or its name
// is misspelt.
void Runtime::checkChannels() {
  const auto listened = std::exchange(listened_, {});
  for (const auto& [channel, where] : listened)
    if (const std::string near = nearChannels(channel); !near.empty())
      throw Error(fmt::format("{}there is no event channel '{}': nothing would ever run this handler.{}", where,
                              channel, near));
  // Hooks of C++ classes.
  std::vector<ClassObject*> classes;
  kernel.root().require<Node>("/classes").collect(classes);
  for (ClassObject* c : classes) {
    if (c->living() == 0) continue;
    for (const Hook* hook : c->hooks())
      if (const std::string near = nearChannels(hook->channel); !near.empty())
        kernel.log().warning("class {} has a hook on '{}', and there is no such channel: nothing runs it.{}", c->name(),
                             hook->channel, near);
  }
}

std::shared_ptr<Subscription> Runtime::subscribe(lua_State* L, Leaf& node, std::string_view channel) {
  // A config may define the channel later: checkChannels() checks again.
  if (inConfig && !isChannel(channel)) {
    luaL_where(L, 1);
    listened_.emplace_back(channel, lua_tostring(L, -1));
    lua_pop(L, 1);
  } else if (const std::string near = nearChannels(channel); !near.empty()) {
    throw Error(fmt::format("there is no event channel '{}': nothing would ever run this handler.{}", channel, near));
  }
  if (warnsOfUnsaved) {
    for (const std::string& line : unsavedWrites(L, -1, memory.tables(L)))
      kernel.log().warning(
          "{}, in a handler of '{}'. That is neither saved nor hashed: a run that goes on from saved state finds what "
          "was there before. Keep it in the table `state` of the script.",
          line, channel);
  }
  auto s = std::make_shared<Subscription>();
  State& state = State::of(L);
  s->state = state.shared_from_this();
  s->node = Ref<Leaf>(&node);
  s->owner = scriptNode;
  s->channel = &kernel.events().channel(channel);
  s->function = luaL_ref(L, LUA_REGISTRYINDEX);
  s->number = s->channel->add(node, [s](Leaf&, const Event& event) { s->run(event); });
  if (made) made->push_back(s);
  return s;
}

void Runtime::report(const Failure& failure, const Subscription& s) {
  kernel.countFault();
  const bool isNew = reported_.insert(failure.where.empty() ? failure.text : failure.where).second;
  if (!isNew && !failure.exhausted) return;
  kernel.log().error("handler of '{}' at {} failed: {}\n  {}", s.channel->name(),
                     s.node ? s.node->path() : "a deleted node", failure.text,
                     failure.exhausted ? "It is switched off: it would take as long every time."
                                       : "It stays; further errors of this line are not logged.");
}

}  // namespace spark::script
