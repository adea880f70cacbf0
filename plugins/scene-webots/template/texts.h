#pragma once
/// \file
/// modules.js and modules.lua, which the build makes part of the program.

#include <string_view>

namespace spark::templates {

extern const std::string_view kJavascriptModules, kLuaModules;

}  // namespace spark::templates
