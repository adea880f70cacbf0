#pragma once
/// \file
/// Runs work in a separate process, whose memory and CPU time are those of the host alone.

#include <functional>
#include <nlohmann/json.hpp>

namespace spark::bench {

/// Rows and numbers in the order in which they are added.
using Json = nlohmann::ordered_json;

class Child {
 public:
  /// Starts `work` in a forked process. result() gives its return value or exception. `line` is the child's end of a
  /// socket to the parent.
  explicit Child(const std::function<Json(int line)>& work);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// The parent's end of the socket. The child's end is closed when the child has ended.
  int line() const { return line_; }
  /// Waits until the child ends. Throws Error with the child's exception, or with its exit status if it crashed.
  Json result();

 private:
  int pid_ = -1, line_ = -1, result_ = -1;
};

}  // namespace spark::bench
