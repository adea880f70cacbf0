#pragma once
/// \file
/// Maps HTTP requests to replies: pages, files, errors. Independent of sockets; requests and replies are plain data.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace spark::web {

/// The head of a request. The texts belong to the caller.
struct HttpRequest {
  std::string_view method, target;
  std::string_view host, origin;  ///< header fields; "" if missing
  bool upgrade = false;           ///< asks for a WebSocket
  bool hasBody = false;
};

/// A reply. Its body is `file` if that is not empty, otherwise `shared` or `text`.
struct HttpReply {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string text;
  std::shared_ptr<const std::string> shared{};  ///< the body instead of `text`, if set
  std::filesystem::path file;
  bool immutable = false;  ///< browsers may cache it for ever: the file's name is a hash of its content
  bool stream = false;     ///< no reply: the connection becomes a viewer
  bool isAsset = false;    ///< the body is to be the asset of path `text`, which AssetLoader::request() delivers
  bool isStatus = false;   ///< the body is to be the status message, which ViewerHub::requestStatus() delivers
  bool close = false;      ///< close the connection after it
};

/// What is served. An empty folder is not served.
struct SiteSettings {
  std::filesystem::path viewer;    ///< folder with index.html and assets/
  std::string viewerLacks;         ///< what is missing to build the viewer, for the plain page
  std::filesystem::path logs;      ///< folder whose files are served under /logs/
  std::vector<std::string> hosts;  ///< accepted names of this server besides IP addresses and localhost; "*": any
};

/// Answers requests for pages and files. Immutable.
class Site {
 public:
  explicit Site(SiteSettings settings) : settings_(std::move(settings)) {}

  /// The reply to a request. Does not throw.
  HttpReply answer(const HttpRequest& request) const;

  /// True if `host`, the Host field of a request, is an accepted name of this server. Refusing others prevents DNS
  /// rebinding: a foreign page whose name resolves to our address.
  bool acceptsHost(std::string_view host) const;

 private:
  HttpReply page(std::string_view path) const;
  HttpReply logFile(std::string_view name) const;
  HttpReply fileIn(const std::filesystem::path& folder, std::string_view name) const;
  bool hasViewer() const;
  SiteSettings settings_;
};

/// True if a page from `origin` may open a WebSocket at `host`: it was loaded from this host and port.
bool isSameOrigin(std::string_view origin, std::string_view host);

/// The percent-decoded components of a relative path; empty if a component is not a plain name.
std::vector<std::string> plainComponents(std::string_view path);

}  // namespace spark::web
