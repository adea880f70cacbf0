#pragma once
/// \file
/// JSON to predicates: arrays are lists, strings and numbers are atoms.

#include <string_view>

#include "spark/read_message.h"

namespace spark::json {

/// Reads any number of JSON values and appends their predicates to `out`. `["he1", 1.2]` is one predicate; an array
/// that begins with an array contains several, `[["he1", 1.2], ["syn"]]`. Booleans become the texts true and false,
/// null becomes NaN; objects are refused. `binary`: the characters of a text are bytes, U+0000 to U+00FF. A mistake
/// costs its predicate, as with readMessage(); the first one is returned. Does not throw on invalid input.
ReadResult read(std::string_view bytes, Predicates& out, const ReadLimits& limits, bool binary = false);

}  // namespace spark::json
