#pragma once
/// \file
/// Evaluation of the expressions in `(eval ...)`: numbers, + - * /, parentheses, variables `Group.name` and
/// `Group[index]['key']`. No script interpreter is involved.

#include <functional>
#include <string>
#include <string_view>

#include "spark/value.h"

namespace spark::rsg {

/// Returns the value of `group.member`; with an empty `member`, of the group itself. Throws Error when there is none.
using VariableLookup = std::function<Value(std::string_view group, std::string_view member)>;

/// Evaluates an expression. `integerDivision` true: the quotient of two integers is rounded down, as in Ruby; false:
/// division is real. Throws Error for malformed expressions and for results that are not finite.
Value evaluate(std::string_view text, const VariableLookup& lookup, bool integerDivision);

/// Formats a result as text. `digits6` true: numbers that are not integers are rounded to single precision and to six
/// significant digits, as in the installed base. Throws Error for numbers beyond single precision, and for lists,
/// tables and nil.
std::string resultText(const Value& value, bool digits6);

}  // namespace spark::rsg
