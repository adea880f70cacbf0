#pragma once
/// \file
/// The one exception type of set-up code, and the hint that follows a misspelt name.

#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/error.h"

namespace spark {

/// Thrown by everything that happens at set-up (configs, plugins, scenes, property access).
/// The text says where, what was expected, what was found and what to do. Never thrown in the step path.
class Error : public std::exception {
 public:
  /// An error of its own, `message` being its whole text.
  explicit Error(std::string message);
  /// An error with a cause: `what()` reads "<message>\n  because: <cause>".
  Error(std::string_view message, const std::exception& cause);
  ~Error() override;
  /// The whole chain, outermost first, one cause a line.
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// A value that is refused however lenient a scene file's calls are taken: the import ends, with the place in the file.
class RefusedValue : public Error {
 public:
  using Error::Error;
};

/// The up to three `candidates` nearest to `wanted` as a sentence (" Did you mean 'a' or 'b'?"), or "" when nothing is
/// near.
std::string didYouMean(std::string_view wanted, const std::vector<std::string>& candidates);

}  // namespace spark
