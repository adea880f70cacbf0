#include "log_player.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "spark/state.h"

namespace spark {

namespace {
constexpr double kFastest = 100;
constexpr double kTolerance = 1e-6;       ///< of a record; the sum of steps is not exact
constexpr std::int64_t kMostLines = 10;   ///< about damaged records
constexpr std::size_t kMostAFrame = 250;  ///< records on the way to another place: other monitors get frames meanwhile
}  // namespace

void LogPlayer::describe(Description<LogPlayer>& d) {
  using P = LogPlayer;
  d.doc(
      "Plays a recorded game to monitors. Commands: (p) pause, (f) forward, (b) back, (l) other direction, (speed x), "
      "(record n).");
  d.property("file", &P::file, &P::setFile).doc("The log: one monitor message a line. Opened when it is set.");
  d.property("commands", &P::commands).doc("Names of the commands that it takes.");
  d.property("recordTime", &P::recordTime_).unit("s").range(0.001, 60).doc("Time between two records.");
  d.property("speed", &P::speed_).range(0, kFastest).state().doc("1: as it was recorded; 2: twice as fast.");
  d.property("paused", &P::paused_).state().doc("Stands still; (p) switches it.");
  d.property("backward", &P::backward_).state().doc("Plays backwards; (l) switches it.");
  d.property("waitForMonitor", &P::waitForMonitor_).doc("Does not begin before the first monitor is there.");
  d.property("record", &P::record, &P::setRecord)
      .min(0)
      .doc("The record that is shown, from 0. Setting it goes there; without a file it is where the next one begins.");
  d.property("records", &P::records).doc("How many there are.");
  d.property("damaged", &P::damaged_).readOnly().doc("Records that could not be played and were passed over.");
  d.implements<IFrameSource>();
  d.implements<ITrainer>();
}

void LogPlayer::setFile(std::string path) {
  log_.reset();
  scene_.clear();
  due_ = 0;
  wanted_.reset();
  moments_.clear();
  underWay_ = false;
  started_ = false;
  damaged_ = 0;
  path_ = std::move(path);
  if (path_.empty()) return;
  log_ = std::make_unique<LogFile>(path_);
  goTo(std::min(at_, log_->size() - 1));
}

void LogPlayer::take(std::size_t record) {
  draw(record);
  const std::string wrong = scene_.take(log_->read(record), childOf<IParser>());
  at_ = record;
  moments_.passed(record, record - log_->fullBefore(record), scene_);
  if (wrong.empty()) return;
  if (++damaged_ <= kMostLines)
    kernel().log().warning("{}: record {} of '{}' is passed over: {}", path(), record, path_, wrong);
}

/// Packets as bytes with their sign: `[0, 0, 97, 0][2, 2, -128]`.
void LogPlayer::draw(std::size_t record) {
  const std::string& text = log_->readDrawings(record);
  auto* drawings = text.empty() ? nullptr : kernel().root().find<IDrawings>();
  if (!drawings) return;
  std::vector<std::byte> packet;
  int value = 0;
  for (const char *at = text.data(), *end = at + text.size(); at < end;) {
    const auto [behind, wrong] = std::from_chars(at, end, value);
    if (wrong == std::errc())
      packet.push_back(static_cast<std::byte>(value));
    else if (*at == ']')
      drawings->draw(packet), packet.clear();
    at = std::max(behind, at + 1);
  }
}

/// As a log's full records do; agents' texts each.
void LogPlayer::takeDrawingsAway() {
  auto* drawings = kernel().root().find<IDrawings>();
  if (!drawings || drawings->version() == 0) return;
  constexpr std::byte kNone{0}, kText{2};
  std::vector<std::byte> packet(6, kNone);  // two swaps of everything
  for (int agent = 0; agent < 256; ++agent) packet.insert(packet.end(), {kText, kText, static_cast<std::byte>(agent)});
  drawings->draw(packet);
}

void LogPlayer::setRecord(std::int64_t record) {
  due_ = 0;
  wanted_.reset();
  underWay_ = false;
  at_ = static_cast<std::size_t>(record);
  if (log_) goTo(std::min(at_, log_->size() - 1));
}

void LogPlayer::goTo(std::size_t target) {
  begin(target);
  go(target, target + 1);
}

/// By way of the last full record, and from there of the last moment that is known. Events of the way are not told,
/// drawings are made.
void LogPlayer::begin(std::size_t target) {
  tellEvents_ = false;
  takeDrawingsAway();
  const std::size_t full = log_->fullBefore(target);
  std::size_t known = full;
  const RecordedScene::Moment* moment = moments_.before(full + 1, target, known);
  take(full);
  if (moment && scene_.restore(*moment)) {
    for (std::size_t i = full + 1; i <= known; ++i)
      if (log_->hasDrawings(i)) draw(i);
    at_ = known;
  }
  if (target > at_) moments_.beginWay(target - at_);
}

/// At most so many records; false while the target is not reached.
bool LogPlayer::go(std::size_t target, std::size_t most) {
  for (; most > 0 && at_ < target; --most) take(at_ + 1);
  return at_ >= target;
}

bool LogPlayer::step() {
  if (!log_ || at_ + 1 >= log_->size()) return false;
  take(at_ + 1);
  tellEvents_ = true;
  return true;
}

/// Commands say where to go; the way is gone once a frame, however many there were, and a long one in several.
void LogPlayer::aim(std::int64_t record) {
  if (log_) wanted_ = std::clamp<std::int64_t>(record, 0, static_cast<std::int64_t>(log_->size()) - 1);
}

void LogPlayer::goWhereAimed() {
  if (!wanted_) return;
  const auto target = static_cast<std::size_t>(*wanted_);
  const bool goesOn = underWay_ && at_ <= target && at_ >= log_->fullBefore(target);
  if (!goesOn && target == at_ + 1) {
    step();
  } else if (goesOn || target != at_) {
    if (!goesOn) begin(target);
    underWay_ = !go(target, kMostAFrame);
    if (underWay_) return;
  }
  underWay_ = false;
  wanted_.reset();
}

/// So many records at once; false at the log's end.
bool LogPlayer::advance(std::size_t records) {
  bool moves = true;
  if (backward_) {
    moves = log_ && at_ >= records;
    if (log_ && at_ > 0) goTo(at_ - std::min(at_, records));
  } else {
    for (; records > 0 && moves; --records) moves = step();
  }
  return moves;
}

bool LogPlayer::fill(MonitorFrame& frame, std::vector<std::uint64_t>& ids, const Event& event, bool watched) {
  if (!started_) lastTime_ = event.time;
  started_ |= watched || !waitForMonitor_;
  const double passed = std::exchange(lastTime_, event.time), now = event.time;
  if (started_ && !paused_ && !underWay_ && now > passed) {
    due_ += speed_ * (now - passed) / recordTime_;
    if (const double whole = std::floor(due_ + kTolerance); whole >= 1)
      due_ = advance(static_cast<std::size_t>(whole)) ? due_ - whole : 0;
  }
  goWhereAimed();
  scene_.copyTo(frame, ids, std::exchange(tellEvents_, false));
  return std::exchange(shown_, scene_.shape()) != scene_.shape();
}

bool LogPlayer::command(const Element& command, std::string& why) {
  const std::string_view name = command.head();
  const auto argument = [&]() -> double {
    const Element e = command.at(1);
    const double v = e && !e.isList() ? e.number() : NAN;
    if (!std::isfinite(v) || v < 0) why = "expected a number of 0 or more";
    return v;
  };
  if (name == "p")
    paused_ = !paused_;
  else if (name == "l")
    backward_ = !backward_;
  else if (name == "f" || name == "b")
    aim(wanted_.value_or(static_cast<std::int64_t>(at_)) + (name == "b" ? -1 : 1));
  else if (name == "speed") {
    if (const double v = argument(); why.empty()) speed_ = std::min(v, kFastest);
  } else if (name == "record") {
    if (const double v = argument(); why.empty()) due_ = 0, aim(static_cast<std::int64_t>(std::min(v, 1e9)));
  } else {
    return false;
  }
  return true;
}

void LogPlayer::saveState(StateWriter& out) const {
  out.write(record());
  out.write(due_);
  out.write(started_);
  out.write(lastTime_);
}

void LogPlayer::loadState(StateReader& in) {
  setRecord(std::max<std::int64_t>(in.readInteger(), 0));
  due_ = in.readNumber();
  started_ = in.readBool();
  lastTime_ = in.readNumber();
}

}  // namespace spark
