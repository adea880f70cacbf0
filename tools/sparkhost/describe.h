#pragma once
/// \file
/// What --list-plugins and --describe print.

#include <string>
#include <string_view>

#include "spark/kernel.h"

namespace sparkhost {

/// One paragraph a plugin: name, version, what it is for, file, classes.
std::string pluginList(spark::Kernel& kernel);

/// A class as it describes itself: bases, plugin, interfaces, properties with type, unit, range and default, methods,
/// phases. Registers the plugins that provide it and its bases. Throws spark::Error for an unknown class.
std::string classDescription(spark::Kernel& kernel, std::string_view className);

}  // namespace sparkhost
