#include "desk.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "api/monitor.h"
#include "drawings_message.h"
#include "messages.h"

namespace spark::web {

namespace {
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr double kMostSaved = 0.002;  // s; what is not used up is kept up to here: no cycle waits much longer
constexpr std::size_t kMostWatches = 1024, kMostWatchesEach = 64;
constexpr auto kWatchApart = milliseconds(100);  // a watched property is looked at so often at most
constexpr auto kDrawingsApart = milliseconds(100);

double secondsSince(std::chrono::steady_clock::time_point t) {
  return duration<double>(std::chrono::steady_clock::now() - t).count();
}
}  // namespace

Desk::Desk(Kernel& kernel, Exchange& exchange) : kernel_(kernel), exchange_(exchange), report_(kernel) {}

template <class F>
void Desk::paid(F f) {
  const auto begin = Clock::now();
  f();
  account_ -= secondsSince(begin);
}

void Desk::refill(Clock::time_point now, double share) {
  account_ = std::min(kMostSaved, account_ + share * duration<double>(now - refilledAt_).count());
  refilledAt_ = now;
}

void Desk::work(const Settings& settings, int spectators) {
  if (!exchange_.questions.empty())
    for (Question& question : exchange_.questions.takeAll()) receive(std::move(question), spectators);
  if (requests_.empty() && watches_.empty() && artists_.empty() && !told_) return;

  const auto now = Clock::now();
  refill(now, settings.share);
  while (!requests_.empty() && account_ > 0) {
    const Question question = std::move(requests_.front());
    requests_.pop_front();
    paid([&] { tell(Answer::Kind::reply, question.viewer, answer(question, settings)); });
  }
  lookAtWatches(now);
  if (!artists_.empty() && now >= drawingsDue_) tellDrawings(now);
  if (std::exchange(told_, false)) exchange_.wake();
}

void Desk::receive(Question question, int spectators) {
  using Kind = Question::Kind;
  const auto ofViewer = [&](const auto& x) { return x.viewer == question.viewer; };
  switch (question.kind) {
    case Kind::request:
      return requests_.push_back(std::move(question));
    case Kind::command:
      return tell(Answer::Kind::reply, question.viewer, command(question));
    case Kind::unwatch:
      std::erase_if(watches_, [&](const auto& w) { return w->viewer == question.viewer && w->id == question.id; });
      return;
    case Kind::drawings:
      std::erase_if(artists_, ofViewer);
      if (question.on) artists_.push_back({question.viewer, 0});
      return;
    case Kind::gone:
      std::erase_if(artists_, ofViewer);
      std::erase_if(watches_, [&](const auto& w) { return w->viewer == question.viewer; });
      std::erase_if(requests_, ofViewer);
      return;
    case Kind::status:
      return tell(Answer::Kind::status, 0, report_.make(spectators));
  }
}

void Desk::tell(Answer::Kind kind, std::uint64_t viewer, std::string text) {
  exchange_.answers.put({kind, viewer, std::move(text)});
  told_ = true;
}

std::string Desk::command(const Question& question) {
  auto* monitor = kernel_.root().find<IMonitorServer>();
  const std::string why = monitor ? monitor->command("the web's referee", question.text)
                                  : "this house has no monitor server, which takes commands";
  return reply("answer", question.id, why.empty() ? "{\"ok\":true}" : failure(why));
}

std::string Desk::answer(const Question& question, const Settings& settings) {
  if (!settings.everybodyInspects && !question.referee)
    return reply("answer", question.id, failure("only the referee asks here"));
  const auto request = nlohmann::json::parse(question.text);  // it was read before
  const std::string what = request.at("do");
  auto* requests = kernel_.root().find<IRequests>();
  if (!requests) return reply("answer", question.id, failure("this house has no control server, /sys/server/control"));
  control::Watch watch;
  const std::string line = requests->answer(question.text, watch, question.referee && settings.refereeChanges);
  if (what != "watch") return reply("answer", question.id, line);
  if (watch.started) {
    const auto ofViewer = [&](const auto& w) { return w->viewer == question.viewer; };
    if (watches_.size() >= kMostWatches ||
        std::count_if(watches_.begin(), watches_.end(), ofViewer) >= static_cast<int>(kMostWatchesEach))
      return reply("watched", question.id, failure("too many properties are watched"));
    startWatch(question, std::move(watch));
  }
  return reply("watched", question.id, line);
}

void Desk::startWatch(const Question& question, control::Watch watch) {
  std::erase_if(watches_, [&](const auto& w) { return w->viewer == question.viewer && w->id == question.id; });
  watches_.push_back(
      std::make_unique<Watched>(Watched{question.viewer, question.id, std::move(watch), Clock::now() + kWatchApart}));
}

/// In turn, from where the account ran out the last time.
void Desk::lookAtWatches(Clock::time_point now) {
  auto* requests = watches_.empty() ? nullptr : kernel_.root().find<IRequests>();
  if (!requests) return watches_.clear();
  for (std::size_t n = watches_.size(); n > 0 && account_ > 0 && !watches_.empty(); --n) {
    nextWatch_ = nextWatch_ < watches_.size() ? nextWatch_ : 0;
    Watched& w = *watches_[nextWatch_];
    bool done = false;
    if (now >= w.due) {
      w.due = now + kWatchApart;
      paid([&] {
        if (const std::string line = requests->nextOf(w.watch, done); !line.empty())
          tell(Answer::Kind::told, w.viewer, reply("watched", w.id, line));
      });
    }
    if (done)
      watches_.erase(watches_.begin() + static_cast<std::ptrdiff_t>(nextWatch_));
    else
      ++nextWatch_;
  }
}

void Desk::tellDrawings(Clock::time_point now) {
  drawingsDue_ = now + kDrawingsApart;
  const auto* drawings = kernel_.root().find<IDrawings>();
  if (!drawings) return;
  while (account_ > 0) {
    std::optional<std::uint64_t> since;
    for (const Artist& artist : artists_)
      if (artist.version != drawings->version()) since = std::min(since.value_or(artist.version), artist.version);
    if (!since) return;
    paid([&] { tellArtists(*drawings, *since); });
  }
}

/// Who was told the same last is told the same now: it is written once for all of them.
void Desk::tellArtists(const IDrawings& drawings, std::uint64_t since) {
  Answer answer{Answer::Kind::told, 0, drawingsMessage(drawings.sets(), since)};
  for (Artist& artist : artists_) {
    if (artist.version != since) continue;
    answer.viewers.push_back(artist.viewer);
    artist.version = drawings.version();
  }
  exchange_.answers.put(std::move(answer));
  told_ = true;
}

}  // namespace spark::web
