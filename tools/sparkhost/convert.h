#pragma once
/// \file
/// --convert: a file of any scene language as a file of Spark's own.

#include <string>

#include "options.h"

namespace sparkhost {

/// Imports the file `in`, a path or a resource, and writes what it made to the file `out`, as a scene file of version
/// 0.2. Then imports that file, and compares both trees. Throws spark::Error, and leaves no file, for what the language
/// cannot express, with node and property. Logs warnings for what belongs to the world and not to the file.
void convert(const Options& options, const std::string& in, const std::string& out);

}  // namespace sparkhost
