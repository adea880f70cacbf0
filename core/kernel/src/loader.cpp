#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstring>
#include <set>
#include <utility>

#include "class_registry.h"
#include "host_headers.h"
#include "loaded_library.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/running.h"
#include "tree.h"

// How a plugin comes and goes.
//
//   scan(folder)   open every *.so (symbols resolved now, names local), read its descriptor, check magic, ABI word and
//                  headers, list it under /plugins. Nothing of the plugin runs: it has no constructors with effects,
//                  and registering is a call.
//   use(name)      call registerClasses: the classes appear under /classes. If it throws, what it registered so far is
//                  removed again.
//   unload(name)   refused while an object of its classes lives, a foreign class derives from them or handlers run
//                  (their code may be the plugin's); then its atUnload actions run, its classes go, /plugins loses it,
//                  and its library is unmapped. The name is kept: the next use opens the file again, which may be
//                  another one by then.
//   unloadLater    as unload where no handler runs, else when the run loop says settle(), between two cycles.
//
// What is mapped is a copy of the file (loaded_library.cpp), shared by kernels that load the same.

namespace fs = std::filesystem;

namespace spark {

namespace {
std::string sanitizerName(std::uint32_t s) {
  return s == 0 ? "no sanitizer" : s == 1 ? "the address sanitizer" : "the thread sanitizer";
}

/// "" when the plugin's word agrees with ours, else what differs.
std::string abiProblem(const AbiWord& theirs) {
  const AbiWord ours = thisAbi();
  const auto number = [](const char* what, std::uint32_t a, std::uint32_t b) {
    return std::string("it was built with ") + what + " " + std::to_string(a) + ", this host with " + std::to_string(b);
  };
  if (theirs.version < ours.version)
    return "it was built for the older plugin ABI " + std::to_string(theirs.version) + ", this host has " +
           std::to_string(ours.version);
  if (theirs.version > ours.version)
    return "it was built for the newer plugin ABI " + std::to_string(theirs.version) + ", this host has " +
           std::to_string(ours.version);
  if (theirs.sanitizer != ours.sanitizer)
    return "it was built with " + sanitizerName(theirs.sanitizer) + ", this host with " + sanitizerName(ours.sanitizer);
  if (theirs.compiler != ours.compiler) return number("compiler ABI", theirs.compiler, ours.compiler);
  if (theirs.alignment != ours.alignment) return number("alignment", theirs.alignment, ours.alignment);
  return {};
}

bool isHostHeader(std::string_view stamp) {
  const char* const* ours = kHostHeaders;
  while (*ours && stamp != *ours) ++ours;
  return *ours;
}

/// "" when each header that the plugin was compiled with is this host's, else the names of those that are not. Headers
/// that the plugin does not include may differ.
std::string headersProblem(const PluginDescriptor& d) {
  bool listed = false;
  std::set<std::string> others;
  for (const char* at = d.headers; at < d.headersEnd; ++at) {
    const std::string stamp(at, strnlen(at, static_cast<std::size_t>(d.headersEnd - at)));
    if (stamp.empty()) continue;
    listed = true;
    if (!isHostHeader(stamp)) others.insert(stamp.substr(0, stamp.find(' ')));
    at += stamp.size();
  }
  if (!listed) return "it does not say which headers it was built with";
  if (others.empty()) return {};
  return fmt::format("this host has another version of {}, or none", fmt::join(others, ", "));
}

/// The linker believes what a file says. Where it is wrong, the host's last words are the file's name.
struct Loading {
  explicit Loading(const char* file) { running().file = file; }
  ~Loading() { running().file = nullptr; }
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;
};

class ClassCollector : public Registrar {
 public:
  void add(ClassDescription description) override { classes.push_back(std::move(description)); }
  void atUnload(std::function<void()> action) override { actions.push_back(std::move(action)); }
  std::vector<ClassDescription> classes;
  std::vector<std::function<void()>> actions;
};

std::string absolutePath(const fs::path& file) { return fs::absolute(file).lexically_normal().string(); }

/// The word for a plugin in paths, configs and messages: letters, digits, '-', '_', '.'.
bool isPluginName(const char* name) {
  const std::string_view n = name ? name : "";
  return !n.empty() && n.front() != '.' && n.size() <= 100 && std::all_of(n.begin(), n.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '_' || c == '.';
  });
}
}  // namespace

