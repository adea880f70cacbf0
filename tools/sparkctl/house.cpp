#include "house.h"

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

// A house in the temporary folder may be anybody's who was quick. What is asked and answered here is often secret (a
// referee's token): the folder must be the user's own and closed to others, and the system says whose program answers.
// The house checks the same from its side.

namespace sparkctl {

namespace fs = std::filesystem;

namespace {
/// Where houses put their sockets: see plugins/control.
std::vector<fs::path> folders() {
  std::vector<fs::path> out;
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime)
    out.push_back(fs::path(runtime) / "spark");
  out.push_back(fs::temp_directory_path() / fmt::format("spark-{}", geteuid()));
  return out;
}

/// "" when only this user can have put something into the folder.
std::string problem(const fs::path& folder) {
  struct stat s = {};
  if (lstat(folder.c_str(), &s) != 0) return {};  // there is none
  if (!S_ISDIR(s.st_mode)) return folder.string() + " is no folder";
  if (s.st_uid != geteuid()) return folder.string() + " is another user's";
  if ((s.st_mode & 077) != 0) return folder.string() + " is open to other users";
  return {};
}

/// A connected socket that never blocks, or -1 and errno.
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

/// A house that cannot take one more caller now lives, too.
bool lives(const fs::path& file) {
  const int s = connectTo(file.string());
  if (s >= 0) close(s);
  return s >= 0 || errno == EAGAIN;
}
}  // namespace

std::vector<std::string> houses(std::vector<std::string>& refused) {
  std::vector<std::string> out;
  for (const fs::path& folder : folders()) {
    if (std::string why = problem(folder); !why.empty()) {
      refused.push_back(std::move(why));
      continue;
    }
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(folder, ec))
      if (entry.path().extension() == ".sock" && lives(entry.path())) out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

House::House(const std::string& socket, double timeout) : name_(socket), timeout_(timeout) {
  const auto until = deadline();
  while ((socket_ = connectTo(socket)) < 0 && errno == EAGAIN && Clock::now() < until)
    poll(nullptr, 0, 20);  // its queue of callers is full
  if (socket_ < 0) throw std::runtime_error(fmt::format("no house answers at {}: {}", socket, std::strerror(errno)));
  ucred peer = {};
  socklen_t size = sizeof peer;
  if (getsockopt(socket_, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0 || peer.uid != geteuid()) {
    close(socket_);
    throw std::runtime_error(
        fmt::format("the program that answers at {} is another user's; it is told nothing", socket));
  }
}

House::~House() { close(socket_); }

House::Clock::time_point House::deadline() const {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_));
}

void House::wait(short events, Clock::time_point until) {
  pollfd p{socket_, events, 0};
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0)
      throw std::runtime_error(
          fmt::format("the house at {} did not answer within {:g} s: it is stopped, or in a very long cycle. --timeout "
                      "waits longer.",
                      name_, timeout_));
    if (poll(&p, 1, static_cast<int>(std::min<long long>(left, 1'000'000))) > 0) return;
  }
}

Json House::ask(const Json& request) {
  const auto until = deadline();
  const std::string line = request.dump() + "\n";
  for (std::size_t sent = 0; sent < line.size();) {
    const ssize_t n = send(socket_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (n > 0)
      sent += static_cast<std::size_t>(n);
    else if (errno == EAGAIN)
      wait(POLLOUT, until);
    else if (errno != EINTR)
      throw std::runtime_error(fmt::format("the house has ended: {}", std::strerror(errno)));
  }
  return receive(until);
}

Json House::next() { return receive(Clock::time_point::max()); }

Json House::receive(Clock::time_point until) {
  std::size_t end;
  while ((end = received_.find('\n')) == std::string::npos) {
    char bytes[4096];
    const ssize_t n = recv(socket_, bytes, sizeof bytes, 0);
    if (n > 0)
      received_.append(bytes, static_cast<std::size_t>(n));
    else if (n < 0 && errno == EAGAIN)
      wait(POLLIN, until);
    else if (n == 0 || errno != EINTR)
      throw std::runtime_error("the house has ended");
  }
  const Json answer = Json::parse(received_.substr(0, end));
  received_.erase(0, end + 1);
  if (!answer.value("ok", false)) throw std::runtime_error(answer.value("error", "the house refused without a reason"));
  return answer;
}

}  // namespace sparkctl
