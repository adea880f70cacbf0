#pragma once
/// \file
/// Which program is at the other end of a connection within this machine.

#include <sys/types.h>

namespace spark::spades {

/// True if a process of the group `group` holds the other end of the TCP connection `socket`, whose both ends are in
/// this machine. Without /proc, which says so, true for every connection.
bool isConnectedTo(int socket, pid_t group);

}  // namespace spark::spades
