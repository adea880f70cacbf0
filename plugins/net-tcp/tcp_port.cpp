#include "net-tcp/tcp_port.h"

#include <netinet/tcp.h>

#include <boost/asio/ip/tcp.hpp>

#include "api/descriptors.h"
#include "spark/error.h"

namespace spark {

namespace {
using boost::asio::ip::tcp;
using boost::system::error_code;

tcp::endpoint tcpEndpoint(const net::Stream::endpoint& from) {
  tcp::endpoint to;
  to.resize(from.size());
  std::memcpy(to.data(), from.data(), from.size());
  return to;
}

/// Detects clients whose machine has failed: after 30 s of silence the system sends probes, and ends the connection
/// after six unanswered ones. TCP_USER_TIMEOUT is not set, since it would also end clients that merely do not read.
void enableKeepAlive(net::Stream::socket& socket) {
  constexpr int kIdle = 30, kInterval = 10, kProbes = 6;  // s, s, number
  using Idle = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>;
  using Interval = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>;
  using Probes = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>;
  error_code ignored;
  socket.set_option(net::Stream::socket::keep_alive(true), ignored);
  socket.set_option(Idle(kIdle), ignored);
  socket.set_option(Interval(kInterval), ignored);
  socket.set_option(Probes(kProbes), ignored);
}
}  // namespace

void TcpPort::describe(Description<TcpPort>& d) {
  d.doc("A TCP port; splits input into messages with the framing below it and delivers them to its consumer.");
  d.property("port", &TcpPort::port, &TcpPort::setPort)
      .range(0, 65535)
      .ofProcess()
      .doc("Port number; 0 picks a free one, which can be read once it listens.");
  d.property("address", &TcpPort::address_).doc("Address to listen on.");
}

void TcpPort::setPort(int port) {
  if (listening() && port != port_)
    throw Error(fmt::format("{}.port: it listens on {} already. Set the port before listen().", path(), port_));
  port_ = port;
}

void TcpPort::open(Acceptor& acceptor) {
  error_code ec;
  const auto address = boost::asio::ip::make_address(address_, ec);
  if (ec)
    throw Error(
        fmt::format("{}.address: expected an IP address such as 0.0.0.0 or ::1, found '{}'.", path(), address_));
  const tcp::endpoint endpoint(address, static_cast<unsigned short>(port_));
  const char* action = "open";
  const auto failed = [&] { return static_cast<bool>(ec); };
  acceptor.open(endpoint.protocol(), ec);
  if (!failed()) closeOnExec(acceptor.native_handle());
  if (!failed()) action = "configure", acceptor.set_option(Acceptor::reuse_address(true), ec);
  if (!failed()) acceptor.non_blocking(true, ec);
  if (!failed()) action = "bind", acceptor.bind(endpoint, ec);
  if (!failed()) action = "listen on", acceptor.listen(boost::asio::socket_base::max_listen_connections, ec);
  if (failed())
    throw Error(fmt::format("{}: cannot {} {}: {}. Choose another port; 0 picks a free one.", path(), action, where(),
                            ec.message()));
  port_ = tcpEndpoint(acceptor.local_endpoint()).port();
}

StreamPort::Accepted TcpPort::accepted(net::Stream::socket socket) const {
  error_code ec;
  const tcp::endpoint peer = tcpEndpoint(socket.remote_endpoint(ec));
  std::string name = ec ? std::string("(gone)") : fmt::format("{}:{}", peer.address().to_string(), peer.port());
  socket.set_option(tcp::no_delay(true), ec);
  enableKeepAlive(socket);
  return {std::move(socket), std::move(name), true};
}

}  // namespace spark
