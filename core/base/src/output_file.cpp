#include "spark/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include "spark/error.h"

// A file is opened without O_TRUNC, locked, looked at, and only then emptied: only the holder of the lock writes, and
// what another process has written meanwhile is seen. The lock (flock(2)) belongs to the open file, so it also keeps
// two simulations of one process apart, and ends with the process.

namespace fs = std::filesystem;

namespace spark {

namespace {
struct Rules {
  std::mutex mutex;
  bool replace = false, confined = false;
  std::string folder;
  std::set<std::string> named, read;  ///< absolute paths without links
};

Rules& rules() {
  static auto& all = *new Rules;
  return all;
}

thread_local int byUser = 0;
thread_local outputs::Trial* trial = nullptr;

/// The absolute path, with the links of its folder, and its own, resolved as far as they exist.
std::string resolved(const std::string& file) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(file, failed), whole = fs::weakly_canonical(absolute, failed);
  return (failed ? absolute.lexically_normal() : whole).string();
}

bool isBelow(const std::string& file, const std::string& folder) {
  return file.size() > folder.size() && file.starts_with(folder) && file[folder.size()] == '/';
}

[[noreturn]] void refuse(const std::string& file, std::string_view what, std::string_view why) {
  throw Error(fmt::format("cannot write {} {}: {}", what, file, why));
}

bool mayReplace() {
  const std::lock_guard guard(rules().mutex);
  return rules().replace;
}

const char* kindOf(mode_t mode) {
  return S_ISDIR(mode)    ? "a folder"
         : S_ISFIFO(mode) ? "a pipe"
         : S_ISSOCK(mode) ? "a socket"
         : S_ISCHR(mode)  ? "a device or terminal"
                          : "a special file";
}

/// Checks all but whether another program writes the file.
void checkName(const std::string& file, std::string_view what) {
  if (file.empty()) throw Error(fmt::format("cannot write {}: expected the name of a file, found none", what));
  if (file.find('\0') != std::string::npos)
    refuse(file.c_str(), what, "expected a name without NUL bytes, found one behind it");
  if (!outputs::permitted(file))
    refuse(file, what, "a recording names it, and what a recording names is not written; name it yourself with --set");
}

/// Checks a regular file that exists.
void checkOld(const std::string& file, std::string_view what, const struct stat& about, bool replace) {
  {
    const std::lock_guard guard(rules().mutex);
    if (rules().read.contains(resolved(file))) refuse(file, what, "this run reads it; take another name");
  }
  if (about.st_size > 0 && !replace)
    refuse(file, what, "it is there already; take another name, remove it, or replace it with --force");
}

bool isLocked(int descriptor, int kind = LOCK_EX) {
  return ::flock(descriptor, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}
constexpr std::string_view kBusy = "another run is writing it; take another name";
}  // namespace

namespace outputs {

void setReplace(bool replace) {
  const std::lock_guard guard(rules().mutex);
  rules().replace = replace;
}

void confine(const std::string& folder) {
  const std::string path = resolved(folder);
  const std::lock_guard guard(rules().mutex);
  rules().confined = true;
  rules().folder = path;
}

void permit(const std::string& file) {
  const std::string path = resolved(file);
  const std::lock_guard guard(rules().mutex);
  rules().named.insert(path);
}

bool permitted(const std::string& file) {
  const std::string path = resolved(file);
  const std::lock_guard guard(rules().mutex);
  return !rules().confined || byUser > 0 || path == "/dev/null" || rules().named.contains(path) ||
         isBelow(path, rules().folder);
}

void keep(const std::string& file) {
  const std::string path = resolved(file);
  const std::lock_guard guard(rules().mutex);
  rules().read.insert(path);
}

ByUser::ByUser() { ++byUser; }
ByUser::~ByUser() { --byUser; }

Trial::Trial() : outer_(trial) { trial = this; }
Trial::~Trial() { trial = outer_; }
bool isTrial() { return trial != nullptr; }

void check(const std::string& file, std::string_view what, bool continues) {
  checkName(file, what);
  struct stat about = {};
  const bool exists = ::stat(file.c_str(), &about) == 0;
  if (exists && S_ISDIR(about.st_mode)) refuse(file, what, "expected a file, found a folder");
  if (exists && S_ISREG(about.st_mode)) {
    checkOld(file, what, about, continues || mayReplace());
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const bool busy = descriptor >= 0 && isLocked(descriptor, LOCK_SH);
    if (descriptor >= 0) ::close(descriptor);
    if (busy) refuse(file, what, kBusy);
  }
  if (trial && (!exists || S_ISREG(about.st_mode))) {
    const std::string path = resolved(file);
    if (const auto at = std::lower_bound(trial->files_.begin(), trial->files_.end(), path);
        at == trial->files_.end() || *at != path)
      trial->files_.insert(at, path);
  }
}

void lock(int descriptor, const std::string& file, std::string_view what) {
  struct stat about = {};
  if (::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode) && isLocked(descriptor)) refuse(file, what, kBusy);
}

}  // namespace outputs

