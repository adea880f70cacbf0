#pragma once
/// \file
/// A row of the table: column names and values, in order.

#include <nlohmann/json.hpp>

namespace sparkbatch {

using Json = nlohmann::ordered_json;

/// A JSON object. Every row has `run`, the number, and `end`, how the run ended: "duration", "stopped" (by the config
/// or a plugin), "error".
using Row = Json;

}  // namespace sparkbatch
