#pragma once
/// \file
/// Properties and methods of any object by name, for scripts, scene files and tools.

#include <span>
#include <string>
#include <string_view>

#include "spark/abi/spark/access.h"
#include "spark/value.h"

namespace spark {

class Leaf;
struct Method;
struct Property;

/// Reads a property. Throws Error if there is none of that name, with the nearest names.
Value getProperty(const Leaf& leaf, std::string_view name);
/// Writes a property. Throws Error if there is none of that name, if it is read only, or if the value has a wrong type
/// or is out of range.
void setProperty(Leaf& leaf, std::string_view name, const Value& value);
/// Writes a property that is not read only. Throws Error if the arguments have a wrong type or are out of range.
void writeProperty(const Property& property, Leaf& leaf, Args& args);
/// Calls a method and returns its result. Throws Error if there is none of that name, with the nearest names, if type
/// or number of the arguments is wrong, or if the method throws.
Value callMethod(Leaf& leaf, std::string_view name, std::span<const Value> arguments);
/// Calls a method as a scene file does, with loose conversions (Args::loose). Returns false, with the reason in
/// `whyNot`, if the call fails; the installed base ignores such calls. Throws RefusedValue only.
bool callLoosely(Leaf& leaf, const Method& method, std::span<const Value> arguments, std::string& whyNot);

}  // namespace spark
