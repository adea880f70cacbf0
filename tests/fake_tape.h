#pragma once
/// \file
/// A tape of inputs that notes what is put on it.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "api/inputs.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark::test {

/// Notes requests, commands and messages. `plays`: it is a tape that is played, on which nothing else may be put.
class FakeTape : public Node, public IInputTape {
  SPARK_CLASS(FakeTape, Node)
 public:
  static void describe(Description<FakeTape>& d) {
    d.doc("Notes inputs.");
    d.implements<IInputTape>();
  }
  /// Makes one where tapes are.
  static FakeTape& in(Kernel& kernel) {
    kernel.registerClass<FakeTape>();
    return kernel.create<FakeTape>("FakeTape", kPath);
  }
  bool playing() const override { return plays; }
  bool put(const Input& input) override {
    if (input.kind == Input::Kind::message) messages.emplace_back(input.text);
    if (input.kind != Input::Kind::request && input.kind != Input::Kind::command) return true;
    if (plays) return false;
    noted.push_back(fmt::format("{}: {}", input.place, input.text));
    return true;
  }
  Clock::time_point time(Clock::time_point live) override { return live; }
  bool decide(std::string_view, std::uint64_t, bool live, bool) override { return live; }

  bool plays = false;
  std::vector<std::string> noted;     ///< requests and commands: "place: text" each
  std::vector<std::string> messages;  ///< of clients
};

}  // namespace spark::test
