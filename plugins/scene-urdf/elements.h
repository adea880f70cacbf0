#pragma once
/// \file
/// Elements of a URDF file.

#include <optional>
#include <vector>

#include "api/math.h"
#include "robot/document.h"

namespace spark::urdf {

using mjcf::Element;
using mjcf::Unsupported;

std::vector<Element> childrenOf(const Element& e);
/// The first child of that tag.
std::optional<Element> childOf(const Element& e, const char* tag);
/// The attribute `name`. Throws Error where it is missing.
std::string nameOf(const Element& e);
/// An attribute as text; "" where it is missing.
std::string_view textOf(const Element& e, const char* attribute);
/// What is in an element as `<mu1>0.5</mu1>` or as `<mu1 value="0.5"/>`, without blanks around it.
std::string_view contentOf(const Element& e);

/// Numbers of a text; nullopt if it has other things in it, or none. Blanks or commas are between them.
std::optional<std::vector<double>> numbersOf(std::string_view text);

/// Numbers in attributes. What cannot be read counts as not given, and is named in `unsupported`.
class Numbers {
 public:
  Numbers(const Element& e, Unsupported& unsupported) : element_(e), unsupported_(unsupported) {}
  double number(const char* attribute, double otherwise);
  /// Writes a whole array; false where the attribute is not there, or is ignored.
  template <class Array>
  bool take(const char* attribute, Array& out) {
    const auto found = read(attribute, static_cast<std::size_t>(out.size()));
    if (found)
      for (std::size_t i = 0; i < found->size(); ++i) out[static_cast<int>(i)] = (*found)[i];
    return found.has_value();
  }

 private:
  std::optional<std::vector<double>> read(const char* attribute, std::size_t count);
  const Element element_;
  Unsupported& unsupported_;
};

/// The element `origin` in `e`: a pose in the frame around.
Pose originOf(const Element& e, Unsupported& unsupported);

}  // namespace spark::urdf