OutputFile::OutputFile(const std::string& file, std::string_view what) : file_(file), what_(what) {
  if (trial) outputs::check(file, what);
  checkName(file, what);
  const char* const name = trial ? "/dev/null" : file.c_str();
  // With O_NONBLOCK a pipe without a reader fails instead of blocking.
  constexpr int kFlags = O_WRONLY | O_NONBLOCK | O_CLOEXEC;
  descriptor_ = ::open(name, kFlags | O_CREAT | O_EXCL, 0666);
  created_ = descriptor_ >= 0;
  if (!created_) descriptor_ = ::open(name, kFlags | O_CREAT, 0666);
  if (descriptor_ < 0) refuse(file, what, errno == ENXIO ? "it is a pipe that nobody reads" : std::strerror(errno));
  try {
    outputs::lock(descriptor_, file, what);
    struct stat about = {};
    if (::fstat(descriptor_, &about) != 0) refuse(file, what, std::strerror(errno));
    if (!S_ISREG(about.st_mode)) return;
    checkOld(file, what, about, mayReplace());
    if (::ftruncate(descriptor_, 0) != 0) refuse(file, what, std::strerror(errno));
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::string_view bytes, const std::function<bool()>& giveUp) {
  constexpr int kLook = 200;  // ms
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
    if (n >= 0 || errno == EINTR) continue;
    if (errno != EAGAIN) throw Error(std::strerror(errno));
    if (giveUp && giveUp()) throw Error("it takes no more bytes");
    pollfd ready{descriptor_, POLLOUT, 0};
    ::poll(&ready, 1, kLook);
  }
}

void OutputFile::discard() {
  if (descriptor_ < 0) return;
  if (created_) ::unlink(file_.c_str());
  ::close(descriptor_);
  descriptor_ = -1;
}

FileDraft::FileDraft(const std::string& file, std::string_view what, bool replace)
    : file_(file), what_(what), replace_(replace || mayReplace()) {
  checkName(file, what);
  target_ = resolved(file);
  struct stat about = {};
  if (::stat(target_.c_str(), &about) == 0) {
    if (!S_ISREG(about.st_mode))
      refuse(file, what, fmt::format("something else than a file is there: {}", kindOf(about.st_mode)));
    checkOld(file, what, about, replace_);
    outputs::check(file, what, replace_);  // another run may be writing it
    replace_ = true;                       // what is there is empty, or may go
  }
  // A new file, never a link or a file of the user.
  do {
    std::uint32_t random = 0;
    if (::getrandom(&random, sizeof random, 0) != sizeof random) fail(errno);
    draft_ = fmt::format("{}.{:08x}", target_, random);
    descriptor_ = ::open(draft_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) fail(errno);
  if (about.st_mode != 0) ::fchmod(descriptor_, about.st_mode & 0777);
}

FileDraft::~FileDraft() {
  if (descriptor_ < 0) return;
  ::unlink(draft_.c_str());
  ::close(descriptor_);
}

void FileDraft::fail(int error) const { refuse(file_, what_, std::strerror(error)); }

void FileDraft::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void FileDraft::finish() {
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(errno);
  int failed = -1;
  if (!replace_) {
    failed = ::renameat2(AT_FDCWD, draft_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE);
    if (failed != 0 && errno == EEXIST) refuse(file_, what_, "it is there already, since a moment ago");
  }
  // Some file systems know no RENAME_NOREPLACE.
  if (failed != 0 && ::rename(draft_.c_str(), target_.c_str()) != 0) fail(errno);
  ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace spark
