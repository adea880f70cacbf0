#pragma once
/// \file
/// JSON to predicates: arrays are lists, strings and numbers are atoms.

#include <string_view>

#include "spark/predicates.h"

namespace spark::json {

/// Reads any number of JSON values and appends their predicates to `out`. `["he1", 1.2]` is one predicate; an array
/// that begins with an array contains several, `[["he1", 1.2], ["syn"]]`. Booleans become the texts true and false,
/// null becomes NaN; objects are refused. After an error `out` keeps the complete predicates before it. Does not throw
/// on invalid input.
ReadResult read(std::string_view bytes, Predicates& out, const ReadLimits& limits);

}  // namespace spark::json
