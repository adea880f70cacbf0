#pragma once
/// \file
/// The page that is served if the viewer was not built: it shows live numbers and what is missing to build the viewer.

#include <string>
#include <string_view>

namespace spark::web {

/// The page as HTML. `missing`: what is missing to build the viewer; "" if unknown.
std::string plainPage(std::string_view missing);

/// The script of the page, served as /plain.js.
extern const char* const kPlainScript;

}  // namespace spark::web
