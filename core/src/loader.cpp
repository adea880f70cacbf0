#include <dlfcn.h>
#include <ltdl.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "spark/error.h"
#include "spark/kernel.h"

// How a plugin comes and goes.
//
//   scan(folder)   open every *.so (symbols resolved now, names local), read its descriptor, check magic and ABI word, list it under
//                  /plugins. Nothing of the plugin runs: it has no constructors with effects, and registering is a call.
//   use(name)      call registerClasses: the classes appear under /classes. If it throws, what it registered so far is taken back.
//   unload(name)   refused while an object of its classes lives or a foreign class derives from them; then its atUnload actions run, its
//                  classes go, /plugins loses it, and the last lt_dlclose unmaps the file.
//
// libltdl asks the dynamic linker for lazy binding and keeps its error text to itself. So each file is first opened with dlopen(NOW, LOCAL):
// what is missing is found then and said in the linker's own words; libltdl's handle keeps it open, ours is closed again.

namespace fs = std::filesystem;

namespace spark {

namespace {
std::mutex& ltdlMutex() {
  static std::mutex mutex;  // libltdl keeps process-wide lists
  return mutex;
}

std::string sanitizerName(std::uint32_t s) { return s == 0 ? "no sanitizer" : s == 1 ? "the address sanitizer" : "the thread sanitizer"; }

/// "" when the plugin's word agrees with ours, else what differs.
std::string abiProblem(const AbiWord& theirs) {
  const AbiWord ours = thisAbi();
  const auto number = [](const char* what, std::uint32_t a, std::uint32_t b) {
    return std::string("it was built with ") + what + " " + std::to_string(a) + ", this host with " + std::to_string(b);
  };
  if (theirs.version < ours.version) return "it was built for the older plugin ABI " + std::to_string(theirs.version) + ", this host has " + std::to_string(ours.version);
  if (theirs.version > ours.version) return "it was built for the newer plugin ABI " + std::to_string(theirs.version) + ", this host has " + std::to_string(ours.version);
  if (theirs.sanitizer != ours.sanitizer) return "it was built with " + sanitizerName(theirs.sanitizer) + ", this host with " + sanitizerName(ours.sanitizer);
  if (theirs.compiler != ours.compiler) return number("compiler ABI", theirs.compiler, ours.compiler);
  if (theirs.alignment != ours.alignment) return number("alignment", theirs.alignment, ours.alignment);
  if (std::memcmp(theirs.headers, ours.headers, sizeof ours.headers) != 0)
    return "its Spark headers (" + std::string(theirs.headers, strnlen(theirs.headers, 16)) + ") are not this host's (" + ours.headers + ")";
  return {};
}

class ClassCollector : public Registrar {
 public:
  explicit ClassCollector(Kernel& kernel) : kernel_(kernel) {}
  void add(ClassDescription description) override { classes.push_back(std::move(description)); }
  void atUnload(std::function<void()> action) override { actions.push_back(std::move(action)); }
  std::vector<ClassDescription> classes;
  std::vector<std::function<void()>> actions;

 private:
  Kernel& kernel_;
};
}  // namespace

Loader::Loader(Kernel& kernel) : kernel_(kernel) {
  const std::lock_guard lock(ltdlMutex());
  if (lt_dlinit() != 0) throw Error(std::string("cannot start libltdl: ") + lt_dlerror());
}

Loader::~Loader() {
  for (const auto& p : kernel_.pluginsNode_->children())
    for (const auto& action : static_cast<Plugin&>(*p).atUnload_) action();
  std::vector<void*> handles;
  for (const auto& p : kernel_.pluginsNode_->children()) {
    Plugin& plugin = static_cast<Plugin&>(*p);
    plugin.atUnload_.clear();
    handles.push_back(plugin.handle_);
  }
  // The classes hold functions of the plugins: they go first.
  std::vector<Leaf*> foreign;
  for (const auto& [name, c] : kernel_.classIndex_)
    if (c->plugin_) foreign.push_back(c);
  for (Leaf* c : foreign) {
    kernel_.classIndex_.erase(kernel_.classIndex_.find(c->name()));
    kernel_.classesNode_->remove(*c);
  }
  kernel_.pluginsNode_->removeChildren();
  const std::lock_guard lock(ltdlMutex());
  for (void* h : handles) lt_dlclose(static_cast<lt_dlhandle>(h));
  lt_dlexit();
}

Plugin& Loader::open(const fs::path& file) {
  const std::lock_guard lock(ltdlMutex());
  const std::string path = fs::absolute(file).lexically_normal().string();
  void* first = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!first) {
    const char* text = dlerror();
    throw Error("cannot load plugin " + path + ": " + (text ? text : "unknown reason"));
  }
  lt_dlhandle handle = lt_dlopen(path.c_str());
  const char* why = handle ? nullptr : lt_dlerror();
  const auto* d = handle ? static_cast<const PluginDescriptor*>(lt_dlsym(handle, "sparkPlugin")) : nullptr;
  dlclose(first);
  const auto refuse = [&](const std::string& reason) {
    if (handle) lt_dlclose(handle);
    throw Error("refused plugin " + path + ": " + reason);
  };
  if (!handle) refuse(why ? why : "libltdl cannot open it");
  if (!d) refuse("it has no symbol sparkPlugin; a plugin ends with SPARK_PLUGIN(name, version, doc, classes...)");
  if (std::memcmp(d->magic, "SPARKPLG", 8) != 0) refuse("its descriptor lacks the magic word SPARKPLG");
  if (const std::string problem = abiProblem(d->abi); !problem.empty()) refuse(problem + ". Build it again with this host's headers.");
  if (d->size != sizeof(PluginDescriptor)) refuse("its descriptor has " + std::to_string(d->size) + " bytes, this host's " + std::to_string(sizeof(PluginDescriptor)));
  if (!d->name || !*d->name || std::strchr(d->name, '/')) refuse("its descriptor has no name");
  if (Leaf* other = kernel_.pluginsNode_->child(d->name))
    refuse(std::string("there is a plugin '") + d->name + "' already, from " + static_cast<Plugin*>(other)->file_);
  Plugin& plugin = kernel_.pluginsNode_->create<Plugin>("Plugin", d->name);
  plugin.version_ = d->version ? d->version : "";
  plugin.doc_ = d->doc ? d->doc : "";
  plugin.file_ = path;
  for (const char* const* c = d->classes; c && *c; ++c) plugin.classes_.emplace_back(*c);
  plugin.handle_ = handle;
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
  } else {
    folders_.push_back(fs::absolute(folder).lexically_normal());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& f : files) {
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
  ClassCollector collector(kernel_);
  const auto takeBack = [&](std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      ClassObject* c = kernel_.findClass(plugin.classes_[i]);
      kernel_.classIndex_.erase(kernel_.classIndex_.find(c->name()));
      kernel_.classesNode_->remove(*c);
    }
  };
  std::size_t added = 0;
  std::vector<std::string> names;
  try {
    plugin.descriptor_->registerClasses(collector);
    for (ClassDescription& d : collector.classes) {
      names.push_back(d.name);
      kernel_.addClass(std::move(d), &plugin);
      ++added;
    }
  } catch (const std::exception& e) {
    plugin.classes_ = names;
    takeBack(added);
    throw Error("plugin '" + plugin.name() + "' (" + plugin.file_ + ") failed to register", e);
  } catch (...) {
    plugin.classes_ = names;
    takeBack(added);
    throw Error("plugin '" + plugin.name() + "' (" + plugin.file_ + ") failed to register: it threw something that is no std::exception");
  }
  plugin.classes_ = names;
  plugin.atUnload_ = std::move(collector.actions);
  plugin.registered_ = true;
}

