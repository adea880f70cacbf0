#include "spark/link.h"

#include <catch2/catch.hpp>
#include <thread>

#include "core_classes.h"
#include "spark/describe.h"
#include "spark/error.h"

// A node declares once which nodes it works with. The kernel finds them, and again after each change of the tree.

using namespace spark;
using spark::test::Core;
using spark::test::ICounter;
using spark::test::Thing;

namespace {
bool isHeavy(const Thing& t) { return t.name() == "heavy"; }

/// Has a link of each kind.
class Linked : public Node {
  SPARK_CLASS(Linked, Node)
 public:
  static void describe(Description<Linked>& d) {
    d.link(&Linked::above, Above<Thing>()).required("It hangs in the air.");
    d.link(&Linked::below, Below<Thing>());
    d.link(&Linked::child, Child<Thing>());
    d.link(&Linked::beside, Beside<Thing>());
    d.link(&Linked::heavy, Above<Thing>().where<isHeavy>("heavy Thing"));
    d.link(&Linked::counter, Above<Thing>().child<ICounter>());
    d.link(&Linked::at, At<Thing>("/usr/t/at"));
    d.link(&Linked::named, At<Thing>(&Linked::path));
    d.link(&Linked::all, Below<Thing>());
    d.link(&Linked::children, Child<ICounter>());
    d.link(&Linked::heavyBelow, Below<Thing>().where<isHeavy>("heavy Thing"));
    d.link(&Linked::allHeavy, Below<Thing>().where<isHeavy>("heavy Thing"));
    d.property("path", &Linked::getPath, &Linked::setPath);
  }
  const std::string& getPath() const { return path; }
  void setPath(std::string to) {
    path = std::move(to);
    named.lookAgain();
  }
  Link<Thing> above, below, child, beside, heavy, at, named, heavyBelow;
  Link<ICounter> counter;
  Links<Thing> all, allHeavy;
  Links<ICounter> children;
  std::string path;
  const Thing* atUnlink = nullptr;
  bool* onlyParentAtUnlink = nullptr;

 private:
  void onUnlink() override {
    if (onlyParentAtUnlink) *onlyParentAtUnlink = !child && above;
  }
};

class MoreLinked : public Linked {
  SPARK_CLASS(MoreLinked, Linked)
 public:
  static void describe(Description<MoreLinked>& d) { d.link(&MoreLinked::root, At<Node>("/")); }
  Link<Node> root;
};

struct Forest : Core {
  Forest() {
    kernel.log().setSink([this](Level, std::string_view line) { text.append(line).append("\n"); });
    kernel.registerClass<Linked>();
    kernel.registerClass<MoreLinked>();
  }
  ~Forest() { kernel.log().setSink({}); }
  Linked& linked(Node& parent) { return static_cast<Linked&>(parent.create("Linked", "linked")); }
  std::string text;
};
}  // namespace

TEST_CASE("A link finds a node above, below or beside its owner, or at a path") {
  Forest t;
  Thing& heavy = t.make("heavy");
  Thing& outer = t.make(heavy, "outer");
  Thing& before = t.make(outer, "before");
  Linked& l = t.linked(outer);
  CHECK(l.above.get() == &outer);
  CHECK(l.heavy.get() == &heavy);
  CHECK(l.beside.get() == &before);
  CHECK_FALSE(l.below);
  CHECK_FALSE(l.child);
  Node& plain = static_cast<Node&>(l.create("Node", "plain"));
  Thing& deep = t.make(plain, "deep");
  CHECK(l.below.get() == &deep);
  CHECK_FALSE(l.child);
  Thing& near = t.make(l, "near");
  CHECK(l.below.get() == &deep);
  CHECK(l.child.get() == &near);
  CHECK(l.child.leaf() == &near);
  CHECK_FALSE(l.at);
  Thing& at = t.make("at");
  CHECK(l.at.get() == &at);
  CHECK(l.counter.get() == before.as<ICounter>());
  CHECK(l.counter.leaf() == &before);
}

TEST_CASE("A link whose target is removed finds the next target, and is empty if there is none") {
  Forest t;
  Thing& outer = t.make("outer");
  Linked& l = t.linked(outer);
  Thing& a = t.make(l, "a");
  Thing& b = t.make(l, "b");
  CHECK(l.child.get() == &a);
  l.remove(a);
  CHECK(l.child.get() == &b);
  l.remove(b);
  CHECK_FALSE(l.child);
  CHECK(l.above.get() == &outer);
}

TEST_CASE("A node that is being removed has no links to its removed children, but still those to nodes above") {
  Forest t;
  Thing& outer = t.make("outer");
  Linked& l = t.linked(outer);
  t.make(l, "a");
  bool onlyParent = false;
  l.onlyParentAtUnlink = &onlyParent;
  t.top->remove(outer);
  CHECK(onlyParent);
}

