#include "loaded_library.h"

#include <dlfcn.h>
#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <ltdl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "spark/error.h"

// A plugin's author builds while the host runs. The linker maps a file's pages as they are needed: were it the author's
// file, code of the old and the new version would run side by side. So what is loaded is a copy in memory
// (memfd_create(2)) that nobody else can write.
//
//   the file ── copied as far as it is loaded, again while somebody writes it ──► a memfd
//   memfd ── dlopen(NOW, LOCAL) as /proc/self/fd/... ── lt_dlopen of the same name ──► one mapping; the memfd is closed
//   the linker's list ── the mapping gets the file's name ──► debuggers, sanitizers and dladdr(3) find the symbols
//
// libltdl asks the dynamic linker for lazy binding and keeps its error text to itself. So each file is first opened
// with dlopen(NOW, LOCAL): what is missing is found then and said in the linker's own words; libltdl's handle keeps it
// open, ours is closed again.
//
// Names: both libltdl and the linker take an equal name for an equal file, and descriptors' numbers come again. So each
// copy's name is spelled in a way of its own. $ORIGIN in a copy's search path would be /proc: libraries that are found
// so are loaded first, from where they are, and the linker then finds them by their names.
//
// Where no copy can be made (no memfd or /proc, no descriptor free, a limit on the size of files, a system that forbids
// to run one) the file itself is loaded.

namespace fs = std::filesystem;

