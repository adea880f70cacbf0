#pragma once
/// \file
/// What a file says of the run that wrote it.

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mcap.h"
#include "spark/kernel.h"
#include "spark/sources.h"

namespace spark::recorder {

/// Simulated time in a recording.
inline mcap::Time nanoseconds(double seconds) { return static_cast<mcap::Time>(std::llround(seconds * 1e9)); }

/// The values of the metadata `spark`: command line, seed and configuration hash.
std::map<std::string, std::string> about(Kernel& kernel, const std::vector<std::string>& arguments);

inline constexpr std::string_view kAttachmentType = "application/octet-stream";
/// A text of the run as an attachment: "script:boxes.lua".
std::string attachmentName(const Sources::Source& source);
/// The channel with that topic; 0: there is none. Throws Error if another version wrote it.
std::uint16_t channelOf(const mcap::Reader& recording, std::string_view topic, std::string_view encoding);
/// Where a state stands.
struct StateAt {
  std::size_t chunk = 0;
  mcap::Time time = 0;
};
/// The newest state that is not later than `seconds`; none if there is none that can be read. Throws Error if another
/// version wrote it.
std::optional<StateAt> stateBefore(mcap::Reader& recording, double seconds);
/// Adds the texts that were attached up to that time to the sources of a kernel that goes on from then. Texts that are
/// damaged are left out.
void addTexts(const mcap::Reader& recording, mcap::Time until, Sources& to);

}  // namespace spark::recorder