void Plugin::describe(Description<Plugin>& d) {
  d.doc("A plugin: a shared library that provides classes.");
  d.property("version", &Plugin::version).doc("Its own version.");
  d.property("doc", &Plugin::doc).doc("What it is for.");
  d.property("file", &Plugin::file).doc("The file it was loaded from.");
  d.property("classes", &Plugin::classes).doc("Names of the classes it provides.");
  d.property("registered", &Plugin::registered).doc("True when a config line registered its classes.");
}

Loader::Loader(Kernel& kernel) : kernel_(kernel) {}

Loader::~Loader() {
  std::vector<std::shared_ptr<LoadedLibrary>> libraries;
  for (const auto& p : kernel_.tree().plugins->children()) {
    Plugin& plugin = static_cast<Plugin&>(*p);
    runActions(plugin);
    libraries.push_back(std::move(plugin.library_));
  }
  // The classes hold functions of the plugins: they go first. Somebody who still owns an object outside the tree will
  // need its class and its code: both are then left to the process.
  bool keep = false;
  std::vector<ClassObject*> foreign;
  for (const auto& [name, c] : kernel_.registry().all()) {
    if (!c->plugin()) continue;
    foreign.push_back(c);
    if (c->living() == 0) continue;
    kernel_.log().error("{} object(s) of class {} outlive their kernel: plugins stay loaded", c->living(), c->name());
    keep = true;
  }
  for (ClassObject* c : foreign) kernel_.registry().drop(*c, keep);
  while (!kernel_.tree().plugins->children().empty())
    kernel_.tree().detach(*kernel_.tree().plugins->children().front());
  static auto& forever = *new std::vector<std::shared_ptr<LoadedLibrary>>;
  if (keep) forever.insert(forever.end(), libraries.begin(), libraries.end());
}

void Loader::runActions(Plugin& plugin) {
  const std::vector<std::function<void()>> actions = std::move(plugin.atUnload_);
  plugin.atUnload_.clear();
  for (const auto& action : actions) try {
      action();
    } catch (const std::exception& e) {
      kernel_.log().error("plugin '{}' failed while it was unloaded: {}", plugin.name(), e.what());
    }
}

Plugin& Loader::open(const fs::path& file) {
  const std::string path = absolutePath(file);
  const Loading loading(path.c_str());
  std::shared_ptr<LoadedLibrary> library = LoadedLibrary::load(path);
  const auto* d = static_cast<const PluginDescriptor*>(library->symbol("sparkPlugin"));
  const auto refuse = [&](const std::string& reason) { throw Error("refused plugin " + path + ": " + reason); };
  if (!d) refuse("it has no symbol sparkPlugin; a plugin ends with SPARK_PLUGIN(name, version, doc, classes...)");
  if (std::memcmp(d->magic, "SPARKPLG", 8) != 0) refuse("its descriptor lacks the magic word SPARKPLG");
  if (d->size < offsetof(PluginDescriptor, name))
    refuse("its descriptor has only " + std::to_string(d->size) + " bytes");
  if (const std::string problem = abiProblem(d->abi); !problem.empty())
    refuse(problem + ". Build it again with this host's headers.");
  if (d->size != sizeof(PluginDescriptor))
    refuse("its descriptor has " + std::to_string(d->size) + " bytes, this host's " +
           std::to_string(sizeof(PluginDescriptor)));
  if (const std::string problem = headersProblem(*d); !problem.empty())
    refuse(problem + ". Build it again with this host's headers.");
  if (!isPluginName(d->name))
    refuse("its name '" + std::string(d->name ? d->name : "") +
           "' is none: letters, digits, '-', '_' and '.' make one");
  if (Leaf* other = kernel_.tree().plugins->child(d->name))
    refuse(std::string("there is a plugin '") + d->name + "' already, from " + static_cast<Plugin*>(other)->file_);
  auto made = kernel_.classOf("Plugin").create();
  made->setName(d->name);
  Plugin& plugin = static_cast<Plugin&>(kernel_.tree().attach(*kernel_.tree().plugins, std::move(made)));
  plugin.version_ = d->version ? d->version : "";
  plugin.doc_ = d->doc ? d->doc : "";
  plugin.file_ = path;
  for (const char* const* c = d->classes; c && *c; ++c) plugin.classes_.emplace_back(*c);
  plugin.library_ = std::move(library);
  plugin.descriptor_ = d;
  return plugin;
}

