#pragma once
/// \file
/// Elements of a URDF file.

#include <optional>
#include <vector>

#include "api/math.h"
#include "robot/document.h"

namespace spark::urdf {

using mjcf::Attributes;
using mjcf::Element;
using mjcf::Unsupported;

std::vector<Element> childrenOf(const Element& e);
/// The first child of that tag.
std::optional<Element> childOf(const Element& e, const char* tag);
/// The attribute `name`. Throws Error where it is missing.
std::string nameOf(const Element& e);
/// The element `origin` in `e`: a pose in the frame around. Throws Error for bad numbers.
Pose originOf(const Element& e, Unsupported& unsupported);

}  // namespace spark::urdf
