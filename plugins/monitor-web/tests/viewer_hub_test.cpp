#include "../viewer_hub.h"

#include <catch2/catch.hpp>
#include <thread>

#include "absence.h"
#include "piece_reader.h"
#include "spark/log.h"

using namespace spark;
using namespace spark::web;
using Catch::Contains;
using spark::test::count;
using spark::web::test::FrameReader;
using spark::web::test::ReadPiece;
using std::chrono::milliseconds;

namespace {

/// A viewer whose transmissions the test completes.
class FakeViewer : public Viewer {
 public:
  explicit FakeViewer(std::uint64_t id) : Viewer(id, "test:" + std::to_string(id)) {}
  /// Completes the transmission of the current message.
  void takeOne() {
    ++(sending.binary() ? frames : texts);
    if (sending.isPast())
      lastPast = *sending.bytes;
    else if (sending.binary())
      lastFrame = *sending.bytes;
    else
      said += *sending.bytes + "\n";
    sending.bytes.reset();
    sent();
  }
  void takeAll() {
    while (sending.bytes) takeOne();
  }
  bool lastIsKey() const { return lastFrame.front() == 1; }
  int resumed = 0, frames = 0, texts = 0;
  std::string said, lastFrame, lastPast, why;
  Message sending;

 private:
  void transmit(const Message& message) override { sending = message; }
  void disconnect(std::string_view reason) override { why = reason; }
  void resume() override { ++resumed; }
};

/// A hub without a simulation; the test provides the frames.
struct HubFixture {
  explicit HubFixture(double history = 0)
      : hub(exchange, log, {"0123456789abcdef", 0.02, 25, 10, history, std::size_t{1} << 20}) {
    log.setSink([](Level, std::string_view) {});
    scene = std::make_shared<SceneDescription>();
    scene->nodes.resize(3);
    scene->nodes[1].kind = FrameNode::Kind::mesh;
    scene->nodes[1].parent = 0;
    scene->nodes[1].load = "StdUnitBox";
  }
  std::shared_ptr<FakeViewer> enter() {
    auto viewer = std::make_shared<FakeViewer>(++ids);
    hub.onConnect(viewer, now);
    return viewer;
  }
  /// 40 ms later: a frame for the hub; false if it requests none.
  bool frame() {
    now += milliseconds(40);
    hub.tick(now);
    SnapshotBatch* batch = exchange.wanted;
    if (!batch) return false;
    Snapshot* s = &batch->snapshots[batch->filled++];
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
    if (s->shape != batch->knownShape && batch->describe) s->scene = scene;
    s->events.clear();
    s->eventTimes.clear();
    if (foul) s->events.open("foul").add(std::exchange(foul, 0)).close(), s->eventTimes.push_back(s->time);
    exchange.filled();
    hub.collect(now);
    return true;
  }
  std::vector<SimulationRequest> requests(SimulationRequest::Kind kind) {
    std::vector<SimulationRequest> out;
    for (SimulationRequest& q : exchange.requests.takeAll())
      if (q.kind == kind) out.push_back(std::move(q));
    return out;
  }

  Exchange exchange;
  Log log;
  ViewerHub hub;
  Clock::time_point now = Clock::now();
  std::shared_ptr<SceneDescription> scene;
  std::vector<std::uint8_t> visible{1, 1, 1};
  std::uint64_t shape = 1, ids = 0;
  int frames = 0, mode = 0, foul = 0;
};

}  // namespace

TEST_CASE("Without viewers nothing is requested from the simulation") {
  HubFixture t;
  CHECK_FALSE(t.frame());
  CHECK_FALSE(t.exchange.watched);
  CHECK(t.exchange.requests.empty());
  auto viewer = t.enter();
  CHECK(t.exchange.watched);
  CHECK(t.frame());
  t.hub.onDisconnect(*viewer);
  CHECK_FALSE(t.exchange.watched);
  CHECK_FALSE(t.frame());
}

