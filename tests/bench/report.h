#pragma once
/// \file
/// Rows as people and programs read them.

#include <filesystem>

#include "child.h"
#include "worlds.h"

namespace spark::bench {

/// The table's head.
void printHead();
/// One world's rows.
void printRows(const World& world, const Json& rows);

/// All rows as comma-separated values, with a line of names; what a row does not have stays empty. Throws Error.
void writeCsv(const Json& rows, const std::filesystem::path& file);

/// Draws the CPU time of a cycle in each world, by raw ODE and by the host in process with one thread, as SVG. Throws
/// Error.
void writeChart(const Json& rows, const std::filesystem::path& file);

/// Appends the main figures to the file of this machine's processor in `folder`, with date and commit. Returns the
/// file. Throws Error.
std::filesystem::path appendHistory(const Json& rows, const std::filesystem::path& folder);

}  // namespace spark::bench