std::vector<std::string> Loader::scan(const fs::path& folder) {
  std::vector<std::string> problems;
  std::error_code ec;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
    if (it->path().extension() == ".so") files.push_back(it->path());
  if (ec) {
    problems.push_back("cannot read plugin folder " + folder.string() + ": " + ec.message());
  } else if (const fs::path full = absolutePath(folder);
             std::find(folders_.begin(), folders_.end(), full) == folders_.end()) {
    folders_.push_back(full);
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& f : files) {
    if (fromFile(f)) continue;
    try {
      open(f);
    } catch (const std::exception& e) {
      problems.emplace_back(e.what());
    }
  }
  for (const std::string& p : problems) kernel_.log().warning("{}", p);
  return problems;
}

void Loader::registerPlugin(Plugin& plugin) {
  if (plugin.registered_) return;
  ClassCollector collector;
  const std::string failed = "plugin '" + plugin.name() + "' (" + plugin.file_ + ") failed to register";
  std::vector<ClassObject*> added;
  const auto takeBack = [&] {
    for (ClassObject* c : added) kernel_.registry().drop(*c, false);
  };
  std::vector<std::string> names;
  const NowRunning now("registering", &plugin);
  try {
    plugin.descriptor_->registerClasses(collector);
    for (ClassDescription& d : collector.classes) {
      if (d.base == d.name) throw Error("class '" + d.name + "' names itself as its base");
      names.push_back(d.name);
      added.push_back(&kernel_.registry().add(std::move(d), &plugin));
    }
  } catch (const std::exception& e) {
    takeBack();
    throw Error(failed, e);
  } catch (...) {
    takeBack();
    throw Error(failed + ": it threw something that is no std::exception");
  }
  plugin.classes_ = names;
  plugin.atUnload_ = std::move(collector.actions);
  plugin.registered_ = true;
}

Plugin& Loader::use(std::string_view name) {
  Plugin* plugin = static_cast<Plugin*>(kernel_.tree().plugins->child(name));
  if (plugin && !plugin->registered_ && plugin->library_->hasChanged()) {  // built again since it was listed
    unloaded_.insert_or_assign(plugin->name(), plugin->file_);
    close(*plugin);
    plugin = nullptr;
  }
  if (!plugin) plugin = openAgain(name);
  if (plugin) {
    registerPlugin(*plugin);
    return *plugin;
  }
  std::vector<std::string> names;
  for (const auto& p : kernel_.tree().plugins->children()) names.push_back(p->name());
  for (const auto& [known, file] : unloaded_) names.push_back(known);
  std::string where;
  for (const fs::path& f : folders_) where += (where.empty() ? "" : ", ") + f.string();
  throw Error("there is no plugin '" + std::string(name) + "'." + didYouMean(name, names) +
              " Looked in: " + (where.empty() ? "no folder" : where) + ".");
}

/// A plugin that was unloaded, or whose file came into a folder after the scan; nullptr when there is none.
Plugin* Loader::openAgain(std::string_view name) {
  std::vector<fs::path> files;
  if (const auto known = unloaded_.find(name); known != unloaded_.end()) files.push_back(known->second);
  if (isPluginName(std::string(name).c_str()))
    for (const fs::path& folder : folders_) files.push_back(folder / (std::string(name) + ".so"));
  for (const fs::path& file : files)
    if (std::error_code ec; fs::is_regular_file(file, ec) && !fromFile(file)) {
      Plugin& plugin = open(file);
      if (plugin.name() == name) return &plugin;
    }
  return nullptr;
}

