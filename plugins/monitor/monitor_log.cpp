#include "monitor_log.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace spark {

void MonitorLog::describe(Description<MonitorLog>& d) {
  using L = MonitorLog;
  d.doc("Writes a log of the match that log players and monitors can play: one monitor message a line.");
  d.link(&MonitorLog::drawings_, At<IDrawings>());
  d.link(&MonitorLog::tape_, At<IInputTape>()).doc("While it plays a recorded run, the log of that run stays.");
  d.property("file", &L::file_)
      .ofProcess()
      .doc("The file; its content is replaced. Used when the first record is written.");
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
  // With O_NONBLOCK a pipe without a reader fails instead of blocking the match. Later writes do wait for its reader.
  errno = 0;
  if (const int file = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666); file >= 0) {
    fcntl(file, F_SETFL, fcntl(file, F_GETFL) & ~O_NONBLOCK);
    out_.reset(fdopen(file, "wb"));
  }
  if (!out_) {
    fail(errno == ENXIO ? "is a pipe that nobody reads" : "cannot be opened for writing");
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
  errno = 0;
  std::fwrite(drawn_.data(), 1, drawn_.size(), out_.get());
  std::fwrite(record_.data(), 1, record_.size(), out_.get());
  if (std::fflush(out_.get()) != 0 || std::ferror(out_.get())) return fail("cannot be written to");
  view_->delivered();
  ++records_;
}

void MonitorLog::fail(std::string_view what) {
  failed_ = true;
  kernel().log().error(
      "{}: the log '{}' {} ({}); there is no log from here on. Check the folder and the space on the disk.", path(),
      file_, what, errno ? std::strerror(errno) : "unknown reason");
}

}  // namespace spark
