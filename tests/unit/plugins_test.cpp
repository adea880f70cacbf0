#include "plugin_files.h"
#include "spark/event.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "temporary_folder.h"

// How plugins are listed, registered and unloaded.

using namespace spark;
using namespace spark::test;

TEST_CASE("What fails while it registers leaves no class behind") {
  House house(false);
  house.kernel.plugins().scan(fixtures("bad-plugins"));
  const auto failure = [&](const char* name) { return refusal([&] { house.kernel.plugins().use(name); }); };
  CHECK_THAT(failure("throws-while-registering"),
             Catch::Contains("throws-while-registering.so") && Catch::Contains("the flux is low"));
  CHECK_THAT(failure("throws-no-exception"),
             Catch::Contains("throws-no-exception.so") && Catch::Contains("no std::exception"));
  CHECK_THAT(failure("duplicate-class"), Catch::Contains("class 'Node' is registered already, by the kernel"));
  CHECK_THAT(failure("own-base"), Catch::Contains("class 'Innocent' names itself as its base"));
  CHECK(house.kernel.findClass("Innocent") == nullptr);
  CHECK(house.kernel.classOf("Node").plugin() == nullptr);
  // It may be tried again, and be unloaded.
  CHECK_THAT(failure("duplicate-class"), Catch::Contains("is registered already"));
  CHECK(house.kernel.plugins().providerOf("Innocent") != nullptr);
  house.kernel.plugins().unload("duplicate-class");
  CHECK_FALSE(isMapped(bad("duplicate-class")));
}

TEST_CASE("Files of a folder are taken in the order of their names") {
  House house(false);
  const test::TemporaryFolder folder;
  for (int i = 0; i < 20; ++i) std::ofstream(folder.path() / fmt::format("file{:02}.so", i * 7 % 20)).flush();
  const auto problems = house.kernel.plugins().scan(folder.path());
  REQUIRE(problems.size() == 20);
  for (std::size_t i = 0; i < problems.size(); ++i)
    CHECK_THAT(problems[i], Catch::Contains(fmt::format("file{:02}.so", i)));
}

TEST_CASE("Scanning lists, a config line registers") {
  House house(false);
  CHECK(house.kernel.plugins().scan(fixtures("fixture-plugins")).empty());
  const Plugin& p = house.kernel.root().require<Plugin>("/plugins/fixture-base");
  CHECK(p.version() == "1.2");
  CHECK(p.classes() == std::vector<std::string>{"FixtureBase"});
  CHECK_FALSE(p.registered());
  CHECK(house.kernel.findClass("FixtureBase") == nullptr);
  CHECK_THAT(refusal([&] { house.kernel.classOf("FixtureBase"); }),
             Catch::Contains("plugin 'fixture-base' provides it"));
  CHECK(&house.kernel.plugins().use("fixture-base") == &p);
  CHECK(&house.kernel.plugins().use("fixture-base") == &p);
  CHECK(house.kernel.classOf("FixtureBase").plugin() == &p);
  CHECK_THAT(refusal([&] { house.kernel.plugins().use("fixture-bace"); }),
             Catch::Contains("'fixture-base'") && Catch::Contains("fixture-plugins"));
}

TEST_CASE("A folder may be scanned again, and a listed file be used by its path") {
  House house(false);
  house.kernel.plugins().scan(fixtures("fixture-plugins"));
  CHECK(house.kernel.plugins().scan(fixtures("fixture-plugins")).empty());
  CHECK(house.kernel.plugins().folders().size() == 1);
  CHECK(house.kernel.plugins().useFile(good("fixture-base")).registered());
  const test::TemporaryFolder folder;
  fs::copy_file(good("fixture-base"), folder.path() / "copy.so");
  const auto problems = house.kernel.plugins().scan(folder.path());
  REQUIRE(problems.size() == 1);
  CHECK_THAT(problems[0],
             Catch::Contains("there is a plugin 'fixture-base' already, from " + good("fixture-base").string()));
}

TEST_CASE("The order in which plugins are registered does not matter") {
  House house(false);
  house.kernel.plugins().scan(fixtures("fixture-plugins"));
  house.kernel.plugins().use("fixture-derived");
  const std::string why = refusal([&] { house.kernel.create("FixtureDerived", "/usr/x"); });
  CHECK_THAT(why, Catch::Contains("class FixtureDerived of plugin fixture-derived needs its base class FixtureBase") &&
                      Catch::Contains("plugin \"fixture-base\""));
  house.kernel.plugins().use("fixture-base");
  Leaf& made = house.kernel.create("FixtureDerived", "/usr/x");
  CHECK(made.classObject()->isA("FixtureBase"));
  CHECK(getProperty(made, "number") == Value(1.0));
  house.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  CHECK(getProperty(made, "number") == Value(2.0));
}

TEST_CASE("A missing base that no plugin provides is said so") {
  House house(false);
  house.kernel.plugins().useFile(good("fixture-derived"));
  CHECK_THAT(refusal([&] { house.kernel.create("FixtureDerived", "/usr/x"); }),
             Catch::Contains("No scanned plugin provides it"));
}

TEST_CASE("Unloading is refused while objects live, and lists them") {
  House house(false);
  Loader& loader = house.kernel.plugins();
  loader.useFile(good("fixture-base"));
  Node& a = house.kernel.create<Node>("FixtureBase", "/usr/a");
  a.create("FixtureBase", "b");
  const std::string why = refusal([&] { loader.unload("fixture-base"); });
  CHECK_THAT(why, Catch::Contains("while its objects live") && Catch::Contains("/usr/a (FixtureBase)") &&
                      Catch::Contains("/usr/a/b (FixtureBase)"));
  house.kernel.root().child("usr")->asNode()->remove(a);
  const auto loose = house.kernel.classOf("FixtureBase").create();
  CHECK_THAT(refusal([&] { loader.unload("fixture-base"); }), Catch::Contains("1 outside the tree"));
  CHECK(house.kernel.findClass("FixtureBase") != nullptr);
}

