#include "about.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "input_codec.h"
#include "spark/error.h"
#include "spark/state.h"

namespace spark::recorder {

std::map<std::string, std::string> about(Kernel& kernel, const std::vector<std::string>& arguments) {
  return {{"arguments", nlohmann::json(arguments).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)},
          {"seed", std::to_string(kernel.seed())},
          {"configurationHash", fmt::format("{:016x}", configurationHash(kernel.root()))}};
}

std::string attachmentName(const Sources::Source& source) { return source.kind + ":" + source.name; }

std::uint16_t channelOf(const mcap::Reader& recording, std::string_view topic, std::string_view encoding) {
  const std::uint16_t out = recording.channelOf(topic);
  if (out != 0 && recording.channels().at(out).encoding != encoding)
    throw Error(fmt::format("expected {} in the encoding {}, found {}: another version of Spark wrote it; use that one",
                            topic, encoding, recording.channels().at(out).encoding));
  return out;
}

std::optional<StateAt> stateBefore(mcap::Reader& recording, double seconds) {
  const std::uint16_t states = channelOf(recording, kStates, kStatesEncoding);
  const auto inTime = [seconds](mcap::Time time) { return static_cast<double>(time) * 1e-9 <= seconds + 1e-9; };
  std::optional<StateAt> out;
  for (std::size_t i = recording.chunks().size(); states != 0 && i-- > 0 && !out;) {
    if (!inTime(recording.chunks()[i].begin)) continue;
    recording.forEach(recording.chunks()[i], [&](const mcap::Message& m) {
      if (m.channel == states && inTime(m.time)) out = {i, m.time};
      return true;
    });
  }
  return out;
}

void addTexts(const mcap::Reader& recording, mcap::Time until, Sources& to) {
  for (const mcap::Reader::Attachment& a : recording.attachments()) {
    const std::size_t colon = a.name.find(':');
    if (a.time > until || colon == std::string::npos) continue;
    try {
      to.add(a.name.substr(0, colon), a.name.substr(colon + 1), recording.read(a));
    } catch (const Error&) {
      continue;  // the reader of files says so
    }
  }
}

}  // namespace spark::recorder
