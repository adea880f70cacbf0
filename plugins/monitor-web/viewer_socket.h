#pragma once
/// \file
/// How a viewer's WebSocket is set: limits and times.

#include <boost/beast/websocket/stream.hpp>
#include <chrono>

#include "viewer_message.h"

namespace spark::web {

/// Before the handshake. A viewer that is silent is asked with pings whether it is still there.
template <class Stream>
void configureSocket(boost::beast::websocket::stream<Stream>& socket) {
  boost::beast::websocket::stream_base::timeout times;
  times.handshake_timeout = std::chrono::seconds(1);  // also for the other's part of a close
  times.idle_timeout = std::chrono::seconds(40);
  times.keep_alive_pings = true;
  socket.set_option(times);
  socket.read_message_max(kLongestMessage);
  socket.auto_fragment(false);
}

}  // namespace spark::web
