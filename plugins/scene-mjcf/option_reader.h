#pragma once
/// \file
/// Reads the element `option` of an MJCF model, and its flags.

#include "robot/model.h"

namespace spark::mjcf {

/// Adds what an element `option` says to Model::options. Throws Error.
void readOption(Attributes& a, Model& model, Unsupported& unsupported);
/// Adds what an element `flag` says to Model::flags, and to Model::options where a property of the world says the same.
/// Throws Error.
void readFlags(Attributes& a, Model& model, Unsupported& unsupported);

}  // namespace spark::mjcf
