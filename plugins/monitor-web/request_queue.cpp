#include "request_queue.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "api/files.h"
#include "api/inputs.h"
#include "api/monitor.h"
#include "drawings_message.h"
#include "spark/error.h"
#include "stream/messages.h"

namespace spark::web {

namespace {
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr double kMaxBudget = 0.002;  // s; bounds how long a cycle can be delayed after a quiet time
constexpr std::size_t kMaxWatches = 1024, kMaxWatchesPerViewer = 64;
constexpr auto kWatchInterval = milliseconds(100);
constexpr auto kDrawingsInterval = milliseconds(100);

double secondsSince(std::chrono::steady_clock::time_point t) {
  return duration<double>(std::chrono::steady_clock::now() - t).count();
}
}  // namespace

RequestQueue::RequestQueue(Kernel& kernel, Exchange& exchange)
    : kernel_(kernel), exchange_(exchange), report_(kernel) {}

template <class F>
void RequestQueue::charge(F f) {
  const auto begin = Clock::now();
  f();
  budget_ -= secondsSince(begin);
}

void RequestQueue::refillBudget(Clock::time_point now, double share) {
  budget_ = std::min(kMaxBudget, budget_ + share * duration<double>(now - refilledAt_).count());
  refilledAt_ = now;
}

void RequestQueue::process(const Settings& settings, int spectators) {
  if (!exchange_.requests.empty())
    for (SimulationRequest& request : exchange_.requests.takeAll()) receive(std::move(request), spectators);
  if (requests_.empty() && watches_.empty() && subscribers_.empty() && !repliesPending_) return;

  const auto now = Clock::now();
  refillBudget(now, settings.share);
  while (!requests_.empty() && budget_ > 0) {
    const SimulationRequest request = std::move(requests_.front());
    requests_.pop_front();
    charge([&] {
      if (request.file) return request.file->answer(findFile(request.text));
      send(SimulationReply::Kind::reply, request.viewer, executeControl(request, settings));
    });
  }
  pollWatches(now);
  if (!subscribers_.empty() && now >= drawingsDue_) sendDrawings(now);
  if (std::exchange(repliesPending_, false)) exchange_.wake();
}

void RequestQueue::receive(SimulationRequest request, int spectators) {
  using Kind = SimulationRequest::Kind;
  const auto ofViewer = [&](const auto& x) { return x.viewer == request.viewer; };
  switch (request.kind) {
    case Kind::control:
    case Kind::file:
      return requests_.push_back(std::move(request));
    case Kind::command:
      return send(SimulationReply::Kind::reply, request.viewer, executeCommand(request));
    case Kind::unwatch:
      return endWatch(request.viewer, request.id);
    case Kind::drawings:
      std::erase_if(subscribers_, ofViewer);
      if (request.on) subscribers_.push_back({request.viewer, 0});
      return;
    case Kind::disconnect:
      std::erase_if(subscribers_, ofViewer);
      std::erase_if(watches_, [&](const auto& w) { return ofViewer(*w); });
      std::erase_if(requests_, ofViewer);
      return;
    case Kind::status:
      return send(SimulationReply::Kind::status, 0, report_.make(spectators));
  }
}

void RequestQueue::send(SimulationReply::Kind kind, std::uint64_t viewer, std::string text) {
  exchange_.replies.put({kind, viewer, std::move(text)});
  repliesPending_ = true;
}

// ---- requests ----

FoundFile RequestQueue::findFile(const std::string& resource) const {
  auto* files = kernel_.root().find<IFileServer>();
  try {
    if (!files || !files->exists(resource)) return {};
    if (auto path = files->hostFile(resource)) return {std::move(path), {}};
    return {{}, files->read(resource)};
  } catch (const Error&) {
    return {};  // the name is none of a resource, or the file may not be read
  }
}

std::string RequestQueue::executeCommand(const SimulationRequest& request) {
  constexpr std::string_view kWho = "the web's referee";
  if (auto* tape = kernel_.root().find<IInputTape>();
      tape && !tape->put({.kind = Input::Kind::command, .place = kWho, .text = request.text}))
    return reply("answer", request.id, failure("a recording is played: nothing can be changed in it"));
  auto* monitor = kernel_.root().find<IMonitorServer>();
  const std::string why =
      monitor ? monitor->command(kWho, request.text) : "this simulation has no monitor server, which takes commands";
  return reply("answer", request.id, why.empty() ? "{\"ok\":true}" : failure(why));
}

std::string RequestQueue::executeControl(const SimulationRequest& request, const Settings& settings) {
  if (!settings.everybodyInspects && !request.referee)
    return reply("answer", request.id, failure("only the referee asks here"));
  auto* control = kernel_.root().find<IRequests>();
  if (!control)
    return reply("answer", request.id, failure("this simulation has no control server, /sys/server/control"));

  const auto message = nlohmann::json::parse(request.text);  // cannot fail: the I/O thread has parsed it
  const bool isWatch = message.at("do") == "watch";
  if (message.at("do") == "make" || message.at("do") == "attach")
    return reply("answer", request.id,
                 failure("only the owner of the host makes nodes and attaches scripts: by sparkctl"));
  control::Watch watch;
  const std::string line = control->answer(request.text, watch, request.referee && settings.refereeChanges);
  if (!isWatch) return reply("answer", request.id, line);
  if (watch.started) {
    if (!mayWatchMore(request.viewer)) return reply("watched", request.id, failure("too many properties are watched"));
    startWatch(request, std::move(watch));
  }
  return reply("watched", request.id, line);
}

// ---- watches ----

bool RequestQueue::mayWatchMore(std::uint64_t viewer) const {
  const auto ofViewer = [&](const auto& w) { return w->viewer == viewer; };
  return watches_.size() < kMaxWatches &&
         std::count_if(watches_.begin(), watches_.end(), ofViewer) < std::ptrdiff_t{kMaxWatchesPerViewer};
}

void RequestQueue::startWatch(const SimulationRequest& request, control::Watch watch) {
  endWatch(request.viewer, request.id);
  watches_.push_back(std::make_unique<WatchedProperty>(
      WatchedProperty{request.viewer, request.id, std::move(watch), Clock::now() + kWatchInterval}));
}

void RequestQueue::endWatch(std::uint64_t viewer, std::int64_t id) {
  std::erase_if(watches_, [&](const auto& w) { return w->viewer == viewer && w->id == id; });
}

/// Round robin, starting with the watch before which the budget ran out the last time.
void RequestQueue::pollWatches(Clock::time_point now) {
  auto* control = watches_.empty() ? nullptr : kernel_.root().find<IRequests>();
  if (!control) return watches_.clear();
  for (std::size_t n = watches_.size(); n > 0 && budget_ > 0 && !watches_.empty(); --n) {
    nextWatch_ = nextWatch_ < watches_.size() ? nextWatch_ : 0;
    WatchedProperty& w = *watches_[nextWatch_];
    bool done = false;
    if (now >= w.due) {
      w.due = now + kWatchInterval;
      charge([&] {
        if (const std::string line = control->nextOf(w.watch, done); !line.empty())
          send(SimulationReply::Kind::update, w.viewer, reply("watched", w.id, line));
      });
    }
    if (done)
      watches_.erase(watches_.begin() + static_cast<std::ptrdiff_t>(nextWatch_));
    else
      ++nextWatch_;
  }
}

// ---- drawings ----

/// Sends one message for each version that subscribers have, the oldest first.
void RequestQueue::sendDrawings(Clock::time_point now) {
  drawingsDue_ = now + kDrawingsInterval;
  const auto* drawings = kernel_.root().find<IDrawings>();
  if (!drawings) return;
  while (budget_ > 0) {
    std::optional<std::uint64_t> oldest;
    for (const DrawingSubscriber& s : subscribers_)
      if (s.version != drawings->version()) oldest = std::min(oldest.value_or(s.version), s.version);
    if (!oldest) return;
    charge([&] { sendDrawingsSince(*drawings, *oldest); });
  }
}

/// One message for all subscribers whose last version is `since`.
void RequestQueue::sendDrawingsSince(const IDrawings& drawings, std::uint64_t since) {
  SimulationReply update{SimulationReply::Kind::update, 0, drawingsMessage(drawings.sets(), since)};
  for (DrawingSubscriber& subscriber : subscribers_) {
    if (subscriber.version != since) continue;
    update.viewers.push_back(subscriber.viewer);
    subscriber.version = drawings.version();
  }
  exchange_.replies.put(std::move(update));
  repliesPending_ = true;
}

}  // namespace spark::web
