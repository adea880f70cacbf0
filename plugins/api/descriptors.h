#pragma once
/// \file
/// File descriptors of this process and the programs that it starts.

#include <fcntl.h>

#include "spark/abi/api/descriptors.h"

namespace spark {

/// Programs that this process starts do not get the descriptor. For those that a library opens without O_CLOEXEC, such
/// as sockets of Boost.Asio: a program that has a listening socket can answer in the host's place.
inline void closeOnExec(int descriptor) { ::fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

}  // namespace spark
