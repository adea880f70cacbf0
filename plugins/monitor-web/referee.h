#pragma once
/// \file
/// The token that makes a viewer a referee.

#include <string>
#include <string_view>

namespace spark::web {

/// 128 bits of the system's randomness, as 32 hexadecimal digits. Throws Error when the system gives none.
std::string makeToken();

/// True when they are equal; the time it takes tells only the length of `given`.
bool isToken(std::string_view token, std::string_view given);

/// Wrong tokens after which a connection is closed.
inline constexpr int kMostWrongTokens = 5;

}  // namespace spark::web
