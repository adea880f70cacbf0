#pragma once
/// \file
/// What a game reports of itself (api/status.h), as the host's status line and its last line on stdout have it.

#include <string>
#include <vector>

#include "api/status.h"
#include "spark/json_writer.h"

namespace sparkhost {

/// ", PlayOn 1:0, round 3": a play mode without its name, the score behind it; all else as `name value`. Empty texts
/// are left out.
std::string statusText(const std::vector<spark::StatusEntry>& entries);

/// Members of the object that is open: `"playMode":"PlayOn","score":[1,0],"status":{"round":3}`.
void writeStatus(spark::JsonWriter& json, const std::vector<spark::StatusEntry>& entries);

}  // namespace sparkhost
