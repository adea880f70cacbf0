#include <catch2/catch.hpp>

#include "core_classes.h"
#include "spark/error.h"

using namespace spark;
using spark::test::Core;
using spark::test::ICounter;
using spark::test::Thing;

TEST_CASE("Paths lead to nodes, absolute and relative") {
  Core core;
  Thing& a = core.make("a");
  Thing& b = core.make(a, "b");
  CHECK(b.path() == "/usr/t/a/b");
  CHECK(core.kernel.root().path() == "/");
  CHECK(b.find("/usr/t/a") == &a);
  CHECK(b.find("..") == &a);
  CHECK(b.find("../../a/./b/") == &b);
  CHECK(b.find("") == &b);
  CHECK(b.find(".") == &b);
  CHECK(b.find("/") == &core.kernel.root());
  CHECK(b.find("//usr//t") == core.top);
  CHECK(b.find("\\usr\\t") == core.top);
  CHECK(b.find("/..") == nullptr);
  CHECK(b.find("../c") == nullptr);
  CHECK(b.find("x/y/z") == nullptr);
}

TEST_CASE("A leaf has nothing below it") {
  Core core;
  Leaf& leaf = core.top->create("Leaf", "l");
  CHECK(leaf.asNode() == nullptr);
  CHECK(leaf.find("x") == nullptr);
  CHECK(leaf.find("..") == core.top);
}

TEST_CASE("Siblings of the same name are numbered") {
  Core core;
  Thing &a = core.make("x"), &b = core.make("x"), &c = core.make("x");
  CHECK(a.path() == "/usr/t/x");
  CHECK(b.path() == "/usr/t/x[2]");
  CHECK(c.path() == "/usr/t/x[3]");
  for (Thing* t : {&a, &b, &c}) CHECK(core.kernel.root().find(t->path()) == t);
  CHECK(core.top->child("x[1]") == &a);
  CHECK(core.top->child("x[4]") == nullptr);
  CHECK(core.top->child("x[0]") == nullptr);
  CHECK(core.top->child("x[-1]") == nullptr);
  CHECK(core.top->child("x[]") == nullptr);
  CHECK(core.top->child("x[99999999999999999999]") == nullptr);
  Thing& literal = core.make("odd]");
  CHECK(core.top->child("odd]") == &literal);
}

TEST_CASE("Names that cannot be part of a path are refused") {
  Core core;
  Thing& a = core.make("a");
  for (const char* bad : {"x/y", "x\\y", ".", "..", ""}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(a.setName(bad), Error);
  }
  CHECK(a.name() == "a");
  CHECK_THROWS_AS(core.kernel.create("Thing", "/usr/../x"), Error);
  const std::uint64_t before = core.kernel.structureVersion();
  a.setName("b");
  CHECK(core.top->child("b") == &a);
  CHECK(core.kernel.structureVersion() > before);
}

TEST_CASE("An absolute path starts at the kernel's root also for a node outside the tree") {
  Core core;
  const auto loose = core.kernel.classOf("Thing").create();
  CHECK(loose->find("/usr/t") == core.top);
  CHECK_FALSE(loose->isLinked());
  CHECK(loose->path() == "Thing");
}

TEST_CASE("The error for a path that does not exist says where it ends and suggests similar names") {
  Core core;
  core.make("wheel");
  CHECK_THROWS_WITH(core.top->require<Thing>("/usr/t/wheal"), Catch::Contains("expected a Thing at '/usr/t/wheal'") &&
                                                                  Catch::Contains("no 'wheal' in /usr/t") &&
                                                                  Catch::Contains("'wheel'"));
  core.top->create("Leaf", "plain");
  CHECK_THROWS_WITH(core.top->require<Thing>("plain"),
                    Catch::Contains("found a Leaf") && Catch::Contains("lacks interface Thing version 1"));
  CHECK(&core.top->require<ICounter>("wheel").leaf() == core.top->child("wheel"));
}

