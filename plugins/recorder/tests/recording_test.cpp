#include "recording.h"

#include <catch2/catch.hpp>
#include <thread>

#include "spark/error.h"
#include "temporary_folder.h"

using namespace spark;
using namespace spark::recorder;
using Catch::Contains;

TEST_CASE("A recording takes messages of several threads, and has all of them when it ends") {
  test::TemporaryFolder folder;
  const std::string file = folder.path() / "a.mcap";
  {
    Recording r(file, "test");
    const std::uint16_t a = r.channel({0, "/a", "raw"}), b = r.channel({0, "/b", "json"}, {"B", "jsonschema", "{}"});
    CHECK(a == 1);
    CHECK(b == 2);
    r.metadata("about", {{"x", "y"}});
    std::thread other([&] {
      for (int i = 0; i < 1000; ++i) r.message(b, 2'000'000 * i, "{}");
    });
    for (int i = 0; i < 1000; ++i) r.message(a, 2'000'000 * i, "message " + std::to_string(i));
    other.join();
    r.attachment(0, "text", "text/plain", "hello");
    CHECK(r.failure().empty());
  }
  mcap::Reader reader(file);
  CHECK(reader.lacks().empty());
  CHECK(reader.schemas().at(1).name == "B");
  CHECK(reader.channels().at(2).schema == 1);
  int ofA = 0, ofB = 0;
  for (const auto& chunk : reader.chunks())
    reader.forEach(chunk, [&](const mcap::Message& m) {
      if (m.channel == 1) CHECK(m.data == "message " + std::to_string(ofA++));
      if (m.channel == 2) ++ofB;
      return true;
    });
  CHECK(ofA == 1000);
  CHECK(ofB == 1000);
  CHECK(reader.read(reader.attachments().at(0)) == "hello");
}

TEST_CASE("A recording for which the disk is too slow ends, and its readers say that the end is missing") {
  test::TemporaryFolder folder;
  const std::string file = folder.path() / "a.mcap";
  {
    Recording r(file, "test", 1 << 20);
    const std::uint16_t a = r.channel({0, "/a", "raw"});
    r.message(a, 0, "before");
    r.message(a, 1, std::string(2 << 20, 'x'));
    CHECK(r.failure() == "more than 1 MB wait to be written");
    r.message(a, 2, "after");
  }
  mcap::Reader reader(file);
  REQUIRE(reader.lacks().size() == 1);
  CHECK_THAT(reader.lacks()[0], Contains("cut off"));
  std::vector<std::string> read;
  for (const auto& chunk : reader.chunks())
    reader.forEach(chunk, [&](const mcap::Message& m) { return read.emplace_back(m.data), true; });
  CHECK(read == std::vector<std::string>{"before"});
}

TEST_CASE("A recording that cannot be written says why") {
  CHECK_THROWS_WITH(Recording("/nonexistent/a.mcap", "test"),
                    Contains("cannot write the recording /nonexistent/a.mcap"));
  Recording r("/dev/full", "test");
  while (r.failure().empty()) std::this_thread::yield();
  CHECK_THAT(r.failure(), Contains("No space left on device"));
  r.message(r.channel({0, "/a", "raw"}), 0, "is ignored");
}
