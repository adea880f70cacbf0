#include "loaded_library.h"

#include <dlfcn.h>
#include <elf.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <ltdl.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "library_file.h"
#include "open_file.h"
#include "spark/error.h"

// Authors rebuild plugins while the host runs. The linker maps the pages of a file on demand, so a host that mapped the
// file itself would run code of the old and the new version side by side. Therefore a private copy in memory
// (memfd_create(2)) is loaded, which no other process can write:
//
//   the file ── copy its loaded part, again if the file changes meanwhile ──► a memfd
//   the memfd ── dlopen(NOW, LOCAL) as /proc/self/fd/..., then lt_dlopen ──► one mapping; the memfd is closed
//   the mapping ── gets the file's name in the linker's list ──► debuggers, sanitizers and dladdr(3) find its symbols
//
// libltdl binds lazily and hides the linker's error texts. So each file is first opened with dlopen(NOW, LOCAL), which
// finds missing symbols and reports them in the linker's words. Then libltdl opens it, and the first handle is closed.
//
// Names: libltdl and the linker take two files of equal names for one file, and descriptor numbers are used again. So
// the path of each copy is spelled differently. A search path that contains $ORIGIN would be relative to /proc for a
// copy: libraries that are found that way are loaded first, from beside the file; the linker then finds them by their
// names.
//
// The file itself is loaded where no copy is possible: no memfd or /proc, no free descriptor, a limit on file sizes, or
// a system that does not execute code from a memfd.

namespace fs = std::filesystem;

namespace spark {

namespace {
constexpr int kMaxCopies = 5;  // attempts, each spoilt by a change of the file

/// Guards libltdl and the list below. Recursive, because load() may destroy a library: the one that it compares with
/// may lose its other owners in that moment.
std::recursive_mutex& libraryMutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// The libraries that this process has loaded.
std::vector<std::weak_ptr<LoadedLibrary>>& libraries() {
  static std::vector<std::weak_ptr<LoadedLibrary>> all;
  return all;
}

/// The program headers of a library; empty if the file is not one.
std::vector<Elf64_Phdr> segmentsOf(int file) {
  Elf64_Ehdr head{};
  if (!readAt(file, 0, &head, 1) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 ||
      head.e_ident[EI_CLASS] != ELFCLASS64)
    return {};
  std::vector<Elf64_Phdr> segments(head.e_phnum);
  if (!readAt(file, head.e_phoff, segments.data(), segments.size())) return {};
  return segments;
}

/// The length of the part that the linker loads [bytes], from the beginning of a file of `size` bytes; debug
/// information follows it. 0: the file is not a library and needs no copy.
std::uint64_t loadedBytes(int file, std::uint64_t size) {
  const std::vector<Elf64_Phdr> segments = segmentsOf(file);
  std::uint64_t end = 0;
  for (const Elf64_Phdr& p : segments)
    end = std::max<std::uint64_t>(end, p.p_offset > size || p.p_filesz > size ? size : p.p_offset + p.p_filesz);
  return segments.empty() ? 0 : std::min(std::max<std::uint64_t>(end, sizeof(Elf64_Ehdr)), size);
}

/// Copies the first `count` bytes. Returns false if a system call fails; a source that has become shorter is no
/// failure.
bool copyBytes(int from, int to, std::uint64_t count) {
  std::vector<char> block(1u << 18);
  for (std::uint64_t at = 0; at < count;) {
    const ssize_t n =
        pread(from, block.data(), std::min<std::uint64_t>(block.size(), count - at), static_cast<off_t>(at));
    if (n <= 0) return n == 0;  // n == 0: the file became shorter, which its stamp shows
    if (pwrite(to, block.data(), static_cast<std::size_t>(n), static_cast<off_t>(at)) != n) return false;
    at += static_cast<std::uint64_t>(n);
  }
  return true;
}

/// True if the resource limits of this process permit a file of `size` bytes.
bool allowsSize(std::uint64_t size) {
  rlimit limit = {};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 && (limit.rlim_cur == RLIM_INFINITY || size <= limit.rlim_cur);
}

/// The file that the linker opens: a private copy of the plugin's file, or the file itself.
class Source {
 public:
  /// Copies the file. Throws Error if the file changes during every attempt.
  explicit Source(const std::string& path)
      : path_(path), name_(path), copy_(memfd_create(shortName(path).c_str(), MFD_CLOEXEC)) {
    const OpenFile file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    struct stat s = {};
    for (int i = 0; i < kMaxCopies; ++i) {
      // What cannot be opened is left to the linker, which has the better error text.
      if (file < 0 || fstat(file, &s) != 0 || !S_ISREG(s.st_mode)) return;
      stamp_ = FileStamp(s);
      const std::uint64_t size = loadedBytes(file, static_cast<std::uint64_t>(s.st_size));
      if (size == 0 || copy_ < 0 || !allowsSize(size)) return;
      if (ftruncate(copy_, 0) != 0 || !copyBytes(file, copy_, size)) return;
      // The copy is consistent if the file is still the same.
      if (fstat(file, &s) != 0 || FileStamp(s) == stamp_) {
        nameCopy();
        return;
      }
    }
    throw Error(fmt::format("cannot load plugin {}: its file is being written. Try again when it is complete.", path));
  }
  /// The name under which the linker opens it.
  const std::string& name() const { return name_; }
  bool isCopy() const { return name_ != path_; }
  /// The file's stamp before it was copied.
  const FileStamp& stamp() const { return stamp_; }
  /// Discards the copy.
  void useFileItself() { name_ = path_; }
  /// The linker's error text with the name of the file instead of the copy's.
  std::string withFileName(std::string text) const {
    for (std::size_t at = text.find(name_); at != std::string::npos && isCopy();
         at = text.find(name_, at + path_.size()))
      text.replace(at, name_.size(), path_);
    return text;
  }