TEST_CASE("A node has the interfaces of its class and of the bases") {
  Core core;
  Leaf& heavy = core.top->create("HeavyThing", "h");
  CHECK(heavy.as<Thing>() != nullptr);
  CHECK(heavy.as<Node>() != nullptr);
  CHECK(heavy.as<Leaf>() == &heavy);
  REQUIRE(heavy.as<ICounter>() != nullptr);
  CHECK(&heavy.as<ICounter>()->leaf() == &heavy);
  CHECK(core.top->create("Node").as<ICounter>() == nullptr);
  CHECK(core.top->as<ClassObject>() == nullptr);
}

TEST_CASE("create makes missing parents and refuses existing paths and unknown classes") {
  Core core;
  Leaf& deep = core.kernel.create("Thing", "/usr/x/y/z");
  CHECK(deep.path() == "/usr/x/y/z");
  CHECK(deep.parent()->classObject()->name() == "Node");
  CHECK_THROWS_WITH(core.kernel.create("Thing", "/usr/x/y/z"), Catch::Contains("exists already, as Thing"));
  CHECK_THROWS_WITH(core.kernel.create("Thing", "relative"), Catch::Contains("absolute path"));
  CHECK_THROWS_WITH(core.kernel.create("Thing", "/usr/"), Catch::Contains("expected a name"));
  CHECK_THROWS_WITH(core.kernel.create("Thang", "/usr/q"), Catch::Contains("'Thing'"));
  core.kernel.create("Leaf", "/usr/leaf");
  CHECK_THROWS_WITH(core.kernel.create("Thing", "/usr/leaf/x"), Catch::Contains("/usr/leaf cannot have children"));
  CHECK(core.top->create("Thing").name() == "Thing");
  CHECK(core.top->create("somewhere/Thing", "p").classObject()->name() == "Thing");
}

TEST_CASE("A node can only be added if a class of this kernel made it") {
  Core core, other;
  CHECK_THROWS_AS(core.top->add(nullptr), Error);
  CHECK_THROWS_WITH(core.top->add(std::make_unique<Thing>()), Catch::Contains("without a class"));
  CHECK_THROWS_WITH(core.top->add(other.kernel.classOf("Thing").create()), Catch::Contains("another kernel"));
}

TEST_CASE("Parents are linked before children, and unlinked after them") {
  Core core;
  std::string order;
  auto tree = core.kernel.classOf("Thing").create();
  const auto watch = [&](Thing& t, char c) {
    t.atLink = [&order, c](Thing&) { order += c; };
    t.atUnlink = [&order, c](Thing&) { order += static_cast<char>(c - 32); };
  };
  Thing& a = *tree->as<Thing>();
  watch(a, 'a');
  watch(core.make(a, "b"), 'b');
  watch(core.make(a, "c"), 'c');
  CHECK(order.empty());
  core.top->add(std::move(tree));
  CHECK(order == "abc");
  core.top->remove(a);
  CHECK(order == "abcBCA");
}

TEST_CASE("If linking fails, the linked nodes are unlinked and the tree is as before") {
  Core core;
  std::string order;
  auto tree = core.kernel.classOf("Thing").create();
  Thing& a = *tree->as<Thing>();
  a.atLink = [&](Thing& t) {
    order += "a";
    core.make(t, "own");
  };
  a.atUnlink = [&](Thing&) { order += "A"; };
  Thing& b = core.make(a, "b");
  b.atUnlink = [&](Thing&) { order += "B"; };
  Thing& c = core.make(a, "c");
  c.atLink = [&](Thing&) { throw Error("c cannot be linked"); };
  c.atUnlink = [&](Thing&) { order += "C"; };
  const Ref<Leaf> ref(&a);
  CHECK_THROWS_WITH(core.top->add(std::move(tree)), "c cannot be linked");
  CHECK(order == "aBA");
  CHECK_FALSE(ref);
  CHECK(core.top->children().empty());
  CHECK(core.kernel.classOf("Thing").living() == 1);
}

