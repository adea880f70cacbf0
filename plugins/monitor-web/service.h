#pragma once
/// \file
/// The I/O thread: the listening port, the connections, the viewers.

#include <atomic>
#include <memory>
#include <string>

#include "site.h"
#include "viewer_hub.h"

namespace spark::web {

/// Settings of a Service; fixed while it lives.
struct ServiceSettings {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6 address to listen on
  unsigned short port = 3280;         ///< 0: any free port
  int maxConnections = 512;           ///< HTTP and viewers together; lowered to what the process may open
  int maxViewers = 256;               ///< at most maxConnections
  double requestTimeout = 15;         ///< s, to receive a request; also to send each part of a response
  SiteSettings site;
  ViewerHubSettings hub;
};

/// Runs the web server in a thread of its own. All functions may be called from any thread.
class Service {
 public:
  /// Opens the port and starts the thread. If the port is in use, opens a free one and logs that. `exchange` and `log`
  /// must outlive it. Throws Error if no port can be opened.
  Service(const ServiceSettings& settings, Exchange& exchange, Log& log);
  /// Closes all connections and joins the thread.
  ~Service();

  /// The open port.
  unsigned short port() const;
  /// Number of viewers; may be a moment old.
  int viewers() const;
  /// Number of connections, viewers included; may be a moment old.
  int connections() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spark::web
