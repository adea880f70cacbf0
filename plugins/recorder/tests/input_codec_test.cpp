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

/// Inputs that fit into one piece.
std::string piece(InputWriter& writer, const std::vector<OwnInput>& inputs) {
  const std::vector<std::string> pieces = writer.write(inputs);
  REQUIRE(pieces.size() == 1);
  return pieces.front();
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
      pieces.push_back(piece(writer, {from, from + static_cast<std::ptrdiff_t>(n)}));
    }
    CHECK(writer.write({}).empty());
    CHECK(readAll(pieces) == inputs);
  }
}

TEST_CASE("A piece after a restart needs none before, any other one does, and each of them once") {
  InputWriter writer;
  const std::string first = piece(writer, inputsOfAllKinds()), second = piece(writer, inputsOfAllKinds());
  const std::string third = piece(writer, inputsOfAllKinds());
  writer.restart();
  CHECK(second.size() < first.size() / 2);
  CHECK(piece(writer, inputsOfAllKinds()) == first);
  CHECK(readAll({first, second, third, first, second}).size() == 5 * inputsOfAllKinds().size());
  CHECK_THROWS_WITH(readAll({second}), Catch::Contains("expected a piece with the number 0, found 1"));
  CHECK_THROWS_WITH(readAll({first, third}), Catch::Contains("expected a piece with the number 1, found 2"));
  CHECK_THROWS_AS(readAll({first, second, second}), Error);
  InputReader reader;
  std::vector<OwnInput> out;
  reader.read(first, out);
  reader.restart();
  CHECK_THROWS_AS(reader.read(second, out), Error);
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
  const std::string first = piece(writer, inputs), again = piece(writer, inputs);
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
    pieces.push_back(piece(writer, messages({text})));
  }
  CHECK(pieces.front().size() > 150);
  CHECK(pieces.back().size() <= 6);
  CHECK(readAll(pieces).back().text == text);
}

TEST_CASE("More clients, words and numbers than are known come back as well") {
  InputWriter writer;
  std::vector<OwnInput> inputs;
  const auto say = [&](std::uint64_t client, const std::string& text) {
    inputs.push_back({Input::Kind::message, "/port" + std::to_string(client % 7), client, 0, text});
  };
  std::string seventeen = "(";
  for (int i = 0; i < 17; ++i) seventeen += std::to_string(i) + ' ';
  SECTION("words") {
    for (std::uint64_t i = 0; i < 3000; ++i) say(i % 700, "(w" + std::to_string(i % 1500) + "x)(b 0.5)");
  }
  SECTION("numbers") {
    for (std::uint64_t i = 0; i < 300; ++i)
      say(1, "(w" + std::to_string(i % 150) + "x 1 2 3 4 5 6 7 8 9 " + std::to_string(i) + ")");
  }
  SECTION("numbers of a word") {
    for (std::uint64_t i = 0; i < 3; ++i) say(1, seventeen + std::to_string(i));
  }
  SECTION("characters of a word, and of a place") {
    for (const std::size_t n : {199u, 200u, 201u, 5000u})
      for (int i = 0; i < 3; ++i)
        inputs.push_back({Input::Kind::request, std::string(n, 'p'), 1, 0, std::string(n, 'y')});
  }
  const std::string bytes = piece(writer, inputs), again = piece(writer, inputs);
  const std::vector<OwnInput> out = readAll({bytes, again});
  REQUIRE(out.size() == 2 * inputs.size());
  CHECK(std::equal(inputs.begin(), inputs.end(), out.begin()));
  CHECK(std::equal(inputs.begin(), inputs.end(), out.begin() + static_cast<std::ptrdiff_t>(inputs.size())));
}

TEST_CASE("Long inputs become several pieces, and one that is too long none") {
  InputWriter writer;
  const std::vector<OwnInput> inputs(5, {Input::Kind::message, "/p", 1, 0, std::string(9 << 20, 'x')});
  const std::vector<std::string> pieces = writer.write(inputs);
  CHECK(pieces.size() == 5);
  CHECK(readAll(pieces) == inputs);
  CHECK_THROWS_WITH(writer.write({{Input::Kind::message, "/p", 1, 0, std::string(49 << 20, 'x')}}),
                    Catch::Contains("too long to be recorded"));
  CHECK(readAll({piece(writer, inputsOfAllKinds())}) == inputsOfAllKinds());
}

TEST_CASE("A few bytes do not become endlessly many inputs, nor do they take endless time") {
  const std::vector<OwnInput> inputs(500'000, {Input::Kind::cycle, "", 0, 0, ""});
  InputWriter writer;
  std::size_t bytes = 0;
  std::vector<std::string> pieces;
  for (int i = 0; i < 2; ++i)
    for (std::string& piece : writer.write(inputs)) bytes += pieces.emplace_back(std::move(piece)).size();
  CHECK(bytes < 20000);
  CHECK(pieces.size() >= 5);
  // Nothing but bits that were probable.
  std::string hostile(1, '\0');
  hostile.resize(200'000);
  std::vector<OwnInput> out;
  CHECK_THROWS_AS(InputReader().read(hostile, out), Error);
  CHECK(out.size() < (64u << 20) / sizeof(OwnInput) + 1);
}

TEST_CASE("Damaged inputs end, with an Error or with others; after an Error nothing is read before a restart") {
  InputWriter writer;
  const std::string bytes = piece(writer, inputsOfAllKinds()), next = piece(writer, inputsOfAllKinds());
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    std::vector<OwnInput> out;
    InputReader reader;
    try {
      reader.read(std::string_view(bytes).substr(0, n), out);
    } catch (const Error&) {
      CHECK_THROWS_AS(reader.read(next, out), Error);
    }
  }
  std::mt19937 random(3);
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    std::vector<OwnInput> out;
    try {
      InputReader().read(damaged, out);
    } catch (const Error&) {
      ++refused;
    }
  }
  CHECK(refused > 10000);
  std::vector<OwnInput> out;
  CHECK_THROWS_AS(InputReader().read("", out), Error);
  CHECK_THROWS_WITH(InputReader().read(bytes + "12345", out), Catch::Contains("behind the last one"));
}
