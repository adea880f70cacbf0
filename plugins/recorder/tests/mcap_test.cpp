#include "mcap.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "spark/error.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark;
using namespace spark::mcap;
using Catch::Contains;

namespace {
/// The bytes of a recording of 30 messages on two channels, in three chunks.
std::string sample(bool finished = true) {
  std::string out;
  Writer w([&out](std::string_view bytes) { out += bytes; }, "test");
  const std::uint16_t schema = w.schema({"Point", "jsonschema", R"({"type":"object"})"});
  const std::uint16_t a = w.channel({schema, "/a", "json"}), b = w.channel({0, "/b", "raw"});
  w.metadata("about", {{"seed", "7"}, {"empty", ""}});
  w.attachment(5, "config.lua", "text/x-lua", "print 'hello'");
  for (int i = 0; i < 30; ++i) {
    w.message(i % 3 == 0 ? b : a, i * 100, "message " + std::to_string(i));
    if (i % 10 == 9) w.endChunk();
  }
  if (finished) w.finish();
  return out;
}

struct File {
  spark::test::TemporaryFolder folder;
  std::string name;
  explicit File(const std::string& bytes) : name(folder.write("a.mcap", bytes)) {}
};

std::vector<std::string> messages(Reader& r) {
  std::vector<std::string> out;
  for (const Reader::Chunk& c : r.chunks())
    r.forEach(c, [&](const Message& m) {
      out.push_back(std::to_string(m.time) + " " + r.channels().at(m.channel).topic + " " + std::string(m.data));
      return true;
    });
  return out;
}
}  // namespace

TEST_CASE("CRC-32 is that of IEEE") {
  CHECK(crc32("123456789") == 0xcbf43926u);
  CHECK(crc32("6789", crc32("12345")) == 0xcbf43926u);
  CHECK(crc32("") == 0);
}

TEST_CASE("What is written is read again") {
  const File file(sample());
  Reader r(file.name);
  CHECK(r.lacks().empty());
  const auto all = messages(r);
  REQUIRE(all.size() == 30);
  CHECK(all[0] == "0 /b message 0");
  CHECK(all[29] == "2900 /a message 29");
  CHECK(r.chunks().size() == 3);
  CHECK(r.chunks()[1].begin == 1000);
  CHECK(r.chunks()[1].end == 1900);
  CHECK(r.end() == 2900);
  CHECK(r.channelOf("/a") == 1);
  CHECK(r.channelOf("/c") == 0);
  CHECK(r.schemas().at(1).name == "Point");
  CHECK(r.metadataOf("about") == std::map<std::string, std::string>{{"seed", "7"}, {"empty", ""}});
  CHECK(r.metadataOf("nothing").empty());
  REQUIRE(r.attachments().size() == 1);
  CHECK(r.attachments()[0].name == "config.lua");
  CHECK(r.read(r.attachments()[0]) == "print 'hello'");
}

TEST_CASE("A chunk can be left early") {
  const File file(sample());
  Reader r(file.name);
  int n = 0;
  CHECK(r.forEach(r.chunks()[0], [&](const Message&) { return ++n < 4; }));
  CHECK(n == 4);
}

TEST_CASE("A file that was cut off anywhere is read up to its last whole chunk, and says so") {
  const std::string whole = sample();
  std::size_t most = 0;
  for (std::size_t length = 8; length < whole.size(); ++length) {
    const File file(whole.substr(0, length));
    Reader r(file.name);
    CHECK(r.lacks().size() == 1);
    const auto all = messages(r);
    CHECK(all.size() % 10 == 0);
    CHECK(all.size() >= most);
    most = all.size();
    CHECK(r.lacks().size() == 1);
  }
  CHECK(most == 30);
  CHECK_THAT(
      [&] {
        const File file(whole.substr(0, whole.size() - 1));
        return Reader(file.name).lacks().at(0);
      }(),
      Contains("the end of the recording is damaged"));
}

TEST_CASE("A file that was never finished is read") {
  const File file(sample(false));
  Reader r(file.name);
  REQUIRE(r.lacks().size() == 1);
  CHECK_THAT(r.lacks()[0], Contains("cut off") && Contains("0.000 s"));
  CHECK(messages(r).size() == 30);
  CHECK(r.attachments().size() == 1);
}

TEST_CASE("Any byte may be wrong: no crash, and what is read is what was written, or is named") {
  const std::string whole = sample();
  const File good(whole);
  Reader original(good.name);
  const auto expected = messages(original);
  for (std::size_t at = 8; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
    const File file(bytes);
    INFO("byte " << at);
    try {
      Reader r(file.name);
      const auto all = messages(r);
      for (const std::string& m : all) CHECK(std::find(expected.begin(), expected.end(), m) != expected.end());
      if (all.size() < expected.size()) CHECK(!r.lacks().empty());
      for (const Reader::Attachment& a : r.attachments()) {
        std::string text = "print 'hello'";
        try {
          text = r.read(a);
        } catch (const Error&) {
        }
        CHECK(text == "print 'hello'");
      }
    } catch (const std::out_of_range&) {
      // a channel's number is another one
    }
  }
}

TEST_CASE("A chunk of a few bytes that would become very many is not read, another one beside it is") {
  std::string out;
  Writer w([&out](std::string_view bytes) { out += bytes; }, "test");
  const std::uint16_t a = w.channel({0, "/a", "raw"});
  const auto chunk = [&](Time time, const std::string& data) {
    w.message(a, time, data);
    w.endChunk();
  };
  std::string noise;  // that compresses badly
  for (std::uint32_t i = 0, x = 1; i < 1u << 20; ++i) noise += static_cast<char>((x = x * 1664525 + 1013904223) >> 24);
  chunk(0, std::string(17u << 20, 'x'));  // into about 2 KB
  chunk(1, std::string(15u << 20, 'x'));
  chunk(2, std::string(16u << 20, 'x') + noise);
  w.finish();
  const File file(out);
  Reader r(file.name);
  REQUIRE(r.lacks().empty());
  std::vector<std::pair<Time, std::size_t>> read;
  for (const Reader::Chunk& c : r.chunks())
    r.forEach(c, [&](const Message& m) {
      read.emplace_back(m.time, m.data.size());
      return true;
    });
  CHECK(read == std::vector<std::pair<Time, std::size_t>>{{1, 15u << 20}, {2, 17u << 20}});
  REQUIRE(r.lacks().size() == 1);
  CHECK_THAT(r.lacks()[0], Contains("its size is too large"));
}

TEST_CASE("What is no recording is refused") {
  const File empty(""), text("this is no recording at all, it is a text");
  CHECK_THROWS_WITH(Reader(empty.name), Contains("is no recording: expected an MCAP file"));
  CHECK_THROWS_WITH(Reader(text.name), Contains("is no recording"));
  CHECK_THROWS_WITH(Reader("/nonexistent/x.mcap"), Contains("cannot read"));
  CHECK_THROWS(Reader(std::filesystem::temp_directory_path().string()));
}
