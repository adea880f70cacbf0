#pragma once
/// \file
/// The JSON text messages to viewers. README.md lists them.

#include <functional>
#include <string>
#include <string_view>

#include "snapshot.h"
#include "spark/json_writer.h"

namespace spark::web {

/// JSON style of all messages: ASCII only; invalid UTF-8 becomes U+FFFD, a number that is not finite 0.
inline constexpr JsonStyle kWebJson{.ascii = true, .notFinite = "0"};
/// Writes an element: lists as arrays, texts that look like numbers as numbers.
void writeElement(JsonWriter& json, const Element& element);

/// `{"type":"hello",...}`. `step`: simulated seconds per cycle; `rate`: default number of frames a second; `history`:
/// simulated seconds that the host keeps.
std::string helloMessage(double step, double rate, double history);
/// What viewers fetch besides the scene message.
enum class AssetKind { mesh, texture };
/// The path where viewers fetch a resource that the scene names; "": nowhere.
using AssetLink = std::function<std::string(AssetKind kind, const std::string& resource)>;
/// `{"type":"scene",...}` with the matrices of the snapshot. `snapshot.scene` must be set; `shape`: its number; `link`:
/// empty if nothing can be fetched, as with recordings.
std::string sceneMessage(const Snapshot& snapshot, std::uint32_t shape, const AssetLink& link = {});
/// Writes colours, shininess and texture of a material as members of the open object.
void writeLook(JsonWriter& json, const IMaterial::Look& look, const std::string& texture, const AssetLink& link);
/// `{"type":"environment",...,"full":true}`: all entries except events.
std::string fullEnvironmentMessage(const Snapshot& snapshot);
/// `{"type":"event",...}`. `time`: simulated seconds.
std::string eventMessage(double time, const Element& event);
/// `{"type":TYPE,"id":ID,...}` with the members of `answer`, a JSON object such as `{"ok":true}`.
std::string reply(std::string_view type, std::int64_t id, std::string_view answer);
/// `{"ok":false,"error":WHY}`.
std::string failure(std::string_view why);

/// Tracks which entries of the environment have changed since they were sent.
class ChangeTracker {
 public:
  /// The environment message with the entries that changed since the last call; "" if there are none. `always`: include
  /// entries with policy `always`, such as the game time.
  std::string update(const Snapshot& snapshot, bool always);

 private:
  bool changed(const EntryKey& key);
  bool changed(std::size_t entry, std::string text);
  std::vector<EntryKey> sent_;           ///< `change` entries, in order of their first appearance
  std::vector<std::string> sentAlways_;  ///< `always` entries as JSON, by index among all entries
};

}  // namespace spark::web
