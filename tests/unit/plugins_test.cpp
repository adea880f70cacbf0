#include <dlfcn.h>
#include <elf.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "spark/error.h"
#include "spark/event.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "temporary_folder.h"
#include "test_support.h"

// Plugins come and go; what is no good is refused with a sentence that names file and reason, and nothing else suffers.

using namespace spark;
using spark::test::House;
using spark::test::isMapped;
namespace fs = std::filesystem;

namespace {
fs::path fixtures(const char* folder) { return test::pluginFolder().parent_path() / "tests" / folder; }
fs::path bad(const std::string& name) { return fixtures("bad-plugins") / (name + ".so"); }
fs::path good(const std::string& name) { return fixtures("fixture-plugins") / (name + ".so"); }

std::string bytesOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Writes into a file that is there, as cp does: whoever has it open sees it change.
void overwrite(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << bytes;
}

/// The bytes of a plugin with another version of the same length.
std::string withVersion(std::string bytes, const std::string& old, const std::string& now) {
  const std::size_t at = bytes.find(old + '\0');
  REQUIRE(at != std::string::npos);
  return bytes.replace(at, now.size(), now);
}

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing was refused";
}
}  // namespace

TEST_CASE("Each bad file of a folder is refused by name and reason, and scanning goes on") {
  House house(false);
  const auto problems = house.kernel.plugins().scan(fixtures("bad-plugins"));
  const std::pair<const char*, const char*> expected[] = {
      {"bad-name", "its name '../escaped' is none"},
      {"missing-dependency", "libspark-gone.so.1: cannot open shared object file"},
      {"missing-symbol", "undefined symbol: _Z30sparkFunctionThatNobodyDefinesv"},
      {"newer-abi", "it was built for the newer plugin ABI"},
      {"no-descriptor", "it has no symbol sparkPlugin"},
      {"no-headers", "it does not say which headers it was built with"},
      {"not-a-library", "it is no shared library"},
      {"older-abi", "it was built for the older plugin ABI"},
      {"other-headers", "this host has another version of api/of_the_future.h, spark/node.h, or none"},
      {"other-sanitizer", "it was built with"},
      {"wrong-magic", "its descriptor lacks the magic word SPARKPLG"},
  };
  REQUIRE(problems.size() == std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    CHECK_THAT(problems[i], Catch::Contains(bad(expected[i].first).string()) && Catch::Contains(expected[i].second));
    CHECK_THAT(house.text, Catch::Contains(problems[i]));
  }
  // Those that fail only when their classes are registered are listed.
  std::vector<std::string> listed;
  for (const auto& p : house.kernel.root().child("plugins")->asNode()->children()) listed.push_back(p->name());
  CHECK(listed ==
        std::vector<std::string>{"duplicate-class", "own-base", "throws-no-exception", "throws-while-registering"});
  for (const auto& [name, reason] : expected) CHECK_FALSE(isMapped(bad(name)));
}

TEST_CASE("One file alone is refused with the same words") {
  House house(false);
  for (const char* name :
       {"bad-name", "missing-dependency", "missing-symbol", "newer-abi", "no-descriptor", "no-headers", "not-a-library",
        "older-abi", "other-headers", "other-sanitizer", "wrong-magic", "duplicate-class", "own-base",
        "throws-no-exception", "throws-while-registering"}) {
    CAPTURE(name);
    CHECK_THAT(refusal([&] { house.kernel.plugins().useFile(bad(name)); }), Catch::Contains(bad(name).string()));
    CHECK(house.kernel.root().child("plugins")->asNode()->children().empty());
    CHECK_FALSE(isMapped(bad(name)));
  }
  CHECK_THAT(refusal([&] { house.kernel.plugins().useFile("/nowhere/x.so"); }),
             Catch::Contains("/nowhere/x.so") && Catch::Contains("No such file"));
}

TEST_CASE("A plugin fits as long as the headers that it includes are the host's, whatever their comments say") {
  House house(false);
  Loader& loader = house.kernel.plugins();
  const auto variant = [](const std::string& name) { return fixtures("abi-plugins") / (name + ".so"); };
  CHECK(loader.useFile(variant("other-comments")).registered());
  CHECK(loader.useFile(variant("other-unused")).registered());
  CHECK_THAT(refusal([&] { loader.useFile(variant("other-layout")); }),
             Catch::Contains(variant("other-layout").string()) &&
                 Catch::Contains("this host has another version of api/drawing.h, or none") &&
                 Catch::Contains("Build it again with this host's headers"));
}

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

TEST_CASE("A file that is cut off, empty or a folder is refused") {
  House house(false);
  const test::TemporaryFolder folder;
  fs::copy_file(good("fixture-base"), folder.path() / "cut.so");
  fs::resize_file(folder.path() / "cut.so", fs::file_size(good("fixture-base")) / 3);
  std::ofstream(folder.path() / "empty.so").flush();
  fs::create_directory(folder.path() / "folder.so");
  std::ofstream(folder.path() / "readme.txt") << "not looked at";
  const auto problems = house.kernel.plugins().scan(folder.path());
  REQUIRE(problems.size() == 3);
  CHECK_THAT(problems[0], Catch::Contains("cut.so") && Catch::Contains("it is cut off"));
  CHECK_THAT(problems[1], Catch::Contains("empty.so") && Catch::Contains("it is no shared library"));
  CHECK_THAT(problems[2], Catch::Contains("folder.so"));
  CHECK_THAT(house.kernel.plugins().scan(folder.path() / "nowhere").at(0),
             Catch::Contains("cannot read plugin folder"));
}

