#include <catch2/catch.hpp>

#include "absence.h"
#include "core_classes.h"
#include "spark/error.h"
#include "spark/running.h"

using namespace spark;
using spark::test::Core;
using spark::test::Thing;

namespace {
/// Makes things that append their name to `order` on each tick.
struct Ticking : Core {
  std::string order;
  Channel& tick = kernel.events().define("tick", Order::parentsFirst, "For tests.");
  Thing& named(Node& parent, const char* name) {
    Thing& t = make(parent, name);
    t.onTick = [this](Thing& self, const Event&) { order += self.name(); };
    return t;
  }
  std::string emit(const char* channel = "tick") {
    order.clear();
    kernel.events().channel(channel).emit({channel, 0, 0, 0, nullptr});
    return order;
  }
};
}  // namespace

TEST_CASE("Handlers run in tree order, in whatever order their nodes were made") {
  Ticking t;
  Thing& b = t.named(*t.top, "b");
  Thing& a = t.named(*t.top, "a");
  t.named(a, "x");
  t.named(b, "y");
  CHECK(t.emit() == "byax");
  t.top->reparent(b, a);
  CHECK(t.emit() == "axby");
}

TEST_CASE("A channel can run children before parents") {
  Ticking t;
  Channel& up = t.kernel.events().define("up", Order::childrenFirst, "For tests.");
  Thing &a = t.named(*t.top, "a"), &b = t.named(a, "b");
  for (Thing* n : {&a, &b}) up.add(*n, [&](Leaf& l, const Event&) { t.order += l.name(); });
  CHECK(t.emit("up") == "ba");
}

TEST_CASE("A node's handlers run in the order of subscription, hooks first") {
  Ticking t;
  Thing& a = t.named(*t.top, "a");
  t.tick.add(a, [&](Leaf&, const Event&) { t.order += "1"; });
  t.tick.add(a, [&](Leaf&, const Event&) { t.order += "2"; });
  CHECK(t.emit() == "a12");
}

TEST_CASE("Events carry their data") {
  Ticking t;
  const Value data("hello");
  Event seen;
  std::string text;
  t.tick.add(*t.top, [&](Leaf&, const Event& e) {
    seen = e;
    text = e.data->toString();
  });
  t.tick.emit({"tick", 1.5, 0.02, 75, &data});
  CHECK(seen.time == 1.5);
  CHECK(seen.cycle == 75);
  CHECK(text == "hello");
}

TEST_CASE("A handler is removed with its node, or by its number") {
  Ticking t;
  Thing& a = t.named(*t.top, "a");
  const auto first = t.tick.add(a, [&](Leaf&, const Event&) { t.order += "1"; });
  const auto second = t.tick.add(a, [&](Leaf&, const Event&) { t.order += "2"; });
  t.tick.remove(second);
  const auto third = t.tick.add(a, [&](Leaf&, const Event&) { t.order += "3"; });
  CHECK(third != second);
  t.tick.remove(second);
  t.tick.remove(0);
  CHECK(t.emit() == "a13");
  t.tick.remove(first);
  CHECK(t.emit() == "a3");
  t.top->remove(a);
  CHECK(t.emit().empty());
  const auto loose = t.kernel.classOf("Thing").create();
  CHECK_THROWS_WITH(t.tick.add(*loose, [](Leaf&, const Event&) {}), Catch::Contains("not linked"));
}

TEST_CASE("A handler that is removed during an event does not run, and its captures live until the event ends") {
  Ticking t;
  Thing &a = t.named(*t.top, "a"), &b = t.named(*t.top, "b"), &c = t.named(*t.top, "c");
  a.onTick = [&](Thing&, const Event&) {
    t.order += "a";
    t.top->remove(b);
  };
  CHECK(t.emit() == "ac");
  const auto alive = std::make_shared<int>(7);
  std::weak_ptr<int> weak = alive;
  std::uint64_t number = 0;
  number = t.tick.add(c, [&, held = alive](Leaf&, const Event&) {
    t.tick.remove(number);
    t.order += std::to_string(*held);
  });
  a.onTick = nullptr;
  CHECK(t.emit() == "c7");
  CHECK(alive.use_count() == 1);
  CHECK(t.emit() == "c");
}

TEST_CASE("A node may remove itself and its siblings while its channel runs") {
  Ticking t;
  Thing& a = t.named(*t.top, "a");
  t.named(*t.top, "b");
  t.tick.add(a, [&](Leaf&, const Event&) {
    t.order += "!";
    t.top->removeChildren();
  });
  t.tick.add(a, [&](Leaf&, const Event&) { t.order += "never"; });
  CHECK(t.emit() == "a!");
  CHECK(t.top->children().empty());
}

TEST_CASE("Handlers that are added during an event first run in the next event") {
  Ticking t;
  Thing& a = t.named(*t.top, "a");
  bool once = true;
  a.onTick = [&](Thing& self, const Event&) {
    t.order += "a";
    if (!std::exchange(once, false)) return;
    for (int i = 0; i < 100; ++i) t.named(self, "n");
    t.tick.add(self, [&](Leaf&, const Event&) { t.order += "h"; });
  };
  t.named(*t.top, "z");
  CHECK(t.emit() == "az");
  CHECK(t.emit() == "ah" + std::string(100, 'n') + "z");
}

