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

/// Reads or writes a property by name, calls a method by name. Throws Error: unknown name (with the nearest), wrong
/// type or count, out of range.
Value getProperty(const Leaf& leaf, std::string_view name);
void setProperty(Leaf& leaf, std::string_view name, const Value& value);
/// Writes a property already found. Throws Error: read only, wrong type or count, out of range.
void writeProperty(const Property& property, Leaf& leaf, Args& args);
Value callMethod(Leaf& leaf, std::string_view name, std::span<const Value> arguments);
/// As callMethod for a method already found. `loose`: conversions and counts as the installed base's scene files have
/// them; returns false (and does nothing) where the original silently ignored the call.
bool callLoosely(Leaf& leaf, const Method& method, std::span<const Value> arguments, std::string& whyNot);

}  // namespace spark
