#include "input_codec.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

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
std::vector<OwnInput> messages(const std::vector<std::string_view>& texts) {
  std::vector<OwnInput> out;
  for (const std::string_view text : texts) out.push_back({Input::Kind::message, "/p/1.5", 7, 0, std::string(text)});
  return out;
}

std::vector<OwnInput> readAll(const std::vector<std::string>& pieces) {
  InputReader reader;
  std::vector<OwnInput> out;
  for (const std::string& piece : pieces) reader.read(piece, out);
  return out;
}
}  // namespace

TEST_CASE("A batch has the inputs that were added") {
  const auto inputs = inputsOfAllKinds();
  InputBatch batch;
  CHECK(batch.empty());
  for (const OwnInput& i : inputs) batch.add({i.kind, i.place, i.key, i.number, i.text});
  CHECK(batch.bytes() > 1000);
  CHECK(batch.inputs() == inputs);
}

TEST_CASE("Inputs are the same after writing and reading, in any number of pieces") {
  const auto inputs = inputsOfAllKinds();
  for (std::size_t each = 1; each <= inputs.size(); ++each) {
    InputWriter writer;
    std::vector<std::string> pieces;
    for (std::size_t i = 0; i < inputs.size(); i += each) {
      const auto from = inputs.begin() + static_cast<std::ptrdiff_t>(i);
      const auto n = std::min(each, inputs.size() - i);
      pieces.push_back(writer.write({from, from + static_cast<std::ptrdiff_t>(n)}));
    }
    CHECK(writer.write({}).empty());
    CHECK(readAll(pieces) == inputs);
  }
}

TEST_CASE("A piece after a restart needs none before, any other one does") {
  InputWriter writer;
  const std::string first = writer.write(inputsOfAllKinds()), second = writer.write(inputsOfAllKinds());
  writer.restart();
  const std::string third = writer.write(inputsOfAllKinds());
  CHECK(second.size() < first.size() / 2);
  CHECK(third == first);
  CHECK(readAll({first, second, third}).size() == 3 * inputsOfAllKinds().size());
  CHECK(readAll({third}) == inputsOfAllKinds());
  CHECK_THROWS_WITH(readAll({second}), Catch::Contains("needs none before"));
}

TEST_CASE("Texts with numbers of any form come back with the same characters") {
  const std::vector<std::string_view> texts = {
      "(he1 0.2541)(he2 -0.0000)(rle4 -6.1395)(syn )",
      "(he1 0.2540)(he2 0.0000)(rle4 -6.1396)(syn )",
      "(he1 -0.0)(he2 -0)(he3 0)(he4 -1)(he5 10)(he6 007)",
      "1.5",
      "-1.5 +1.5 .5 5. 5 -5 -.5 - . -. 0.0 -0.0 00.5 -007.25 0.50 0.5000000 12.34.56.78 1.2.3",
      "214748.3647 9007199254740991 9007199254740992 900719925474099.2 9999999999999999999999.5 1.99999999999999999999",
      "0.1234567 0.12345678 -0.1234567 123.12345678",
      "1.5e-3 0x1.8 v1.2-1.5 1-1.5--1.5 a1 a_1 _1.5 1a 1.5a",
      "a mark \x01 1.5 and \0 2.5"sv,
      "1.5\x06",
      "((((1)(",
      ")1",
      ""};
  InputWriter writer;
  const auto inputs = messages(texts);
  const std::string first = writer.write(inputs), again = writer.write(inputs);
  const auto out = readAll({first, again});
  REQUIRE(out.size() == 2 * inputs.size());
  for (std::size_t i = 0; i < out.size(); ++i) CHECK(out[i] == inputs[i % inputs.size()]);
}

TEST_CASE("A text with the words of the one before costs little more than its new digits") {
  std::string text;
  for (int joint = 0; joint < 22; ++joint) text += "(joint" + std::to_string(joint) + " 0.2500)";
  InputWriter writer;
  std::vector<std::string> pieces;
  for (int i = 0; i < 100; ++i) {
    text[text.find(' ') + 3] = static_cast<char>('0' + i % 10);
    pieces.push_back(writer.write(messages({text})));
  }
  CHECK(pieces.front().size() > 150);
  CHECK(pieces.back().size() <= 6);
  CHECK(readAll(pieces).back().text == text);
}

TEST_CASE("More clients, words and numbers than are known come back as well") {
  InputWriter writer;
  std::vector<OwnInput> inputs;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const std::string n = std::to_string(i % 1500);
    inputs.push_back(
        {Input::Kind::message, "/port" + std::to_string(i % 7), i % 700, 0, "(word" + n + "x 0.5)(b " + n + ")"});
  }
  const std::string many =
      "(" + std::string(50, ' ') + "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17)" + std::string(5000, 'y');
  for (int i = 0; i < 3; ++i) inputs.push_back({Input::Kind::request, "", 0, 0, many});
  CHECK(readAll({writer.write(inputs), writer.write({inputs.back()})}).size() == inputs.size() + 1);
  InputWriter other;
  CHECK(readAll({other.write(inputs)}) == inputs);
}

TEST_CASE("Inputs that are cut off or damaged are refused, or are others, and those after them as well") {
  InputWriter writer;
  const std::string bytes = writer.write(inputsOfAllKinds()), next = writer.write(inputsOfAllKinds());
  for (std::size_t n = 1; n < bytes.size(); ++n) {
    std::vector<OwnInput> out;
    InputReader reader;
    try {
      reader.read(std::string_view(bytes).substr(0, n), out);
    } catch (const Error&) {
      CHECK_THROWS_AS(reader.read(next, out), Error);
      continue;
    }
    CHECK(out != inputsOfAllKinds());
  }
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    std::string damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    std::vector<OwnInput> out;
    try {
      InputReader reader;
      reader.read(damaged, out);
    } catch (const Error&) {
      continue;
    }
    CHECK(out != inputsOfAllKinds());
  }
  std::vector<OwnInput> out;
  CHECK_THROWS_AS(InputReader().read("\x02\x42", out), Error);
  CHECK_THROWS_WITH(InputReader().read(bytes + "xxxxx", out), Catch::Contains("behind the last one"));
}
