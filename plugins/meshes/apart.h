#pragma once
/// \file
/// Work of libraries that may crash.

#include <functional>
#include <string>

namespace spark::meshes {

/// Does `work` in a copy of this process and returns its result, of at most 1 GiB. A crash, more than 1.5 GiB of
/// further memory or more than 10 s of CPU time ends the copy alone. `work` has no descriptor of this process but 0.
/// Nothing else that `work` changes is seen here. Throws Error with the message of an exception of `work`, or that says
/// how the copy ended.
std::string doneApart(const std::function<std::string()>& work);

}  // namespace spark::meshes
