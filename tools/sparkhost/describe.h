#pragma once
/// \file
/// The output of --list-plugins and --describe.

#include <string>
#include <string_view>

#include "spark/kernel.h"

namespace sparkhost {

/// One paragraph per plugin: name, version, purpose, file, classes.
std::string pluginList(spark::Kernel& kernel);

/// The description of a class: bases, plugin, interfaces, phases, links, properties with type, unit, range and default,
/// methods. Registers the plugins of the class and its bases. Throws spark::Error if the class is unknown.
std::string classDescription(spark::Kernel& kernel, std::string_view className);

}  // namespace sparkhost
