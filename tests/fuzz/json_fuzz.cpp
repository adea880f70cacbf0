// The JSON reader. It does not crash, throw or exceed its limits.
#include <cstdint>
#include <cstdlib>

#include "fuzz/check_tree.h"
#include "parser-json/json_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  spark::Predicates read;
  read.open("kept").close();
  const auto result = spark::json::read(bytes, read, {16, 4096});
  if (read.size() < 2 || read.size() > 2 + 4096) std::abort();
  if (result.message.empty() && result.consumed != size) std::abort();
  spark::fuzz::checkTree(read);
  return 0;
}
