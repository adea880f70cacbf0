#pragma once
/// \file
/// JSON to predicates: arrays are lists, strings and numbers are atoms.

#include <string_view>

#include "spark/predicates.h"

namespace spark::json {

/// Reads any number of JSON values and appends their predicates to `out`. `["he1", 1.2]` is one predicate; an array
/// that begins with an array holds several, `[["he1", 1.2], ["syn"]]`. Booleans are the texts true and false, null is
/// not-a-number, objects are refused. At an error what was complete before stays. Never throws on bad bytes.
ReadResult read(std::string_view bytes, Predicates& out, const ReadLimits& limits);

}  // namespace spark::json