TEST_CASE("While a node is being linked, it may add and remove other nodes but not itself or its parents") {
  Core core;
  Thing& victim = core.make("victim");
  auto made = core.kernel.classOf("Thing").create();
  Thing& t = *made->as<Thing>();
  core.make(t, "first");
  core.make(t, "second");
  std::string linked;
  t.child("first")->as<Thing>()->atLink = [&](Thing& self) {
    core.top->remove(victim);
    self.parent()->create("Thing", "third").as<Thing>()->atLink = nullptr;
    linked += "1";
  };
  t.child("second")->as<Thing>()->atLink = [&](Thing&) { linked += "2"; };
  core.top->add(std::move(made));
  CHECK(linked == "12");
  CHECK(core.top->child("victim") == nullptr);
  CHECK(t.child("third")->isLinked());

  auto removesItself = core.kernel.classOf("Thing").create();
  removesItself->as<Thing>()->atLink = [](Thing& self) { self.parent()->remove(self); };
  CHECK_THROWS_WITH(core.top->add(std::move(removesItself)), Catch::Contains("just being linked"));

  Thing& outer = core.make("outer");
  auto removesParent = core.kernel.classOf("Thing").create();
  removesParent->as<Thing>()->atLink = [&](Thing&) { core.top->remove(outer); };
  CHECK_THROWS_WITH(core.make(outer, "inner").add(std::move(removesParent)),
                    Catch::Contains("cannot remove /usr/t/outer now: /usr/t/outer/inner/Thing is just being linked"));
  CHECK(core.top->child("outer") == &outer);
}

TEST_CASE("If onUnlink throws, the error is logged and the node is removed") {
  Core core;
  core.make("x").atUnlink = [](Thing& self) { self.parent()->remove(self); };
  core.top->remove(*core.top->child("x"));
  CHECK(core.top->children().empty());
  CHECK_THAT(core.text, Catch::Contains("/usr/t/x (class Thing) failed to leave the tree"));
}

TEST_CASE("Children that onUnlink makes are removed too") {
  Core core;
  Thing& x = core.make("x");
  std::string order;
  x.atUnlink = [&](Thing& self) {
    order += "x";
    Thing& late = core.make(self, "late");
    CHECK(late.isLinked());
    late.atUnlink = [&](Thing&) { order += "l"; };
    late.atEnd = [&](Thing& t) { order += t.isLinked() ? "?" : "L"; };
  };
  core.top->remove(x);
  CHECK(order == "xlL");
  CHECK(core.kernel.classOf("Thing").living() == 1);
}

TEST_CASE("Removing a node destroys its children first, from first to last") {
  Core core;
  std::string order;
  Thing& a = core.make("a");
  const auto note = [&order](Thing& t) { order += t.name(); };
  for (const auto& [name, below] : {std::pair{"b", "d"}, std::pair{"c", "e"}}) {
    Thing& child = core.make(a, name);
    child.atEnd = note;
    core.make(child, below).atEnd = note;
  }
  a.atEnd = note;
  core.top->remove(a);
  CHECK(order == "dbeca");
  CHECK_THROWS_AS(core.top->remove(*core.top), Error);
}

TEST_CASE("References are empty before the first destructor runs") {
  Core core;
  Thing &a = core.make("a"), &b = core.make(a, "b");
  Thing& c = core.make(core.make(a, "branch"), "c");
  const Ref<Thing> toA(&a), toC(&c);
  const Ref<ICounter> toB(&b);
  Ref<Thing> copy = toA;
  REQUIRE(copy.get() == &a);
  CHECK(toB->count() == 0);
  bool seen = true;
  b.atEnd = [&](Thing&) { seen = toA || toB || toC; };  // b is destroyed first
  core.top->remove(a);
  CHECK_FALSE(seen);
  CHECK_FALSE(copy);
  CHECK_FALSE(toC);
  CHECK(toB.get() == nullptr);
  Ref<Thing> empty;
  copy = empty;
  CHECK_FALSE(copy);
}

TEST_CASE("A reference may outlive the kernel and is then empty") {
  Ref<Thing> ref;
  {
    Core core;
    ref = Ref<Thing>(core.top);
    CHECK(ref);
  }
  CHECK_FALSE(ref);
}

