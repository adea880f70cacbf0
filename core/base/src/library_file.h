#pragma once
/// \file
/// Private to the loader: checks a file before the dynamic linker gets it.

#include <string>

namespace spark {

/// Returns "" if the file is a complete shared library for this machine as far as its headers show, else the reason as
/// the second half of a sentence: "it is ...". The dynamic linker trusts these headers and would end the process if
/// they were damaged; code and data behind them are not checked. Never blocks: a file that is not a regular file is not
/// read. Returns "" also for a file that cannot be opened, because the linker has the better message for that.
std::string libraryProblem(const std::string& path);

}  // namespace spark
