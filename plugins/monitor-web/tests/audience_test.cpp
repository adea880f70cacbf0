#include "../audience.h"

#include <catch2/catch.hpp>
#include <thread>

#include "frame_reader.h"
#include "spark/log.h"

using namespace spark;
using namespace spark::web;
using Catch::Contains;
using spark::web::test::FrameReader;
using std::chrono::milliseconds;

namespace {

/// A viewer whose messages arrive when the test says so.
class FakeViewer : public Viewer {
 public:
  explicit FakeViewer(std::uint64_t id) : Viewer(id, "test:" + std::to_string(id)) {}
  /// Takes one message that waits.
  void takeOne() {
    ++(leaving.binary() ? frames : texts);
    if (leaving.binary())
      lastFrame = *leaving.bytes;
    else
      said += *leaving.bytes + "\n";
    leaving.bytes.reset();
    sent();
  }
  void takeAll() {
    while (leaving.bytes) takeOne();
  }
  bool lastIsKey() const { return lastFrame.front() == 1; }
  int resumed = 0, frames = 0, texts = 0;
  std::string said, lastFrame, why;
  Message leaving;

 private:
  void transmit(const Message& message) override { leaving = message; }
  void hangUp(std::string_view reason) override { why = reason; }
  void resume() override { ++resumed; }
};

/// An audience with the simulation's side played by hand.
struct Theatre {
  Theatre() {
    log.setSink([](Level, std::string_view) {});
    scene = std::make_shared<SceneDescription>();
    scene->nodes.resize(3);
    scene->nodes[1].kind = FrameNode::Kind::mesh;
    scene->nodes[1].parent = 0;
    scene->nodes[1].load = "StdUnitBox";
  }
  std::shared_ptr<FakeViewer> enter() {
    auto viewer = std::make_shared<FakeViewer>(++ids);
    audience.arrived(viewer, now);
    return viewer;
  }
  /// Lets the audience want a frame, gives it one 40 ms later; false when none is wanted.
  bool frame() {
    now += milliseconds(40);
    audience.tick(now);
    Snapshot* s = exchange.wanted.exchange(nullptr);
    if (!s) return false;
    ++frames;
    s->shape = shape;
    s->time = 0.04 * frames;
    s->transforms.assign(2, Matrix::Identity());
    s->transforms[0](0, 3) = 0.01f * static_cast<float>(frames);
    s->visible = visible;
    s->environment.predicates.clear();
    s->environment.entries.clear();
    s->environment.put(EnvPolicy::full, "FieldLength", 30.0);
    s->environment.put(EnvPolicy::always, "time", 0.04 * frames);
    s->environment.put(EnvPolicy::change, "play_mode", mode);
    s->keys = {{}, {}, {1, static_cast<std::uint64_t>(mode)}};
    if (s->shape != s->knownShape && s->describe) s->scene = scene;
    s->events.clear();
    s->eventTimes.clear();
    if (foul) s->events.open("foul").add(std::exchange(foul, 0)).close(), s->eventTimes.push_back(s->time);
    exchange.ready.store(s);
    audience.collect(now);
    return true;
  }
  std::vector<Question> questions(Question::Kind kind) {
    std::vector<Question> out;
    for (Question& q : exchange.questions.takeAll())
      if (q.kind == kind) out.push_back(std::move(q));
    return out;
  }

