#include "viewer_hub.h"

#include <algorithm>
#include <array>

#include "api/credentials.h"
#include "spark/error.h"
#include "spark/log.h"

namespace spark::web {

namespace {
using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;
using std::chrono::seconds;

// The choice of rates is small, which bounds the number of lanes and so of encodings of a frame.
constexpr int kMaxWrongTokens = 5;  // after which a viewer is disconnected
constexpr std::array<double, 7> kRates{1, 2, 5, 10, 20, 25, 50};

// Token bucket of each viewer's messages.
constexpr double kMessageBurst = 400, kMessagesPerSecond = 200;
constexpr double kHistoryCost = 9;  // a request for the past counts as ten messages

constexpr std::size_t kMaxOutlineBytes = 256u << 10;

constexpr auto kMinSceneInterval = milliseconds(250);   // between scene messages while the scene keeps changing
constexpr auto kMinAlwaysInterval = milliseconds(100);  // between values of an `always` entry, such as the game time
constexpr auto kStatusInterval = seconds(1);
constexpr auto kStatusTimeout = seconds(2);
constexpr auto kStallCheckInterval = seconds(1);

double nearestRate(double rate) {
  return *std::min_element(kRates.begin(), kRates.end(),
                           [rate](double a, double b) { return std::abs(a - rate) < std::abs(b - rate); });
}

Clock::duration periodOf(double rate) { return duration_cast<Clock::duration>(duration<double>(1 / rate)); }

/// A frame that comes at most this long before a lane is due counts for it: the simulation, not the lane's clock,
/// determines when frames come.
Clock::duration toleranceOf(double rate) { return periodOf(rate) / 4; }

Message textMessage(std::string text) {
  return {Message::Kind::text, std::make_shared<const std::string>(std::move(text))};
}
}  // namespace

ViewerHub::ViewerHub(Exchange& exchange, Log& log, ViewerHubSettings settings)
    : exchange_(exchange), log_(log), settings_(std::move(settings)) {
  if (settings_.history > 0) history_.emplace(settings_.history, settings_.historyBytes);
  exchange_.watched.store(keepsHistory());
}

ViewerHub::~ViewerHub() { clear(); }

void ViewerHub::clear() {
  viewers_.clear();
  statusWaiters_.clear();
  exchange_.watched.store(false);
  exchange_.wanted.store(nullptr);
  exchange_.ready.store(nullptr);
}

Viewer* ViewerHub::find(std::uint64_t id) {
  const auto at = viewers_.find(id);
  return at == viewers_.end() ? nullptr : at->second.get();
}

// ---- viewers and lanes ----

std::size_t ViewerHub::laneFor(double rate, bool fine) {
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    if (lanes_[i].rate == rate && lanes_[i].fine == fine) return i;
  lanes_.push_back({rate, fine, StreamEncoder(fine ? kFine : kCoarse)});
  return lanes_.size() - 1;
}

void ViewerHub::enterLane(Viewer& viewer, double rate, bool fine) {
  viewer.lane = laneFor(nearestRate(rate), fine);
  viewer.needsKey = true;
  ++lanes_[viewer.lane].viewers;
}

void ViewerHub::onConnect(const std::shared_ptr<Viewer>& viewer, Clock::time_point now) {
  viewers_[viewer->id()] = viewer;
  viewer->messageBudget = kMessageBurst;
  viewer->budgetUpdatedAt = now;
  enterLane(*viewer, settings_.rate, true);
  exchange_.watched.store(true, std::memory_order_relaxed);
  viewer->sendText(helloMessage(settings_.step, settings_.rate, settings_.history));
  if (!status_.empty()) viewer->sendText(status_);
  if (now - statusAt_ > kStatusInterval) statusDue_ = now;
}

void ViewerHub::onDisconnect(Viewer& viewer) {
  --lanes_[viewer.lane].viewers;
  exchange_.requests.put({SimulationRequest::Kind::disconnect, viewer.id()});
  viewers_.erase(viewer.id());
  if (viewers_.empty()) exchange_.watched.store(keepsHistory(), std::memory_order_relaxed);
}

// ---- messages from viewers ----

bool ViewerHub::charge(Viewer& viewer, Clock::time_point now) {
  const double elapsed = duration<double>(now - viewer.budgetUpdatedAt).count();
  viewer.budgetUpdatedAt = now;
  viewer.messageBudget = std::min(kMessageBurst, viewer.messageBudget + elapsed * kMessagesPerSecond) - 1;
  return viewer.messageBudget >= 0;
}

void ViewerHub::onMessage(Viewer& viewer, std::string_view text, Clock::time_point now) {
  if (viewer.closing()) return;
  if (!charge(viewer, now)) return viewer.close("too many messages");
  try {
    handle(viewer, readViewerMessage(text));
  } catch (const Error& e) {
    viewer.sendText(reply("answer", 0, failure(e.what())));
  }
}

void ViewerHub::handle(Viewer& viewer, ViewerMessage message) {
  using What = ViewerMessage::What;
  using Kind = SimulationRequest::Kind;
  switch (message.what) {
    case What::view: {
      Lane& before = lanes_[viewer.lane];
      --before.viewers;
      return enterLane(viewer, message.rate > 0 ? message.rate : before.rate, message.fine.value_or(before.fine));
    }
    case What::drawings:
      viewer.wantsDrawings = message.on;
      return exchange_.requests.put({Kind::drawings, viewer.id(), 0, {}, false, message.on});
    case What::login:
      return login(viewer, message.text);
    case What::history:
      return sendPast(viewer, message);
    case What::unwatch:
      return exchange_.requests.put({Kind::unwatch, viewer.id(), message.id});
    case What::command:
      if (!viewer.referee)
        return viewer.sendText(
            reply("answer", message.id, failure("only the referee gives commands: open the referee's link")));
      return enqueue(viewer, {Kind::command, viewer.id(), message.id, std::move(message.text), true});
    case What::request:
      return enqueue(viewer, {Kind::control, viewer.id(), message.id, std::move(message.text), viewer.referee});
  }
}

void ViewerHub::login(Viewer& viewer, std::string_view token) {
  if (isToken(settings_.token, token)) {
    viewer.referee = true;
    log_.info("Web: {} is a referee.", viewer.peer());
    return viewer.sendText("{\"type\":\"referee\",\"ok\":true}");
  }
  log_.warning("Web: {} gave a wrong referee's token.", viewer.peer());
  if (++viewer.wrongTokens >= kMaxWrongTokens) return viewer.close("too many wrong tokens");
  viewer.sendText("{\"type\":\"referee\",\"ok\":false,\"error\":\"this is not the token that the host printed\"}");
}

// ---- the past ----

/// Answers with a message and, for a piece or a scene, a binary one behind it. Until they are sent nothing more is read
/// from this viewer.
void ViewerHub::sendPast(Viewer& viewer, const ViewerMessage& message) {
  viewer.messageBudget -= kHistoryCost;
  if (viewer.messageBudget < 0) return viewer.close("too many messages");
  if (!keepsHistory()) return viewer.sendText(reply("answer", message.id, failure("this host keeps no history")));
  if (!message.at && !message.scene) return sendOutline(viewer, message.id);
  const auto bytes = message.at ? history_->pieceAt(*message.at) : history_->scene(*message.scene);
  if (!bytes) return viewer.sendText(reply("answer", message.id, failure("this is not in the history")));
  viewer.sendText(reply("answer", message.id,
                        fmt::format(R"({{"ok":true,"from":{:.9g},"to":{:.9g}}})", history_->from(), history_->to())));
  viewer.send({Message::Kind::piece, bytes});
}

void ViewerHub::sendOutline(Viewer& viewer, std::int64_t id) {
  std::string text = reply("answer", id,
                           fmt::format(R"({{"ok":true,"from":{:.9g},"to":{:.9g},"messages":{}}})", history_->from(),
                                       history_->to(), history_->outline(kMaxOutlineBytes)));
  viewer.send({Message::Kind::outline, std::make_shared<const std::string>(std::move(text))});
}

/// Each viewer has one request at a time with the simulation thread, so a viewer that sends many does not delay others.
void ViewerHub::enqueue(Viewer& viewer, SimulationRequest request) {
  viewer.pending.push_back(std::move(request));
  if (viewer.pending.size() == 1) exchange_.requests.put(viewer.pending.front());
}

// ---- data from the simulation thread ----

void ViewerHub::collect(Clock::time_point now) {
  if (exchange_.ready.exchange(nullptr, std::memory_order_acquire)) {
    batchLent_ = false;
    takeBatch(now);
  }
  if (!exchange_.replies.empty()) takeReplies();
}

void ViewerHub::takeReplies() {
  using Kind = SimulationReply::Kind;
  for (SimulationReply& reply : exchange_.replies.takeAll()) {
    if (reply.kind == Kind::status) {
      takeStatus(std::move(reply.text));
    } else if (!reply.viewers.empty()) {
      multicast(std::move(reply));
    } else if (Viewer* viewer = find(reply.viewer)) {  // nullptr: it has disconnected
      if (!reply.text.empty()) viewer->sendText(std::move(reply.text));
      if (reply.kind == Kind::reply && !viewer->pending.empty()) completeRequest(*viewer);
    }
  }
}

void ViewerHub::completeRequest(Viewer& viewer) {
  viewer.pending.pop_front();
  if (!viewer.pending.empty()) exchange_.requests.put(viewer.pending.front());
  viewer.resume();
}

void ViewerHub::takeStatus(std::string text) {
  statusRequested_ = false;
  status_ = std::move(text);
  statusAt_ = Clock::now();
  broadcast(status_);
  for (auto& waiter : std::exchange(statusWaiters_, {})) waiter.callback(status_);
}

void ViewerHub::requestStatus(Clock::time_point now, StatusCallback callback) {
  if (!status_.empty() && now - statusAt_ < kStatusInterval) return callback(status_);
  statusWaiters_.push_back({std::move(callback), now});
}

void ViewerHub::broadcast(std::string text) {
  const Message message = textMessage(std::move(text));
  for (const auto& [id, viewer] : viewers_) viewer->send(message);
}

void ViewerHub::multicast(SimulationReply reply) {
  const Message message = textMessage(std::move(reply.text));
  for (const std::uint64_t id : reply.viewers)
    if (Viewer* viewer = find(id)) viewer->send(message);
}

/// The history takes all snapshots, viewers get the newest one.
void ViewerHub::takeBatch(Clock::time_point now) {
  bool described = false;
  for (std::size_t i = 0; i < batch_.filled; ++i) described = takeSnapshot(batch_.snapshots[i], now);
  if (!described) return;
  const Snapshot& newest = batch_.snapshots[batch_.filled - 1];
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    Lane& lane = lanes_[i];
    if (lane.viewers > 0 && now >= lane.due - toleranceOf(lane.rate)) sendLane(i, newest, now);
  }
}

