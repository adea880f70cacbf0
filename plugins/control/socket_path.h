#pragma once
/// \file
/// Paths of control sockets: one per simulation, named after its process, in $XDG_RUNTIME_DIR/spark or
/// $TMPDIR/spark-<uid>.

#include <filesystem>

namespace spark::control {

/// The folder for this user's control sockets; created with mode 0700 if missing. Throws Error if it belongs to another
/// user or is accessible to others.
std::filesystem::path socketFolder();

/// An unused path in the folder: `<pid>.sock`, `<pid>-2.sock`, ... Removes a file of that name that a dead process has
/// left.
std::filesystem::path freeSocket(const std::filesystem::path& folder);

/// Removes the sockets of simulations whose process has ended.
void removeStale(const std::filesystem::path& folder);

}  // namespace spark::control
