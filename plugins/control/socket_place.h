#pragma once
/// \file
/// Where control sockets live: $XDG_RUNTIME_DIR/spark or $TMPDIR/spark-<uid>, one file per house, named after the
/// process.

#include <filesystem>

namespace spark::control {

/// The folder for this user's control sockets; made with mode 0700 when missing. Throws Error when it belongs to
/// somebody else or others may look into it.
std::filesystem::path socketFolder();

/// A name in the folder that no living house uses: `<pid>.sock`, `<pid>-2.sock`, ... Removes a file that a dead process
/// left there.
std::filesystem::path freeSocket(const std::filesystem::path& folder);
/// Removes the sockets of houses whose process has gone.
void sweep(const std::filesystem::path& folder);

}  // namespace spark::control
