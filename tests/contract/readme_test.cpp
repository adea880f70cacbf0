#include <fstream>
#include <sstream>

#include "all_plugins.h"

// Users read a plugin's README first. It has an example, and a table that names every property of the plugin's classes.

using namespace spark;
using spark::test::AllPlugins;
namespace fs = std::filesystem;

namespace {
std::string textOf(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The lines of all tables.
std::string tablesOf(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("|")) out += line + "\n";
  return out;
}
}  // namespace

TEST_CASE("Every plugin has a README with an example and a table that names its properties") {
  AllPlugins host;
  for (Plugin* plugin : test::pluginsOf(host.kernel)) {
    const fs::path file = fs::path(SPARK_PLUGIN_SOURCES) / plugin->name() / "README.md";
    INFO("plugin " << plugin->name() << ": " << file.string());
    REQUIRE(fs::exists(file));
    const std::string text = textOf(file), tables = tablesOf(text);
    CHECK(text.starts_with("# "));
    CHECK(text.find("```lua") != std::string::npos);
    std::string missing;
    for (ClassObject* c : host.classesOf(*plugin)) {
      if (text.find("--describe " + c->name()) != std::string::npos)
        continue;  // too many for a table: the README says how to list them
      for (const Property* p : c->properties()) {
        const bool own = (!c->base() || c->base()->property(p->name) == nullptr) && p->type != "random stream";
        if (own && tables.find("`" + p->name + "`") == std::string::npos)
          missing += "\n  " + c->name() + "." + p->name + "  " + p->type + " [" + p->unit + "]  " + p->doc;
      }
    }
    if (!missing.empty()) FAIL_CHECK("its table does not name:" << missing);
  }
}