namespace spark {

namespace {
constexpr int kTries = 5;  // copies of a file that changes meanwhile

std::recursive_mutex& libraryMutex() {
  static std::recursive_mutex mutex;  // libltdl and the list below are the process's
  return mutex;
}

std::vector<std::weak_ptr<LoadedLibrary>>& libraries() {
  static std::vector<std::weak_ptr<LoadedLibrary>> all;
  return all;
}

class OpenFile {
 public:
  explicit OpenFile(int number) : number_(number) {}
  ~OpenFile() {
    if (number_ >= 0) close(number_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  operator int() const { return number_; }

 private:
  int number_;
};

template <class T>
bool readBytes(int file, std::uint64_t offset, std::vector<T>& to) {
  return pread(file, to.data(), to.size() * sizeof(T), static_cast<off_t>(offset)) ==
         static_cast<ssize_t>(to.size() * sizeof(T));
}

std::vector<Elf64_Phdr> segmentsOf(int file) {
  std::vector<Elf64_Ehdr> head(1);
  if (!readBytes(file, 0, head) || std::memcmp(head[0].e_ident, ELFMAG, SELFMAG) != 0 ||
      head[0].e_ident[EI_CLASS] != ELFCLASS64)
    return {};
  std::vector<Elf64_Phdr> segments(head[0].e_phnum);
  if (!readBytes(file, head[0].e_phoff, segments)) return {};
  return segments;
}

/// Bytes from the beginning that are loaded; what follows is for debuggers. 0: it is no library, and nobody needs a
/// copy.
std::uint64_t loadedBytes(int file, std::uint64_t size) {
  const std::vector<Elf64_Phdr> segments = segmentsOf(file);
  std::uint64_t end = 0;
  for (const Elf64_Phdr& p : segments)
    end = std::max<std::uint64_t>(end, p.p_offset > size || p.p_filesz > size ? size : p.p_offset + p.p_filesz);
  return segments.empty() ? 0 : std::min(std::max<std::uint64_t>(end, sizeof(Elf64_Ehdr)), size);
}

bool copyBytes(int from, int to, std::uint64_t count) {
  std::vector<char> block(1u << 18);
  for (std::uint64_t at = 0; at < count;) {
    const ssize_t n =
        pread(from, block.data(), std::min<std::uint64_t>(block.size(), count - at), static_cast<off_t>(at));
    if (n <= 0) return n == 0;  // it was shortened: its stamp says so
    if (pwrite(to, block.data(), static_cast<std::size_t>(n), static_cast<off_t>(at)) != n) return false;
    at += static_cast<std::uint64_t>(n);
  }
  return true;
}

bool allows(std::uint64_t size) {
  rlimit limit = {};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 && (limit.rlim_cur == RLIM_INFINITY || size <= limit.rlim_cur);
}

/// What is given to the linker: a private copy of a file, or the file itself.
class Source {
 public:
  /// Throws Error when the file is written all the time.
  explicit Source(const std::string& path)
      : path_(path), name_(path), copy_(memfd_create(shortName(path).c_str(), MFD_CLOEXEC)) {
    const OpenFile file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    struct stat s = {};
    for (int i = 0; i < kTries; ++i) {
      if (file < 0 || fstat(file, &s) != 0 || !S_ISREG(s.st_mode)) return;  // the linker says it better
      stamp_ = FileStamp(s);
      const std::uint64_t size = loadedBytes(file, static_cast<std::uint64_t>(s.st_size));
      if (size == 0 || copy_ < 0 || !allows(size)) return;
      if (ftruncate(copy_, 0) != 0 || !copyBytes(file, copy_, size)) return;
      if (fstat(file, &s) != 0 || FileStamp(s) == stamp_) {
        nameCopy();
        return;
      }
    }
    throw Error("cannot load plugin " + path + ": somebody is writing it. Try again when it is complete.");
  }
  const std::string& name() const { return name_; }
  bool isCopy() const { return name_ != path_; }
  const FileStamp& stamp() const { return stamp_; }
  void useFileItself() { name_ = path_; }
  /// The linker's words about it, with the file's name for the copy's.
  std::string words(std::string text) const {
    for (std::size_t at = text.find(name_); at != std::string::npos && isCopy();
         at = text.find(name_, at + path_.size()))
      text.replace(at, name_.size(), path_);
    return text;
  }

 private:
  static std::string shortName(const std::string& path) { return fs::path(path).filename().string().substr(0, 200); }

  /// Another spelling each time: the bits of a counter are ways that lead nowhere.
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

/// What a library needs, and where it looks: the texts of its dynamic section.
struct Needs {
  std::vector<std::string> libraries, folders;
};

Needs needsOf(const std::string& name) {
  const OpenFile file(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  const std::vector<Elf64_Phdr> segments = segmentsOf(file);
  const auto dynamic =
      std::find_if(segments.begin(), segments.end(), [](const auto& p) { return p.p_type == PT_DYNAMIC; });
  if (dynamic == segments.end()) return {};
  std::vector<Elf64_Dyn> entries(dynamic->p_filesz / sizeof(Elf64_Dyn));
  if (!readBytes(file, dynamic->p_offset, entries)) return {};
  const auto valueOf = [&](Elf64_Sxword tag) {
    const auto at = std::find_if(entries.begin(), entries.end(), [&](const Elf64_Dyn& d) { return d.d_tag == tag; });
    return at == entries.end() ? 0 : at->d_un.d_val;
  };
  const std::uint64_t address = valueOf(DT_STRTAB);
  const auto home = std::find_if(segments.begin(), segments.end(), [&](const Elf64_Phdr& p) {
    return p.p_type == PT_LOAD && address >= p.p_vaddr && address - p.p_vaddr + valueOf(DT_STRSZ) <= p.p_filesz;
  });
  if (home == segments.end()) return {};
  std::vector<char> texts(valueOf(DT_STRSZ));
  if (!readBytes(file, address - home->p_vaddr + home->p_offset, texts)) return {};
  texts.push_back(0);
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

/// Opens what a copy would not find: libraries that its search path has relative to the file ($ORIGIN). Held until the
/// copy is open.
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
  /// What is there already, such as the kernel, is not loaded again from elsewhere.
  static void* open(const std::string& name, const fs::path& file) {
    void* known = dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    return known ? known : dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  static std::optional<fs::path> resolved(std::string folder, const std::string& path) {
    for (const std::string word : {"$ORIGIN", "${ORIGIN}"})
      if (const std::size_t at = folder.find(word); at != std::string::npos)
        return fs::path(folder.replace(at, word.size(), fs::path(path).parent_path().string()));
    return std::nullopt;
  }
  std::vector<void*> handles_;
};

/// "" when the file looks like a whole shared library. The dynamic linker trusts its headers: a file that was copied
/// half would kill us.
std::string fileProblem(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::error_code ec;
  const std::uintmax_t size = fs::file_size(path, ec);
  Elf64_Ehdr head{};
  if (!in || ec) return {};  // the linker says it better
  if (!in.read(reinterpret_cast<char*>(&head), sizeof head) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 ||
      head.e_type != ET_DYN)
    return "it is no shared library";
  if (head.e_ident[EI_CLASS] != ELFCLASS64) return {};
  in.seekg(static_cast<std::streamoff>(head.e_phoff));
  for (int i = 0; i < head.e_phnum; ++i) {
    Elf64_Phdr part{};
    if (!in.read(reinterpret_cast<char*>(&part), sizeof part) || part.p_offset > size ||
        part.p_filesz > size - part.p_offset)
      return "it is cut off after " + std::to_string(size) + " bytes";
  }
  return {};
}

std::string lastWords() {
  const char* text = dlerror();
  return text ? text : "unknown reason";
}

/// Of the linker's list, which others read at any time: kept to the end of the process.
char* keptName(const std::string& path) {
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
    throw Error(std::string(how) + " plugin " + path_ + ": " + source.words(why));
  };
  if (const std::string problem = fileProblem(source.name()); !problem.empty()) fail("refused", problem);
  static const int started = lt_dlinit();
  if (started != 0) fail("cannot load", "libltdl does not start");
  const Neighbours neighbours(source.name(), path_);
  void* first = dlopen(source.name().c_str(), RTLD_NOW | RTLD_LOCAL);
  std::string why = first ? "" : lastWords();
  if (!first && source.isCopy() && why.find("failed to map") != std::string::npos) {
    source.useFileItself();
    first = dlopen(path_.c_str(), RTLD_NOW | RTLD_LOCAL);
    why = first ? "" : lastWords();
  }
  if (!first) fail("cannot load", why);
  stamp_ = source.stamp();
  handle_ = lt_dlopen(source.name().c_str());
  if (const char* text = handle_ ? nullptr : lt_dlerror()) why = text;
  if (handle_ && source.isCopy() && dlinfo(first, RTLD_DI_LINKMAP, &map_) == 0) {
    linkerName_ = map_->l_name;
    map_->l_name = keptName(path_);
  }
  dlclose(first);
  if (!handle_) fail("refused", why.empty() ? "libltdl cannot open it" : why);
}

LoadedLibrary::~LoadedLibrary() {
  if (!handle_) return;
  const std::lock_guard lock(libraryMutex());
  if (map_) map_->l_name = linkerName_;  // the linker frees it
  lt_dlclose(static_cast<lt_dlhandle>(handle_));
}

bool LoadedLibrary::hasChanged() const {
  std::error_code ec;
  return fs::exists(path_, ec) && !(FileStamp::of(path_) == stamp_);
}

const void* LoadedLibrary::symbol(const char* name) const {
  const std::lock_guard lock(libraryMutex());
  return lt_dlsym(static_cast<lt_dlhandle>(handle_), name);
}

}  // namespace spark