TEST_CASE("Unloading is refused while classes of other plugins derive") {
  House house(false);
  Loader& loader = house.kernel.plugins();
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

TEST_CASE("An unloaded plugin is gone: its classes, its node, its file from memory; and it may come again") {
  House house(false);
  Loader& loader = house.kernel.plugins();
  for (int round = 0; round < 3; ++round) {
    loader.useFile(good("fixture-base"));
    REQUIRE(isMapped(good("fixture-base")));
    Leaf& made = house.kernel.create("FixtureBase", "/usr/a");
    house.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
    StateWriter out(false);
    saveTree(made, out);
    made.parent()->remove(made);
    loader.unload("fixture-base");
    CHECK(house.kernel.findClass("FixtureBase") == nullptr);
    CHECK(house.kernel.root().find("/plugins/fixture-base") == nullptr);
    CHECK(house.kernel.root().find("/classes/FixtureBase") == nullptr);
    CHECK_FALSE(isMapped(good("fixture-base")));
    house.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  }
}

TEST_CASE("A kernel takes its plugins with it, and leaves another kernel's alone") {
  House other(false);
  other.kernel.plugins().useFile(good("fixture-derived"));
  {
    House house(false);
    house.kernel.plugins().scan(fixtures("fixture-plugins"));
    house.kernel.plugins().use("fixture-derived");
    house.kernel.plugins().use("fixture-base");
    house.kernel.create("FixtureDerived", "/elsewhere/x");
    house.kernel.create("FixtureBase", "/sys/y");
  }
  CHECK_FALSE(isMapped(good("fixture-base")));
  CHECK(isMapped(good("fixture-derived")));
  CHECK(other.kernel.findClass("FixtureDerived") != nullptr);
}

TEST_CASE("The plugins' nodes belong to the loader") {
  House house(false);
  house.kernel.plugins().useFile(good("fixture-base"));
  Leaf& node = *house.kernel.root().find("/plugins/fixture-base");
  CHECK_THROWS_AS(node.parent()->remove(node), Error);
  CHECK_THROWS_AS(node.setName("other"), Error);
  house.kernel.plugins().unload("fixture-base");
}

TEST_CASE("What is listed and not in use yet is taken as it is by then, and a file that came later is found") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  House house(false);
  Loader& loader = house.kernel.plugins();
  loader.scan(folder.path());
  overwrite(file, withVersion(bytesOf(file), "1.2", "1.4"));
  CHECK(loader.use("fixture-base").version() == "1.4");
  CHECK_THAT(refusal([&] { loader.use("fixture-derived"); }), Catch::Contains("there is no plugin 'fixture-derived'"));
  fs::copy_file(good("fixture-derived"), folder.path() / "fixture-derived.so");
  CHECK(loader.use("fixture-derived").registered());
  CHECK_THAT(refusal([&] { loader.use("../fixture-derived"); }), Catch::Contains("there is no plugin"));
}

TEST_CASE("While handlers run a plugin is not unloaded; what asked for it then gets it between two cycles") {
  House house(false);
  Loader& loader = house.kernel.plugins();
  loader.useFile(good("fixture-base"));
  Leaf& made = house.kernel.create("FixtureBase", "/usr/a");
  std::string now, later;
  house.kernel.events().channel("knock").add(house.kernel.root(), [&](Leaf&, const Event&) {
    now = refusal([&] { loader.unload("fixture-base"); });
    later = refusal([&] { loader.unloadLater("fixture-base"); });
  });
  house.kernel.events().channel("knock").emit({"knock"});
  CHECK_THAT(later, Catch::Contains("while its objects live") && Catch::Contains("/usr/a (FixtureBase)"));
  made.parent()->remove(made);
  house.kernel.events().channel("knock").emit({"knock"});
  CHECK_THAT(now, Catch::Contains("while handlers of events run"));
  CHECK(later == "nothing was refused");
  CHECK(house.kernel.findClass("FixtureBase") != nullptr);
  loader.settle();
  CHECK(house.kernel.findClass("FixtureBase") == nullptr);
  CHECK(loader.use("fixture-base").registered());
  loader.unloadLater("fixture-base");  // nothing runs
  CHECK(house.kernel.findClass("FixtureBase") == nullptr);
}

TEST_CASE("Scripts unload and load plugins, at once in a config and between two cycles in a handler") {
  House house(false);
  house.kernel.plugins().scan(fixtures("fixture-plugins"));
  ScriptServer& lua = scripts(house.kernel);
  lua.run("plugin 'fixture-base'  unload 'fixture-base'", "test");
  CHECK(house.kernel.findClass("FixtureBase") == nullptr);
  lua.run("plugin 'fixture-base'  new('FixtureBase', '/usr/a')", "test");
  CHECK_THAT(refusal([&] { lua.run("unload 'fixture-base'", "test"); }),
             Catch::Contains("test:1:") && Catch::Contains("/usr/a (FixtureBase)"));
  lua.run("on('knock', function() delete '/usr/a'  unload 'fixture-base' end)", "test");
  house.kernel.events().channel("knock").emit({"knock"});
  CHECK(house.text.empty());
  CHECK(house.kernel.findClass("FixtureBase") != nullptr);
  house.kernel.plugins().settle();
  CHECK(house.kernel.findClass("FixtureBase") == nullptr);
}