Plugin& Loader::use(std::string_view name) {
  if (Leaf* found = kernel_.pluginsNode_->child(name)) {
    Plugin& plugin = static_cast<Plugin&>(*found);
    registerPlugin(plugin);
    return plugin;
  }
  std::vector<std::string> names;
  for (const auto& p : kernel_.pluginsNode_->children()) names.push_back(p->name());
  std::string where;
  for (const fs::path& f : folders_) where += (where.empty() ? "" : ", ") + f.string();
  throw Error("there is no plugin '" + std::string(name) + "'." + didYouMean(name, names) + " Looked in: " + (where.empty() ? "no folder" : where) + ".");
}

Plugin& Loader::useFile(const fs::path& file) {
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
  void* handle = plugin.handle_;
  kernel_.pluginsNode_->remove(plugin);
  const std::lock_guard lock(ltdlMutex());
  lt_dlclose(static_cast<lt_dlhandle>(handle));
}

void Loader::unload(std::string_view name) {
  Leaf* found = kernel_.pluginsNode_->child(name);
  if (!found) throw Error("cannot unload plugin '" + std::string(name) + "': there is none of that name");
  Plugin& plugin = static_cast<Plugin&>(*found);
  std::vector<ClassObject*> mine;
  for (const auto& [n, c] : kernel_.classIndex_)
    if (c->plugin_ == &plugin) mine.push_back(c);
  std::string living, derived;
  const auto isMine = [&](ClassObject* c) { return std::find(mine.begin(), mine.end(), c) != mine.end(); };
  const auto walk = [&](auto& self, const Node& node) -> void {
    for (const auto& c : node.children()) {
      if (isMine(c->classObject())) living += "\n  " + c->path() + " (" + c->classObject()->name() + ")";
      if (c->asNode()) self(self, *c->asNode());
    }
  };
  walk(walk, *kernel_.root_);
  std::size_t products = 0;
  for (ClassObject* c : mine) products += c->living();
  if (products > 0)
    throw Error("cannot unload plugin '" + plugin.name() + "' while its objects live:" + (living.empty() ? " " + std::to_string(products) + " outside the tree" : living) +
                "\nRemove them first.");
  for (const auto& [n, c] : kernel_.classIndex_)
    if (c->plugin_ != &plugin && std::any_of(mine.begin(), mine.end(), [&](ClassObject* m) { return m->name() == c->baseName(); }))
      derived += "\n  " + n + (c->plugin_ ? " of plugin '" + c->plugin_->name() + "'" : "");
  if (!derived.empty()) throw Error("cannot unload plugin '" + plugin.name() + "' while classes derive from its classes:" + derived + "\nUnload those first.");
  for (const auto& action : plugin.atUnload_) action();
  plugin.atUnload_.clear();
  for (ClassObject* c : mine) {
    kernel_.classIndex_.erase(kernel_.classIndex_.find(c->name()));
    kernel_.classesNode_->remove(*c);
  }
  close(plugin);
}

Plugin* Loader::providerOf(std::string_view className) const {
  for (const auto& p : kernel_.pluginsNode_->children()) {
    Plugin& plugin = static_cast<Plugin&>(*p);
    if (std::find(plugin.classes().begin(), plugin.classes().end(), className) != plugin.classes().end()) return &plugin;
  }
  return nullptr;
}

}  // namespace spark