/// Returns false if its scene changed again and is not described yet.
bool ViewerHub::takeSnapshot(Snapshot& snapshot, Clock::time_point now) {
  if (snapshot.scene) takeScene(snapshot, now);
  sendEnvironment(snapshot, now);
  if (snapshot.shape != shape_) return false;
  frameScene_.update(snapshot.visible);
  if (keepsHistory()) history_->take(snapshot, shapeNumber_, frameScene_);
  return true;
}

void ViewerHub::takeScene(Snapshot& snapshot, Clock::time_point now) {
  shape_ = snapshot.shape;
  scene_ = std::make_shared<const std::string>(sceneMessage(snapshot, ++shapeNumber_, assets_.links()));
  sceneAt_ = now;
  if (keepsHistory()) history_->takeScene(shapeNumber_, *scene_);
  frameScene_.begin(snapshot);
  snapshot.scene.reset();
}

void ViewerHub::sendEnvironment(const Snapshot& snapshot, Clock::time_point now) {
  // Entries that changed. Viewers without a scene get all entries together with it.
  const bool always = now >= alwaysDue_;
  if (always) alwaysDue_ = now + kMinAlwaysInterval;
  if (std::string changes = environment_.update(snapshot, always); !changes.empty()) {
    const Message message = textMessage(std::move(changes));
    for (const auto& [id, viewer] : viewers_)
      if (viewer->shape != 0) viewer->send(message);
  }
  // Events.
  std::size_t i = 0;
  for (const Element event : snapshot.events) broadcast(eventMessage(snapshot.eventTimes[i++], event));
}

