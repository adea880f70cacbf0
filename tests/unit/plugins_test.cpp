#include "plugin_files.h"
#include "spark/event.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "temporary_folder.h"

// How plugins are listed, registered and unloaded.

using namespace spark;
using namespace spark::test;

TEST_CASE("A plugin that fails while it registers leaves no class behind") {
  TestHost host(false);
  host.kernel.plugins().scan(fixtures("bad-plugins"));
  const auto failure = [&](const char* name) { return refusal([&] { host.kernel.plugins().use(name); }); };
  CHECK_THAT(failure("throws-while-registering"),
             Catch::Contains("throws-while-registering.so") && Catch::Contains("the flux is low"));
  CHECK_THAT(failure("throws-no-exception"),
             Catch::Contains("throws-no-exception.so") && Catch::Contains("no std::exception"));
  CHECK_THAT(failure("duplicate-class"), Catch::Contains("class 'Node' is registered already, by the kernel"));
  CHECK_THAT(failure("own-base"), Catch::Contains("class 'Innocent' names itself as its base"));
  CHECK(host.kernel.findClass("Innocent") == nullptr);
  CHECK(host.kernel.classOf("Node").plugin() == nullptr);
  // The plugin can be tried again and be unloaded.
  CHECK_THAT(failure("duplicate-class"), Catch::Contains("is registered already"));
  CHECK(host.kernel.plugins().providerOf("Innocent") != nullptr);
  host.kernel.plugins().unload("duplicate-class");
  CHECK_FALSE(isMapped(bad("duplicate-class")));
}

TEST_CASE("Files of a folder are scanned in the order of their names") {
  TestHost host(false);
  const test::TemporaryFolder folder;
  for (int i = 0; i < 20; ++i) std::ofstream(folder.path() / fmt::format("file{:02}.so", i * 7 % 20)).flush();
  const auto problems = host.kernel.plugins().scan(folder.path());
  REQUIRE(problems.size() == 20);
  for (std::size_t i = 0; i < problems.size(); ++i)
    CHECK_THAT(problems[i], Catch::Contains(fmt::format("file{:02}.so", i)));
}

TEST_CASE("A scan only lists plugins, and use registers one") {
  TestHost host(false);
  CHECK(host.kernel.plugins().scan(fixtures("fixture-plugins")).empty());
  const Plugin& p = host.kernel.root().require<Plugin>("/plugins/fixture-base");
  CHECK(p.version() == "1.2");
  CHECK(p.classes() == std::vector<std::string>{"FixtureBase"});
  CHECK_FALSE(p.registered());
  CHECK(host.kernel.findClass("FixtureBase") == nullptr);
  CHECK_THAT(refusal([&] { host.kernel.classOf("FixtureBase"); }),
             Catch::Contains("plugin 'fixture-base' provides it"));
  CHECK(&host.kernel.plugins().use("fixture-base") == &p);
  CHECK(&host.kernel.plugins().use("fixture-base") == &p);
  CHECK(host.kernel.classOf("FixtureBase").plugin() == &p);
  CHECK_THAT(refusal([&] { host.kernel.plugins().use("fixture-bace"); }),
             Catch::Contains("'fixture-base'") && Catch::Contains("fixture-plugins"));
}

TEST_CASE("A folder can be scanned again, and a listed file can be used by its path") {
  TestHost host(false);
  host.kernel.plugins().scan(fixtures("fixture-plugins"));
  CHECK(host.kernel.plugins().scan(fixtures("fixture-plugins")).empty());
  CHECK(host.kernel.plugins().folders().size() == 1);
  CHECK(host.kernel.plugins().useFile(good("fixture-base")).registered());
  const test::TemporaryFolder folder;
  fs::copy_file(good("fixture-base"), folder.path() / "copy.so");
  const auto problems = host.kernel.plugins().scan(folder.path());
  REQUIRE(problems.size() == 1);
  CHECK_THAT(problems[0],
             Catch::Contains("there is a plugin 'fixture-base' already, from " + good("fixture-base").string()));
}