TEST_CASE("A link finds its new target when its owner moves or a node is renamed") {
  Forest t;
  Thing &one = t.make("one"), &two = t.make("two");
  Linked& l = t.linked(one);
  CHECK(l.above.get() == &one);
  one.reparent(l, two);
  CHECK(l.above.get() == &two);
  CHECK_FALSE(l.at);
  two.setName("at");
  CHECK(l.at.get() == &two);
}

TEST_CASE("A link along the path in a property follows changes of the property") {
  Forest t;
  Linked& l = t.linked(t.make("outer"));
  CHECK_FALSE(l.named);
  setProperty(l, "path", "..");
  CHECK(l.named.get() == l.above.get());
  setProperty(l, "path", "/usr");
  CHECK_FALSE(l.named);  // no Thing
}

TEST_CASE("A list of links holds all targets in tree order") {
  Forest t;
  Linked& l = t.linked(t.make("outer"));
  CHECK(l.all.empty());
  Thing& a = t.make(l, "a");
  Thing& inner = t.make(a, "inner");
  Thing& b = t.make(l, "b");
  std::vector<Thing*> found;
  for (const Found<Thing>& f : l.all) found.push_back(f.object);
  CHECK(found == std::vector<Thing*>{&a, &inner, &b});
  REQUIRE(l.children.size() == 2);
  CHECK(l.children.all()[1].leaf == &b);
  l.remove(a);
  CHECK(l.all.size() == 1);
}

TEST_CASE("A link with a condition passes over what does not fulfil it, also below and in lists") {
  Forest t;
  Linked& l = t.linked(t.make("outer"));
  Thing& light = t.make(l, "light");
  CHECK_FALSE(l.heavyBelow);
  CHECK(l.allHeavy.empty());
  Thing& one = t.make(light, "heavy");
  Thing& other = t.make(t.make(l, "later"), "heavy");
  CHECK(l.heavyBelow.get() == &one);
  REQUIRE(l.allHeavy.size() == 2);
  CHECK(l.allHeavy.all()[0].object == &one);
  CHECK(l.allHeavy.all()[1].object == &other);
  CHECK(l.all.size() == 4);
}

TEST_CASE("The ends of a list of links belong together, whichever is taken first after a change") {
  Forest t;
  Linked& l = t.linked(t.make("outer"));
  Thing &one = t.make(l, "one"), &two = t.make(l, "two"), &three = t.make(l, "three");
  CHECK(l.all.size() == 3);
  l.remove(one);
  l.remove(three);
  const auto end = l.all.end(), begin = l.all.begin();  // end() first, as compilers may evaluate arguments
  REQUIRE(end - begin == 1);
  CHECK(begin->object == &two);
}

TEST_CASE("Links work before their owner is in the tree, and find more targets once it is") {
  Forest t;
  auto made = t.kernel.classOf("Linked").create();
  auto& l = static_cast<Linked&>(*made);
  CHECK_FALSE(l.child);
  Thing& a = t.make(l, "a");
  CHECK(l.child.get() == &a);
  Thing& outer = t.make("outer");
  outer.add(std::move(made));
  CHECK(l.above.get() == &outer);
  CHECK(l.child.get() == &a);
}

TEST_CASE("A class inherits the links of its bases") {
  Forest t;
  Thing& outer = t.make("outer");
  auto& l = static_cast<MoreLinked&>(outer.create("MoreLinked"));
  CHECK(l.above.get() == &outer);
  CHECK(l.root.get() == &t.kernel.root());
  CHECK(l.classObject()->links().size() == 13);
}

TEST_CASE("The error for a missing target says what was expected and where") {
  Forest t;
  Linked& l = t.linked(*t.kernel.root().find<Node>("/usr"));
  CHECK_THAT(t.text, Catch::Contains("/usr/linked: expected a Thing above it, found none. It hangs in the air."));
  const auto problem = [](const auto& link) -> std::string {
    try {
      link.require();
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  CHECK(problem(l.counter) == "/usr/linked: expected a Counter among the children of the Thing above it, found none");
  CHECK(problem(l.heavy) == "/usr/linked: expected a heavy Thing above it, found none");
  CHECK_THAT(problem(l.at), Catch::Contains("expected a Thing at '/usr/t/at'") && Catch::Contains("no 'at' in /usr/t"));
  CHECK_THAT(problem(Link<Thing>()), Catch::Contains("d.link(&Class::member"));
}

TEST_CASE("A link that is not a member of a node starts at the node that it names") {
  Forest t;
  const FreeLink<Thing> link(t.kernel.root(), At<Thing>("/usr/t/at"));
  CHECK_FALSE(link);
  Thing& at = t.make("at");
  CHECK(link.get() == &at);
  t.top->remove(at);
  CHECK_FALSE(link);
}
