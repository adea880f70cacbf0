#pragma once
/// \file
/// Classes whose objects are made as those of their base.

#include <memory>

#include "spark/abi/spark/make_as_base.h"
#include "spark/leaf.h"

namespace spark {

/// For ClassDescription::make: objects of the class are made as those of its base, and the class only describes them in
/// another way. Not to be called.
std::unique_ptr<Leaf> makeAsBase();

}  // namespace spark
