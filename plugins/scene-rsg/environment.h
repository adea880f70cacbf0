#pragma once
/// \file
/// The variables of one import of one file.

#include <optional>
#include <string>
#include <vector>

#include "program.h"

namespace spark::rsg {

/// Template parameters and definitions; file scope, all values are texts.
///
/// The installed base keeps parameters and definitions in one list and lets the two counters drift apart when an import
/// passes another number of arguments than the template has names (scene-language section 1.6). By default each name
/// has its own value instead, and a parameter that was not given is an error where it is used; `byName` false keeps the
/// drifting list.
class Environment {
 public:
  Environment(const Program& program, std::vector<std::string> arguments, bool byName);
  /// Declares the next template parameter. Throws Error when the name exists.
  void parameter(int slot);
  /// Defines or overwrites.
  void define(int slot, std::string value);
  /// Throws Error: not defined, or not given by the import.
  const std::string& value(int slot) const;

 private:
  [[noreturn]] void missing(int slot) const;
  const Program& program_;
  std::vector<std::string> arguments_;              // not by name: the one list
  std::vector<std::optional<std::string>> values_;  // by name: of each slot
  std::vector<int> index_;                          // of each declared slot: its place in the list, else -1
  std::size_t given_;
  int names_ = 0, parameters_ = 0;
  bool byName_;
};

}  // namespace spark::rsg