void ViewerHub::sendLane(std::size_t index, const Snapshot& snapshot, Clock::time_point now) {
  Lane& lane = lanes_[index];
  const Clock::duration period = periodOf(lane.rate);
  lane.due = std::max(lane.due + period, now + period / 2);
  lane.encoder.advance(frameScene_.instant(snapshot, shapeNumber_));
  lane.key.reset();
  lane.delta.reset();
  for (const auto& [id, viewer] : viewers_)
    if (viewer->lane == index) sendFrame(*viewer, lane, snapshot);
}

void ViewerHub::sendFrame(Viewer& viewer, Lane& lane, const Snapshot& snapshot) {
  // It skips this frame while an earlier one is queued, so the next delta is useless to it.
  if (viewer.lags()) {
    viewer.needsKey = true;
    return;
  }
  if (viewer.shape != shape_) sendScene(viewer, snapshot);
  const bool key = viewer.needsKey || !lane.encoder.hasDelta();
  auto& bytes = key ? lane.key : lane.delta;
  if (!bytes) bytes = std::make_shared<const std::string>(key ? lane.encoder.key() : lane.encoder.delta());
  viewer.needsKey = false;
  viewer.send({Message::Kind::frame, bytes});
}

void ViewerHub::sendScene(Viewer& viewer, const Snapshot& snapshot) {
  viewer.send({Message::Kind::scene, scene_});
  if (viewer.shape == 0) viewer.sendText(fullEnvironmentMessage(snapshot));
  viewer.shape = shape_;
  viewer.needsKey = true;
}

