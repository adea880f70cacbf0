#pragma once
/// \file
/// Classes and a kernel for the tests of the core.

#include <functional>
#include <string>
#include <vector>

#include "spark/event.h"
#include "spark/kernel.h"
#include "spark/random.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

/// An interface that is not a class of the kernel.
struct ICounter {
  SPARK_INTERFACE(Counter, 1);
  virtual int count() const = 0;
  virtual Leaf& leaf() = 0;

 protected:
  ~ICounter() = default;
};

/// A node with one property of each kind, and hooks that a test can set.
class Thing : public Node, public ICounter {
  SPARK_CLASS(Thing, Node)
 public:
  static void describe(Description<Thing>& d) {
    d.doc("A thing.");
    d.implements<ICounter>();
    d.property("mass", &Thing::mass_).unit("kg").min(0).max(100).state().doc("How heavy it is.");
    d.property("label", &Thing::label_).choices({"red", "green"}).state().doc("Its label.");
    d.property("list", &Thing::list_).range(-1, 1).doc("Numbers.");
    d.property("count", &Thing::count).doc("Calls so far.");
    d.property("noise", &Thing::noise_).state().doc("Its stream.");
    d.method("add", &Thing::addNumbers).parameters({"a", "b"}).doc("The sum.");
    d.method("opt", &Thing::optional)
        .parameters({"a", "b"})
        .optional(1)
        .surplusIgnored()
        .doc("The sum, b may be missing.");
    d.method("join", &Thing::join).doc("All texts.");
    d.method("fail", &Thing::fail).doc("Throws.");
    d.alias("plus", "add");
    d.on<&Thing::tick>(ChannelName("tick"));
  }
  int count() const override { return count_; }
  Leaf& leaf() override { return *this; }
  double addNumbers(double a, double b) {
    ++count_;
    return a + b;
  }
  double optional(double a, double b) { return a + b; }
  std::string join(std::vector<std::string> all) {
    std::string out;
    for (const std::string& s : all) out += s;
    return out;
  }
  void fail() { throw Error("it fails"); }
  void tick(const Event& e) {
    if (onTick) onTick(*this, e);
  }

  double mass_ = 1;
  std::string label_ = "red";
  std::vector<double> list_;
  int count_ = 0;
  std::int64_t hidden = 0;
  RandomStream noise_{*this, "noise"};
  std::function<void(Thing&)> atLink, atUnlink, atMove, atEnd;
  std::function<void(Thing&, const Event&)> onTick;
  ~Thing() override {
    if (atEnd) atEnd(*this);
  }

 protected:
  void onLink() override {
    if (atLink) atLink(*this);
  }
  void onUnlink() override {
    if (atUnlink) atUnlink(*this);
  }
  void onMoved() override {
    if (atMove) atMove(*this);
  }
  void saveState(StateWriter& out) const override { out.write(hidden); }
  void loadState(StateReader& in) override { hidden = in.readInteger(); }
};

/// Overrides a property and a method of its base.
class HeavyThing : public Thing {
  SPARK_CLASS(HeavyThing, Thing)
 public:
  static void describe(Description<HeavyThing>& d) {
    d.doc("A heavy thing.");
    d.property("mass", &HeavyThing::mass_).unit("kg").min(50).doc("How heavy it is.");
    d.method("join", &HeavyThing::shout).doc("One text, loud.");
  }
  HeavyThing() { mass_ = 60; }
  std::string shout(std::string text) { return text + "!"; }
};

/// An abstract base.
class Idea : public Leaf {
  SPARK_CLASS(Idea, Leaf)
 public:
  static void describe(Description<Idea>& d) {
    d.doc("Cannot be made.");
    d.abstract();
  }
};

/// A kernel with these classes and a node /usr/t, under which tests make their nodes.
struct Core : TestHost {
  Core() : TestHost(false) {
    kernel.registerClass<Thing>();
    kernel.registerClass<HeavyThing>();
    kernel.registerClass<Idea>();
    top = &kernel.create<Thing>("Thing", "/usr/t");
  }
  Thing& make(Node& parent, std::string name) { return parent.create<Thing>("Thing", name); }
  Thing& make(std::string name) { return make(*top, std::move(name)); }
  Thing* top;
};

}  // namespace spark::test
