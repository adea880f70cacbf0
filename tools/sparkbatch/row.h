#pragma once
/// \file
/// A row of the table: column names and values, in order.

#include <nlohmann/json.hpp>

namespace sparkbatch {

using Json = nlohmann::ordered_json;

/// A JSON object. Every row has `run`; `end` says how the run ended: "duration", "stopped" (something in the config
/// ended it), "error".
using Row = Json;

}  // namespace sparkbatch
