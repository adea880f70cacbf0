#include "web_monitor.h"

#include "spark/kernel.h"
#include "stream/scene_capture.h"

namespace spark {

namespace {
constexpr std::uint32_t kMaxEventTokens = 1u << 14;  // of events since the last snapshot; further events are dropped
}

void WebMonitor::describe(Description<WebMonitor>& d) {
  d.doc("Hands frames of the scene to the web server while browsers watch.");
  d.implements<IFrameTaker>();
  d.link(&WebMonitor::server_, At<WebServer>());
}

void WebMonitor::event(const Element& event) {
  const web::Exchange* exchange = this->exchange();
  if (!exchange || !exchange->watched.load(std::memory_order_relaxed) || events_.size() > kMaxEventTokens) return;
  events_.append(event);
  ++eventCount_;
}

void WebMonitor::take(const NewestFrame& newest, IMonitorEncoder*, const Event& event) {
  newest_ = &newest;
  time_ = event.time;
  takenAt_ = kernel().structureVersion();
  const web::Exchange* exchange = this->exchange();
  if (!exchange) return;
  eventTimes_.resize(eventCount_, event.time);
  if (!exchange->watched.load(std::memory_order_relaxed)) {
    events_.clear();
    eventTimes_.clear();
    eventCount_ = 0;
  }
  takeAgain();
}

void WebMonitor::takeAgain() {
  web::Exchange* exchange = this->exchange();
  web::SnapshotBatch* batch = exchange ? exchange->wanted.load(std::memory_order_acquire) : nullptr;
  if (!newest_ || !batch) return;
  const bool setBack = time_ < takenTime_;
  if (time_ < batch->due && !setBack && !exchange->urgent.load(std::memory_order_relaxed)) return;
  if (takenAt_ != kernel().structureVersion() || newest_->frame.shape == 0) return;  // its pointers may dangle
  takenTime_ = time_;
  fill(*newest_, time_, *batch);
  exchange->filled();
}

void WebMonitor::fill(const NewestFrame& newest, double time, web::SnapshotBatch& batch) {
  web::Snapshot& out = batch.snapshots[batch.filled++];
  batch.due = time + batch.interval;
  web::copyFrame(newest, time, out);
  eventTimes_.resize(eventCount_, time);  // of events that came between frames, as when a monitor connects
  std::swap(out.events, events_);
  std::swap(out.eventTimes, eventTimes_);
  events_.clear();
  eventTimes_.clear();
  eventCount_ = 0;
  if (out.shape != batch.knownShape && batch.describe) out.scene = web::describeScene(newest.frame);
}

}  // namespace spark
