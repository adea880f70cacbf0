#include "spark/script_server.h"

#include <fmt/format.h>

#include <optional>

#include "restore.h"
#include "runtime.h"
#include "values.h"

namespace fs = std::filesystem;

namespace spark {

struct ScriptServer::Impl : script::Runtime {
  using Runtime::Runtime;
};

ScriptServer& scripts(Kernel& kernel) {
  if (auto* known = kernel.root().find<ScriptServer>(ScriptServer::kPath)) return *known;
  if (!kernel.findClass(ScriptServer::kClassName)) kernel.registerClass<ScriptServer>();
  return kernel.create<ScriptServer>(ScriptServer::kClassName, ScriptServer::kPath);
}

void ScriptServer::describe(Description<ScriptServer>& d) {
  d.doc("Runs configs, and scripts that are attached to nodes.");
  d.implements<IScriptServer>();
  d.implements<IScriptText>();
}

ScriptServer::ScriptServer() = default;
ScriptServer::~ScriptServer() = default;

void ScriptServer::onLink() { impl_ = std::make_shared<Impl>(kernel()); }
void ScriptServer::onUnlink() { impl_->close(); }
void ScriptServer::saveState(StateWriter& out) const {
  if (impl_) impl_->memory.save(out);
}
void ScriptServer::loadState(StateReader& in) {
  if (impl_) impl_->memory.load(in);
}

// A script may remove the script server, so every function that runs one keeps the runtime until it returns.

void ScriptServer::addFolder(fs::path folder) { impl_->folders.push_back(std::move(folder)); }
void ScriptServer::setWorkingFolder(fs::path folder) { impl_->workingFolder = std::move(folder); }
void ScriptServer::addOverride(std::string key, Value value) { impl_->settings.add(std::move(key), std::move(value)); }

void ScriptServer::applyOverrides() { impl_->settings.apply(); }

void ScriptServer::runConfig(std::string_view file) {
  const auto running = impl_;
  const script::Script config = running->readConfig(file);
  // The folder of the outermost config stays: scripts that a scene file names later are searched in it.
  std::optional<script::Restore<fs::path>> keepFolder;
  if (running->inConfig)
    keepFolder.emplace(running->configFolder, config.path.parent_path());
  else
    running->configFolder = config.path.parent_path();
  {
    const script::Restore shielding(running->inConfig, true);
    running->run(config.text, fmt::format("@{}", file));
  }
  running->checkChannels();
  running->settings.finish();
}

Value ScriptServer::run(std::string_view text, std::string_view chunkName) {
  const auto running = impl_;
  return running->run(text, fmt::format("={}", chunkName));
}

void ScriptServer::setGlobal(std::string_view name, const Value& value) { impl_->setGlobal(name, value); }

void ScriptServer::attach(Leaf& node, std::string_view file, const Value& arguments) {
  const auto running = impl_;
  running->attachFile(node, file, nullptr, [&](lua_State* L) { script::pushArguments(L, arguments); });
}

List ScriptServer::attachText(Leaf& node, std::string_view text, std::string_view chunkName, bool trusted,
                              const Value& arguments) {
  const auto running = impl_;
  return running->attach(node, text, fmt::format("={}", chunkName), trusted,
                         [&](lua_State* L) { script::pushArguments(L, arguments); });
}

void ScriptServer::warnOfUnsaved() { impl_->warnsOfUnsaved = true; }

std::vector<List> ScriptServer::options() const { return impl_->settings.options(); }
std::vector<std::string> ScriptServer::secrets() const { return impl_->settings.secrets(); }

}  // namespace spark
