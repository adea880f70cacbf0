#include "socket_path.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "api/unix_socket.h"
#include "spark/error.h"

namespace spark::control {

namespace fs = std::filesystem;

namespace {
fs::path folderName() {
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime && fs::is_directory(runtime))
    return fs::path(runtime) / "spark";
  return fs::temp_directory_path() / fmt::format("spark-{}", geteuid());
}
}  // namespace

fs::path socketFolder() {
  fs::path folder = folderName();
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    throw Error(fmt::format("cannot make {} for the control socket: {}", folder.string(), std::strerror(errno)));
  struct stat s = {};
  if (lstat(folder.c_str(), &s) != 0 || !S_ISDIR(s.st_mode))
    throw Error(fmt::format("{}, where the control socket belongs, is no folder. Remove it.", folder.string()));
  if (s.st_uid != geteuid())
    throw Error(fmt::format(
        "{}, where the control socket belongs, is another user's. Set XDG_RUNTIME_DIR to a folder of your own.",
        folder.string()));
  if ((s.st_mode & 077) != 0)
    throw Error(fmt::format("{0}, where the control socket belongs, is open to other users. Say chmod 700 {0}.",
                            folder.string()));
  return folder;
}

void removeStale(const fs::path& folder) {
  std::error_code ec;
  std::vector<fs::path> dead;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const fs::path& file = it->path();
    const int pid = std::atoi(file.filename().c_str());  // <pid>.sock, <pid>-2.sock
    if (file.extension() != ".sock" || pid <= 0 || !it->is_socket(ec)) continue;
    // A dead process alone proves nothing: a process in another container has no pid here. A socket without a listener
    // alone proves nothing either: a new process binds before it listens.
    if (kill(pid, 0) != 0 && errno == ESRCH && unix_socket::isAbandoned(file)) dead.push_back(file);
  }
  for (const fs::path& file : dead) fs::remove(file, ec);
}

fs::path freeSocket(const fs::path& folder) {
  for (int n = 1;; ++n) {
    fs::path file = folder / (n == 1 ? fmt::format("{}.sock", getpid()) : fmt::format("{}-{}.sock", getpid(), n));
    if (!fs::exists(file)) return file;
    if (!unix_socket::isAbandoned(file)) continue;
    fs::remove(file);
    return file;
  }
}

}  // namespace spark::control
