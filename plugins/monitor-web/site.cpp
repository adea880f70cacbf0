#include "site.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <cctype>

#include "plain_page.h"

// A requested path is checked by its names alone, without the file system: after decoding, each component must be a
// plain name (no leading dot, no separator, no control character), so a path cannot leave its folder.

namespace spark::web {

namespace fs = std::filesystem;

namespace {
constexpr std::size_t kMaxComponents = 4;  // of a path below a served folder
constexpr const char* kGzipType = "application/gzip";

HttpReply refusal(unsigned status, std::string text) {
  HttpReply out;
  out.status = status;
  out.text = std::move(text) + "\n";
  out.close = status != 404;
  return out;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// `host` in lower case, without its port and without the brackets of an IPv6 address.
std::string hostName(std::string_view host) {
  if (host.starts_with('['))
    return host.find(']') == host.npos ? std::string() : lower(host.substr(1, host.find(']') - 1));
  return lower(host.substr(0, host.find(':')));
}

std::string localHostName() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? lower(name.data()) : std::string();
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// Decodes percent escapes, such as %41 for A; "" if one is malformed.
std::string percentDecoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hexDigit(text[i + 1]) : -1,
              low = i + 2 < text.size() ? hexDigit(text[i + 2]) : -1;
    if (high < 0 || low < 0) return {};
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

bool isPlainName(std::string_view name) {
  const auto bad = [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '/' || c == '\\'; };
  return !name.empty() && name.size() <= 255 && name.front() != '.' && std::none_of(name.begin(), name.end(), bad);
}

std::string typeOf(const fs::path& file) {
  static constexpr std::array<std::array<const char*, 2>, 13> kTypes{{{".html", "text/html; charset=utf-8"},
                                                                      {".js", "text/javascript; charset=utf-8"},
                                                                      {".css", "text/css; charset=utf-8"},
                                                                      {".json", "application/json"},
                                                                      {".svg", "image/svg+xml"},
                                                                      {".png", "image/png"},
                                                                      {".ico", "image/x-icon"},
                                                                      {".webmanifest", "application/manifest+json"},
                                                                      {".wasm", "application/wasm"},
                                                                      {".woff2", "font/woff2"},
                                                                      {".log", "text/plain; charset=utf-8"},
                                                                      {".txt", "text/plain; charset=utf-8"},
                                                                      {".gz", kGzipType}}};
  const std::string extension = lower(file.extension().string());
  for (const auto& [ending, type] : kTypes)
    if (extension == ending) return type;
  return "application/octet-stream";
}
}  // namespace

std::vector<std::string> plainComponents(std::string_view path) {
  std::vector<std::string> out;
  while (true) {
    const std::size_t end = std::min(path.find('/'), path.size());
    std::string name = percentDecoded(path.substr(0, end));
    if (!isPlainName(name) || out.size() == kMaxComponents) return {};
    out.push_back(std::move(name));
    if (end == path.size()) return out;
    path.remove_prefix(end + 1);
  }
}

bool isSameOrigin(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"})
    if (origin.starts_with(scheme)) return !host.empty() && lower(origin.substr(scheme.size())) == lower(host);
  return false;
}

bool Site::acceptsHost(std::string_view host) const {
  const std::string name = hostName(host);
  if (name.empty()) return false;
  boost::system::error_code ec;
  boost::asio::ip::make_address(name, ec);  // an IP address cannot be rebound
  if (!ec || name == "localhost" || name.ends_with(".localhost") || name == localHostName()) return true;
  return std::any_of(settings_.hosts.begin(), settings_.hosts.end(),
                     [&](const std::string& known) { return known == "*" || lower(known) == name; });
}

bool Site::hasViewer() const {
  std::error_code ec;
  return !settings_.viewer.empty() && fs::is_regular_file(settings_.viewer / "index.html", ec);
}

HttpReply Site::answer(const HttpRequest& request) const {
  if (!acceptsHost(request.host))
    return refusal(
        421, fmt::format("This server is not known as '{}'. Its config may name it: server.hosts = {{ \"NAME\" }}.",
                         request.host.substr(0, 100)));
  if (request.method != "GET" && request.method != "HEAD") return refusal(405, "Only GET and HEAD are answered.");
  if (request.hasBody) return refusal(413, "A request with a body is not taken.");
  if (!request.target.starts_with('/')) return refusal(400, "Expected a path.");
  const std::string_view path = request.target.substr(0, request.target.find_first_of("?#"));
  if (path == "/stream") {
    if (!request.upgrade) return refusal(426, "Expected a WebSocket.");
    if (!request.origin.empty() && !isSameOrigin(request.origin, request.host))
      return refusal(403, fmt::format("A page from '{}' may not watch here.", request.origin.substr(0, 100)));
    HttpReply out;
    out.stream = true;
    return out;
  }
  return page(path);
}

HttpReply Site::page(std::string_view path) const {
  HttpReply out;
  if (path == "/status.json") {
    out.type = "application/json";
    out.isStatus = true;
    return out;
  }
  if (path.starts_with("/mesh/") || path.starts_with("/texture/")) {
    out.text = path.substr(1);
    out.isAsset = true;
    return out;
  }
  if (path.starts_with("/logs/")) return logFile(path.substr(6));
  if (hasViewer()) return fileIn(settings_.viewer, path == "/" ? "index.html" : path.substr(1));
  if (path == "/") {
    out.type = "text/html; charset=utf-8";
    out.text = plainPage(settings_.viewerLacks);
    return out;
  }
  if (path == "/plain.js") {
    out.type = "text/javascript; charset=utf-8";
    out.text = kPlainScript;
    return out;
  }
  return refusal(404, "There is no such page.");
}

/// Logs may come from untrusted sources: their type keeps browsers from running them as pages or scripts of this
/// server.
HttpReply Site::logFile(std::string_view name) const {
  if (settings_.logs.empty()) return refusal(404, "There are no logs here.");
  HttpReply out = fileIn(settings_.logs, name);
  if (out.status == 200) out.type = out.type == kGzipType ? kGzipType : "text/plain; charset=utf-8";
  out.immutable = false;
  return out;
}

HttpReply Site::fileIn(const fs::path& folder, std::string_view name) const {
  const std::vector<std::string> components = plainComponents(name);
  fs::path file = folder;
  for (const std::string& c : components) file /= c;
  std::error_code ec;
  if (components.empty() || !fs::is_regular_file(file, ec)) return refusal(404, "There is no such file.");
  HttpReply out;
  out.file = file;
  out.type = typeOf(file);
  out.immutable = components.front() == "assets";  // the bundler puts a hash of the content into the name
  return out;
}

}  // namespace spark::web
