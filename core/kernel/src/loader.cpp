#include <fmt/format.h>

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

// The life of a plugin.
//
//   scan(folder)   opens every *.so (all symbols resolved, names local), reads its descriptor, checks magic number, ABI
//                  word and headers, and lists the plugin under /plugins. No code of the plugin runs.
//   use(name)      calls registerClasses: the classes appear under /classes. If it throws, the classes that it has
//                  registered are removed again.
//   unload(name)   is refused while objects of its classes exist, a class of another plugin derives from them, or
//                  handlers run, whose code may be the plugin's. It runs the atUnload actions, removes the classes and
//                  the entry under /plugins, and unmaps the library. The path of the file is kept: the next use()
//                  opens the file again, which may be a new version then.
//   unloadLater    is unload() if no handler runs; otherwise settle() unloads, which the run loop calls between cycles.
//
// The library that is mapped is a copy of the file, and kernels that load the same file share it (loaded_library.cpp).

namespace fs = std::filesystem;

namespace spark {

namespace {
std::string sanitizerName(std::uint32_t s) {
  return s == 0 ? "no sanitizer" : s == 1 ? "the address sanitizer" : "the thread sanitizer";
}

/// "" if the plugin's ABI word equals the host's, else the difference.
std::string abiProblem(const AbiWord& theirs) {
  const AbiWord ours = thisAbi();
  if (theirs.version != ours.version)
    return fmt::format("it was built for the {} plugin ABI {}, this host has {}",
                       theirs.version < ours.version ? "older" : "newer", theirs.version, ours.version);
  if (theirs.sanitizer != ours.sanitizer)
    return fmt::format("it was built with {}, this host with {}", sanitizerName(theirs.sanitizer),
                       sanitizerName(ours.sanitizer));
  if (theirs.compiler != ours.compiler)
    return fmt::format("it was built with compiler ABI {}, this host with {}", theirs.compiler, ours.compiler);
  if (theirs.alignment != ours.alignment)
    return fmt::format("it was built with alignment {}, this host with {}", theirs.alignment, ours.alignment);
  return {};
}

/// True if the host was built with that version of a header.
bool isHostHeader(std::string_view stamp) {
  const char* const* ours = kHostHeaders;
  while (*ours && stamp != *ours) ++ours;
  return *ours;
}

/// "" if the host was built with the same versions of all headers that the plugin includes, else the names of the other
/// ones. Headers that the plugin does not include may differ.
std::string headersProblem(const PluginDescriptor& d) {
  // The texts in the list are separated by zeros, of which there may be several.
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

/// Records the file that is being loaded: if its contents crash the linker, the crash report has the name.
struct Loading {
  explicit Loading(const char* file) { running().file = file; }
  ~Loading() { running().file = nullptr; }
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;
};

/// Collects what a plugin registers, so that nothing is registered if it throws.
class ClassCollector : public Registrar {
 public:
  void add(ClassDescription description) override { classes.push_back(std::move(description)); }
  void atUnload(std::function<void()> action) override { actions.push_back(std::move(action)); }
  std::vector<ClassDescription> classes;
  std::vector<std::function<void()>> actions;
};

std::string absolutePath(const fs::path& file) { return fs::absolute(file).lexically_normal().string(); }

/// True for a name that can be used in paths and configs: letters, digits, '-', '_', '.'.
bool isPluginName(std::string_view name) {
  constexpr std::size_t kLongest = 100;
  return !name.empty() && name.front() != '.' && name.size() <= kLongest &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; });
}

/// True if of two files in one folder only the first one has that name.
bool isNamedAs(const fs::path& file, const fs::path& other, std::string_view name) {
  return file.parent_path() == other.parent_path() && file.stem() == name && other.stem() != name;
}

/// The text, "" for nullptr.
const char* textOf(const char* text) { return text ? text : ""; }

/// Libraries that stay loaded until the process ends.
std::vector<std::shared_ptr<LoadedLibrary>>& permanentLibraries() {
  static auto& libraries = *new std::vector<std::shared_ptr<LoadedLibrary>>;
  return libraries;
}
}  // namespace