TEST_CASE("The order in which plugins are registered does not matter") {
  TestHost host(false);
  host.kernel.plugins().scan(fixtures("fixture-plugins"));
  host.kernel.plugins().use("fixture-derived");
  const std::string why = refusal([&] { host.kernel.create("FixtureDerived", "/usr/x"); });
  CHECK_THAT(why, Catch::Contains("class FixtureDerived of plugin fixture-derived needs its base class FixtureBase") &&
                      Catch::Contains("plugin \"fixture-base\""));
  host.kernel.plugins().use("fixture-base");
  Leaf& made = host.kernel.create("FixtureDerived", "/usr/x");
  CHECK(made.classObject()->isA("FixtureBase"));
  CHECK(getProperty(made, "number") == Value(1.0));
  host.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  CHECK(getProperty(made, "number") == Value(2.0));
}

TEST_CASE("The error for a missing base class says if no plugin provides it") {
  TestHost host(false);
  host.kernel.plugins().useFile(good("fixture-derived"));
  CHECK_THAT(refusal([&] { host.kernel.create("FixtureDerived", "/usr/x"); }),
             Catch::Contains("No scanned plugin provides it"));
}

TEST_CASE("Unloading is refused while objects of the plugin exist, and the error lists them") {
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  loader.useFile(good("fixture-base"));
  Node& a = host.kernel.create<Node>("FixtureBase", "/usr/a");
  a.create("FixtureBase", "b");
  const std::string why = refusal([&] { loader.unload("fixture-base"); });
  CHECK_THAT(why, Catch::Contains("while its objects live") && Catch::Contains("/usr/a (FixtureBase)") &&
                      Catch::Contains("/usr/a/b (FixtureBase)"));
  for (int i = 0; i < 20; ++i) a.create("FixtureBase");
  CHECK_THAT(refusal([&] { loader.unload("fixture-base"); }), Catch::Contains("\n  and 12 more\nRemove them first."));
  host.kernel.root().child("usr")->asNode()->remove(a);
  const auto loose = host.kernel.classOf("FixtureBase").create();
  CHECK_THAT(refusal([&] { loader.unload("fixture-base"); }), Catch::Contains("1 outside the tree"));
  CHECK(host.kernel.findClass("FixtureBase") != nullptr);
}

TEST_CASE("Unloading is refused while other plugins have classes derived from the plugin's") {
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  loader.scan(fixtures("fixture-plugins"));
  loader.use("fixture-derived");
  loader.use("fixture-base");
  CHECK_THAT(refusal([&] { loader.unload("fixture-base"); }),
             Catch::Contains("FixtureDerived of plugin 'fixture-derived'"));
  loader.unload("fixture-derived");
  loader.unload("fixture-base");
  CHECK(loader.providerOf("FixtureBase") == nullptr);
  CHECK_THAT(refusal([&] { loader.unload("fixture-base"); }), Catch::Contains("there is none of that name"));
}

TEST_CASE("Unloading removes a plugin's classes, node and code, and it can be loaded again") {
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  for (int round = 0; round < 3; ++round) {
    loader.useFile(good("fixture-base"));
    REQUIRE(isMapped(good("fixture-base")));
    Leaf& made = host.kernel.create("FixtureBase", "/usr/a");
    host.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
    StateWriter out(false);
    saveTree(made, out);
    made.parent()->remove(made);
    loader.unload("fixture-base");
    CHECK(host.kernel.findClass("FixtureBase") == nullptr);
    CHECK(host.kernel.root().find("/plugins/fixture-base") == nullptr);
    CHECK(host.kernel.root().find("/classes/FixtureBase") == nullptr);
    CHECK_FALSE(isMapped(good("fixture-base")));
    host.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  }
}

TEST_CASE("A kernel unloads its plugins when it is destroyed but not those of another kernel") {
  TestHost other(false);
  other.kernel.plugins().useFile(good("fixture-derived"));
  {
    TestHost host(false);
    host.kernel.plugins().scan(fixtures("fixture-plugins"));
    host.kernel.plugins().use("fixture-derived");
    host.kernel.plugins().use("fixture-base");
    host.kernel.create("FixtureDerived", "/elsewhere/x");
    host.kernel.create("FixtureBase", "/sys/y");
  }
  CHECK_FALSE(isMapped(good("fixture-base")));
  CHECK(isMapped(good("fixture-derived")));
  CHECK(other.kernel.findClass("FixtureDerived") != nullptr);
}