 private:
  /// The name that /proc shows for the memfd, which is limited to 249 bytes.
  static std::string shortName(const std::string& path) { return fs::path(path).filename().string().substr(0, 200); }

  /// Spells the copy's path in a new way: the bits of a counter choose between components that change nothing, "./" and
  /// "../fd/".
  void nameCopy() {
    static std::uint64_t count = 0;
    name_ = "/proc/self/fd/";
    for (std::uint64_t n = ++count; n > 0; n >>= 1) name_ += n & 1 ? "../fd/" : "./";
    name_ += std::to_string(copy_);
    if (access(name_.c_str(), R_OK) != 0) name_ = path_;
  }

  std::string path_, name_;
  FileStamp stamp_;
  const OpenFile copy_;
};

/// What the dynamic section of a library says about the libraries that it needs.
struct Needs {
  std::vector<std::string> libraries;  ///< their names (DT_NEEDED)
  std::vector<std::string> folders;    ///< its search path (DT_RPATH, DT_RUNPATH)
};

Needs needsOf(const std::string& name) {
  const OpenFile file(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  const std::vector<Elf64_Phdr> segments = segmentsOf(file);
  const auto dynamic =
      std::find_if(segments.begin(), segments.end(), [](const auto& p) { return p.p_type == PT_DYNAMIC; });
  if (dynamic == segments.end()) return {};
  std::vector<Elf64_Dyn> entries(dynamic->p_filesz / sizeof(Elf64_Dyn));
  if (!readAt(file, dynamic->p_offset, entries.data(), entries.size())) return {};
  const auto valueOf = [&](Elf64_Sxword tag) {
    const auto at = std::find_if(entries.begin(), entries.end(), [&](const Elf64_Dyn& d) { return d.d_tag == tag; });
    return at == entries.end() ? 0 : at->d_un.d_val;
  };
  // The string table, found in the loaded segment that contains its address.
  const std::uint64_t address = valueOf(DT_STRTAB);
  const auto home = std::find_if(segments.begin(), segments.end(), [&](const Elf64_Phdr& p) {
    return p.p_type == PT_LOAD && address >= p.p_vaddr && address - p.p_vaddr + valueOf(DT_STRSZ) <= p.p_filesz;
  });
  if (home == segments.end()) return {};
  std::vector<char> texts(valueOf(DT_STRSZ));
  if (!readAt(file, address - home->p_vaddr + home->p_offset, texts.data(), texts.size())) return {};
  texts.push_back(0);

  // The entries that are names; a search path is split at its colons.
  Needs needs;
  for (const Elf64_Dyn& d : entries) {
    if (d.d_tag == DT_NULL) break;
    if (d.d_un.d_val >= texts.size()) continue;
    const std::string text = &texts[d.d_un.d_val];
    if (d.d_tag == DT_NEEDED) needs.libraries.push_back(text);
    if (d.d_tag != DT_RPATH && d.d_tag != DT_RUNPATH) continue;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      needs.folders.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return needs;
}

/// Opens the libraries that the linker could not find for a copy, because its search path is relative to the file
/// ($ORIGIN), and keeps them open until the copy is open.
class Neighbours {
 public:
  Neighbours(const std::string& name, const std::string& path) {
    const Needs needs = needsOf(name);
    for (const std::string& folder : needs.folders)
      for (const std::string& library : needs.libraries)
        if (const auto file = resolved(folder, path); file && fs::is_regular_file(*file / library))
          if (void* handle = open(library, *file / library)) handles_.push_back(handle);
  }
  ~Neighbours() {
    for (void* handle : handles_) dlclose(handle);
  }
  Neighbours(const Neighbours&) = delete;
  Neighbours& operator=(const Neighbours&) = delete;

 private:
  /// Does not load a second version of a library that is loaded already, such as the kernel.
  static void* open(const std::string& name, const fs::path& file) {
    void* known = dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    return known ? known : dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  /// A folder of the search path that is relative to the file, as an absolute one; nothing for other folders.
  static std::optional<fs::path> resolved(std::string folder, const std::string& path) {
    for (const std::string word : {"$ORIGIN", "${ORIGIN}"})
      if (const std::size_t at = folder.find(word); at != std::string::npos)
        return fs::path(folder.replace(at, word.size(), fs::path(path).parent_path().string()));
    return std::nullopt;
  }
  std::vector<void*> handles_;
};

/// The text of the last dlopen(3) error.
std::string linkerError() {
  const char* text = dlerror();
  return text ? text : "unknown reason";
}

/// A copy of the path for the linker's list, which other code may read at any time: valid until the process ends.
char* permanentName(const std::string& path) {
  static auto& names = *new std::set<std::string>;
  return const_cast<char*>(names.insert(path).first->c_str());
}
}  // namespace

FileStamp::FileStamp(const struct stat& s) : s_(s), there_(true) {}

FileStamp FileStamp::of(const std::string& path) {
  struct stat s = {};
  return stat(path.c_str(), &s) == 0 ? FileStamp(s) : FileStamp();
}

bool FileStamp::operator==(const FileStamp& o) const {
  const auto same = [](const timespec& a, const timespec& b) { return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec; };
  return there_ && o.there_ && s_.st_dev == o.s_.st_dev && s_.st_ino == o.s_.st_ino && s_.st_size == o.s_.st_size &&
         same(s_.st_mtim, o.s_.st_mtim) && same(s_.st_ctim, o.s_.st_ctim);
}

std::shared_ptr<LoadedLibrary> LoadedLibrary::load(const std::string& path) {
  const std::lock_guard lock(libraryMutex());
  std::erase_if(libraries(), [](const auto& weak) { return weak.expired(); });
  for (const auto& weak : libraries())
    if (auto known = weak.lock(); known && known->path_ == path && known->stamp_ == FileStamp::of(path)) return known;
  std::shared_ptr<LoadedLibrary> made(new LoadedLibrary(path));
  made->open();
  libraries().push_back(made);
  return made;
}

void LoadedLibrary::open() {
  Source source(path_);
  const auto fail = [&](const char* how, const std::string& why) {
    throw Error(fmt::format("{} plugin {}: {}", how, path_, source.withFileName(why)));
  };
  // A damaged library would end the process.
  if (const std::string problem = libraryProblem(source.name()); !problem.empty()) fail("refused", problem);
  static const int started = lt_dlinit();
  if (started != 0) fail("cannot load", "libltdl does not start");

  // The linker opens it, which resolves all symbols. "failed to map" of a copy: this system forbids to execute it.
  const Neighbours neighbours(source.name(), path_);
  void* first = dlopen(source.name().c_str(), RTLD_NOW | RTLD_LOCAL);
  std::string why = first ? "" : linkerError();
  if (!first && source.isCopy() && why.find("failed to map") != std::string::npos) {
    source.useFileItself();
    first = dlopen(path_.c_str(), RTLD_NOW | RTLD_LOCAL);
    why = first ? "" : linkerError();
  }
  if (!first) fail("cannot load", why);
  stamp_ = source.stamp();

  // libltdl opens the same mapping, which then has the name of the file.
  handle_ = lt_dlopen(source.name().c_str());
  if (const char* text = handle_ ? nullptr : lt_dlerror()) why = text;
  if (handle_ && source.isCopy() && dlinfo(first, RTLD_DI_LINKMAP, &map_) == 0) {
    linkerName_ = map_->l_name;
    map_->l_name = permanentName(path_);
  }
  dlclose(first);
  if (!handle_) fail("refused", why.empty() ? "libltdl cannot open it" : why);
}

LoadedLibrary::~LoadedLibrary() {
  if (!handle_) return;
  const std::lock_guard lock(libraryMutex());
  if (map_) map_->l_name = linkerName_;  // the linker frees its own name
  lt_dlclose(static_cast<lt_dlhandle>(handle_));
}

bool LoadedLibrary::hasChanged() const {
  std::error_code ec;
  return fs::exists(path_, ec) && !(FileStamp::of(path_) == stamp_);
}

bool LoadedLibrary::hasChanged(const std::string& path) {
  const std::lock_guard lock(libraryMutex());
  return std::any_of(libraries().begin(), libraries().end(), [&path](const auto& weak) {
    const auto library = weak.lock();
    return library && library->path_ == path && library->hasChanged();
  });
}

const void* LoadedLibrary::symbol(const char* name) const {
  const std::lock_guard lock(libraryMutex());
  return lt_dlsym(static_cast<lt_dlhandle>(handle_), name);
}

}  // namespace spark
