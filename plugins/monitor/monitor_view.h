#pragma once

#include <string>
#include <vector>

#include "api/monitor.h"

namespace spark {

/// The key of an environment's list.
EntryKey keyOf(const Predicates& predicates, std::uint32_t token);

/// What one viewer (a client, a log) was sent, and from it what it is to get next.
///
/// Every viewer has its own reference: matrices as last sent, the value of each `change` entry as last sent, waiting
/// events. So viewers of different speed each get all they lack and nothing twice, however many frames they miss.
///
/// Viewers that were sent the same in the same frames are alike: one of them is encoded, the others become() it. A
/// hundred monitors that keep up cost one encoding.
class MonitorView {
 public:
  /// `newest` must outlive the view.
  explicit MonitorView(const NewestFrame& newest) : newest_(newest), update_{newest.frame, false, {}, {}, {}} {}

  /// The next message is full.
  void requestFull() { needsFull_ = true; }
  /// An event that this viewer has not got. Of more than kMostWaiting tokens the older half is forgotten.
  void addEvent(const Element& event);
  static constexpr std::uint32_t kMostWaiting = 8192;
  /// Appends the next message, made from the newest frame, to `out`. Touches only this view: several may do it at the
  /// same time.
  void encode(IMonitorEncoder& encoder, std::string& out);
  /// The message left: events are not told again.
  void delivered();
  /// The last message was full.
  bool wasFull() const { return update_.full; }

  /// True when both would be sent the same message now, by the same encoder.
  bool isLike(const MonitorView& other) const;
  /// Takes over what an alike view is after it was encoded.
  void become(const MonitorView& other);

 private:
  bool willBeFull() const { return needsFull_ || shape_ != newest_.frame.shape; }
  void forgetOldEvents();
  void pickNodes();
  void pickEntries();
  bool changed(const EntryKey& key);

  const NewestFrame& newest_;
  MonitorUpdate update_;
  std::vector<Matrix> sent_;
  std::vector<std::uint8_t> visible_;
  std::vector<EntryKey> told_;
  std::uint64_t shape_ = 0;
  std::uint64_t newestId_ = 0;              ///< nodes up to this number had their visibility repeated
  std::uint64_t history_ = 0, events_ = 0;  ///< equal in two views: they were sent the same, the same waits
  bool needsFull_ = true;
};

}  // namespace spark
