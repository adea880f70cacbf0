#include <catch2/catch.hpp>
#include <cmath>

#include "core_classes.h"
#include "spark/error.h"

using namespace spark;
using spark::test::Core;
using spark::test::Thing;

namespace {
std::vector<std::string> namesOf(const std::vector<const Property*>& all) {
  std::vector<std::string> out;
  for (const Property* p : all) out.push_back(p->name);
  return out;
}
Value call(Leaf& leaf, std::string_view method, std::vector<Value> arguments) {
  return callMethod(leaf, method, arguments);
}
}  // namespace

TEST_CASE("A class object knows its base, interfaces, properties and methods") {
  Core core;
  ClassObject& heavy = core.kernel.classOf("HeavyThing");
  CHECK(heavy.path() == "/classes/HeavyThing");
  CHECK(heavy.baseName() == "Thing");
  CHECK(heavy.base() == &core.kernel.classOf("Thing"));
  CHECK(heavy.isA("Leaf"));
  CHECK_FALSE(heavy.isA("Idea"));
  CHECK(core.kernel.classOf("Leaf").base() == nullptr);
  CHECK(namesOf(heavy.properties()) == std::vector<std::string>{"name", "mass", "label", "list", "count", "noise"});
  CHECK(heavy.property("mass")->min == 50.0);
  CHECK(core.kernel.classOf("Thing").property("mass")->min == 0.0);
  CHECK(heavy.method("plus")->name == "add");
  CHECK(heavy.method("getFullPath") != nullptr);
  CHECK(heavy.method("nothing") == nullptr);
  CHECK(heavy.classObject()->name() == "Class");
  CHECK(core.kernel.classOf("Class").classObject() == &core.kernel.classOf("Class"));
  CHECK(getProperty(heavy, "base") == Value("Thing"));
}

TEST_CASE("A class counts its live objects") {
  Core core;
  ClassObject& thing = core.kernel.classOf("Thing");
  CHECK(thing.living() == 1);
  {
    const auto loose = thing.create();
    core.make("x");
    CHECK(thing.living() == 3);
    CHECK(getProperty(thing, "living") == Value(3));
  }
  core.top->removeChildren();
  CHECK(thing.living() == 1);
}

TEST_CASE("An abstract class cannot be instantiated") {
  Core core;
  CHECK(core.kernel.classOf("Idea").isAbstract());
  CHECK_THROWS_WITH(core.kernel.create("Idea", "/usr/i"), Catch::Contains("class Idea is a base for others"));
}

TEST_CASE("A class name cannot be registered twice") {
  Core core;
  CHECK_THROWS_WITH(core.kernel.registerClass<Thing>(), Catch::Contains("class 'Thing' is registered already"));
}

TEST_CASE("Classes are sorted by name") {
  Core core;
  std::string before;
  for (const auto& c : core.kernel.root().child("classes")->asNode()->children()) {
    CHECK(before < c->name());
    before = c->name();
  }
}

TEST_CASE("Properties are read, written and checked") {
  Core core;
  Thing& t = *core.top;
  setProperty(t, "mass", 2.5);
  CHECK(getProperty(t, "mass") == Value(2.5));
  setProperty(t, "mass", "100");
  CHECK(t.mass_ == 100);
  CHECK_THROWS_WITH(setProperty(t, "mass", -1),
                    Catch::Contains("/usr/t.mass") && Catch::Contains("expected 0.0 to 100.0 kg, found -1"));
  CHECK_THROWS_AS(setProperty(t, "mass", 100.5), Error);
  CHECK_THROWS_AS(setProperty(t, "mass", std::nan("")), Error);
  CHECK_THROWS_WITH(setProperty(t, "mass", Value()), Catch::Contains("expected number, found nil"));
  CHECK_THROWS_WITH(setProperty(t, "masss", 1),
                    Catch::Contains("has no property 'masss'") && Catch::Contains("'mass'"));
  CHECK_THROWS_WITH(setProperty(t, "count", 1), Catch::Contains("/usr/t.count is read only"));
  CHECK(t.mass_ == 100);
}

TEST_CASE("A range applies to numbers given as text and to each number of a list") {
  Core core;
  Thing& t = *core.top;
  CHECK_THROWS_AS(setProperty(t, "mass", "-5"), Error);
  CHECK_THROWS_AS(setProperty(t, "mass", "nan"), Error);
  CHECK_THROWS_AS(setProperty(t, "mass", "heavy"), Error);
  CHECK_THROWS_AS(setProperty(t, "list", List{0.5, 2}), Error);
  CHECK_THROWS_AS(setProperty(t, "list", List{0.5, "2"}), Error);
  setProperty(t, "list", List{0.5, "-1"});
  CHECK(t.list_ == std::vector<double>{0.5, -1});
  std::string why;
  const std::vector<Value> low{"-5kg"};
  CHECK_FALSE(callLoosely(t, *t.classObject()->method("setMass"), low, why));
  CHECK_THAT(why, Catch::Contains("expected 0.0 to 100.0 kg"));
  CHECK(t.mass_ == 1);
}

TEST_CASE("A property with choices accepts no other text") {
  Core core;
  setProperty(*core.top, "label", "green");
  CHECK_THROWS_WITH(setProperty(*core.top, "label", "blue"),
                    Catch::Contains("expected one of 'red', 'green', found \"blue\""));
  CHECK(core.top->label_ == "green");
}

