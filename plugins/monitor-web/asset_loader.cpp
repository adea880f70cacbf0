#include "asset_loader.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <csignal>
#include <fstream>

#include "mesh_message.h"
#include "spark/error.h"
#include "spark/log.h"

namespace spark::web {

namespace {
/// The type of a picture by its first bytes. Throws Error if browsers do not show it.
const char* pictureType(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  throw Error("expected a PNG or JPEG file");
}

std::string readFile(const std::filesystem::path& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  if (failed) throw Error(failed.message());
  if (size > AssetLoader::kMostFileBytes)
    throw Error(fmt::format("expected at most {} bytes, found {}", AssetLoader::kMostFileBytes, size));
  std::ifstream in(path, std::ios::binary);
  std::string content(size, '\0');
  if (!in.read(content.data(), static_cast<std::streamsize>(size))) throw Error("the file cannot be read");
  return content;
}
}  // namespace

AssetLoader::AssetLoader(AssetList& list, Exchange& exchange, Log& log, Post post)
    : list_(list), exchange_(exchange), log_(log), post_(std::move(post)) {
  // It gets no signals, which belong to the simulation thread, and does not preempt that one.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] {
    pthread_setname_np(pthread_self(), "web-files");
    const sched_param none{};
    pthread_setschedparam(pthread_self(), SCHED_BATCH, &none);
    run();
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void AssetLoader::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    if (question_) question_->answer({});
  }
  wakeup_.notify_all();
  if (thread_.joinable()) thread_.join();
  jobs_.clear();
}

bool AssetLoader::request(std::string_view path, Callback callback) {
  auto asset = list_.find(path);
  if (!asset) return false;
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back({std::move(*asset), std::move(callback)});
  }
  wakeup_.notify_all();
  return true;
}

void AssetLoader::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wakeup_.wait(lock, [this] { return stopped_ || !jobs_.empty(); });
    if (stopped_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    LoadedAsset loaded = load(job.asset);
    // Callbacks hold connections, which belong to the I/O thread: they are destroyed there, too.
    post_([callback = std::move(job.callback), loaded = std::move(loaded)] { callback(loaded); });
    lock.lock();
  }
}

/// A file that does not exist is looked for again the next time. One that cannot be shown is logged once.
LoadedAsset AssetLoader::load(const Asset& asset) {
  if (const auto known = kept_.find(asset); known != kept_.end()) return known->second;
  LoadedAsset loaded;
  try {
    loaded = read(asset);
    if (!loaded.bytes) return loaded;
  } catch (const std::exception& e) {
    log_.warning("Web: viewers do not show '{}': {}", asset.resource, e.what());
  }
  keep(asset, loaded);
  return loaded;
}

void AssetLoader::keep(const Asset& asset, const LoadedAsset& loaded) {
  const auto sizeOf = [](const LoadedAsset& a) { return a.bytes ? a.bytes->size() : 0; };
  kept_[asset] = loaded;
  order_.push_back(asset);
  keptBytes_ += sizeOf(loaded);
  while (keptBytes_ > kMostKeptBytes && order_.size() > 1) {
    const auto oldest = kept_.find(order_.front());
    keptBytes_ -= sizeOf(oldest->second);
    kept_.erase(oldest);
    order_.pop_front();
  }
}

LoadedAsset AssetLoader::read(const Asset& asset) {
  std::optional<std::string> bytes = file(asset.resource);
  if (!bytes) return {};
  std::string type = "application/octet-stream";
  if (asset.kind == AssetKind::texture) {
    type = pictureType(*bytes);
  } else {
    const auto beside = [this](const std::string& resource) { return file(resource); };
    bytes = meshMessage(meshes::readVisualMesh(asset.resource, *bytes, beside), list_.links());
  }
  return {std::make_shared<const std::string>(*std::move(bytes)), std::move(type)};
}

/// The content of a resource; nullopt if it does not exist.
std::optional<std::string> AssetLoader::file(const std::string& resource) {
  FoundFile found = find(resource);
  if (found.path) return readFile(*found.path);
  return std::move(found.content);
}

/// Waits for the simulation thread, or for stop().
FoundFile AssetLoader::find(const std::string& resource) {
  const auto question = std::make_shared<FileQuestion>();
  {
    const std::lock_guard lock(mutex_);
    if (stopped_) return {};
    question_ = question;
  }
  SimulationRequest request{SimulationRequest::Kind::file};
  request.text = resource;
  request.file = question;
  exchange_.requests.put(std::move(request));
  return question->wait();
}

}  // namespace spark::web
