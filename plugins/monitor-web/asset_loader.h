#pragma once
/// \file
/// Reads the meshes and textures that viewers fetch, in a thread of its own: neither the simulation nor other viewers
/// wait for a file.
///
///     I/O thread              loader's thread                   simulation thread
///     HTTP session ─ path ──► looks up the resource ─ name ───► RequestQueue, between cycles: which file is it?
///       and sends it ◄─ bytes ─ reads and encodes it ◄─ path ─┘
///
/// What is loaded is kept, so a mesh is read once for all viewers.

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "asset_list.h"
#include "exchange.h"

namespace spark {
class Log;
}

namespace spark::web {

/// An asset as it is sent.
struct LoadedAsset {
  std::shared_ptr<const std::string> bytes;  ///< nullptr: the file does not exist, or cannot be shown
  std::string type;                          ///< as in HTTP: image/png
};

class AssetLoader {
 public:
  using Callback = std::function<void(LoadedAsset)>;
  /// Runs a function in the I/O thread.
  using Post = std::function<void(std::function<void()>)>;
  static constexpr std::size_t kMostFileBytes = 16u << 20, kMostKeptBytes = 256u << 20;

  /// All must outlive it.
  AssetLoader(AssetList& list, Exchange& exchange, Log& log, Post post);
  ~AssetLoader() { stop(); }

  /// Calls back in the I/O thread when the asset is loaded. False if the path means none; then it does not call back.
  /// I/O thread.
  bool request(std::string_view path, Callback callback);
  /// Ends the thread; no callback is called after that.
  void stop();

 private:
  struct Job {
    Asset asset;
    Callback callback;
  };
  void run();
  LoadedAsset load(const Asset& asset);
  LoadedAsset read(const Asset& asset);
  std::optional<std::string> file(const std::string& resource);
  FoundFile find(const std::string& resource);
  void keep(const Asset& asset, const LoadedAsset& loaded);

  AssetList& list_;
  Exchange& exchange_;
  Log& log_;
  const Post post_;
  std::map<Asset, LoadedAsset> kept_;  ///< the loader's thread only, and the next two
  std::deque<Asset> order_;            ///< of `kept_`, oldest first
  std::size_t keptBytes_ = 0;

  std::mutex mutex_;  ///< of all below
  std::condition_variable wakeup_;
  std::deque<Job> jobs_;
  std::shared_ptr<FileQuestion> question_;  ///< the last one
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace spark::web
