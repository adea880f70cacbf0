#pragma once
/// \file
/// Limits and timeouts of a viewer's WebSocket.

#include <boost/beast/websocket/stream.hpp>
#include <chrono>

#include "viewer_message.h"

namespace spark::web {

/// Sets them; call it before the handshake. An idle connection is kept alive with pings and closed after 40 s without
/// any answer.
template <class Stream>
void configureSocket(boost::beast::websocket::stream<Stream>& socket) {
  boost::beast::websocket::stream_base::timeout times;
  times.handshake_timeout = std::chrono::seconds(1);  // also the time to answer a close frame
  times.idle_timeout = std::chrono::seconds(40);
  times.keep_alive_pings = true;
  socket.set_option(times);
  socket.read_message_max(kMaxMessageBytes);
  socket.auto_fragment(false);
}

}  // namespace spark::web