TEST_CASE("Reparenting keeps the object, calls onMoved of the moved nodes, and appends the node to the new parent") {
  Core core;
  Thing &a = core.make("a"), &b = core.make("b"), &c = core.make(a, "c"), &d = core.make(c, "d");
  core.make(b, "first");
  const Ref<Thing> ref(&c);
  std::string order;
  c.atMove = [&](Thing&) { order += "c"; };
  d.atMove = [&](Thing&) { order += "d"; };
  c.atUnlink = [&](Thing&) { order += "!"; };
  a.reparent(c, b);
  CHECK(order == "cd");
  CHECK(ref);
  CHECK(d.path() == "/usr/t/b/c/d");
  CHECK(b.children().back().get() == &c);
  CHECK(a.children().empty());
  CHECK_THROWS_WITH(b.reparent(c, d), Catch::Contains("below itself"));
  CHECK_THROWS_AS(a.reparent(c, *core.top), Error);
}

TEST_CASE("A move that fails is undone") {
  Core core;
  Thing &a = core.make("a"), &b = core.make("b"), &c = core.make(a, "c");
  c.atMove = [&](Thing& t) {
    if (t.parent() == &b) throw Error("not there");
  };
  CHECK_THROWS_WITH(a.reparent(c, b), "not there");
  CHECK(c.path() == "/usr/t/a/c");
  CHECK(b.children().empty());
}

TEST_CASE("A node that moves out of the kernel's tree is unlinked, and linked when it moves back") {
  Core core;
  auto loose = core.kernel.classOf("Node").create();
  Thing& c = core.make("c");
  int links = 0, unlinks = 0;
  c.atLink = [&](Thing&) { ++links; };
  c.atUnlink = [&](Thing&) { ++unlinks; };
  core.top->reparent(c, *loose->asNode());
  CHECK_FALSE(c.isLinked());
  CHECK(unlinks == 1);
  loose->asNode()->reparent(c, *core.top);
  CHECK(c.isLinked());
  CHECK(links == 1);
}

TEST_CASE("The kernel's own nodes cannot be removed, moved, renamed or given other children") {
  Core core;
  Node& root = core.kernel.root();
  Leaf &classes = *root.child("classes"), &plugins = *root.child("plugins"), &thing = core.kernel.classOf("Thing");
  CHECK_THROWS_AS(root.remove(classes), Error);
  CHECK_THROWS_AS(root.remove(plugins), Error);
  CHECK_THROWS_AS(root.removeChildren(), Error);
  CHECK_THROWS_AS(root.reparent(classes, *core.top), Error);
  CHECK_THROWS_WITH(classes.asNode()->remove(thing), Catch::Contains("/classes/Thing"));
  CHECK_THROWS_AS(classes.asNode()->removeChildren(), Error);
  CHECK_THROWS_AS(classes.asNode()->reparent(thing, *core.top), Error);
  CHECK_THROWS_AS(thing.setName("Other"), Error);
  CHECK_THROWS_AS(root.setName("x"), Error);
  CHECK_THROWS_AS(core.kernel.create("Thing", "/classes/x"), Error);
  CHECK_THROWS_AS(core.kernel.create("Node", "/plugins/x"), Error);
  CHECK_THROWS_AS(core.top->reparent(core.make("m"), *classes.asNode()), Error);
  CHECK(core.top->child("m") != nullptr);
  CHECK(core.top->isLinked());
}

TEST_CASE("Descendants of a type are collected depth first") {
  Core core;
  Thing &a = core.make("a"), &b = core.make(a, "b"), &c = core.make("c");
  core.top->create("Node", "n");
  std::vector<Thing*> all, shallow;
  core.top->collect(all);
  CHECK(all == std::vector<Thing*>{&a, &b, &c});
  core.top->collect(shallow, false);
  CHECK(shallow == std::vector<Thing*>{&a, &c});
  CHECK(core.top->childOf<Thing>() == &a);
  CHECK(b.ancestor<Thing>() == &a);
  CHECK(core.top->ancestor<Thing>() == nullptr);
}

