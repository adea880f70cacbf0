#pragma once
/// \file
/// The thread that serves viewers: a port, the connections behind it, the audience.

#include <atomic>
#include <memory>
#include <string>

#include "audience.h"
#include "site.h"

namespace spark::web {

struct ServiceSettings {
  std::string address = "127.0.0.1";
  unsigned short port = 3280;  ///< 0: a free one
  int maxConnections = 512, maxViewers = 256;
  double requestTimeout = 15;  ///< s; until a request must be there, and until a piece of an answer must be taken
  SiteSettings site;
  AudienceSettings audience;
};

class Service {
 public:
  /// Opens the port and starts the thread. When the port is taken, a free one is, and the log says so. Throws Error: no
  /// port at all. `exchange` and `log` must outlive it.
  Service(ServiceSettings settings, Exchange& exchange, Log& log);
  /// Closes all connections and ends the thread.
  ~Service();

  /// The port that is open.
  unsigned short port() const;
  int viewers() const;
  int connections() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spark::web
