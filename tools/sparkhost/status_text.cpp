#include "status_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparkhost {

using spark::StatusEntry;
using spark::Value;

namespace {
/// A list's elements with `between` them.
std::string joined(const Value& value, const char* between) {
  if (!value.isList()) return value.plain();
  std::string out;
  for (const Value& part : value.toList()) out += (out.empty() ? "" : between) + part.plain();
  return out;
}

}  // namespace

std::string statusText(const std::vector<StatusEntry>& entries) {
  std::string out, before;
  for (const StatusEntry& entry : entries) {
    const std::string text = joined(entry.value, entry.name == "score" ? ":" : " ");
    if (text.empty()) continue;
    if (entry.name == "playMode")
      out += ", " + text;
    else if (entry.name == "score" && before == "playMode")
      out += ' ' + text;
    else
      out += fmt::format(", {} {}", entry.name, text);
    before = entry.name;
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