  Exchange exchange;
  Log log;
  Audience audience{exchange, log, {"0123456789abcdef", 0.02, 25, 10}};
  Clock::time_point now = Clock::now();
  std::shared_ptr<SceneDescription> scene;
  std::vector<std::uint8_t> visible{1, 1, 1};
  std::uint64_t shape = 1, ids = 0;
  int frames = 0, mode = 0, foul = 0;
};

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("Nobody watches: the simulation is asked for nothing") {
  Theatre t;
  CHECK_FALSE(t.frame());
  CHECK_FALSE(t.exchange.watched);
  CHECK(t.exchange.questions.empty());
  auto viewer = t.enter();
  CHECK(t.exchange.watched);
  CHECK(t.frame());
  t.audience.left(*viewer);
  CHECK_FALSE(t.exchange.watched);
  CHECK_FALSE(t.frame());
}

TEST_CASE("A viewer gets hello, scene, environment, a key, then deltas") {
  Theatre t;
  auto viewer = t.enter();
  REQUIRE(t.frame());
  viewer->takeAll();
  CHECK_THAT(viewer->said, Catch::StartsWith("{\"type\":\"hello\",\"protocol\":1,"));
  CHECK(viewer->said.find("\"type\":\"scene\"") < viewer->said.find("\"full\":true"));
  CHECK_THAT(viewer->said, Contains("[\"FieldLength\",30]") && Contains("\"load\":\"StdUnitBox\""));
  FrameReader reader(2);
  CHECK(viewer->lastIsKey());
  reader.take(viewer->lastFrame);
  for (int i = 0; i < 10; ++i) {
    REQUIRE(t.frame());
    viewer->takeAll();
    CHECK_FALSE(viewer->lastIsKey());
    reader.take(viewer->lastFrame);
    CHECK(reader.time == Approx(0.04 * t.frames));
  }
  CHECK(count(viewer->said, "\"scene\"") == 1);
  CHECK(count(viewer->said, "\"play_mode\"") == 1);
  t.mode = 4;
  t.foul = 7;
  t.frame();
  viewer->takeAll();
  CHECK_THAT(viewer->said, Contains("[\"play_mode\",4]") && Contains("\"entry\":[\"foul\",7]"));
}

TEST_CASE("A viewer that lags misses frames, gets a key when it is back, and nobody else notices") {
  Theatre t;
  auto slow = t.enter(), quick = t.enter();
  t.frame();
  slow->takeAll(), quick->takeAll();
  FrameReader reader(2);
  reader.take(quick->lastFrame);
  for (int i = 0; i < 5; ++i) {
    t.frame();
    quick->takeAll();
    reader.take(quick->lastFrame);
    CHECK_FALSE(quick->lastIsKey());
  }
  slow->takeAll();
  CHECK(slow->frames == 2);
  t.frame();
  slow->takeAll();
  CHECK(slow->lastIsKey());
  quick->takeAll();
  reader.take(quick->lastFrame);
  FrameReader other(2);
  other.take(slow->lastFrame);
  CHECK(other.quantised == reader.quantised);
}

TEST_CASE("Viewers of one lane share the bytes") {
  Theatre t;
  auto a = t.enter(), b = t.enter();
  t.frame();
  a->takeAll(), b->takeAll();
  t.frame();
  while (!a->leaving.binary()) a->takeOne();
  while (!b->leaving.binary()) b->takeOne();
  CHECK(a->leaving.bytes == b->leaving.bytes);
}

TEST_CASE("Each viewer gets the rate and the detail that it asks for") {
  Theatre t;
  auto fast = t.enter(), slow = t.enter();
  t.audience.said(*slow, R"({"do":"view","rate":4.5,"detail":"coarse"})", t.now);
  for (int i = 0; i < 100; ++i) {
    t.frame();
    fast->takeAll(), slow->takeAll();
  }
  CHECK(fast->frames == 100);
  CHECK((slow->frames >= 19 && slow->frames <= 22));
  CHECK(int(fast->lastFrame[1]) == kFine.position);
  CHECK(int(slow->lastFrame[1]) == kCoarse.position);
}

TEST_CASE("Another scene goes out before its first frame, but not in every frame while it keeps changing") {
  Theatre t;
  auto viewer = t.enter();
  t.frame();
  viewer->takeAll();
  for (int i = 0; i < 50; ++i) {
    ++t.shape;
    t.frame();
    viewer->takeAll();
  }
  const int scenes = count(viewer->said, "\"type\":\"scene\"");
  CHECK((scenes >= 6 && scenes <= 10));
  for (int i = 0; i < 10; ++i) t.frame(), viewer->takeAll();
  CHECK(count(viewer->said, "\"type\":\"scene\"") <= scenes + 1);
  CHECK_FALSE(viewer->lastIsKey());
}

TEST_CASE("Who takes nothing for long is closed, and so is who lets too much pile up") {
  Theatre t;
  auto viewer = t.enter();
  t.frame();
  t.now = Clock::now() + std::chrono::seconds(11);
  t.audience.tick(t.now);
  CHECK_THAT(viewer->why, Contains("do not read"));
  auto other = t.enter();
  const std::string text(1 << 20, 'x');
  for (int i = 0; i < 20; ++i) other->sendText(text);
  CHECK_THAT(other->why, Contains("too much"));
}

TEST_CASE("Each viewer has one question with the simulation at a time, and is not read while many wait") {
  Theatre t;
  auto eager = t.enter(), other = t.enter();
  t.questions(Question::Kind::request);
  for (int i = 1; i <= 20; ++i)
    t.audience.said(*eager, R"({"do":"get","id":)" + std::to_string(i) + R"(,"path":"/"})", t.now);
  t.audience.said(*other, R"({"do":"plugins","id":1})", t.now);
  CHECK_FALSE(eager->mayRead());
  for (int i = 1; i <= 20; ++i) {
    const auto asked = t.questions(Question::Kind::request);
    REQUIRE(asked.size() == (i == 1 ? 2 : 1));
    CHECK(asked[0].id == i);
    t.exchange.answers.put({Answer::Kind::reply, asked[0].viewer, "{\"id\":" + std::to_string(i) + "}"});
    t.audience.collect(t.now);
  }
  eager->takeAll();
  CHECK(eager->mayRead());
  CHECK(eager->resumed > 0);
  CHECK_THAT(eager->said, Contains("{\"id\":20}"));
}

TEST_CASE("What several are told is one message for all of them, and nobody else's") {
  Theatre t;
  auto first = t.enter(), second = t.enter(), other = t.enter();
  for (auto& viewer : {first, second, other}) viewer->takeAll();
  t.exchange.answers.put({Answer::Kind::told, 0, "{\"type\":\"drawings\"}", {first->id(), 77, second->id()}});
  t.audience.collect(t.now);
  REQUIRE(first->leaving.bytes);
  CHECK(*first->leaving.bytes == "{\"type\":\"drawings\"}");
  CHECK(first->leaving.bytes == second->leaving.bytes);
  CHECK_FALSE(other->leaving.bytes);
}

TEST_CASE("Only who knows the token gives commands; who guesses is closed") {
  Theatre t;
  auto viewer = t.enter();
  t.questions(Question::Kind::command);
  const auto say = [&](const std::string& text) {
    t.audience.said(*viewer, text, t.now);
    viewer->takeAll();
  };
  say(R"~({"do":"command","id":1,"text":"(killsim)"})~");
  CHECK_THAT(viewer->said, Contains("only the referee"));
  CHECK(t.questions(Question::Kind::command).empty());
  for (const char* wrong : {"", "0123456789abcde", "0123456789abcdeF", "0123456789abcdef0"})
    say(std::string(R"({"do":"login","token":")") + wrong + "\"}");
  CHECK(viewer->why.empty());
  CHECK_FALSE(viewer->referee);
  say(R"({"do":"login","token":"0123456789abcdef"})");
  CHECK(viewer->referee);
  say(R"~({"do":"command","id":2,"text":"(kickOff Left)"})~");
  CHECK(t.questions(Question::Kind::command).size() == 1);
  auto guesser = t.enter();
  for (int i = 0; i < 5; ++i) t.audience.said(*guesser, R"({"do":"login","token":"x"})", t.now);
  CHECK_THAT(guesser->why, Contains("wrong tokens"));
}

TEST_CASE("How the host is doing is asked once a second, and for who asks when nobody watches") {
  Theatre t;
  std::string heard;
  t.audience.whenStatus(t.now, [&](const std::string& text) { heard = text; });
  t.audience.tick(t.now);
  REQUIRE(t.questions(Question::Kind::status).size() == 1);
  t.audience.tick(t.now);
  CHECK(t.questions(Question::Kind::status).empty());
  t.exchange.answers.put({Answer::Kind::status, 0, "{\"type\":\"status\"}"});
  t.audience.collect(t.now);
  CHECK(heard == "{\"type\":\"status\"}");
  // A host that does not answer: what was known last.
  heard.clear();
  t.audience.whenStatus(t.now + std::chrono::seconds(5), [&](const std::string& text) { heard = text; });
  t.audience.tick(t.now + std::chrono::seconds(5));
  CHECK(heard.empty());
  t.audience.tick(t.now + std::chrono::seconds(8));
  CHECK(heard == "{\"type\":\"status\"}");
}

TEST_CASE("A mailbox loses nothing and keeps each sender's order") {
  Mailbox<std::pair<int, int>> box;
  constexpr int kEach = 2000;
  std::vector<std::thread> senders;
  for (int s = 0; s < 3; ++s)
    senders.emplace_back([&box, s] {
      for (int i = 0; i < kEach; ++i) box.put({s, i});
    });
  int next[3] = {0, 0, 0}, got = 0;
  while (got < 3 * kEach)
    for (const auto& [sender, number] : box.takeAll()) {
      REQUIRE(number == next[sender]++);
      ++got;
    }
  for (auto& sender : senders) sender.join();
  CHECK(box.empty());
}
