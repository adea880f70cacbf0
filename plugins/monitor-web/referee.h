#pragma once
/// \file
/// The token with which a viewer becomes a referee.

#include <string>
#include <string_view>

namespace spark::web {

/// A new token: 128 random bits of the system as 32 hexadecimal digits. Throws Error if the system has none.
std::string makeToken();

/// True if they are equal and not empty. Its run time depends only on the length of `given`, not on its content.
bool isToken(std::string_view token, std::string_view given);

/// Number of wrong tokens after which a viewer is disconnected.
inline constexpr int kMaxWrongTokens = 5;

}  // namespace spark::web
