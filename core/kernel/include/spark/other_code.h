#pragma once
/// \file
/// Plugins whose files have changed.

#include "spark/abi/spark/other_code.h"
#include "spark/plugin_object.h"

namespace spark {

/// True if the plugin's file has other code by now than the one that was loaded from it.
bool hasOtherCode(const Plugin& plugin);

}  // namespace spark
