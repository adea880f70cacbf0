#include "status_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparkhost {

using spark::StatusEntry;
using spark::Value;

namespace {
/// The elements of a list with `separator` between them.
std::string joined(const Value& value, const char* separator) {
  if (!value.isList()) return value.plain();
  std::string out;
  for (const Value& element : value.toList()) out += (out.empty() ? "" : separator) + element.plain();
  return out;
}

}  // namespace

std::string statusText(const std::vector<StatusEntry>& entries) {
  std::string out, previous;
  for (const StatusEntry& entry : entries) {
    const std::string text = joined(entry.value, entry.name == "score" ? ":" : " ");
    if (text.empty()) continue;
    if (entry.name == "playMode")
      out += ", " + text;
    else if (entry.name == "score" && previous == "playMode")
      out += ' ' + text;
    else
      out += fmt::format(", {} {}", entry.name, text);
    previous = entry.name;
  }
  return out;
}

void writeStatus(spark::JsonWriter& json, const std::vector<StatusEntry>& entries) {
  const auto isOther = [](const StatusEntry& entry) { return !isStatusWord(entry); };
  for (const StatusEntry& entry : entries)
    if (!isOther(entry)) json.member(entry.name, entry.value);
  if (std::none_of(entries.begin(), entries.end(), isOther)) return;
  json.key("status").beginObject();
  for (const StatusEntry& entry : entries)
    if (isOther(entry)) json.member(entry.name, entry.value);
  json.endObject();
}

}  // namespace sparkhost