TEST_CASE("collect gives the same nodes whether the tree order is up to date or not") {
  Core core;
  Thing &a = core.make("a"), &b = core.make(a, "b"), &c = core.make(b, "c"), &d = core.make("d");
  const auto collected = [](const Node& from, bool deep) {
    std::vector<Thing*> out;
    from.collect(out, deep);
    return out;
  };
  const auto check = [&](const std::vector<Thing*>& all, const std::vector<Thing*>& shallow,
                         const std::vector<Thing*>& belowA) {
    CHECK(collected(*core.top, true) == all);
    CHECK(collected(*core.top, false) == shallow);
    CHECK(collected(a, true) == belowA);
    std::vector<Leaf*> leaves;
    core.top->collect(leaves);
    CHECK(leaves == std::vector<Leaf*>(all.begin(), all.end()));
    std::vector<Node*> nodes;
    core.top->collect(nodes, false);
    CHECK(nodes == std::vector<Node*>(shallow.begin(), shallow.end()));
  };
  check({&a, &b, &c, &d}, {&a, &d}, {&b, &c});
  core.kernel.updateOrder();
  check({&a, &b, &c, &d}, {&a, &d}, {&b, &c});
  Thing& e = core.make(a, "e");
  check({&a, &b, &c, &e, &d}, {&a, &d}, {&b, &c, &e});
  core.kernel.updateOrder();
  check({&a, &b, &c, &e, &d}, {&a, &d}, {&b, &c, &e});
  a.reparent(b, d);
  check({&a, &e, &d, &b, &c}, {&a, &d}, {&e});
  core.kernel.updateOrder();
  check({&a, &e, &d, &b, &c}, {&a, &d}, {&e});
  a.remove(e);
  check({&a, &d, &b, &c}, {&a, &d}, {});
  core.kernel.updateOrder();
  check({&a, &d, &b, &c}, {&a, &d}, {});
}

TEST_CASE("Nodes outside the kernel's tree are collected too") {
  Core core;
  core.kernel.updateOrder();
  auto made = core.kernel.classOf("Thing").create();
  Node& loose = *made->asNode();
  Leaf& inner = loose.create("Thing", "inner");
  std::vector<Thing*> all;
  loose.collect(all);
  CHECK(all == std::vector<Thing*>{inner.as<Thing>()});
}

TEST_CASE("A node knows when the tree below it last changed") {
  Core core;
  Thing &a = core.make("a"), &b = core.make("b");
  const auto changes = [&](const Node& node, const auto& act) {
    const std::uint64_t before = node.changedAt();
    act();
    return node.changedAt() > before;
  };
  CHECK(changes(a, [&] { core.make(a, "x"); }));
  CHECK(changes(*core.top, [&] { core.make(a, "y"); }));
  CHECK(core.top->changedAt() == core.kernel.structureVersion());
  CHECK_FALSE(changes(b, [&] { core.make(a, "z"); }));
  CHECK(changes(a, [&] { a.child("z")->setName("renamed"); }));
  CHECK_FALSE(changes(a, [&] { a.setName("other"); }));
  CHECK(changes(*core.top, [&] { a.setName("again"); }));
  CHECK(changes(a, [&] { a.remove(*a.child("y")); }));
  CHECK(changes(b, [&] { a.reparent(*a.child("x"), b); }));
  CHECK(changes(a, [&] { b.reparent(*b.child("x"), a); }));
  CHECK(changes(b, [&] { a.reparent(*a.child("x"), b); }));
  CHECK(changes(a, [&] { a.reparent(*a.child("renamed"), b); }));
}

TEST_CASE("Ids are not reused, and kernels have separate trees") {
  Core core, other;
  Thing& a = core.make("a");
  const std::uint64_t id = a.id();
  core.top->remove(a);
  CHECK(core.make("b").id() > id);
  CHECK(other.kernel.root().find("/usr/t/b") == nullptr);
}

