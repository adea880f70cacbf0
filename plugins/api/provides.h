#pragma once
/// \file
/// Classes of plugins that may be missing.

#include "spark/abi/api/provides.h"
#include "spark/kernel.h"
#include "spark/plugin_object.h"

namespace spark {

/// True if there is a class of this name; the plugin that provides it is used from now on.
inline bool provides(Kernel& kernel, const char* className) {
  if (kernel.findClass(className)) return true;
  const Plugin* const provider = kernel.plugins().providerOf(className);
  if (provider) kernel.plugins().use(provider->name());
  return provider;
}

}  // namespace spark