TEST_CASE("A viewer gets hello, scene, environment, a key frame, then deltas") {
  HubFixture t;
  auto viewer = t.enter();
  REQUIRE(t.frame());
  viewer->takeAll();
  CHECK_THAT(viewer->said, Catch::StartsWith("{\"type\":\"hello\",\"protocol\":2,"));
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

TEST_CASE("A viewer that lags skips frames and resumes with a key frame, and the others get all frames") {
  HubFixture t;
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

TEST_CASE("Viewers of one lane share the message buffers") {
  HubFixture t;
  auto a = t.enter(), b = t.enter();
  t.frame();
  a->takeAll(), b->takeAll();
  t.frame();
  while (!a->sending.binary()) a->takeOne();
  while (!b->sending.binary()) b->takeOne();
  CHECK(a->sending.bytes == b->sending.bytes);
}

TEST_CASE("Each viewer gets the rate and the detail that it requests") {
  HubFixture t;
  auto fast = t.enter(), slow = t.enter();
  t.hub.onMessage(*slow, R"({"do":"view","rate":4.5,"detail":"coarse"})", t.now);
  for (int i = 0; i < 100; ++i) {
    t.frame();
    fast->takeAll(), slow->takeAll();
  }
  CHECK(fast->frames == 100);
  CHECK((slow->frames >= 19 && slow->frames <= 22));
  CHECK(int(fast->lastFrame[1]) == kFine.position);
  CHECK(int(slow->lastFrame[1]) == kCoarse.position);
}

TEST_CASE("A new scene is sent before its first frame, but not in every frame while it keeps changing") {
  HubFixture t;
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

TEST_CASE("A viewer that reads nothing for a long time or has too long a queue is disconnected") {
  HubFixture t;
  auto viewer = t.enter();
  t.frame();
  t.now = Clock::now() + std::chrono::seconds(11);
  t.hub.tick(t.now);
  CHECK_THAT(viewer->why, Contains("do not read"));
  auto other = t.enter();
  const std::string text(1 << 20, 'x');
  for (int i = 0; i < 20; ++i) other->sendText(text);
  CHECK_THAT(other->why, Contains("too much"));
}

TEST_CASE("Each viewer has one pending request in the simulation, and is not read while it has many in the queue") {
  HubFixture t;
  auto eager = t.enter(), other = t.enter();
  t.requests(SimulationRequest::Kind::control);
  for (int i = 1; i <= 20; ++i)
    t.hub.onMessage(*eager, R"({"do":"get","id":)" + std::to_string(i) + R"(,"path":"/"})", t.now);
  t.hub.onMessage(*other, R"({"do":"plugins","id":1})", t.now);
  CHECK_FALSE(eager->mayRead());
  for (int i = 1; i <= 20; ++i) {
    const auto asked = t.requests(SimulationRequest::Kind::control);
    REQUIRE(asked.size() == (i == 1 ? 2 : 1));
    CHECK(asked[0].id == i);
    t.exchange.replies.put({SimulationReply::Kind::reply, asked[0].viewer, "{\"id\":" + std::to_string(i) + "}"});
    t.hub.collect(t.now);
  }
  eager->takeAll();
  CHECK(eager->mayRead());
  CHECK(eager->resumed > 0);
  CHECK_THAT(eager->said, Contains("{\"id\":20}"));
}

TEST_CASE("An update for several viewers is one message shared by them, and other viewers do not get it") {
  HubFixture t;
  auto first = t.enter(), second = t.enter(), other = t.enter();
  for (auto& viewer : {first, second, other}) viewer->takeAll();
  t.exchange.replies.put(
      {SimulationReply::Kind::update, 0, "{\"type\":\"drawings\"}", {first->id(), 77, second->id()}});
  t.hub.collect(t.now);
  REQUIRE(first->sending.bytes);
  CHECK(*first->sending.bytes == "{\"type\":\"drawings\"}");
  CHECK(first->sending.bytes == second->sending.bytes);
  CHECK_FALSE(other->sending.bytes);
}

TEST_CASE("Only a viewer with the token may give commands, and one that guesses tokens is disconnected") {
  HubFixture t;
  auto viewer = t.enter();
  t.requests(SimulationRequest::Kind::command);
  const auto say = [&](const std::string& text) {
    t.hub.onMessage(*viewer, text, t.now);
    viewer->takeAll();
  };
  say(R"~({"do":"command","id":1,"text":"(killsim)"})~");
  CHECK_THAT(viewer->said, Contains("only the referee"));
  CHECK(t.requests(SimulationRequest::Kind::command).empty());
  for (const char* wrong : {"", "0123456789abcde", "0123456789abcdeF", "0123456789abcdef0"})
    say(std::string(R"({"do":"login","token":")") + wrong + "\"}");
  CHECK(viewer->why.empty());
  CHECK_FALSE(viewer->referee);
  say(R"({"do":"login","token":"0123456789abcdef"})");
  CHECK(viewer->referee);
  say(R"~({"do":"command","id":2,"text":"(kickOff Left)"})~");
  CHECK(t.requests(SimulationRequest::Kind::command).size() == 1);
  auto guesser = t.enter();
  for (int i = 0; i < 5; ++i) t.hub.onMessage(*guesser, R"({"do":"login","token":"x"})", t.now);
  CHECK_THAT(guesser->why, Contains("wrong tokens"));
}

TEST_CASE("With a history, frames are requested by simulated time, several at once, also without viewers") {
  HubFixture t(60);
  CHECK(t.exchange.watched);
  t.hub.tick(t.now);
  REQUIRE(t.exchange.wanted.load() != nullptr);
  CHECK(t.exchange.wanted.load()->due < 0);
  REQUIRE(t.frame());  // a new scene
  t.hub.tick(t.now);
  SnapshotBatch* batch = t.exchange.wanted;
  REQUIRE(batch != nullptr);
  CHECK(batch->due == Approx(0.12));
  CHECK(batch->interval == Approx(0.08).epsilon(1e-4));
  for (std::size_t i = 1; i < batch->snapshots.size(); ++i) {
    REQUIRE(t.frame());
    CHECK(t.exchange.wanted.load() == batch);
    CHECK(batch->filled == i);
  }
  REQUIRE(t.frame());
  CHECK(t.exchange.wanted.load() == nullptr);
  t.hub.tick(t.now);
  CHECK_FALSE(t.exchange.wantsNow());
  CHECK(batch->filled == 0);
  CHECK(batch->due == Approx(0.04 + 0.08 * 4 + 0.08));
  auto viewer = t.enter();
  t.hub.tick(t.now);
  CHECK(t.exchange.wantsNow());
  t.hub.onDisconnect(*viewer);
  CHECK(t.exchange.watched);
}

TEST_CASE("A viewer that comes gets the newest frame, and every event that has not been handed over") {
  HubFixture t(60);
  REQUIRE(t.frame());
  for (int i = 1; i <= 3; ++i) {
    t.foul = i;
    REQUIRE(t.frame());
  }
  auto viewer = t.enter();
  REQUIRE(t.frame());
  viewer->takeAll();
  CHECK(count(viewer->said, "foul") == 3);
  CHECK(viewer->frames == 1);
  FrameReader reader(2);
  reader.take(viewer->lastFrame);
  CHECK(reader.time == Approx(0.2));
}

TEST_CASE("A viewer gets any piece of the past, its scene, and an outline") {
  HubFixture t(60);
  for (int i = 0; i < 299; ++i) REQUIRE(t.frame());
  t.mode = 4;
  t.frame();
  auto viewer = t.enter();
  viewer->takeAll();
  t.frame();
  const auto ask = [&](const std::string& message) {
    viewer->said.clear();
    viewer->lastPast.clear();
    t.hub.onMessage(*viewer, message, t.now);
    viewer->takeAll();
  };
  viewer->takeAll();
  CHECK_THAT(viewer->said, Contains("\"history\":60"));
  ask(R"({"do":"history","id":5,"at":3.5})");
  CHECK_THAT(viewer->said, Contains(R"({"type":"answer","id":5,"ok":true,"from":0.04,"to":12.04})"));
  const ReadPiece piece(viewer->lastPast);
  CHECK((piece.from <= 3.5 && piece.to > 3.5));
  FrameReader reader(2);
  for (const std::string& frame : piece.frames) reader.take(frame);
  ask(R"({"do":"history","id":6,"scene":)" + std::to_string(piece.shape) + "}");
  CHECK_THAT(ReadPiece(viewer->lastPast).texts.at(0), Contains("StdUnitBox"));
  ask(R"({"do":"history","id":7})");
  CHECK_THAT(viewer->lastPast, Contains(R"("messages":[{"type":"environment","time":0.04,"full":true)") &&
                                   Contains(R"(["play_mode",4])"));
  ask(R"({"do":"history","id":8,"scene":77})");
  CHECK_THAT(viewer->said, Contains(R"("id":8,"ok":false)"));
  HubFixture without;
  auto other = without.enter();
  without.hub.onMessage(*other, R"({"do":"history","id":1,"at":0})", without.now);
  other->takeAll();
  CHECK_THAT(other->said, Contains("keeps no history"));
}

TEST_CASE("A viewer that asks for the past again and again has one message of it in its queue, and is closed") {
  HubFixture t(60);
  for (int i = 0; i < 300; ++i) REQUIRE(t.frame());
  auto greedy = t.enter(), other = t.enter();
  greedy->takeAll(), other->takeAll();
  t.hub.onMessage(*greedy, R"({"do":"history","id":1,"at":3})", t.now);
  CHECK_FALSE(greedy->mayRead());  // the transport reads nothing now
  greedy->takeAll();
  CHECK(greedy->mayRead());
  t.hub.onMessage(*greedy, R"({"do":"history","id":2})", t.now);
  CHECK_FALSE(greedy->mayRead());
  greedy->takeAll();
  int answered = 0;
  for (; greedy->why.empty() && answered < 1000; ++answered) {
    t.hub.onMessage(*greedy, R"({"do":"history","id":1,"at":1e300})", t.now);
    greedy->takeAll();
  }
  CHECK_THAT(greedy->why, Contains("too many"));
  CHECK((answered > 20 && answered < 50));
  // Who asks fifteen times a second, as the page does, is never closed; and frames go on for all.
  for (int i = 0; i < 600; ++i) {
    REQUIRE(t.frame());
    if (i % 2 == 0) t.hub.onMessage(*other, R"({"do":"history","id":1,"at":5})", t.now);
    other->takeAll();
  }
  CHECK(other->why.empty());
  CHECK(other->frames > 550);
}

TEST_CASE("The status is requested once a second, and without viewers when a page requests it") {
  HubFixture t;
  std::string heard;
  t.hub.requestStatus(t.now, [&](const std::string& text) { heard = text; });
  t.hub.tick(t.now);
  REQUIRE(t.requests(SimulationRequest::Kind::status).size() == 1);
  t.hub.tick(t.now);
  CHECK(t.requests(SimulationRequest::Kind::status).empty());
  t.exchange.replies.put({SimulationReply::Kind::status, 0, "{\"type\":\"status\"}"});
  t.hub.collect(t.now);
  CHECK(heard == "{\"type\":\"status\"}");
  // If the host does not answer, the last known status is sent.
  heard.clear();
  t.now = Clock::now() + std::chrono::seconds(5);
  t.hub.requestStatus(t.now, [&](const std::string& text) { heard = text; });
  t.hub.tick(t.now);
  CHECK(heard.empty());
  t.hub.tick(t.now + std::chrono::seconds(3));
  CHECK(heard == "{\"type\":\"status\"}");
}

TEST_CASE("A mailbox loses no message and keeps the order of each sender") {
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
