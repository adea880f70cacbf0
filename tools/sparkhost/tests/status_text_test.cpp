#include "../status_text.h"

#include <catch2/catch.hpp>

#include "spark/describe.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;
using sparkhost::statusText;

namespace {
std::string statusJson(const std::vector<StatusEntry>& entries) {
  std::string out;
  JsonWriter json(out);
  json.beginObject();
  sparkhost::writeStatus(json, entries);
  json.endObject();
  return out;
}

/// Reports the entries that the test sets.
class Reporter : public Node, public IStatus {
  SPARK_CLASS(Reporter, Node)
 public:
  static void describe(Description<Reporter>& d) { d.implements<IStatus>(); }
  void report(std::vector<StatusEntry>& out) const override { out.insert(out.end(), entries.begin(), entries.end()); }
  std::vector<StatusEntry> entries;
};

struct Reporters : TestHost {
  Reporters() : TestHost(false) { kernel.registerClass<Reporter>(); }
  Reporter& add(const std::string& path, std::vector<StatusEntry> entries) {
    auto& reporter = kernel.create<Reporter>("Reporter", path);
    reporter.entries = std::move(entries);
    return reporter;
  }
};
}  // namespace

TEST_CASE("The status line has the play mode, then the score, then all other entries with their names") {
  CHECK(statusText({{"playMode", "PlayOn", {}}, {"score", List{1, 0}, {"Left", "Right"}}}) == ", PlayOn 1:0");
  CHECK(statusText({{"score", List{3, 2, 1}, {}}, {"round", 7, {}}, {"wind", List{0.5, -1}, {}}}) ==
        ", score 3:2:1, round 7, wind 0.5 -1");
  CHECK(statusText({{"teams", List{"Red", "Blue"}, {}}, {"halted", true, {}}}) == ", teams Red Blue, halted true");
  CHECK(statusText({{"playMode", "", {}}, {"score", List{1, 0}, {}}}) == ", score 1:0");
  CHECK(statusText({}).empty());
}

TEST_CASE("The host's last line has known entries as members, and all others in status") {
  CHECK(statusJson({{"playMode", "PlayOn", {}}, {"score", List{1, 0}, {"Left", "Right"}}}) ==
        R"({"playMode":"PlayOn","score":[1,0]})");
  CHECK(statusJson({{"round", 7, {}}, {"teams", List{"a\"b", "\n\\"}, {}}, {"x", List{Value(), HUGE_VAL, 0.5}, {}}}) ==
        R"({"teams":["a\"b","\n\\"],"status":{"round":7,"x":[null,null,0.5]}})");
  // A known name with a value of another type counts as unknown.
  CHECK(statusJson({{"score", 3, {}}, {"playMode", 5, {}}}) == R"({"status":{"score":3,"playMode":5}})");
  CHECK(statusJson({}) == "{}");
}

TEST_CASE("All nodes below /sys and /usr report in tree order, and the first entry of a name counts") {
  Reporters host;
  StatusReporters reporters;
  CHECK(reporters.read(host.kernel).empty());
  host.add("/usr/deep/down/game", {{"score", List{1, 2}, {}}, {"round", 3, {}}});
  auto& first = host.add("/sys/server/any", {{"round", 8, {}}, {"wind", 0.5, {}}});
  CHECK(statusText(reporters.read(host.kernel)) == ", round 8, wind 0.5, score 1:2");
  first.entries[0].value = 9;
  CHECK(statusText(reporters.read(host.kernel)) == ", round 9, wind 0.5, score 1:2");
  first.parent()->remove(first);
  CHECK(statusText(reporters.read(host.kernel)) == ", score 1:2, round 3");
}
