#pragma once
/// \file
/// For programs that run simulations of their own: gives a kernel the plugins, configs and scenes of a Spark
/// installation. docs/embedding.md is a whole program.

#include <filesystem>
#include <string>
#include <vector>

#include "spark/abi/api/embedding.h"
#include "spark/kernel.h"
#include "spark/script_server.h"

namespace spark {

/// The folders of a Spark installation, and what configs can read about the program that runs them.
struct Installation {
  std::filesystem::path plugins;  ///< folder of the plugins' files
  std::filesystem::path share;    ///< folder with lua/ and scenes/
  /// Folders with your own scenes in rsg/, searched before Spark's.
  std::vector<std::string> scenePaths;
  /// True: configs open no web page and no control socket.
  bool alone = true;
};

#ifdef SPARK_PLUGIN_DIR
/// The installation that find_package(Spark) found.
inline Installation installed() { return {.plugins = SPARK_PLUGIN_DIR, .share = SPARK_SHARE_DIR, .scenePaths = {}}; }
#endif

/// Gives `kernel` the plugins, configs and scenes of an installation: then scripts(kernel).runConfig("boxes.lua")
/// works.
inline void useInstallation(Kernel& kernel, const Installation& from) {
  kernel.plugins().scan(from.plugins);
  scripts(kernel).addFolder(from.share / "lua");
  List paths(from.scenePaths.begin(), from.scenePaths.end());
  scripts(kernel).setGlobal("host", List{List{"share", from.share.string()}, List{"scenePaths", std::move(paths)},
                                         List{"alone", from.alone}});
}

}  // namespace spark
