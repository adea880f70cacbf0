#include "input_codec.h"

#include <catch2/catch.hpp>
#include <limits>

#include "spark/error.h"

using namespace spark;
using namespace spark::recorder;
using namespace std::literals;

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

TEST_CASE("Texts with numbers of any form come back with the same characters") {
  const std::string_view texts[] = {
      "(he1 0.2541)(he2 -0.0000)(rle4 -6.1395)(syn )",
      "1.5",
      "-1.5 +1.5 .5 5. 5 -5 -.5 - . -. 0.0 -0.0 00.5 -007.25 0.50 0.5000000 12.34.56.78 1.2.3",
      "214748.3647 214748.3648 2147.483647 9999999999999999999999.5 1.99999999999999999999",
      "1.5e-3 0x1.8 v1.2-1.5 1-1.5--1.5",
      "a mark \x01 1.5 and \0 2.5"sv,
      "1.5\x06",
      ""};
  InputWriter writer;
  for (const std::string_view text : texts) writer.add({.kind = Input::Kind::message, .place = "/1.5", .text = text});
  std::vector<OwnInput> out;
  readInputs(writer.take(), out);
  REQUIRE(out.size() == std::size(texts));
  for (std::size_t i = 0; i < out.size(); ++i) {
    CHECK(out[i].text == texts[i]);
    CHECK(out[i].place == "/1.5");
  }
}

TEST_CASE("Texts that differ only in their numbers differ only behind all texts") {
  const auto piece = [](std::string_view text) {
    InputWriter writer;
    writer.add({.kind = Input::Kind::message, .place = "/p", .text = text});
    return writer.take();
  };
  const std::string a = piece("(he1 1.25)(he2 -0.0001)"), b = piece("(he1 -3.75)(he2 12.0000)");
  REQUIRE(a.size() == b.size());
  CHECK(a.substr(0, a.size() - 8) == b.substr(0, b.size() - 8));
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
  CHECK_THROWS_AS(readInputs("\x01\x42", out), Error);
}