void Plugin::describe(Description<Plugin>& d) {
  d.doc("A plugin: a shared library that provides classes.");
  d.property("version", &Plugin::version).doc("Its own version.");
  d.property("doc", &Plugin::doc).doc("What it is for.");
  d.property("file", &Plugin::file).doc("The file it was loaded from.");
  d.property("classes", &Plugin::classes).doc("Names of the classes it provides.");
  d.property("registered", &Plugin::registered).doc("True when a config line registered its classes.");
  d.method("unload", &Plugin::unload)
      .doc("Unloads it; in a handler of an event when the cycle is over. Refused while objects of its classes live.");
}

void Plugin::unload() { kernel().plugins().unloadLater(std::string(name())); }  // a copy: it may remove this object

Loader::Loader(Kernel& kernel) : kernel_(kernel) {}

Loader::~Loader() {
  std::vector<std::shared_ptr<LoadedLibrary>> libraries;
  for (const auto& p : kernel_.tree().plugins->children()) {
    Plugin& plugin = static_cast<Plugin&>(*p);
    runActions(plugin);
    libraries.push_back(std::move(plugin.library_));
  }
  // Classes contain functions of their plugins, so they are removed before the libraries. An object outside the tree
  // that outlives the kernel still needs its class and its code, so both stay in memory in that case.
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
  if (keep) permanentLibraries().insert(permanentLibraries().end(), libraries.begin(), libraries.end());
}

/// Runs the atUnload actions once.
void Loader::runActions(Plugin& plugin) {
  const std::vector<std::function<void()>> actions = std::move(plugin.atUnload_);
  plugin.atUnload_.clear();
  for (const auto& action : actions) try {
      action();
    } catch (const std::exception& e) {
      kernel_.log().error("plugin '{}' failed while it was unloaded: {}", plugin.name(), e.what());
    }
}

