#pragma once
/// \file
/// Output of rows as tables and as files.

#include <filesystem>

#include "child.h"
#include "worlds.h"

namespace spark::bench {

/// Prints the head of the table.
void printHead();
/// Prints the rows of one world.
void printRows(const World& world, const Json& rows);

/// Writes all rows as comma-separated values with a line of names. Values that a row does not have are empty. Throws
/// Error.
void writeCsv(const Json& rows, const std::filesystem::path& file);

/// Draws the CPU time of a cycle in each world, by raw ODE and by the host in process with one thread, as SVG. Throws
/// Error.
void writeChart(const Json& rows, const std::filesystem::path& file);

/// Appends the main figures to the file of this machine's processor in `folder`, with date and commit. Returns the
/// file. Throws Error.
std::filesystem::path appendHistory(const Json& rows, const std::filesystem::path& folder);

}  // namespace spark::bench
