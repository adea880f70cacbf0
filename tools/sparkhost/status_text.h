#pragma once
/// \file
/// The game's status (api/status.h) as text for the status line and as JSON for the last line on stdout.

#include <string>
#include <vector>

#include "api/status.h"
#include "spark/json_writer.h"

namespace sparkhost {

/// ", PlayOn 1:0, round 3": the play mode and a score after it without names; other entries as `name value`. Empty
/// values are omitted.
std::string statusText(const std::vector<spark::StatusEntry>& entries);

/// Writes members into the current object: `"playMode":"PlayOn","score":[1,0],"status":{"round":3}`.
void writeStatus(spark::JsonWriter& json, const std::vector<spark::StatusEntry>& entries);

}  // namespace sparkhost
