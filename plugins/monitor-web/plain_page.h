#pragma once
/// \file
/// What is served where the viewer was not built: the live numbers, and what is missing.

#include <string>
#include <string_view>

namespace spark::web {

/// The page; `lacks` says what is missing, "" when that is not known.
std::string plainPage(std::string_view lacks);

/// Its script, /plain.js.
extern const char* const kPlainScript;

}  // namespace spark::web
