#pragma once
/// \file
/// The variables of an import.

#include <optional>
#include <string>
#include <vector>

#include "program.h"

namespace spark::rsg {

/// Template parameters and definitions of one import of one file. Their scope is the file, their values are texts.
///
/// The installed base keeps parameters and definitions in one list; when an import passes another number of arguments
/// than the template has parameters, names refer to wrong values from then on (scene-language section 1.6). By default
/// each name has its own value here, and using a parameter without an argument is an error; `byName` false reproduces
/// the list of the installed base.
class Environment {
 public:
  /// `program` must outlive the environment. `arguments` are those of the import.
  Environment(const Program& program, std::vector<std::string> arguments, bool byName);
  /// Declares the variable `slot` as the next template parameter. Throws Error when it is declared already.
  void parameter(std::size_t slot);
  /// Defines the variable `slot`, or replaces its value.
  void define(std::size_t slot, std::string value);
  /// The value of the variable `slot`. Throws Error when it is not defined, or is a parameter without an argument.
  const std::string& value(std::size_t slot) const;

 private:
  static constexpr int kUndeclared = -1;
  [[noreturn]] void missing(std::size_t slot) const;
  const Program& program_;
  std::vector<std::string> arguments_;              ///< not by name: the list of arguments and definitions
  std::vector<std::optional<std::string>> values_;  ///< by name: value of each slot
  std::vector<int> index_;                          ///< of each slot: position in the list, or kUndeclared
  std::size_t given_;                               ///< number of arguments of the import
  int names_ = 0;                                   ///< number of declared slots
  std::size_t parameters_ = 0;                      ///< number of declared parameters
  bool byName_;
};

}  // namespace spark::rsg
