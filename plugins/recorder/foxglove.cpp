#include "foxglove.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::recorder {

namespace {
constexpr std::string_view kObjects = R"({"type":"array","items":{"type":"object"}})";

/// A schema whose fields are all required. `properties`: JSON.
mcap::Schema schemaOf(std::string_view name, std::string_view required, std::string_view properties) {
  return {std::string(name), "jsonschema",
          fmt::format(R"({{"title":"{}","type":"object","required":[{}],"properties":{{{}}}}})", name, required,
                      properties)};
}
}  // namespace

mcap::Schema logSchema() {
  constexpr std::string_view kInteger = R"({"type":"integer"})", kText = R"({"type":"string"})";
  return schemaOf("foxglove.Log", R"("timestamp","level","message","name","file","line")",
                  fmt::format(R"("timestamp":{{"type":"object","properties":{{"sec":{0},"nsec":{0}}}}},)"
                              R"("level":{0},"message":{1},"name":{1},"file":{1},"line":{0})",
                              kInteger, kText));
}

mcap::Schema shapesSchema() {
  return schemaOf("foxglove.SceneUpdate", R"("deletions","entities")",
                  fmt::format(R"("deletions":{0},"entities":{0})", kObjects));
}

mcap::Schema placesSchema() {
  return schemaOf("foxglove.FrameTransforms", R"("transforms")", fmt::format(R"("transforms":{})", kObjects));
}

void writeTime(JsonWriter& json, const char* key, mcap::Time time) {
  constexpr mcap::Time kSecond = 1'000'000'000;
  json.key(key).beginObject().member("sec", time / kSecond).member("nsec", time % kSecond).endObject();
}

std::string logMessage(mcap::Time time, Level level, std::string_view line) {
  std::string out;
  JsonWriter json(out);
  json.beginObject();
  writeTime(json, "timestamp", time);
  // DEBUG, INFO, WARNING and ERROR are 1 to 4.
  json.member("level", std::max(1, static_cast<int>(level))).member("message", line);
  json.member("name", "sparkhost").member("file", "").member("line", 0).endObject();
  return out;
}

}  // namespace spark::recorder