Plugin& Loader::useFile(const fs::path& file) {
  Plugin* known = fromFile(file);
  if (known) {
    registerPlugin(*known);
    return *known;
  }
  Plugin& plugin = open(file);
  try {
    registerPlugin(plugin);
  } catch (...) {
    close(plugin);
    throw;
  }
  return plugin;
}

void Loader::close(Plugin& plugin) {
  const std::shared_ptr<LoadedLibrary> library = std::move(plugin.library_);  // the node may hold what is in it
  kernel_.tree().detach(plugin);
}

Plugin* Loader::fromFile(const fs::path& file) const {
  const std::string path = absolutePath(file);
  for (const auto& p : kernel_.tree().plugins->children())
    if (static_cast<Plugin&>(*p).file_ == path) return static_cast<Plugin*>(p.get());
  return nullptr;
}

std::vector<ClassObject*> Loader::classesOf(const Plugin& plugin) const {
  std::vector<ClassObject*> all;
  for (const auto& [name, c] : kernel_.registry().all())
    if (c->plugin() == &plugin) all.push_back(c);
  return all;
}

/// The plugin of that name. Throws Error when something needs it.
Plugin& Loader::unused(std::string_view name) const {
  Leaf* found = kernel_.tree().plugins->child(name);
  if (!found) throw Error("cannot unload plugin '" + std::string(name) + "': there is none of that name");
  Plugin& plugin = static_cast<Plugin&>(*found);
  const std::vector<ClassObject*> mine = classesOf(plugin);
  std::string living, derived;
  const auto isMine = [&](ClassObject* c) { return std::find(mine.begin(), mine.end(), c) != mine.end(); };
  const auto walk = [&](auto& self, const Node& node) -> void {
    for (const auto& c : node.children()) {
      if (isMine(c->classObject())) living += "\n  " + c->path() + " (" + c->classObject()->name() + ")";
      if (c->asNode()) self(self, *c->asNode());
    }
  };
  walk(walk, kernel_.root());
  std::size_t products = 0;
  for (ClassObject* c : mine) products += c->living();
  if (products > 0)
    throw Error("cannot unload plugin '" + plugin.name() + "' while its objects live:" +
                (living.empty() ? " " + std::to_string(products) + " outside the tree" : living) +
                "\nRemove them first.");
  for (const auto& [n, c] : kernel_.registry().all())
    if (c->plugin() != &plugin && std::any_of(mine.begin(), mine.end(), [&, derivedClass = c](ClassObject* m) {
          return m->name() == derivedClass->baseName();
        }))
      derived += "\n  " + n + (c->plugin() ? " of plugin '" + c->plugin()->name() + "'" : "");
  if (!derived.empty())
    throw Error("cannot unload plugin '" + plugin.name() + "' while classes derive from its classes:" + derived +
                "\nUnload those first.");
  return plugin;
}

void Loader::unload(std::string_view name) {
  Plugin& plugin = unused(name);
  if (kernel_.events().running())
    throw Error("cannot unload plugin '" + plugin.name() +
                "' while handlers of events run, which may be its own. Unload it between two cycles.");
  runActions(plugin);
  for (ClassObject* c : classesOf(plugin)) kernel_.registry().drop(*c, false);
  unloaded_.insert_or_assign(plugin.name(), plugin.file_);
  close(plugin);
}

void Loader::unloadLater(std::string_view name) {
  if (!kernel_.events().running()) return unload(name);
  unused(name);
  leaving_.emplace_back(name);
}

void Loader::unloadLeaving() {
  for (const std::string& name : std::exchange(leaving_, {})) try {
      unload(name);
    } catch (const std::exception& e) {
      kernel_.log().error("{}", e.what());
    }
}

Plugin* Loader::providerOf(std::string_view className) const {
  for (const auto& p : kernel_.tree().plugins->children()) {
    Plugin& plugin = static_cast<Plugin&>(*p);
    if (std::find(plugin.classes().begin(), plugin.classes().end(), className) != plugin.classes().end())
      return &plugin;
  }
  return nullptr;
}

}  // namespace spark
