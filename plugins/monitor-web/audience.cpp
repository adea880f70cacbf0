#include "audience.h"

#include <algorithm>
#include <array>

#include "referee.h"
#include "spark/error.h"
#include "spark/log.h"

namespace spark::web {

namespace {
using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Few rates, so that there are few lanes.
constexpr std::array<double, 7> kRates{1, 2, 5, 10, 20, 25, 50};
constexpr double kAllowance = 400, kAllowanceRate = 200;  // messages a viewer may send at once, and a second
constexpr auto kSceneApart = milliseconds(250);  // while a scene keeps changing it is described so often at most

constexpr auto kAlwaysApart = milliseconds(100);  // the time of play is told so often at most
constexpr auto kStatusPatience = seconds(2);

double nearestRate(double rate) {
  return *std::min_element(kRates.begin(), kRates.end(),
                           [rate](double a, double b) { return std::abs(a - rate) < std::abs(b - rate); });
}

Clock::duration periodOf(double rate) { return duration_cast<Clock::duration>(duration<double>(1 / rate)); }
// So much earlier than due is in time: frames come when the simulation makes them.
Clock::duration toleranceOf(double rate) { return periodOf(rate) / 4; }
}  // namespace

Audience::Audience(Exchange& exchange, Log& log, AudienceSettings settings)
    : exchange_(exchange), log_(log), settings_(std::move(settings)) {}

Audience::~Audience() { dismiss(); }

void Audience::dismiss() {
  viewers_.clear();
  statusWaiters_.clear();
  exchange_.watched.store(false);
  exchange_.wanted.store(nullptr);
  exchange_.ready.store(nullptr);
}

Viewer* Audience::find(std::uint64_t id) {
  const auto at = viewers_.find(id);
  return at == viewers_.end() ? nullptr : at->second.get();
}

// ---- who is there ----

std::size_t Audience::laneFor(double rate, bool fine) {
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    if (lanes_[i].rate == rate && lanes_[i].fine == fine) return i;
  lanes_.push_back({rate, fine, StreamEncoder(fine ? kFine : kCoarse)});
  return lanes_.size() - 1;
}

void Audience::enter(Viewer& viewer, double rate, bool fine) {
  viewer.lane = laneFor(nearestRate(rate), fine);
  viewer.needsKey = true;
  ++lanes_[viewer.lane].viewers;
}

void Audience::arrived(const std::shared_ptr<Viewer>& viewer, Clock::time_point now) {
  viewers_[viewer->id()] = viewer;
  viewer->allowance = kAllowance;
  viewer->allowanceAt = now;
  enter(*viewer, settings_.rate, true);
  exchange_.watched.store(true, std::memory_order_relaxed);
  viewer->sendText(helloMessage(settings_.step, settings_.rate));
  if (!status_.empty()) viewer->sendText(status_);
  if (now - statusAt_ > seconds(1)) statusDue_ = now;
}

void Audience::left(Viewer& viewer) {
  --lanes_[viewer.lane].viewers;
  exchange_.questions.put({Question::Kind::gone, viewer.id()});
  viewers_.erase(viewer.id());
  if (viewers_.empty()) exchange_.watched.store(false, std::memory_order_relaxed);
}

// ---- what they say ----

bool Audience::allowed(Viewer& viewer, Clock::time_point now) {
  const double passed = duration<double>(now - viewer.allowanceAt).count();
  viewer.allowanceAt = now;
  viewer.allowance = std::min(kAllowance, viewer.allowance + passed * kAllowanceRate) - 1;
  return viewer.allowance >= 0;
}

void Audience::said(Viewer& viewer, std::string_view text, Clock::time_point now) {
  if (viewer.closing()) return;
  if (!allowed(viewer, now)) return viewer.close("too many messages");
  try {
    act(viewer, readViewerMessage(text));
  } catch (const Error& e) {
    viewer.sendText(reply("answer", 0, failure(e.what())));
  }
}

void Audience::act(Viewer& viewer, ViewerMessage message) {
  using What = ViewerMessage::What;
  switch (message.what) {
    case What::view: {
      Lane& before = lanes_[viewer.lane];
      --before.viewers;
      return enter(viewer, message.rate > 0 ? message.rate : before.rate, message.fine.value_or(before.fine));
    }
    case What::drawings:
      viewer.wantsDrawings = message.on;
      return exchange_.questions.put({Question::Kind::drawings, viewer.id(), 0, {}, false, message.on});
    case What::login:
      return login(viewer, message.text);
    case What::unwatch:
      return exchange_.questions.put({Question::Kind::unwatch, viewer.id(), message.id});
    case What::command:
      if (!viewer.referee)
        return viewer.sendText(
            reply("answer", message.id, failure("only the referee gives commands: open the referee's link")));
      return ask(viewer, {Question::Kind::command, viewer.id(), message.id, std::move(message.text), true});
    case What::request:
      return ask(viewer, {Question::Kind::request, viewer.id(), message.id, std::move(message.text), viewer.referee});
  }
}

void Audience::login(Viewer& viewer, std::string_view token) {
  if (isToken(settings_.token, token)) {
    viewer.referee = true;
    log_.info("Web: {} is a referee.", viewer.peer());
    return viewer.sendText("{\"type\":\"referee\",\"ok\":true}");
  }
  log_.warning("Web: {} gave a wrong referee's token.", viewer.peer());
  if (++viewer.wrongTokens >= kMostWrongTokens) return viewer.close("too many wrong tokens");
  viewer.sendText("{\"type\":\"referee\",\"ok\":false,\"error\":\"this is not the token that the host printed\"}");
}

/// One question of each viewer is with the simulation's thread at a time: they get their turns whoever asks most.
void Audience::ask(Viewer& viewer, Question question) {
  viewer.asked.push_back(std::move(question));
  if (viewer.asked.size() == 1) exchange_.questions.put(viewer.asked.front());
}

// ---- what the simulation's thread hands over ----

void Audience::collect(Clock::time_point now) {
  if (exchange_.ready.exchange(nullptr, std::memory_order_acquire)) {
    away_ = false;
    takeSnapshot(now);
  }
  if (!exchange_.answers.empty()) takeAnswers();
}

void Audience::takeAnswers() {
  for (Answer& answer : exchange_.answers.takeAll()) {
    if (answer.kind == Answer::Kind::status) {
      takeStatus(std::move(answer.text));
      continue;
    }
    if (!answer.viewers.empty()) {
      tellSome(std::move(answer));
      continue;
    }
    Viewer* viewer = find(answer.viewer);
    if (!viewer) continue;
    if (!answer.text.empty()) viewer->sendText(std::move(answer.text));
    if (answer.kind != Answer::Kind::reply || viewer->asked.empty()) continue;
    viewer->asked.pop_front();
    if (!viewer->asked.empty()) exchange_.questions.put(viewer->asked.front());
    viewer->resume();
  }
}

void Audience::takeStatus(std::string text) {
  statusAsked_ = false;
  status_ = std::move(text);
  statusAt_ = Clock::now();
  broadcast(status_);
  for (auto& [hear, since] : std::exchange(statusWaiters_, {})) hear(status_);
}

void Audience::whenStatus(Clock::time_point now, std::function<void(const std::string&)> hear) {
  if (!status_.empty() && now - statusAt_ < seconds(1)) return hear(status_);
  statusWaiters_.emplace_back(std::move(hear), now);
}

void Audience::broadcast(std::string text) {
  const Message message{Message::Kind::text, std::make_shared<const std::string>(std::move(text))};
  for (const auto& [id, viewer] : viewers_) viewer->send(message);
}

void Audience::tellSome(Answer answer) {
  const Message message{Message::Kind::text, std::make_shared<const std::string>(std::move(answer.text))};
  for (const std::uint64_t id : answer.viewers)
    if (Viewer* viewer = find(id)) viewer->send(message);
}

void Audience::takeSnapshot(Clock::time_point now) {
  if (snapshot_.scene) takeScene(now);
  tellEnvironment(now);
  if (snapshot_.shape != shape_) return;  // the scene changes faster than it is described
  noteFlickers();
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    Lane& lane = lanes_[i];
    if (lane.viewers > 0 && now >= lane.due - toleranceOf(lane.rate)) sendLane(i, now);
  }
}

