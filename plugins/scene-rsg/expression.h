#pragma once
/// \file
/// Expressions of `(eval ...)`: numbers, + - * /, parentheses, variables `Group.name`, `Group[index]['key']`. Computed
/// here, never by an interpreter.

#include <functional>
#include <string>
#include <string_view>

#include "spark/value.h"

namespace spark::rsg {

/// Gives the value of `group.member` (`member` empty: of the bare group). Throws Error when there is none.
using VariableLookup = std::function<Value(std::string_view group, std::string_view member)>;

/// Computes an expression. `integerDivision`: two integers divide to the floor, as in Ruby; otherwise division is real.
/// Throws Error: what was expected, what was found. Results that are no finite numbers are errors.
Value evaluate(std::string_view text, const VariableLookup& lookup, bool integerDivision);

/// The text that a result becomes. `digits6`: numbers that are not integers are narrowed to single precision and
/// written with six significant digits, as the installed base does at every level. Throws Error for values that have no
/// text.
std::string resultText(const Value& value, bool digits6);

}  // namespace spark::rsg
