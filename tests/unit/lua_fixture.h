#pragma once
/// \file
/// A kernel with a few classes to script, and a folder for script files.

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <map>

#include "spark/error.h"
#include "spark/script_server.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace spark::test {

/// A node with properties and methods of several types.
class Thing : public Node {
  SPARK_CLASS(Thing, Node)
 public:
  static void describe(Description<Thing>& d) {
    d.doc("Something to script.");
    d.property("mass", &Thing::mass).unit("kg").min(0).doc("How heavy it is.");
    d.property("count", &Thing::count).doc("An integer.");
    d.property("label", &Thing::label).doc("A text.");
    d.property("anything", &Thing::anything).doc("Any value.");
    d.property("fixed", &Thing::fixed).doc("Read only.");
    d.method("add", &Thing::add).parameters({"a", "b"}).doc("Adds.");
    d.method("echo", &Thing::echo).parameters({"value"}).doc("Gives back what it gets.");
    d.method("raise", &Thing::raise).parameters({"channel"}).doc("Emits an event.");
  }
  double add(double a, double b) { return a + b; }
  Value echo(Value v) { return v; }
  void raise(std::string channel) { kernel().events().channel(channel).emit({channel}); }
  int fixed() const { return 7; }
  double mass = 1;
  std::int64_t count = 0;
  std::string label = "none";
  Value anything;
};

/// Named variables, as the scene plugin has them.
class Group : public Leaf {
  SPARK_CLASS(Group, Leaf)
 public:
  static void describe(Description<Group>& d) {
    d.doc("Variables by name.");
    d.property("names", &Group::names).doc("Their names.");
    d.method("get", &Group::get).doc("One of them.");
    d.method("set", &Group::set).doc("Sets one.");
  }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& [name, value] : values) out.push_back(name);
    return out;
  }
  Value get(std::string name) const { return values.at(name); }
  void set(std::string name, Value value) { values[name] = value; }
  std::map<std::string, Value> values;
};

/// A kernel with these classes, an empty folder for scripts, and shortcuts to run them.
struct LuaHost : TestHost {
  const TemporaryFolder home;
  const std::filesystem::path& folder = home.path();
  LuaHost() : TestHost(false) {
    kernel.registerClass<Thing>();
    kernel.registerClass<Group>();
    scripts(kernel).addFolder(folder);
  }
  void write(const std::string& name, const std::string& text) { home.write(name, text); }
  Value run(std::string_view text) { return scripts(kernel).run(text, "test"); }
  /// The text of the error that running `text` raises; "" when there is none.
  std::string failure(std::string_view text) {
    return errorOf([&] { run(text); });
  }
  /// Like failure, for a config file with the content `text`.
  std::string configFailure(const std::string& text) {
    write("config.lua", text);
    return errorOf([&] { scripts(kernel).runConfig("config.lua"); });
  }
  template <class F>
  static std::string errorOf(F f) {
    try {
      f();
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  Thing& thing(std::string_view path) { return kernel.create<Thing>("Thing", path); }
  void emit(std::string_view channel) { kernel.events().channel(channel).emit({channel}); }
};

}  // namespace spark::test
