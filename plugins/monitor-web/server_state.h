#pragma once
/// \file
/// State of the web server's I/O thread that all its sessions share. I/O thread only.

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <list>
#include <memory>

#include "asset_loader.h"
#include "service.h"

namespace spark::web {

namespace beast = boost::beast;
namespace http = boost::beast::http;

/// An open HTTP connection, listed in ServerState::connections.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Closes the socket at once.
  virtual void drop() = 0;

  bool answering = false;                     ///< a response is being prepared or sent
  std::list<Connection*>::iterator position;  ///< in ServerState::connections
};

/// Owned by the Service; outlives all sessions.
struct ServerState {
  const ServiceSettings settings;
  Log& log;
  Site site;
  ViewerHub hub;
  std::list<Connection*> connections;  ///< HTTP only, ordered by the time of the last request, oldest first
  int viewers = 0;                     ///< open viewer connections, those in their handshake included
  std::uint64_t lastViewerId = 0;
  std::function<bool(std::string_view, AssetLoader::Callback)> loadAsset;  ///< as AssetLoader::request()
  std::function<void()> update;  ///< runs the hub's due work and sets its timer; call it after a hub call
};

/// Serves HTTP on a connection until it closes or becomes a viewer. The session owns itself.
void serveHttp(ServerState& state, beast::tcp_stream stream);

/// Accepts the WebSocket that `request` asks for and adds the viewer to the hub. The session owns itself.
void serveViewer(ServerState& state, beast::tcp_stream stream, const http::request<http::empty_body>& request);

}  // namespace spark::web
