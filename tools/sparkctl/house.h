#pragma once
/// \file
/// A connection to a running house.

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/streambuf.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sparkctl {

using Json = nlohmann::ordered_json;

/// The control sockets of this user's living houses, by name.
std::vector<std::string> houses();

/// Speaks to one house. Functions throw std::runtime_error with one sentence when it does not answer.
class House {
 public:
  explicit House(const std::string& socket);
  /// Sends one request and waits for its answer. Throws what the house says when it refuses.
  Json ask(const Json& request);
  /// Waits for the next line of a watch.
  Json next();

 private:
  boost::asio::io_context io_;
  boost::asio::local::stream_protocol::socket socket_{io_};
  boost::asio::streambuf buffer_;
};

}  // namespace sparkctl