// ---- timing ----

/// Requests a snapshot if a lane is due, or for the history. Returns when the first lane will be due, or max() if a
/// snapshot for it is under way or there are no viewers.
Clock::time_point ViewerHub::requestSnapshot(Clock::time_point now) {
  Clock::time_point first = Clock::time_point::max();
  for (const Lane& lane : lanes_)
    if (lane.viewers > 0) first = std::min(first, lane.due - toleranceOf(lane.rate));
  const bool due = first <= now;
  if (due || !batchLent_) exchange_.urgent.store(due, std::memory_order_relaxed);
  if (!batchLent_ && (due || keepsHistory())) {
    batch_.filled = 0;
    batch_.due = keepsHistory() ? history_->due() : SnapshotBatch::kAnyTime;
    batch_.interval = keepsHistory() ? history_->interval() : 0;
    batch_.knownShape = shape_;
    batch_.describe = now - sceneAt_ >= kMinSceneInterval;
    batchLent_ = true;
    exchange_.wanted.store(&batch_, std::memory_order_release);
  }
  return due ? Clock::time_point::max() : first;
}

/// A busy simulation thread may not reply in time: waiters then get the last known status.
void ViewerHub::expireStatusWaiters(Clock::time_point now) {
  if (statusWaiters_.empty() || now - statusWaiters_.front().since < kStatusTimeout) return;
  for (auto& waiter : std::exchange(statusWaiters_, {})) waiter.callback(status_.empty() ? "{}" : status_);
}

void ViewerHub::disconnectStalled(Clock::time_point now) {
  for (const auto& [id, viewer] : viewers_)
    if (now - viewer->sendingSince(now) > duration<double>(settings_.stallTimeout))
      viewer->close("you do not read what you are sent");
}

Clock::time_point ViewerHub::tick(Clock::time_point now) {
  const bool statusWanted = !viewers_.empty() || !statusWaiters_.empty();
  if (!statusWanted) statusDue_ = now;
  if (statusWanted && !statusRequested_ && now >= statusDue_) {
    statusRequested_ = true;
    statusDue_ = now + kStatusInterval;
    exchange_.requests.put({SimulationRequest::Kind::status});
  }
  if (now >= stallsDue_) {
    stallsDue_ = now + kStallCheckInterval;
    expireStatusWaiters(now);
    disconnectStalled(now);
  }
  const Clock::time_point frame = requestSnapshot(now);
  return std::min({frame, statusWanted && !statusRequested_ ? statusDue_ : stallsDue_, stallsDue_});
}

}  // namespace spark::web
