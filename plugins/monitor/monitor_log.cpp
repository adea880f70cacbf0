#include "monitor_log.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spark/error.h"

namespace spark {

void MonitorLog::describe(Description<MonitorLog>& d) {
  using L = MonitorLog;
  d.doc("Writes a log of the match that log players and monitors can play: one monitor message a line.");
  d.link(&MonitorLog::drawings_, At<IDrawings>());
  d.link(&MonitorLog::tape_, At<IInputTape>()).doc("While it plays a recorded run, the log of that run stays.");
  d.property("file", &L::file, &L::setFile)
      .ofProcess()
      .doc("The file, which is new, or replaced with --force. It is opened when the first record is written.");
  d.property("interval", &L::interval_)
      .unit("s")
      .min(0)
      .doc("Simulated time between two records, rounded to cycles; at least the server's own interval.");
  d.property("fullInterval", &L::fullInterval_).unit("s").min(0).doc("A record is full if the last full one is older.");
  d.property("whilePlayed", &L::whilePlayed_)
      .ofProcess()
      .doc("It is written although a recorded run is played, to another file than that of the run.");
  d.property("records", &L::records_).readOnly().doc("Number of records written.");
  d.implements<IFrameTaker>();
}

void MonitorLog::setFile(std::string file) {
  // A name that will be refused is an error of the config, not of the first cycle.
  const bool written = whilePlayed_ || !tape_ || !tape_->playing();
  if (written && outputs::permitted(file)) outputs::check(file, "the log");
  file_ = std::move(file);
}

void MonitorLog::event(const Element& event) {
  if (failed_) return;
  if (view_)
    view_->addEvent(event);
  else
    early_.append(event);
}

/// Opens the file at the first frame. False if that failed, now or before.
bool MonitorLog::open(const NewestFrame& newest) {
  if (failed_ || view_) return !failed_;
  try {
    out_ = std::make_unique<OutputFile>(file_, "the log");
  } catch (const Error& e) {
    fail(e.what());
    return false;
  }
  view_.emplace(newest);
  for (const Element early : early_) view_->addEvent(early);
  early_.clear();
  return true;
}

void MonitorLog::take(const NewestFrame& newest, IMonitorEncoder* encoder, const Event& event) {
  if (!whilePlayed_ && tape_ && tape_->playing()) return;
  if (event.cycle < nextCycle_ || !encoder || !open(newest)) return;
  const auto every =
      std::max<std::int64_t>(1, event.step > 0 ? std::llround(std::min(interval_ / event.step, 1e9)) : 1);
  nextCycle_ = event.cycle + every;
  // Half a step of tolerance: the sum of steps is not exact.
  if (event.time - lastFull_ > fullInterval_ + 0.5 * event.step) view_->requestFull();
  record_.clear();
  view_->encode(*encoder, record_);
  if (view_->wasFull()) lastFull_ = event.time;
  recordDrawings();
  write();
}

/// A full record gets all drawings, others those that changed. Only S-expression records may have drawings.
void MonitorLog::recordDrawings() {
  drawn_.clear();
  if (!drawings_ || !record_.starts_with('(')) return;
  drawings_->record(view_->wasFull() ? 0 : drawnVersion_, drawn_);
  drawnVersion_ = drawings_->version();
}

void MonitorLog::write() {
  record_ += '\n';
  try {
    out_->write(drawn_);
    out_->write(record_);
  } catch (const Error& e) {
    return fail(fmt::format("cannot write to the log {}: {}", file_, e.what()));
  }
  view_->delivered();
  ++records_;
}

void MonitorLog::fail(std::string_view what) {
  failed_ = true;
  kernel().log().error("{}: {}. There is no log from here on; check the folder and the space on the disk.", path(),
                       what);
}

}  // namespace spark
