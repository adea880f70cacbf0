#include "all_plugins.h"

// Each plugin comes, makes one of everything, and goes, for real: its file is no longer mapped.

using namespace spark;
using spark::test::House;

namespace {
/// Registers `name` and whatever provides the bases of its classes; returns them, bases last.
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

TEST_CASE("Every plugin unloads after its objects are gone, and is no longer mapped") {
  std::vector<std::string> names;
  {
    House house;
    for (Plugin* p : test::pluginsOf(house.kernel)) names.push_back(p->name());
  }
  for (const std::string& name : names) {
    INFO("plugin " << name);
    House house;
    const std::string file = house.kernel.root().require<Plugin>("/plugins/" + name).file();
    std::vector<std::string> used = useWithBases(house.kernel, name);
    for (ClassObject* c : house.kernel.classes()) {
      if (!c->plugin() || c->isAbstract()) continue;
      INFO("class " << c->name());
      c->create();
      try {
        Leaf& made = house.kernel.create(c->name(), "/usr/" + c->name());
        made.parent()->remove(made);
      } catch (const Error&) {
        // It may need a house; nothing of it may stay.
      }
      CHECK(c->living() == 0);
    }
    // A plugin may be needed by one that was used later, so go round until all are gone.
    for (std::size_t round = 0; round < 10 && !used.empty(); ++round)
      std::erase_if(used, [&](const std::string& u) {
        try {
          house.kernel.plugins().unload(u);
          return true;
        } catch (const Error&) {
          return false;
        }
      });
    CHECK(used.empty());
    CHECK_FALSE(test::isMapped(file));
  }
}
