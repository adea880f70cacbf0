#pragma once
/// \file
/// Reads the elements `equality` and `tendon`.

#include "compiler.h"
#include "robot/model.h"

namespace spark::mjcf {

/// Reads what is in these sections.
class ConstraintReader {
 public:
  ConstraintReader(const Compiler& compiler, const Defaults& defaults, Unsupported& unsupported)
      : compiler_(compiler), defaults_(defaults), unsupported_(unsupported) {}
  /// Adds what it takes to the model. Throws Error.
  void equality(const Element& e, Model& model);
  /// `parts`: the elements in it. Throws Error.
  void tendon(const Element& e, const std::vector<Element>& parts, Model& model);

 private:
  Attributes attributes(const Element& e, const char* tag);
  const Compiler& compiler_;
  const Defaults& defaults_;
  Unsupported& unsupported_;
};

}  // namespace spark::mjcf
