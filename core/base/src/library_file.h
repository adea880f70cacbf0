#pragma once
/// \file
/// Private to the loader: whether a file may be given to the dynamic linker.

#include <string>

namespace spark {

/// "" when the file is a whole shared library for this machine as far as its headers say, else what is wrong: a
/// sentence's second half, "it is ...". The linker trusts its headers and ends the process where they are damaged; what
/// lies behind them is not looked at. Never waits: what is no regular file is not read. "" also for what cannot be
/// opened: the linker says that better.
std::string libraryProblem(const std::string& path);

}  // namespace spark