TEST_CASE("Nodes and handlers that are added and removed within one event leave nothing behind") {
  Ticking t;
  Thing& a = t.named(*t.top, "a");
  const auto held = std::make_shared<int>(0);
  a.onTick = [&](Thing& self, const Event&) {
    Thing& brief = t.named(self, "brief");
    t.tick.add(brief, [held](Leaf&, const Event&) {});
    self.remove(brief);
    t.tick.remove(t.tick.add(self, [held](Leaf&, const Event&) {}));
  };
  for (int i = 0; i < 3; ++i) t.emit();
  CHECK(held.use_count() == 1);
  CHECK(t.emit().empty());
}

TEST_CASE("A handler may emit an event on its own channel") {
  Ticking t;
  Thing& a = t.named(*t.top, "a");
  t.named(*t.top, "b");
  int depth = 0;
  a.onTick = [&](Thing& self, const Event& e) {
    t.order += "a";
    if (++depth == 3)
      self.parent()->remove(self);
    else
      t.tick.emit(e);
  };
  CHECK(t.emit() == "aaabbb");
  CHECK(t.emit() == "b");
}

TEST_CASE("A handler that throws is reported with channel, node and class, and the other handlers run") {
  Ticking t;
  Thing& a = t.named(*t.top, "a");
  t.named(*t.top, "b");
  a.onTick = [](Thing&, const Event&) { throw Error("broken"); };
  CHECK(t.emit() == "b");
  CHECK_THAT(t.text, Catch::Contains("tick of /usr/t/a (class Thing) failed: broken"));
  t.top->remove(a);
  Thing& c = t.named(*t.top, "c");
  c.onTick = [](Thing&, const Event&) { throw 7; };
  CHECK(t.emit() == "b");
  CHECK_THAT(t.text, Catch::Contains("no std::exception"));
  t.top->remove(c);
  t.named(*t.top, "d").onTick = [&](Thing& self, const Event&) {
    for (int i = 0; i < 50; ++i) t.tick.add(*t.top, [](Leaf&, const Event&) {});
    t.top->remove(self);
    throw Error("while leaving");
  };
  CHECK(t.emit() == "b");
  CHECK_THAT(t.text, Catch::Contains("tick of a removed node failed: while leaving"));
}

TEST_CASE("A handler that throws each time is reported once and counted each time") {
  Ticking t;
  Thing &a = t.named(*t.top, "a"), &b = t.named(*t.top, "b");
  int n = 0;
  for (Thing* thing : {&a, &b})
    thing->onTick = [&](Thing&, const Event&) { throw Error(fmt::format("broken {}", ++n)); };
  for (int i = 0; i < 5; ++i) t.emit();
  CHECK(t.kernel.faults() == 10);
  CHECK_THAT(t.text, Catch::Contains("tick of /usr/t/a (class Thing) failed: broken 1\n  It stays; further faults of "
                                     "this handler are counted, not logged."));
  CHECK_THAT(t.text, Catch::Contains("tick of /usr/t/b (class Thing) failed: broken 2"));
  CHECK(test::count(t.text, "broken") == 2);
}

TEST_CASE("The running handler is known, and after a nested event it is the outer one again") {
  Ticking t;
  Channel& inner = t.kernel.events().define("inner", Order::parentsFirst, "For tests.");
  Thing &a = t.named(*t.top, "a"), &b = t.named(*t.top, "b");
  const auto words = [] {
    char text[200];
    return std::string(text, describeRunning(running(), text, sizeof text));
  };
  std::vector<std::string> seen;
  b.onTick = {};
  inner.add(b, [&](Leaf&, const Event&) { seen.push_back(words()); });
  a.onTick = [&](Thing&, const Event&) {
    inner.emit({"inner"});
    seen.push_back(words());
  };
  const std::uint64_t beats = running().beats;
  t.emit();
  CHECK(seen == std::vector<std::string>{"in inner of /usr/t/b (class Thing)", "in tick of /usr/t/a (class Thing)"});
  CHECK(words() == "outside of the code of nodes");
  CHECK(running().beats >= beats + 2);
  // A second sibling of the same name is numbered as in paths. The text is cut to the size of the buffer.
  NowRunning now("x", &t.make(*t.top, "a"));
  CHECK(words() == "in x of /usr/t/a[2] (class Thing)");
  char narrow[6];
  CHECK(std::string(narrow, describeRunning(running(), narrow, sizeof narrow)) == "in x o");
}

TEST_CASE("An event can be sent to one node only") {
  Ticking t;
  t.named(*t.top, "a");
  Thing& b = t.named(*t.top, "b");
  t.tick.add(b, [&](Leaf&, const Event&) { t.order += "!"; });
  t.tick.emitAt(b, {"tick", 0, 0, 0, nullptr});
  CHECK(t.order == "b!");
}

TEST_CASE("A channel may be used before it is defined, and a second definition must agree") {
  Core core;
  Channel& late = core.kernel.events().channel("late");
  core.kernel.events().channel("aaa");
  CHECK(&core.kernel.events().define("late", Order::childrenFirst, "Defined now.") == &late);
  CHECK(late.doc() == "Defined now.");
  CHECK_THROWS_WITH(core.kernel.events().define("late", Order::parentsFirst, "Again."),
                    Catch::Contains("'late' is defined already"));
  std::vector<std::string> names;
  for (const Channel* c : core.kernel.events().all()) names.push_back(c->name());
  CHECK(names == std::vector<std::string>{"aaa", "late", "tick"});
  CHECK(late.empty());
}
