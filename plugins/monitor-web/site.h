#pragma once
/// \file
/// What the web server answers to HTTP requests. Knows no sockets: a request comes as plain data, an answer goes as
/// plain data.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace spark::web {

/// What counts of a request.
struct Request {
  std::string_view method, target;
  std::string_view host, origin;  ///< "" when missing
  bool upgrade = false;           ///< wants a WebSocket
  bool hasBody = false;
};

/// An answer. Its body is `text`, or the file where one is named.
struct Reply {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string text;
  std::filesystem::path file;
  bool keep = false;      ///< its name says what is in it: browsers may keep it
  bool stream = false;    ///< no answer: the request becomes a viewer
  bool isStatus = false;  ///< the body is how the host is doing, as soon as that is known
  bool close = false;     ///< nothing more is taken from who asks so
};

/// What is served. Folders may be "": nothing of the kind.
struct SiteSettings {
  std::filesystem::path viewer;  ///< index.html and assets/
  std::string viewerLacks;       ///< why there is no viewer, for the plain page
  std::filesystem::path logs;    ///< files under /logs/
  std::vector<std::string>
      hosts;  ///< names under which the server is known, besides IP addresses and localhost; "*": any
};

class Site {
 public:
  explicit Site(SiteSettings settings) : settings_(std::move(settings)) {}

  /// Nothing is thrown.
  Reply answer(const Request& request) const;

  /// True when a browser that was sent to `host` was sent to us and to nobody who only claims our address (DNS
  /// rebinding).
  bool isOurs(std::string_view host) const;

 private:
  Reply page(std::string_view path) const;
  Reply logFile(std::string_view name) const;
  Reply fileIn(const std::filesystem::path& folder, std::string_view name) const;
  bool hasViewer() const;
  SiteSettings settings_;
};

/// True when a page from `origin` may open a WebSocket at `host`: it came from there.
bool isSameOrigin(std::string_view origin, std::string_view host);

/// The components of a path below a folder, percent-decoded; nothing for a path that has another component than plain
/// names.
std::vector<std::string> plainComponents(std::string_view path);

}  // namespace spark::web
