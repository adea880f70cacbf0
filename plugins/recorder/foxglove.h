#pragma once
/// \file
/// Messages in schemas of Foxglove, which other programs show: https://docs.foxglove.dev/docs/sdk/schemas.

#include <string>
#include <string_view>

#include "mcap.h"
#include "spark/json_writer.h"
#include "spark/log.h"

namespace spark::recorder {

/// The schemas of logMessage(), Frames::shapes() and Places::message(): names, types, and the fields at the top.
mcap::Schema logSchema();
mcap::Schema shapesSchema();
mcap::Schema placesSchema();

/// Writes a member that is a time.
void writeTime(JsonWriter& json, const char* key, mcap::Time time);
/// A line of the log as a message of the schema foxglove.Log.
std::string logMessage(mcap::Time time, Level level, std::string_view line);

}  // namespace spark::recorder
