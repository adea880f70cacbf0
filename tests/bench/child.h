#pragma once
/// \file
/// Work in a process of its own: memory is its own, and its CPU time is the host's alone.

#include <functional>
#include <nlohmann/json.hpp>

namespace spark::bench {

/// Rows and numbers, in the order in which they are put.
using Json = nlohmann::ordered_json;

class Child {
 public:
  /// Starts `work` in a fork; what it returns, or throws, comes back by result(). `line` is its end of a line to us.
  explicit Child(const std::function<Json(int line)>& work);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// Our end of the line; closed when the child has ended.
  int line() const { return line_; }
  /// Waits for its end. Throws Error with what the child threw, or how it died.
  Json result();

 private:
  int pid_ = -1, line_ = -1, result_ = -1;
};

}  // namespace spark::bench
