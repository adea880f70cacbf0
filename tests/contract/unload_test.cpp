#include "all_plugins.h"

// Loads each plugin, makes an object of each of its classes, and unloads it. Then its file must no longer be mapped.

using namespace spark;
using spark::test::TestHost;

namespace {
/// Registers the plugin `name` and the plugins that provide the bases of its classes. Returns their names, bases last.
std::vector<std::string> useWithBases(Kernel& kernel, const std::string& name) {
  std::vector<std::string> used{name};
  for (std::size_t i = 0; i < used.size(); ++i) {
    Plugin& plugin = kernel.plugins().use(used[i]);
    for (ClassObject* c : kernel.classes()) {
      if (c->plugin() != &plugin || kernel.findClass(c->baseName())) continue;
      Plugin* provider = kernel.plugins().providerOf(c->baseName());
      INFO("class " << c->name() << " needs base " << c->baseName());
      REQUIRE(provider != nullptr);
      if (std::find(used.begin(), used.end(), provider->name()) == used.end()) used.push_back(provider->name());
    }
  }
  return used;
}
}  // namespace

TEST_CASE("Every plugin can be unloaded once its objects are destroyed, and is then no longer mapped") {
  const test::PluginsUnloaded unloaded;
  std::vector<std::string> names;
  {
    TestHost host;
    for (Plugin* p : test::pluginsOf(host.kernel)) names.push_back(p->name());
  }
  for (const std::string& name : names) {
    INFO("plugin " << name);
    TestHost host;
    const std::string file = host.kernel.root().require<Plugin>("/plugins/" + name).file();
    std::vector<std::string> used = useWithBases(host.kernel, name);
    for (ClassObject* c : host.kernel.classes()) {
      if (!c->plugin() || c->isAbstract()) continue;
      INFO("class " << c->name());
      c->create();
      try {
        Leaf& made = host.kernel.create(c->name(), "/usr/" + c->name());
        made.parent()->remove(made);
      } catch (const Error&) {
        // The object may need a scene. No object may remain.
      }
      CHECK(c->living() == 0);
    }
    // A plugin may be needed by one that was registered later, so repeat until all are unloaded.
    for (std::size_t round = 0; round < 10 && !used.empty(); ++round)
      std::erase_if(used, [&](const std::string& u) {
        try {
          host.kernel.plugins().unload(u);
          return true;
        } catch (const Error&) {
          return false;
        }
      });
    CHECK(used.empty());
    CHECK_FALSE(test::isMapped(file));
  }
}