TEST_CASE("A derived class can narrow a property of its base") {
  Core core;
  Leaf& heavy = core.top->create("HeavyThing");
  CHECK_THROWS_AS(setProperty(heavy, "mass", 10), Error);
  CHECK_THROWS_AS(call(heavy, "setMass", {10}), Error);
  setProperty(heavy, "mass", 200);
  CHECK(core.kernel.classOf("HeavyThing").defaultOf(*heavy.classObject()->property("mass")) == Value(60.0));
  CHECK(core.kernel.classOf("Idea").defaultOf(*core.kernel.classOf("Idea").property("name")).isNil());
}

TEST_CASE("Every property has a getter, and a setter unless it is read only") {
  Core core;
  CHECK(call(*core.top, "setMass", {7}).isNil());
  CHECK(call(*core.top, "getMass", {}) == Value(7.0));
  CHECK(core.top->classObject()->method("setCount") == nullptr);
  CHECK(core.top->classObject()->method("getCount") != nullptr);
  call(*core.top, "setList", {1, 0, -1});
  CHECK(core.top->list_ == std::vector<double>{1, 0, -1});
  call(*core.top, "setName", {"renamed"});
  CHECK(core.top->path() == "/usr/renamed");
}

TEST_CASE("A call checks the number and the types of its arguments") {
  Core core;
  Thing& t = *core.top;
  CHECK(call(t, "add", {1, 2.5}) == Value(3.5));
  CHECK(call(t, "plus", {1, 2}) == Value(3.0));
  CHECK(call(t, "opt", {1}) == Value(1.0));
  CHECK(call(t, "join", {"a", "b", 3}) == Value("ab3"));
  CHECK(call(t, "join", {}) == Value(""));
  CHECK(call(t, "join", {Value::typed("007"), Value::typed("1e3")}) == Value("0071e3"));
  CHECK(call(t, "join", {Value::typed("{007, 'a b'}")}) == Value("007a b"));
  CHECK(call(t, "add", {Value::typed("007"), Value::typed("1e3")}) == Value(1007.0));
  CHECK(call(t, "setList", {Value::typed("0.5"), Value::typed("1")}) == Value());
  CHECK(call(t, "setList", {Value::typed("{0.5, 1}")}) == Value());
  CHECK_THROWS_WITH(call(t, "add", {1}), Catch::Contains("add(a: number, b: number) expected 2 arguments, found 1"));
  CHECK_THROWS_WITH(call(t, "add", {1, 2, 3}), Catch::Contains("expected 2 arguments, found 3"));
  CHECK_THROWS_WITH(call(t, "opt", {1, 2, 3}), Catch::Contains("expected 1 to 2 arguments"));
  CHECK_THROWS_WITH(call(t, "add", {1, "x"}),
                    Catch::Contains("cannot call add of /usr/t") && Catch::Contains("expected number"));
  CHECK_THROWS_WITH(call(t, "ad", {1, 2}), Catch::Contains("has no method 'ad'") && Catch::Contains("'add'"));
  CHECK_THROWS_WITH(call(t, "fail", {}),
                    Catch::Contains("cannot call fail of /usr/t") && Catch::Contains("because: it fails"));
  CHECK(t.count_ == 3);
}

TEST_CASE("A loose call tolerates what the installed base tolerated, and reports why it fails otherwise") {
  Core core;
  Thing& t = *core.top;
  std::string why;
  const auto loosely = [&](const char* name, std::vector<Value> arguments) {
    return callLoosely(t, *t.classObject()->method(name), arguments, why);
  };
  CHECK(loosely("add", {"1", "x"}));
  CHECK(why.empty());
  CHECK_FALSE(loosely("add", {1}));
  CHECK_THAT(why, Catch::Contains("expected 2 arguments, found 1"));
  CHECK_FALSE(loosely("add", {1, 2, 3}));
  CHECK(loosely("opt", {1, 2, 3}));
  CHECK_FALSE(loosely("fail", {}));
  CHECK_THAT(why, Catch::Contains("it fails"));
  CHECK(loosely("setMass", {"12abc"}));
  CHECK(t.mass_ == 12);
}

TEST_CASE("Nodes have the installed base's methods for names and for the tree") {
  Core core;
  Thing& a = core.make("a");
  core.make(a, "b");
  CHECK(call(a, "getName", {}) == Value("a"));
  CHECK(call(a, "getFullPath", {}) == Value("/usr/t/a"));
  CHECK(call(a, "isLeaf", {}) == Value(false));
  call(a, "unlinkChildren", {});
  CHECK(a.children().empty());
  call(a, "unlinkLeaf", {});
  CHECK(core.top->children().empty());
  CHECK_THROWS_AS(call(core.kernel.classOf("Thing"), "unlinkLeaf", {}), Error);
}

TEST_CASE("Errors have a chain of causes, and hints suggest similar names") {
  CHECK(std::string(Error("outer", Error("inner")).what()) == "outer\n  because: inner");
  CHECK(didYouMean("mas", {"mass", "map", "zebra"}) == " Did you mean 'map' or 'mass'?");
  CHECK(didYouMean("MASS", {"mass"}) == " Did you mean 'mass'?");
  CHECK(didYouMean("xyzzy", {"mass"}).empty());
  CHECK(didYouMean("aa", {"ab", "ac", "ad", "ae"}) == " Did you mean 'ab', 'ac' or 'ad'?");
  CHECK(didYouMean(std::string(100000, 'x'), {"mass"}).empty());
}