/// Loads a file and lists it under /plugins.
Plugin& Loader::open(const fs::path& file) {
  const std::string path = absolutePath(file);
  const Loading loading(path.c_str());
  std::shared_ptr<LoadedLibrary> library = LoadedLibrary::load(path);

  // The members of the descriptor are read in the order in which the checks make them reliable.
  const auto* d = static_cast<const PluginDescriptor*>(library->symbol("sparkPlugin"));
  const auto refuse = [&](std::string_view reason) { throw Error(fmt::format("refused plugin {}: {}", path, reason)); };
  const auto refuseBuild = [&](const std::string& problem) {
    if (!problem.empty()) refuse(problem + ". Build it again with this host's headers.");
  };
  if (!d) refuse("it has no symbol sparkPlugin; a plugin ends with SPARK_PLUGIN(name, version, doc, classes...)");
  if (std::memcmp(d->magic, "SPARKPLG", 8) != 0) refuse("its descriptor lacks the magic word SPARKPLG");
  if (d->size < offsetof(PluginDescriptor, name)) refuse(fmt::format("its descriptor has only {} bytes", d->size));
  refuseBuild(abiProblem(d->abi));
  if (d->size != sizeof(PluginDescriptor))
    refuse(fmt::format("its descriptor has {} bytes, this host's {}", d->size, sizeof(PluginDescriptor)));
  refuseBuild(headersProblem(*d));
  if (!isPluginName(textOf(d->name)))
    refuse(fmt::format("its name '{}' is none: letters, digits, '-', '_' and '.' make one", textOf(d->name)));
  if (Leaf* const other = kernel_.tree().plugins->child(d->name)) {
    Plugin& first = static_cast<Plugin&>(*other);
    const auto refusal = [&](const std::string& used) {
      return fmt::format("there is a plugin '{}' already, from {}", d->name, used);
    };
    // Of two files in a folder, such as lamp-old.so and lamp.so, the one with the plugin's name is the plugin.
    if (first.registered_ || !isNamedAs(path, first.file_, d->name)) refuse(refusal(first.file_));
    kernel_.log().warning("refused plugin {}: {}", first.file_, refusal(path));
    close(first);
  }

  auto made = kernel_.classOf("Plugin").create();
  made->setName(d->name);
  Plugin& plugin = static_cast<Plugin&>(kernel_.tree().attach(*kernel_.tree().plugins, std::move(made)));
  plugin.version_ = textOf(d->version);
  plugin.doc_ = textOf(d->doc);
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
    problems.push_back(fmt::format("cannot read plugin folder {}: {}", folder.string(), ec.message()));
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

/// Registers all classes of a plugin, or none if that fails.
void Loader::registerPlugin(Plugin& plugin) {
  if (plugin.registered_) return;
  ClassCollector collector;
  const std::string failed = fmt::format("plugin '{}' ({}) failed to register", plugin.name(), plugin.file_);
  std::vector<ClassObject*> added;
  const auto takeBack = [&] {
    for (ClassObject* c : added) kernel_.registry().drop(*c, false);
  };
  std::vector<std::string> names;
  const NowRunning now("registering", &plugin);
  try {
    plugin.descriptor_->registerClasses(collector);
    for (ClassDescription& d : collector.classes) {
      if (d.base == d.name) throw Error(fmt::format("class '{}' names itself as its base", d.name));
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
  // A plugin that has been rebuilt since it was listed is loaded again.
  if (plugin && !plugin->registered_ && plugin->library_->hasChanged()) {
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
  std::vector<std::string> where;
  for (const fs::path& f : folders_) where.push_back(f.string());
  throw Error(fmt::format("there is no plugin '{}'.{} Looked in: {}.", name, didYouMean(name, names),
                          where.empty() ? "no folder" : fmt::format("{}", fmt::join(where, ", "))));
}

/// Loads a plugin that was unloaded, or whose file is newer than the scan of its folder. Returns nullptr if there is
/// none.
Plugin* Loader::openAgain(std::string_view name) {
  std::vector<fs::path> files;
  if (const auto known = unloaded_.find(name); known != unloaded_.end()) files.push_back(known->second);
  if (isPluginName(name))
    for (const fs::path& folder : folders_) files.push_back(folder / fmt::format("{}.so", name));
  for (const fs::path& file : files)
    if (std::error_code ec; fs::is_regular_file(file, ec) && !fromFile(file)) {
      Plugin& plugin = open(file);
      if (plugin.name() == name) return &plugin;
    }
  return nullptr;
}

bool Plugin::hasOtherCode() const { return LoadedLibrary::hasChanged(file_); }

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

/// Removes a plugin from /plugins and unmaps its library.
void Loader::close(Plugin& plugin) {
  // The object may contain functions of the library, so it is destroyed first.
  const std::shared_ptr<LoadedLibrary> library = std::move(plugin.library_);
  kernel_.tree().detach(plugin);
}

/// The listed plugin of that file, nullptr if there is none.
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

/// The plugin of that name. Throws Error if its classes are in use.
Plugin& Loader::unused(std::string_view name) const {
  Leaf* found = kernel_.tree().plugins->child(name);
  if (!found) throw Error(fmt::format("cannot unload plugin '{}': there is none of that name", name));
  Plugin& plugin = static_cast<Plugin&>(*found);
  const std::vector<ClassObject*> classes = classesOf(plugin);

  // Objects of its classes, with the paths of some in the tree.
  constexpr std::size_t kMaxListed = 10;
  std::size_t count = 0, listed = 0;
  for (ClassObject* c : classes) count += c->living();
  std::string living;
  const auto walk = [&](auto& self, const Node& node) -> void {
    for (const auto& c : node.children()) {
      if (std::find(classes.begin(), classes.end(), c->classObject()) != classes.end() && listed++ < kMaxListed)
        living += fmt::format("\n  {} ({})", c->path(), c->classObject()->name());
      if (c->asNode()) self(self, *c->asNode());
    }
  };
  walk(walk, kernel_.root());
  if (listed > kMaxListed) living += fmt::format("\n  and {} more", listed - kMaxListed);
  if (count > 0)
    throw Error(fmt::format("cannot unload plugin '{}' while its objects live:{}\nRemove them first.", plugin.name(),
                            living.empty() ? fmt::format(" {} outside the tree", count) : living));

  // Classes of other plugins that derive from its classes.
  std::string derived;
  for (const auto& [n, c] : kernel_.registry().all())
    if (c->plugin() != &plugin && std::any_of(classes.begin(), classes.end(), [&, other = c](ClassObject* own) {
          return own->name() == other->baseName();
        }))
      derived += c->plugin() ? fmt::format("\n  {} of plugin '{}'", n, c->plugin()->name()) : fmt::format("\n  {}", n);
  if (!derived.empty())
    throw Error(fmt::format("cannot unload plugin '{}' while classes derive from its classes:{}\nUnload those first.",
                            plugin.name(), derived));
  return plugin;
}

void Loader::unload(std::string_view name) {
  Plugin& plugin = unused(name);
  if (kernel_.events().running())
    throw Error(
        fmt::format("cannot unload plugin '{}' while handlers of events run, which may be its own. Unload it "
                    "between two cycles.",
                    plugin.name()));
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
