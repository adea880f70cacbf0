#pragma once

#include <string>
#include <vector>

#include "api/monitor.h"
#include "api/net.h"

namespace spark {

/// Name and content of one entry of the environment, as hashes: to know what a client was told.
struct EntryKey {
  std::uint64_t name = 0, content = 0;
};
/// The key of an environment's list.
EntryKey keyOf(const Predicates& predicates, std::uint32_t token);

/// What one client was sent, and from it what it is to get next.
///
/// Every client has its own reference: matrices as last sent, the value of each `change` entry as last sent, waiting events. So clients
/// of different speed each get all they lack and nothing twice, however many frames they miss. There is no queue of frames: only when
/// the last message has left is the next one made, from the newest frame.
class MonitorClient {
 public:
  /// Both must outlive the client.
  MonitorClient(IConnection& connection, const MonitorFrame& frame) : connection_(connection), update_{frame, false, {}, {}, {}} {}

  IConnection& connection() const { return connection_; }
  /// The next message is full.
  void requestFull() { needsFull_ = true; }
  /// An event that this client has not got.
  void addEvent(const Element& event) { update_.events.append(event); }
  /// Makes the next message from the server's frame. `ids`: numbers of its nodes; `keys`: of its entries; `precision`: a matrix is sent when
  /// an element moved by more. Touches only this client: clients may do it at the same time.
  void encode(IMonitorEncoder& encoder, const std::vector<std::uint64_t>& ids, const std::vector<EntryKey>& keys, float precision);
  /// Hands the message to the connection.
  void send();
  /// Closes the connection once, with the reason in the log.
  void close(std::string_view reason);
  bool closing() const { return closing_; }

 private:
  void pickNodes(const std::vector<std::uint64_t>& ids, float precision);
  void pickEntries(const std::vector<EntryKey>& keys);
  bool changed(const EntryKey& key);

  IConnection& connection_;
  MonitorUpdate update_;
  std::string message_;
  std::vector<Matrix> sent_;
  std::vector<std::uint8_t> visible_;
  std::vector<EntryKey> told_;
  std::uint64_t shape_ = 0;
  std::uint64_t newestId_ = 0;  ///< nodes up to this number had their visibility repeated
  bool needsFull_ = true, closing_ = false;
};

}  // namespace spark