void Audience::takeScene(Clock::time_point now) {
  shape_ = snapshot_.shape;
  scene_ = std::make_shared<const std::string>(sceneMessage(snapshot_, ++shapeNumber_));
  sceneAt_ = now;
  snapshot_.scene.reset();
  visible_ = snapshot_.visible;
  flickers_.clear();
}

void Audience::noteFlickers() {
  for (std::uint32_t i = 0; i < visible_.size(); ++i)
    if (visible_[i] != snapshot_.visible[i] && std::find(flickers_.begin(), flickers_.end(), i) == flickers_.end())
      flickers_.push_back(i);
}

void Audience::tellEnvironment(Clock::time_point now) {
  const bool always = now >= alwaysDue_;
  if (always) alwaysDue_ = now + kAlwaysApart;
  if (std::string changed = diary_.take(snapshot_, always); !changed.empty()) {
    const Message message{Message::Kind::text, std::make_shared<const std::string>(std::move(changed))};
    for (const auto& [id, viewer] : viewers_)
      if (viewer->shape != 0) viewer->send(message);  // others get it all with their scene
  }
  std::size_t i = 0;
  for (const Element event : snapshot_.events) broadcast(eventMessage(snapshot_.eventTimes[i++], event));
}

void Audience::sendLane(std::size_t index, Clock::time_point now) {
  Lane& lane = lanes_[index];
  const Clock::duration period = periodOf(lane.rate);
  lane.due = std::max(lane.due + period, now + period / 2);
  lane.encoder.advance({shapeNumber_, snapshot_.time, snapshot_.transforms, snapshot_.visible, flickers_});
  lane.key.reset();
  lane.delta.reset();
  for (const auto& [id, viewer] : viewers_)
    if (viewer->lane == index) sendFrame(*viewer, lane);
}

