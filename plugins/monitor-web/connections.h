#pragma once
/// \file
/// What sessions see of the service they belong to. I/O thread only.

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <list>
#include <memory>

#include "service.h"

namespace spark::web {

namespace beast = boost::beast;
namespace http = boost::beast::http;

/// An open connection, in the list of all.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Ends it at once.
  virtual void drop() = 0;

  bool answering = false;  ///< an answer is on its way
  std::list<Connection*>::iterator place;
};

/// The I/O thread's things, as sessions use them; it outlives them.
struct Hall {
  const ServiceSettings settings;
  Log& log;
  Site site;
  Audience audience;
  std::list<Connection*> visitors;  ///< HTTP, who came or asked last at the end
  std::size_t viewers = 0;
  std::uint64_t lastId = 0;
  std::function<void()> pump;  ///< looks at the audience's clock again
};

/// Serves HTTP to a connection until it ends or becomes a viewer.
void serveHttp(Hall& hall, beast::tcp_stream stream);

/// Makes a viewer of a connection that asked for it.
void serveViewer(Hall& hall, beast::tcp_stream stream, const http::request<http::empty_body>& request);

}  // namespace spark::web
