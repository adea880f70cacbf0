#pragma once
/// \file
/// The exception type of set-up code, and hints for misspelt names.

#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/error.h"

namespace spark {

/// The exception thrown by all set-up code: configs, plugins, scenes, access to properties. Its text says where the
/// error is, what was expected, what was found and what to do. The step path never throws.
class Error : public std::exception {
 public:
  /// An error without a cause. `message` is its whole text.
  explicit Error(std::string message);
  /// An error with a cause: `what()` is "<message>\n  because: <cause>".
  Error(std::string_view message, const std::exception& cause);
  ~Error() override;
  /// The message, followed by one line for each cause, outermost first. Valid while the error lives.
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// A value that even the lenient calls of scene files refuse. It ends the import, which adds the location in the file
/// to the text.
class RefusedValue : public Error {
 public:
  using Error::Error;
};

/// Suggests up to three of the `candidates` that are spelt most like `wanted`, as a sentence that follows another one:
/// " Did you mean 'a' or 'b'?". Returns "" if no candidate is similar.
std::string didYouMean(std::string_view wanted, const std::vector<std::string>& candidates);

}  // namespace spark