TEST_CASE("A node in use and the nodes above it cannot be removed, moved or renamed") {
  Core core;
  Thing &a = core.make("a"), &b = core.make(a, "b"), &c = core.make(b, "c"), &other = core.make("other");
  {
    const InUse use(b, "it holds the roof");
    CHECK_THROWS_WITH(a.remove(b), Catch::Equals("cannot remove /usr/t/a/b now: it is in use: it holds the roof"));
    CHECK_THROWS_WITH(core.top->remove(a),
                      Catch::Equals("cannot remove /usr/t/a now: /usr/t/a/b is in use: it holds the roof"));
    CHECK_THROWS_WITH(core.top->removeChildren(), Catch::Contains("/usr/t/a/b is in use"));
    CHECK(core.top->children().size() == 2);
    CHECK_THROWS_WITH(core.top->reparent(a, other), Catch::Contains("cannot move /usr/t/a now"));
    CHECK_THROWS_WITH(a.setName("x"),
                      Catch::Equals("cannot name /usr/t/a 'x' now: /usr/t/a/b is in use: it holds the roof"));
    CHECK_THROWS_WITH(callMethod(a, "unlinkLeaf", {}), Catch::Contains("it holds the roof"));
    CHECK_NOTHROW(a.setName("a"));
    c.setName("d");
    b.remove(c);
    core.top->remove(other);
  }
  a.setName("x");
  core.top->remove(a);
  CHECK(core.top->children().empty());
}

TEST_CASE("A use with a depth also protects the names of nodes below, down to that depth") {
  Core core;
  Thing &a = core.make("a"), &b = core.make(a, "b"), &c = core.make(b, "c");
  const InUse use(a, "paths lead there", 1);
  CHECK_THROWS_WITH(b.setName("x"),
                    Catch::Equals("cannot name /usr/t/a/b 'x' now: /usr/t/a is in use: paths lead there"));
  c.setName("x");
  a.remove(b);
}

TEST_CASE("Several uses of a node may end in any order") {
  Core core;
  auto kernel = std::make_unique<spark::test::TestHost>(false);
  Leaf& leaf = kernel->kernel.create("Node", "/usr/a");
  auto first = std::make_unique<InUse>(leaf, "one"), second = std::make_unique<InUse>(leaf, "two"),
       third = std::make_unique<InUse>(leaf, "three");
  second.reset();
  CHECK_THROWS_WITH(leaf.setName("b"), Catch::Contains("three"));
  third.reset();
  CHECK_THROWS_WITH(leaf.setName("b"), Catch::Contains("one"));
  first.reset();
  CHECK_NOTHROW(leaf.setName("b"));
}

TEST_CASE("Names are resolved correctly among hundreds of children") {
  Core core;
  std::vector<Thing*> all;
  for (int i = 0; i < 300; ++i) all.push_back(&core.make(i % 3 == 0 ? "same" : "n" + std::to_string(i)));
  const auto agree = [&] {
    for (std::size_t i = 0; i < all.size(); ++i) {
      CAPTURE(i, all[i]->path());
      REQUIRE(core.kernel.root().find(all[i]->path()) == all[i]);
    }
    CHECK(core.top->child("same[99999]") == nullptr);
    CHECK(core.top->child("none") == nullptr);
  };
  agree();
  CHECK(all[297]->path() == "/usr/t/same[100]");
  core.top->remove(*all[0]);
  all.erase(all.begin());
  agree();
  CHECK(all[296]->path() == "/usr/t/same[99]");
  all[10]->setName("same");
  agree();
  core.make("late");
  all[20]->setName("other");
  CHECK(core.top->child("n21") == nullptr);
  agree();
  Thing& elsewhere = core.make("elsewhere");
  core.top->reparent(*all[5], elsewhere);
  all.erase(all.begin() + 5);
  core.make("later");
  agree();
  core.top->removeChildren();
  CHECK(core.top->child("same") == nullptr);
}

TEST_CASE("The depth of the tree is limited") {
  Core core;
  Node* at = core.top;
  const auto deeper = [&] { at = at->create("Node", "n").asNode(); };
  CHECK_THROWS_WITH(
      [&] {
        for (;;) deeper();
      }(),
      Catch::Equals("cannot add a Node here: the tree is at most 1000 levels deep"));
  CHECK(at->children().empty());
  int levels = 0;
  for (Node* up = at; up; up = up->parent()) ++levels;
  CHECK(levels == Node::kMostLevels + 1);
}