void Audience::sendFrame(Viewer& viewer, Lane& lane) {
  if (viewer.lags()) {  // it has not taken the last one
    viewer.needsKey = true;
    return;
  }
  if (viewer.shape != shape_) sendScene(viewer);
  const bool key = viewer.needsKey || !lane.encoder.hasDelta();
  auto& bytes = key ? lane.key : lane.delta;
  if (!bytes) bytes = std::make_shared<const std::string>(key ? lane.encoder.key() : lane.encoder.delta());
  viewer.needsKey = false;
  viewer.send({Message::Kind::frame, bytes});
}

void Audience::sendScene(Viewer& viewer) {
  viewer.send({Message::Kind::scene, scene_});
  if (viewer.shape == 0) viewer.sendText(fullEnvironmentMessage(snapshot_));
  viewer.shape = shape_;
  viewer.needsKey = true;
}

// ---- the clock ----

Clock::time_point Audience::wantSnapshot(Clock::time_point now) {
  if (away_ || viewers_.empty()) return Clock::time_point::max();
  Clock::time_point first = Clock::time_point::max();
  for (const Lane& lane : lanes_)
    if (lane.viewers > 0) first = std::min(first, lane.due - toleranceOf(lane.rate));
  if (first > now) return first;
  snapshot_.knownShape = shape_;
  snapshot_.describe = now - sceneAt_ >= kSceneApart;
  away_ = true;
  exchange_.wanted.store(&snapshot_, std::memory_order_release);
  return Clock::time_point::max();
}

/// A host that is busy otherwise does not answer: who waits is told what was known last.
void Audience::giveUpOnStatus(Clock::time_point now) {
  if (statusWaiters_.empty() || now - statusWaiters_.front().second < kStatusPatience) return;
  for (auto& [hear, since] : std::exchange(statusWaiters_, {})) hear(status_.empty() ? "{}" : status_);
}

Clock::time_point Audience::tick(Clock::time_point now) {
  const bool statusWanted = !viewers_.empty() || !statusWaiters_.empty();
  if (statusWaiters_.empty() && viewers_.empty()) statusDue_ = now;
  if (statusWanted && !statusAsked_ && now >= statusDue_) {
    statusAsked_ = true;
    statusDue_ = now + seconds(1);
    exchange_.questions.put({Question::Kind::status});
  }
  if (now >= stallsDue_) {
    stallsDue_ = now + seconds(1);
    giveUpOnStatus(now);
    for (const auto& [id, viewer] : viewers_)
      if (now - viewer->leavingSince(now) > duration<double>(settings_.stallTimeout))
        viewer->close("you do not read what you are sent");
  }
  const Clock::time_point frame = wantSnapshot(now);
  return std::min({frame, statusWanted && !statusAsked_ ? statusDue_ : stallsDue_, stallsDue_});
}

}  // namespace spark::web
