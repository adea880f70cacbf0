#pragma once
/// \file
/// The text messages that viewers get, as JSON. README.md lists them.

#include <string>
#include <string_view>

#include "snapshot.h"
#include "spark/json_writer.h"

namespace spark::web {

/// Of all messages. Bytes that are no UTF-8 become U+FFFD, numbers that are not finite 0.
inline constexpr JsonStyle kWebJson{.ascii = true, .notFinite = "0"};
/// Writes an element: lists as arrays, texts that are numbers as numbers.
void writeElement(JsonWriter& json, const Element& element);

/// `{"type":"hello",...}`. `step`: simulated seconds of a cycle; `rate`: frames a second that a viewer gets unless it
/// asks for another.
std::string helloMessage(double step, double rate);
/// `{"type":"scene",...}` with the matrices as they are now.
std::string sceneMessage(const Snapshot& snapshot, std::uint32_t shape);
/// `{"type":"environment",...,"full":true}`: every entry.
std::string fullEnvironmentMessage(const Snapshot& snapshot);
/// `{"type":"event",...}` for event `i`.
std::string eventMessage(double time, const Element& event);
/// `{"type":"TYPE","id":ID,` in front of what an answer `{"ok":...}` says.
std::string reply(std::string_view type, std::int64_t id, std::string_view answer);
/// `{"ok":false,"error":"..."}`.
std::string failure(std::string_view why);

/// What viewers were told of the environment, to tell them what changed.
class EnvironmentDiary {
 public:
  /// Notes what the snapshot says; the message that tells the differences, "" when there are none. `always`: also of
  /// the entries that other monitors get with every frame, such as the time of play.
  std::string take(const Snapshot& snapshot, bool always);

 private:
  bool changed(const EntryKey& key);
  bool changed(std::size_t entry, std::string text);
  std::vector<EntryKey> told_;
  std::vector<std::string> toldAlways_;  ///< by index among the entries
};

}  // namespace spark::web
