#include "udp_log_sink.h"

#include <arpa/inet.h>
#include <spdlog/sinks/udp_sink.h>

#include "spark/error.h"

namespace spark {

void UdpLogSink::describe(Description<UdpLogSink>& d) {
  d.doc("Sends the log to another program: one UDP datagram for each message.");
  d.property("host", &UdpLogSink::host, &UdpLogSink::setHost).doc("The receiver's address, IPv4 in numbers.");
  d.property("port", &UdpLogSink::port, &UdpLogSink::setPort).range(0, 65535).doc("The receiver's port; 0: none.");
}

std::shared_ptr<spdlog::logger> UdpLogSink::open() {
  if (port_ == 0) return nullptr;
  in_addr address{};
  if (host_.find('\0') != std::string::npos || ::inet_pton(AF_INET, host_.c_str(), &address) != 1)
    throw Error(fmt::format("host: expected an IPv4 address in numbers, such as 127.0.0.1, found '{}'", host_));
  return inThread(std::make_shared<spdlog::sinks::udp_sink_st>(
      spdlog::sinks::udp_sink_config(host_, static_cast<std::uint16_t>(port_))));
}

void UdpLogSink::setHost(std::string host) {
  host_ = std::move(host);
  restart();
}

void UdpLogSink::setPort(int port) {
  port_ = port;
  restart();
}

}  // namespace spark
