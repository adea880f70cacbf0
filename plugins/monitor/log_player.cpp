#include "log_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "spark/state.h"

namespace spark {

namespace {
constexpr double kMaxSpeed = 100;
constexpr const char* kExpected = "expected a number of 0 or more";
constexpr double kTolerance = 1e-6;            // records; the sum of time steps is not exact
constexpr std::int64_t kMaxDamagedLines = 10;  // in the log, about damaged records
constexpr std::size_t kBegin = 64;             // bytes of a file that tell its format
constexpr std::size_t kMaxPerFrame = 250;      // records of a seek, so that it does not delay frames
}  // namespace

void LogPlayer::describe(Description<LogPlayer>& d) {
  using P = LogPlayer;
  d.doc(
      "Plays a log to monitors. Commands: (p) pause, (f) forward, (b) back, (l) reverse, (speed x), "
      "(record n), (time t).");
  d.link(&P::formats_, Child<IGameLog>());
  d.property("file", &P::file, &P::setFile)
      .doc("The log: one monitor message a line, or a format that a child reads. Opened when it is set.");
  d.property("commands", &P::commands).doc("Names of the commands that it takes.");
  d.property("recordTime", &P::recordTime_)
      .unit("s")
      .range(0.001, 60)
      .doc("Time between two records; some files tell it.");
  d.property("speed", &P::speed_).range(0, kMaxSpeed).state().doc("1: as it was recorded; 2: twice as fast.");
  d.property("paused", &P::paused_).state().doc("Playing is paused; (p) toggles it.");
  d.property("backward", &P::backward_).state().doc("Plays backwards; (l) toggles it.");
  d.property("waitForMonitor", &P::waitForMonitor_).doc("Playing begins when the first monitor connects.");
  d.property("record", &P::record, &P::setRecord)
      .min(0)
      .doc(
          "The record that is shown, from 0. Setting it shows that record; without a file it is where the next file "
          "begins.");
  d.property("time", &P::time, &P::setTime)
      .ofProcess()
      .unit("s")
      .min(0)
      .doc("Recorded time of the record that is shown. Setting it shows the last record up to then.");
  d.property("records", &P::records).doc("Number of records.");
  d.property("damaged", &P::damaged_).readOnly().doc("Number of records that could not be played and were skipped.");
  d.implements<IFrameSource>();
  d.implements<ITrainer>();
  d.implements<ICommandCheck>();
}

void LogPlayer::setFile(std::string path) {
  text_.reset();
  format_ = nullptr;
  scene_.clear();
  due_ = 0;
  target_.reset();
  snapshots_.clear();
  seeking_ = false;
  started_ = false;
  damaged_ = 0;
  path_ = std::move(path);
  if (path_.empty()) return;
  std::string begin(kBegin, '\0');
  std::ifstream file(path_, std::ios::binary);
  begin.resize(static_cast<std::size_t>(file.read(begin.data(), kBegin).gcount()));
  const auto format =
      std::find_if(formats_.begin(), formats_.end(), [&](const auto& f) { return f->recognises(begin); });
  if (format == formats_.end()) {
    auto text = std::make_unique<LogFile>();
    text->open(path_);
    text_ = std::move(text);
  } else {
    (*format)->open(path_);
    format_ = format->leaf;
  }
  if (log()->interval() > 0) recordTime_ = log()->interval();
  seek(std::min(at_, log()->size() - 1));
}

IGameLog* LogPlayer::log() const {
  const Leaf* const leaf = format_.get();
  IGameLog* const format = leaf ? leaf->as<IGameLog>().object : nullptr;
  return format && format->size() > 0 ? format : text_.get();
}

double LogPlayer::time() const {
  const auto at = static_cast<std::size_t>(record());
  const double t = log() && at < log()->size() ? log()->time(at) : NAN;
  return std::isfinite(t) ? t : static_cast<double>(at) * recordTime_;
}

/// The last record that is not later than a time.
std::size_t LogPlayer::recordAt(double seconds) const {
  const std::size_t n = log() ? log()->size() : 0;
  if (n == 0 || !std::isfinite(log()->time(0))) return static_cast<std::size_t>(seconds / recordTime_ + kTolerance);
  std::size_t low = 0;
  for (std::size_t high = n; high - low > 1;) {
    const std::size_t middle = (low + high) / 2;
    (log()->time(middle) <= seconds + kTolerance ? low : high) = middle;
  }
  return low;
}

/// Applies a record to the scene. A damaged one is logged and leaves the scene as it was.
void LogPlayer::apply(std::size_t record) {
  draw(record);
  const std::string wrong = scene_.take(log()->read(record), childOf<IParser>());
  at_ = record;
  snapshots_.onRecord(record, record - log()->fullBefore(record), scene_);
  if (wrong.empty()) return;
  if (++damaged_ <= kMaxDamagedLines)
    kernel().log().warning("{}: record {} of '{}' is passed over: {}", path(), record, path_, wrong);
}

/// Draws the packets of a record. In the file they are lists of signed bytes: `[0, 0, 97, 0][2, 2, -128]`.
void LogPlayer::draw(std::size_t record) {
  const std::string& text = log()->readDrawings(record);
  auto* drawings = text.empty() ? nullptr : kernel().root().find<IDrawings>();
  if (!drawings) return;
  std::vector<std::byte> packet;
  int value = 0;
  for (const char *at = text.data(), *end = at + text.size(); at < end;) {
    const auto [next, wrong] = std::from_chars(at, end, value);
    if (wrong == std::errc())
      packet.push_back(static_cast<std::byte>(value));
    else if (*at == ']')
      drawings->draw(packet), packet.clear();
    at = std::max(next, at + 1);
  }
}

/// Clears all drawings with the packets that a log's full records contain for it; agents' texts one by one.
void LogPlayer::clearDrawings() {
  auto* drawings = kernel().root().find<IDrawings>();
  if (!drawings || drawings->version() == 0) return;
  constexpr std::byte kNone{0}, kText{2};
  std::vector<std::byte> packet(6, kNone);  // two swaps of everything
  for (int agent = 0; agent < 256; ++agent) packet.insert(packet.end(), {kText, kText, static_cast<std::byte>(agent)});
  drawings->draw(packet);
}

void LogPlayer::setRecord(std::int64_t record) {
  due_ = 0;
  target_.reset();
  seeking_ = false;
  at_ = static_cast<std::size_t>(record);
  if (log()) seek(std::min(at_, log()->size() - 1));
}

void LogPlayer::setTime(double seconds) { setRecord(static_cast<std::int64_t>(recordAt(seconds))); }

/// Shows a record now, however far away it is.
void LogPlayer::seek(std::size_t target) {
  beginSeek(target);
  continueSeek(target, target + 1);
}

/// Goes to the last full record before the target, and from there to the last snapshot before the target. The drawings
/// of all records in between are drawn; their events are dropped.
void LogPlayer::beginSeek(std::size_t target) {
  sendEvents_ = false;
  clearDrawings();
  const std::size_t full = log()->fullBefore(target);
  std::size_t record = full;
  const RecordedScene::Snapshot* snapshot = snapshots_.findLast(full + 1, target, record);
  apply(full);
  if (snapshot && scene_.restore(*snapshot)) {
    for (std::size_t i = full + 1; i <= record; ++i)
      if (log()->hasDrawings(i)) draw(i);
    at_ = record;
  }
  if (target > at_) snapshots_.beginSeek(target - at_);
}

/// Applies at most `maxRecords`; true if the target is reached.
bool LogPlayer::continueSeek(std::size_t target, std::size_t maxRecords) {
  for (; maxRecords > 0 && at_ < target; --maxRecords) apply(at_ + 1);
  return at_ >= target;
}

/// Plays the next record, with its events; false at the end of the log.
bool LogPlayer::step() {
  if (!log() || at_ + 1 >= log()->size()) return false;
  apply(at_ + 1);
  sendEvents_ = true;
  return true;
}

void LogPlayer::setTarget(std::int64_t record) {
  if (log()) target_ = std::clamp<std::int64_t>(record, 0, static_cast<std::int64_t>(log()->size()) - 1);
}

/// Moves towards the target, at most kMaxPerFrame records.
void LogPlayer::seekTarget() {
  if (!target_) return;
  const auto target = static_cast<std::size_t>(*target_);
  // A seek that has begun continues if the new target can be reached from where it is.
  const bool continues = seeking_ && at_ <= target && at_ >= log()->fullBefore(target);
  if (!continues && target == at_ + 1) {
    step();
  } else if (continues || target != at_) {
    if (!continues) beginSeek(target);
    seeking_ = !continueSeek(target, kMaxPerFrame);
    if (seeking_) return;
  }
  seeking_ = false;
  target_.reset();
}

/// Moves by a number of records in the current direction; false if the log ends before.
bool LogPlayer::advance(std::size_t records) {
  bool moved = true;
  if (backward_) {
    moved = log() && at_ >= records;
    if (log() && at_ > 0) seek(at_ - std::min(at_, records));
  } else {
    for (; records > 0 && moved; --records) moved = step();
  }
  return moved;
}

bool LogPlayer::fill(MonitorFrame& frame, std::vector<std::uint64_t>& ids, const Event& event, bool watched) {
  if (!started_) lastTime_ = event.time;
  started_ |= watched || !waitForMonitor_;
  const double last = std::exchange(lastTime_, event.time);
  if (started_ && !paused_ && !seeking_ && event.time > last) {
    due_ += speed_ * (event.time - last) / recordTime_;
    if (const double whole = std::floor(due_ + kTolerance); whole >= 1)
      due_ = advance(static_cast<std::size_t>(whole)) ? due_ - whole : 0;
  }
  seekTarget();
  scene_.copyTo(frame, ids, std::exchange(sendEvents_, false));
  return std::exchange(shownShape_, scene_.shape()) != scene_.shape();
}

namespace {
/// The argument of a command: NAN unless it is a number of 0 or more.
double argumentOf(const Element& command) {
  const Element e = command.at(1);
  const double v = e && !e.isList() ? e.number() : NAN;
  return std::isfinite(v) && v >= 0 ? v : NAN;
}
}  // namespace

std::string LogPlayer::check(const Element& command) {
  const std::string_view name = command.head();
  const bool isKey = name.size() == 1 && std::string_view("pflb").find(name) != std::string_view::npos;
  if (!isKey && name != "speed" && name != "record" && name != "time") return {};
  if (!log()) return "there is no log";
  const std::size_t count = isKey ? 0 : 1;
  if (!isKey && std::isnan(argumentOf(command))) return kExpected;
  if (name == "speed" && argumentOf(command) > kMaxSpeed)
    return fmt::format("expected at most {}, which it is now", kMaxSpeed);
  return command.size() == count + 1 ? std::string()
                                     : fmt::format("expected {}, found {}: the rest is ignored",
                                                   isKey ? "no argument" : "one argument", command.size() - 1);
}

bool LogPlayer::command(const Element& command, std::string& why) {
  const std::string_view name = command.head();
  const auto argument = [&] {
    const double v = argumentOf(command);
    if (std::isnan(v)) why = kExpected;
    return v;
  };
  if (name == "p")
    paused_ = !paused_;
  else if (name == "l")
    backward_ = !backward_;
  else if (name == "f" || name == "b")
    setTarget(record() + (name == "b" ? -1 : 1));
  else if (name == "speed") {
    if (const double v = argument(); why.empty()) speed_ = std::min(v, kMaxSpeed);
  } else if (name == "record") {
    if (const double v = argument(); why.empty()) due_ = 0, setTarget(static_cast<std::int64_t>(std::min(v, 1e9)));
  } else if (name == "time") {
    if (const double v = argument(); why.empty())
      due_ = 0, setTarget(static_cast<std::int64_t>(recordAt(std::min(v, 1e9))));
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
