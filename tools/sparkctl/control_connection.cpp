#include "control_connection.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

// Any user can create sockets in the temporary folder, and requests may contain secrets (a referee's token). So the
// folder must belong to the user and be closed to others, and the program behind the socket must run as the same user.
// The server makes the same checks.

namespace sparkctl {

namespace fs = std::filesystem;

namespace {
/// Folders of control sockets: see plugins/control/socket_path.h.
std::vector<fs::path> folders() {
  std::vector<fs::path> out;
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime)
    out.push_back(fs::path(runtime) / "spark");
  out.push_back(fs::temp_directory_path() / fmt::format("spark-{}", geteuid()));
  return out;
}

/// The reason why the folder cannot be trusted; "" if only this user can have created its files.
std::string problem(const fs::path& folder) {
  struct stat s = {};
  if (lstat(folder.c_str(), &s) != 0) return {};  // there is none
  if (!S_ISDIR(s.st_mode)) return fmt::format("{} is no folder", folder.string());
  if (s.st_uid != geteuid()) return fmt::format("{} is another user's", folder.string());
  if ((s.st_mode & 077) != 0) return fmt::format("{} is open to other users", folder.string());
  return {};
}

/// A connected, non-blocking socket; -1 and errno on error.
int connectTo(const std::string& file) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (file.size() >= sizeof address.sun_path) return errno = ENAMETOOLONG, -1;
  std::memcpy(address.sun_path, file.c_str(), file.size() + 1);
  const int s = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (s >= 0 && connect(s, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return s;
  const int error = errno;
  if (s >= 0) close(s);
  errno = error;
  return -1;
}

/// A request with its line feed. Throws std::runtime_error if a text in it is not UTF-8.
std::string lineOf(const Json& request) {
  try {
    return request.dump() + "\n";
  } catch (const Json::type_error&) {
    throw std::runtime_error("expected arguments in UTF-8, found other bytes");
  }
}

/// True if a simulation listens on the socket, even if its queue of connections is full.
bool isAlive(const fs::path& file) {
  const int s = connectTo(file.string());
  if (s >= 0) close(s);
  return s >= 0 || errno == EAGAIN;
}
}  // namespace

bool isUtf8(const std::string& text) {
  try {
    return !Json(text).dump().empty();
  } catch (const Json::type_error&) {
    return false;
  }
}

std::vector<std::string> findSockets(std::vector<std::string>& skipped) {
  std::vector<std::string> out;
  for (const fs::path& folder : folders()) {
    if (std::string why = problem(folder); !why.empty()) {
      skipped.push_back(std::move(why));
      continue;
    }
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(folder, ec))
      if (entry.path().extension() == ".sock" && isAlive(entry.path())) out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

ControlConnection::ControlConnection(const std::string& socket, double timeout) : name_(socket), timeout_(timeout) {
  const auto until = deadline();
  while ((socket_ = connectTo(socket)) < 0 && errno == EAGAIN && Clock::now() < until)
    poll(nullptr, 0, 20);  // the queue of connections is full: sleep 20 ms
  if (socket_ < 0)
    throw std::runtime_error(fmt::format("no simulation answers at {}: {}", socket, std::strerror(errno)));
  ucred peer = {};
  socklen_t size = sizeof peer;
  if (getsockopt(socket_, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0 || peer.uid != geteuid()) {
    close(socket_);
    throw std::runtime_error(
        fmt::format("the program that answers at {} is another user's; it is told nothing", socket));
  }
}

ControlConnection::~ControlConnection() { close(socket_); }

ControlConnection::Clock::time_point ControlConnection::deadline() const {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_));
}

void ControlConnection::wait(short events, Clock::time_point until) {
  pollfd p{socket_, events, 0};
  while (true) {
    const auto remaining = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (remaining <= 0)
      throw std::runtime_error(fmt::format(
          "the simulation at {} did not answer within {:g} s: it is stopped, or in a very long cycle. --timeout "
          "waits longer.",
          name_, timeout_));
    if (poll(&p, 1, static_cast<int>(std::min<long long>(remaining, 1'000'000))) > 0) return;
  }
}

Json ControlConnection::ask(const Json& request) {
  const auto until = deadline();
  const std::string line = lineOf(request);
  for (std::size_t sent = 0; sent < line.size();) {
    const ssize_t n = send(socket_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (n > 0)
      sent += static_cast<std::size_t>(n);
    else if (errno == EAGAIN)
      wait(POLLOUT, until);
    else if (errno != EINTR)
      throw std::runtime_error(fmt::format("the simulation has ended: {}", std::strerror(errno)));
  }
  return receive(until);
}

Json ControlConnection::next() { return receive(Clock::time_point::max()); }

Json ControlConnection::receive(Clock::time_point until) {
  std::size_t end;
  while ((end = received_.find('\n')) == std::string::npos) {
    char bytes[4096];
    const ssize_t n = recv(socket_, bytes, sizeof bytes, 0);
    if (n > 0)
      received_.append(bytes, static_cast<std::size_t>(n));
    else if (n < 0 && errno == EAGAIN)
      wait(POLLIN, until);
    else if (n == 0 || errno != EINTR)
      throw std::runtime_error("the simulation has ended");
  }
  Json answer = Json::parse(received_.substr(0, end), nullptr, false);
  received_.erase(0, end + 1);
  if (!answer.is_object() || !answer.contains("ok") || !answer["ok"].is_boolean())
    throw std::runtime_error(fmt::format("the program that answers at {} is no simulation of this version", name_));
  if (answer["ok"] == true) return answer;
  const auto error = answer.find("error");
  throw std::runtime_error(error != answer.end() && error->is_string() ? error->get<std::string>()
                                                                       : "the simulation refused without a reason");
}

}  // namespace sparkctl
