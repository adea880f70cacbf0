#pragma once
/// \file
/// Access rights of clients: tokens, and the user behind a local socket.

#include <fmt/format.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "spark/abi/api/credentials.h"
#include "spark/error.h"
#include "spark/value.h"

namespace spark {

/// The type of a parameter that is a secret, such as a token: recordings leave out its value, and as a property or a
/// result it is "".
struct Secret {
  std::string text;
};

template <>
struct Convert<Secret> {
  static constexpr int kScalars = 1;
  static constexpr const char* kName = "secret";
  static std::string typeName() { return kName; }
  static Secret from(Args& args) { return {Convert<std::string>::from(args)}; }
  static Value to(const Secret&) { return ""; }
};

/// A new token: 128 random bits of the system as 32 hexadecimal digits. Throws Error if the system has none.
inline std::string makeToken() {
  std::array<unsigned char, 16> bytes;
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error(fmt::format("cannot make a token: the system gives no random numbers: {}", std::strerror(errno)));
  std::string out;
  for (const unsigned char byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

/// True if they are equal and not empty. Its run time depends only on the length of `given`, not on its content.
inline bool isToken(std::string_view token, std::string_view given) {
  if (token.empty()) return false;
  unsigned difference = token.size() == given.size() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(given[i]) ^
                                        static_cast<unsigned char>(token[i % token.size()]));
  return difference == 0;
}

/// True if the peer of a connected Unix socket runs as the user of this program.
inline bool isSameUser(int descriptor) {
  struct ucred peer = {};
  socklen_t size = sizeof peer;
  return getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

}  // namespace spark
