#pragma once
/// \file
/// What one viewer was sent, and what it gets next.

#include <string>
#include <vector>

#include "api/monitor.h"

namespace spark {

/// Name and content hash of the list at `token`.
EntryKey keyOf(const Predicates& predicates, std::uint32_t token);

/// The state of one viewer (a client, a log): matrices and `change` entries as they were sent last, and events that
/// were not sent yet. With a state of its own each viewer gets all changes exactly once, however many frames it skips.
///
/// Views that were sent the same messages are equivalent: one of them is encoded, the others copy its state. A hundred
/// monitors that keep up cost one encoding.
class MonitorView {
 public:
  /// `newest` must outlive the view.
  explicit MonitorView(const NewestFrame& newest) : newest_(newest), update_{newest.frame, false, {}, {}, {}} {}

  /// Makes the next message a full one.
  void requestFull() { needsFull_ = true; }
  /// Adds an event to the next message. If the waiting events exceed kMaxEventTokens, the older half is dropped.
  void addEvent(const Element& event);
  static constexpr std::uint32_t kMaxEventTokens = 8192;
  /// Appends the next message to `out`, encoded from the newest frame. Changes only this view: several views may be
  /// encoded in parallel.
  void encode(IMonitorEncoder& encoder, std::string& out);
  /// The message was sent: its events are removed.
  void delivered();
  /// True if the last message was full.
  bool wasFull() const { return update_.full; }

  /// True if the same encoder would encode the same message for both now.
  bool isEquivalent(const MonitorView& other) const;
  /// Copies the state of an equivalent view after that one was encoded.
  void copyState(const MonitorView& other);

 private:
  bool willBeFull() const { return needsFull_ || shape_ != newest_.frame.shape; }
  void dropOldEvents();
  void pickNodes();
  void pickEntries();
  bool changed(const EntryKey& key);

  const NewestFrame& newest_;
  MonitorUpdate update_;
  // As sent last.
  std::vector<Matrix> matrices_;       ///< by node
  std::vector<std::uint8_t> visible_;  ///< by node
  std::vector<EntryKey> entries_;      ///< `change` entries
  std::uint64_t shape_ = 0;            ///< MonitorFrame::shape
  std::uint64_t newestId_ = 0;         ///< the visibility of nodes up to this id was sent in a diff, too

  // Hashes: views with equal ones were sent the same messages, and have the same waiting events.
  std::uint64_t historyHash_ = 0, eventsHash_ = 0;
  bool needsFull_ = true;
};

}  // namespace spark
