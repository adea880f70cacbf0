#pragma once
/// \file
/// Private to the loader: the public headers that this host and its plugins were built with.

namespace spark {

/// Texts such as "api/physics.h 0123456789abcdef": a header and the hash of its text without comments. In order of
/// name, ended by nullptr.
extern const char* const kHostHeaders[];

}  // namespace spark
