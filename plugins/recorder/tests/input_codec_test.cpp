#include "input_codec.h"

#include <catch2/catch.hpp>
#include <limits>

#include "spark/error.h"

using namespace spark;
using namespace spark::recorder;

namespace {
std::vector<OwnInput> inputsOfAllKinds() {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  std::vector<OwnInput> out{{Input::Kind::time, "", 0, 123456789012345, ""},
                            {Input::Kind::connect, "/sys/server/net/agents", 1, 0, "127.0.0.1:4711"},
                            {Input::Kind::message, "/sys/server/net/agents", 1, 0, std::string("(scene\0x)\xff", 10)},
                            {Input::Kind::cycle, "", 0, 1, ""},
                            {Input::Kind::time, "", 0, 123456789012000, ""},
                            {Input::Kind::decision, "sent", std::numeric_limits<std::uint64_t>::max(), 0, ""},
                            {Input::Kind::request, "", 0, -5, "{}"},
                            {Input::Kind::command, "the web's referee", 0, kMost, std::string(1000, 'x')},
                            {Input::Kind::leave, "/sys/server/net/agents", 1, -kMost, ""}};
  return out;
}
Input view(const OwnInput& i) { return {i.kind, i.place, i.key, i.number, i.text}; }
}  // namespace

TEST_CASE("Inputs are the same after writing and reading, in any number of pieces") {
  const auto inputs = inputsOfAllKinds();
  for (std::size_t each = 1; each <= inputs.size(); ++each) {
    InputWriter writer;
    std::vector<OwnInput> out;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      writer.add(view(inputs[i]));
      if ((i + 1) % each == 0) readInputs(writer.take(), out);
    }
    readInputs(writer.take(), out);
    CHECK(out == inputs);
  }
}

TEST_CASE("Inputs that are cut off or damaged are refused") {
  InputWriter writer;
  for (const OwnInput& i : inputsOfAllKinds()) writer.add(view(i));
  const std::string bytes = writer.take();
  for (std::size_t n = 1; n < bytes.size(); ++n) {
    std::vector<OwnInput> out;
    try {
      readInputs(std::string_view(bytes).substr(0, n), out);
    } catch (const Error&) {
    }
    CHECK(out.size() < inputsOfAllKinds().size());
  }
  std::vector<OwnInput> out;
  CHECK_THROWS_AS(readInputs("\x42", out), Error);
}