TEST_CASE("A file one of whose segments lies where nothing is loaded is refused") {
  const std::string whole = bytesOf(good("fixture-base"));
  Elf64_Ehdr head;
  REQUIRE(whole.size() > sizeof head);
  std::memcpy(&head, whole.data(), sizeof head);
  const test::TemporaryFolder folder;
  std::size_t moved = 0;
  for (int i = 0; i < head.e_phnum; ++i) {
    const std::size_t at = head.e_phoff + static_cast<std::size_t>(i) * sizeof(Elf64_Phdr);
    Elf64_Phdr p;
    std::memcpy(&p, whole.data() + at, sizeof p);
    if (p.p_type == PT_LOAD || p.p_type == PT_NULL || p.p_type == PT_GNU_STACK) continue;
    p.p_vaddr += 1 << 30;
    std::string bytes = whole;
    std::memcpy(bytes.data() + at, &p, sizeof p);
    overwrite(folder.path() / ("segment" + std::to_string(i) + ".so"), bytes);
    ++moved;
  }
  REQUIRE(moved >= 2);
  House house(false);
  CHECK(house.kernel.plugins().scan(folder.path()).size() == moved);
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

TEST_CASE("A file that is overwritten while its plugin runs harms nobody, and loading again gives the new version") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  House house(false);
  Loader& loader = house.kernel.plugins();
  loader.scan(folder.path());
  loader.use("fixture-base");
  const std::string whole = bytesOf(file);
  overwrite(file, whole.substr(0, whole.size() / 3));  // a copy that is under way
  Leaf& made = house.kernel.create("FixtureBase", "/usr/a");
  house.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  CHECK(getProperty(made, "number") == Value(2.0));
  overwrite(file, withVersion(whole, "1.2", "1.3"));
  house.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  CHECK(getProperty(made, "number") == Value(3.0));
  CHECK(house.kernel.root().require<Plugin>("/plugins/fixture-base").version() == "1.2");
  made.parent()->remove(made);
  loader.unload("fixture-base");
  CHECK_FALSE(isMapped(file));
  const Plugin& again = loader.use("fixture-base");  // without a scan
  CHECK(again.version() == "1.3");
  CHECK(again.file() == file.string());
  CHECK(house.kernel.create("FixtureBase", "/usr/a").classObject()->plugin() == &again);
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

TEST_CASE("A file that is broken when it is to be loaded again is refused, and may be repaired") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  const std::string whole = bytesOf(file);
  House house(false);
  Loader& loader = house.kernel.plugins();
  loader.useFile(file);
  loader.unload("fixture-base");
  overwrite(file, whole.substr(0, 4000));  // of a file with debug information half would do
  CHECK_THAT(refusal([&] { loader.use("fixture-base"); }),
             Catch::Contains(file.string()) && Catch::Contains("it is cut off"));
  fs::remove(file);
  CHECK_THAT(refusal([&] { loader.use("fixture-base"); }), Catch::Contains("there is no plugin 'fixture-base'"));
  overwrite(file, whole);
  CHECK(loader.use("fixture-base").registered());
}

TEST_CASE("Kernels share a file that is the same, and each keeps the version that it loaded") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  const auto codeOf = [](House& house) {
    return reinterpret_cast<const void*>(house.kernel.classOf("FixtureBase").hooks().front()->run);
  };
  House a(false), b(false), c(false);
  a.kernel.plugins().useFile(file);
  b.kernel.plugins().useFile(file);
  CHECK(codeOf(a) == codeOf(b));
  overwrite(file, withVersion(bytesOf(file), "1.2", "1.5"));
  CHECK(c.kernel.plugins().useFile(file).version() == "1.5");
  CHECK(codeOf(a) != codeOf(c));
  CHECK(a.kernel.plugins().useFile(file).version() == "1.2");
  CHECK(b.kernel.plugins().use("fixture-base").version() == "1.2");
}

TEST_CASE("Debuggers find a plugin's code under its file's name") {
  House house(false);
  house.kernel.plugins().useFile(good("fixture-base"));
  Dl_info info = {};
  REQUIRE(dladdr(reinterpret_cast<const void*>(house.kernel.classOf("FixtureBase").hooks().front()->run), &info) != 0);
  CHECK(std::string(info.dli_fname) == good("fixture-base").string());
}

TEST_CASE("Where no private copy can be made the file itself is loaded") {
  House house(false);
  rlimit before = {};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit none{100, before.rlim_max};
  REQUIRE(setrlimit(RLIMIT_FSIZE, &none) == 0);
  Plugin& plugin = house.kernel.plugins().useFile(good("fixture-base"));
  setrlimit(RLIMIT_FSIZE, &before);
  CHECK(plugin.registered());
  CHECK(isMapped(good("fixture-base")));
  house.kernel.plugins().unload("fixture-base");
  CHECK_FALSE(isMapped(good("fixture-base")));
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

TEST_CASE("A library that a plugin finds relative to its own file is found, and goes with it") {
  const test::TemporaryFolder folder;
  fs::copy(fixtures("neighbour-plugins"), folder.path() / "elsewhere", fs::copy_options::recursive);
  House house(false);
  const fs::path file = folder.path() / "elsewhere" / "with-neighbour.so",
                 library = folder.path() / "elsewhere" / "lib" / "libfixture-neighbour.so";
  house.kernel.plugins().useFile(file);
  CHECK(getProperty(house.kernel.create("WithNeighbour", "/usr/a"), "answer") == Value(42));
  CHECK(isMapped(library));
  house.kernel.root().child("usr")->asNode()->removeChildren();
  house.kernel.plugins().unload("with-neighbour");
  CHECK_FALSE(isMapped(file));
  CHECK_FALSE(isMapped(library));
  fs::remove(library);
  CHECK_THAT(refusal([&] { house.kernel.plugins().use("with-neighbour"); }),
             Catch::Contains(file.string()) && Catch::Contains("libfixture-neighbour.so: cannot open"));
}
