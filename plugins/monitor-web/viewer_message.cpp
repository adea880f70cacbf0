#include "viewer_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "spark/error.h"

namespace spark::web {

namespace {
using Json = nlohmann::json;
constexpr int kMaxJsonDepth = 32;

/// Parses an object of at most kMaxJsonDepth levels.
Json parse(std::string_view text) {
  const auto shallow = [](int depth, Json::parse_event_t, Json&) {
    if (depth > kMaxJsonDepth) throw Error(fmt::format("expected JSON nested at most {} deep", kMaxJsonDepth));
    return true;
  };
  try {
    Json message = Json::parse(text, shallow);
    if (message.is_object()) return message;
  } catch (const Json::exception&) {
  }
  throw Error("expected one JSON object a message, {\"do\":...}");
}

std::string textOf(const Json& message, const char* key) {
  const auto at = message.find(key);
  if (at == message.end() || !at->is_string()) throw Error(fmt::format("the message lacks a text \"{}\"", key));
  return at->get<std::string>();
}

std::int64_t idOf(const Json& message, bool required) {
  const auto at = message.find("id");
  if (at != message.end() && at->is_number_integer()) return at->get<std::int64_t>();
  if (required || at != message.end())
    throw Error("the message lacks a whole number \"id\", by which its answer is known");
  return 0;
}

void readView(const Json& message, ViewerMessage& out) {
  if (const auto rate = message.find("rate"); rate != message.end()) {
    if (!rate->is_number()) throw Error("expected a number as \"rate\"");
    out.rate = std::clamp(rate->get<double>(), kMinRate, kMaxRate);
  }
  const auto detail = message.find("detail");
  if (detail == message.end()) return;
  if (*detail != "fine" && *detail != "coarse") throw Error("expected \"fine\" or \"coarse\" as \"detail\"");
  out.fine = *detail == "fine";
}
void readHistory(const Json& message, ViewerMessage& out) {
  if (const auto at = message.find("at"); at != message.end()) {
    if (!at->is_number()) throw Error("expected a time in seconds as \"at\"");
    out.at = at->get<double>();
  }
  if (const auto scene = message.find("scene"); scene != message.end()) {
    if (!scene->is_number_unsigned() || scene->get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
      throw Error("expected the number of a scene as \"scene\"");
    out.scene = scene->get<std::uint32_t>();
  }
}
}  // namespace

ViewerMessage readViewerMessage(std::string_view text) {
  using What = ViewerMessage::What;
  const Json message = parse(text);
  const std::string what = textOf(message, "do");
  ViewerMessage out;
  if (what == "view") {
    out.what = What::view;
    readView(message, out);
  } else if (what == "drawings") {
    out.what = What::drawings;
    const auto on = message.find("on");
    if (on == message.end() || !on->is_boolean()) throw Error("expected \"on\" to be true or false");
    out.on = on->get<bool>();
  } else if (what == "history") {
    out.what = What::history;
    out.id = idOf(message, true);
    readHistory(message, out);
  } else if (what == "login") {
    out.what = What::login;
    out.text = textOf(message, "token");
  } else if (what == "command") {
    out.what = What::command;
    out.id = idOf(message, false);
    out.text = textOf(message, "text");
  } else {
    out.what = what == "unwatch" ? What::unwatch : What::request;
    out.id = idOf(message, true);
    out.watch = what == "watch";
    out.text = text;
  }
  return out;
}

}  // namespace spark::web