TEST_CASE("The plugins' nodes belong to the loader") {
  TestHost host(false);
  host.kernel.plugins().useFile(good("fixture-base"));
  Leaf& node = *host.kernel.root().find("/plugins/fixture-base");
  CHECK_THROWS_AS(node.parent()->remove(node), Error);
  CHECK_THROWS_AS(node.setName("other"), Error);
  host.kernel.plugins().unload("fixture-base");
}

TEST_CASE("use reads the current file of a listed plugin, and finds files added after the scan") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  loader.scan(folder.path());
  overwrite(file, withVersion(bytesOf(file), "1.2", "1.4"));
  CHECK(loader.use("fixture-base").version() == "1.4");
  CHECK_THAT(refusal([&] { loader.use("fixture-derived"); }), Catch::Contains("there is no plugin 'fixture-derived'"));
  fs::copy_file(good("fixture-derived"), folder.path() / "fixture-derived.so");
  CHECK(loader.use("fixture-derived").registered());
  CHECK_THAT(refusal([&] { loader.use("../fixture-derived"); }), Catch::Contains("there is no plugin"));
}

TEST_CASE("A plugin is not unloaded while handlers run; unloadLater defers it to the end of the cycle") {
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  loader.useFile(good("fixture-base"));
  Leaf& made = host.kernel.create("FixtureBase", "/usr/a");
  std::string now, later;
  host.kernel.events().channel("knock").add(host.kernel.root(), [&](Leaf&, const Event&) {
    now = refusal([&] { loader.unload("fixture-base"); });
    later = refusal([&] { loader.unloadLater("fixture-base"); });
  });
  host.kernel.events().channel("knock").emit({"knock"});
  CHECK_THAT(later, Catch::Contains("while its objects live") && Catch::Contains("/usr/a (FixtureBase)"));
  made.parent()->remove(made);
  host.kernel.events().channel("knock").emit({"knock"});
  CHECK_THAT(now, Catch::Contains("while handlers of events run"));
  CHECK(later == "nothing was refused");
  CHECK(host.kernel.findClass("FixtureBase") != nullptr);
  loader.settle();
  CHECK(host.kernel.findClass("FixtureBase") == nullptr);
  CHECK(loader.use("fixture-base").registered());
  loader.unloadLater("fixture-base");  // no handler runs
  CHECK(host.kernel.findClass("FixtureBase") == nullptr);
}

TEST_CASE("A script unloads a plugin at once, or between two cycles if a handler does it") {
  TestHost host(false);
  host.kernel.plugins().scan(fixtures("fixture-plugins"));
  ScriptServer& lua = scripts(host.kernel);
  lua.run("plugin 'fixture-base'  unload 'fixture-base'", "test");
  CHECK(host.kernel.findClass("FixtureBase") == nullptr);
  lua.run("plugin 'fixture-base'  new('FixtureBase', '/usr/a')", "test");
  CHECK_THAT(refusal([&] { lua.run("unload 'fixture-base'", "test"); }),
             Catch::Contains("test:1:") && Catch::Contains("/usr/a (FixtureBase)"));
  lua.run("on('knock', function() delete '/usr/a'  unload 'fixture-base' end)", "test");
  host.kernel.events().channel("knock").emit({"knock"});
  CHECK(host.text.empty());
  CHECK(host.kernel.findClass("FixtureBase") != nullptr);
  host.kernel.plugins().settle();
  CHECK(host.kernel.findClass("FixtureBase") == nullptr);
}

TEST_CASE("A plugin's node unloads it as well") {
  TestHost host(false);
  host.kernel.plugins().scan(fixtures("fixture-plugins"));
  ScriptServer& lua = scripts(host.kernel);
  lua.run("plugin 'fixture-base'  new('FixtureBase', '/usr/a')  node = get '/plugins/fixture-base'", "test");
  CHECK_THAT(refusal([&] { lua.run("node:unload()", "test"); }),
             Catch::Contains("while its objects live") && Catch::Contains("/usr/a (FixtureBase)"));
  CHECK(lua.run("delete '/usr/a'  node:unload()  return node.alive", "test") == Value(false));
  CHECK(host.kernel.findClass("FixtureBase") == nullptr);
  CHECK(lua.run("return plugin('fixture-base').registered", "test") == Value(true));
}
