// The S-expression reader. It does not crash or exceed its limits, and its result can be written.
#include <cstdint>
#include <cstdlib>

#include "fuzz/check_tree.h"
#include "spark/read_message.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  spark::Predicates read;
  const spark::ReadLimits limits{16, 4096};
  const auto result = spark::readSexp(bytes, read, limits);
  if (result.consumed > size || read.size() > limits.maxTokens) std::abort();
  if (result.message.empty() && result.consumed != size) std::abort();
  spark::fuzz::checkTree(read);
  std::string text;
  spark::writeSexp(read, 2, text);

  // Reading around the mistakes of a message gives at least what is in front of the first.
  spark::Predicates around;
  if (spark::readMessage(bytes, around, limits).consumed > size || around.size() > limits.maxTokens) std::abort();
  if (around.size() < read.size()) std::abort();
  spark::fuzz::checkTree(around);

  // A reader with a maximum number of expressions stops at the end of an expression.
  spark::Predicates one;
  spark::readSexp(bytes, one, limits, 1);
  spark::fuzz::checkTree(one);
  return 0;
}
