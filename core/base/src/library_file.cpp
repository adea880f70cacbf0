#include "library_file.h"

#include <elf.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

// What the linker asserts, or follows without a look: the tables of the headers lie in the file, segments in order and
// aligned, the dynamic section and what it points to in segments. Elf Specification 1.2 and System V gABI, chapters 4
// and 5.

namespace spark {

namespace {
class Descriptor {
 public:
  explicit Descriptor(const std::string& path) : number_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return number_; }

 private:
  int number_;
};

template <class T>
bool readAt(int file, std::uint64_t offset, T* to, std::size_t count) {
  const auto bytes = static_cast<ssize_t>(count * sizeof(T));
  return pread(file, to, count * sizeof(T), static_cast<off_t>(offset)) == bytes;
}

/// True when [begin, begin + size) lies in [from, from + length).
bool within(std::uint64_t begin, std::uint64_t size, std::uint64_t from, std::uint64_t length) {
  return begin >= from && begin - from <= length && size <= length - (begin - from);
}

bool isDamagedSegment(const Elf64_Phdr& p) {
  const bool oddAlignment =
      p.p_align > 1 && (!std::has_single_bit(p.p_align) || (p.p_vaddr - p.p_offset) % p.p_align != 0);
  return p.p_filesz > p.p_memsz || oddAlignment || !within(p.p_vaddr, p.p_memsz, 0, 1ull << 32) || !(p.p_flags & PF_R);
}

/// What other segments describe is loaded by the loaded ones.
bool isAstray(const Elf64_Phdr& p, const std::vector<Elf64_Phdr>& segments) {
  if (p.p_type == PT_LOAD || p.p_type == PT_GNU_STACK || p.p_type == PT_NULL) return false;
  const std::uint64_t size = p.p_type == PT_TLS ? p.p_filesz : p.p_memsz;
  return std::none_of(segments.begin(), segments.end(), [&](const Elf64_Phdr& load) {
    return load.p_type == PT_LOAD && within(p.p_vaddr, size, load.p_vaddr, load.p_memsz + 0xfff);
  });
}

/// The linker's tables: which entry says where one is, and how long it is (DT_NULL: not said).
struct Table {
  Elf64_Sxword where, size;
};
constexpr Table kTables[] = {{DT_STRTAB, DT_STRSZ},
                             {DT_SYMTAB, DT_NULL},
                             {DT_RELA, DT_RELASZ},
                             {DT_JMPREL, DT_PLTRELSZ},
                             {DT_HASH, DT_NULL},
                             {DT_GNU_HASH, DT_NULL},
                             {DT_PLTGOT, DT_NULL},
                             {DT_INIT, DT_NULL},
                             {DT_FINI, DT_NULL},
                             {DT_INIT_ARRAY, DT_INIT_ARRAYSZ},
                             {DT_FINI_ARRAY, DT_FINI_ARRAYSZ},
                             {DT_VERSYM, DT_NULL},
                             {DT_VERNEED, DT_NULL},
                             {DT_VERDEF, DT_NULL}};

bool isDamagedDynamic(const std::vector<Elf64_Dyn>& entries, const std::vector<Elf64_Phdr>& segments) {
  const auto value = [&](Elf64_Sxword tag) -> const Elf64_Dyn* {
    for (const Elf64_Dyn& d : entries) {
      if (d.d_tag == DT_NULL) return nullptr;
      if (d.d_tag == tag) return &d;
    }
    return nullptr;
  };
  const auto is = [&](Elf64_Sxword tag, std::uint64_t expected) {
    return !value(tag) || value(tag)->d_un.d_val == expected;
  };
  if (std::none_of(entries.begin(), entries.end(), [](const Elf64_Dyn& d) { return d.d_tag == DT_NULL; })) return true;
  if (!value(DT_STRTAB) || !value(DT_STRSZ) || !value(DT_SYMTAB)) return true;
  if (!is(DT_SYMENT, sizeof(Elf64_Sym)) || !is(DT_RELAENT, sizeof(Elf64_Rela)) || !is(DT_PLTREL, DT_RELA)) return true;
  const auto divides = [&](Elf64_Sxword tag, std::uint64_t size) {
    return !value(tag) || value(tag)->d_un.d_val % size == 0;
  };
  if (!divides(DT_RELASZ, sizeof(Elf64_Rela)) || !divides(DT_PLTRELSZ, sizeof(Elf64_Rela)) ||
      !divides(DT_INIT_ARRAYSZ, 8) || !divides(DT_FINI_ARRAYSZ, 8))
    return true;
  if (value(DT_RELACOUNT) &&
      (!value(DT_RELASZ) || value(DT_RELACOUNT)->d_un.d_val > value(DT_RELASZ)->d_un.d_val / sizeof(Elf64_Rela)))
    return true;
  if (value(DT_RELA) && (!value(DT_RELASZ) || !value(DT_RELAENT))) return true;
  if (value(DT_JMPREL) && (!value(DT_PLTRELSZ) || !value(DT_PLTREL))) return true;
  const auto loaded = [&](std::uint64_t address, std::uint64_t size) {
    return std::any_of(segments.begin(), segments.end(), [&](const Elf64_Phdr& p) {
      return p.p_type == PT_LOAD && within(address, std::max<std::uint64_t>(size, 1), p.p_vaddr, p.p_memsz);
    });
  };
  for (const Table& t : kTables)
    if (const Elf64_Dyn* where = value(t.where)) {
      const Elf64_Dyn* size = t.size == DT_NULL ? nullptr : value(t.size);
      if (!loaded(where->d_un.d_ptr, size ? size->d_un.d_val : 0)) return true;
    }
  const std::uint64_t names = value(DT_STRSZ)->d_un.d_val;
  for (const Elf64_Dyn& d : entries) {
    if (d.d_tag == DT_NULL) break;
    const bool isName = d.d_tag == DT_NEEDED || d.d_tag == DT_SONAME || d.d_tag == DT_RPATH || d.d_tag == DT_RUNPATH;
    if (isName && d.d_un.d_val >= names) return true;
  }
  return false;
}
}  // namespace

std::string libraryProblem(const std::string& path) {
  const Descriptor file(path);
  struct stat s = {};
  if (file < 0 || fstat(file, &s) != 0) return {};
  if (!S_ISREG(s.st_mode)) return "it is no regular file";
  const auto size = static_cast<std::uint64_t>(s.st_size);
  Elf64_Ehdr head{};
  if (!readAt(file, 0, &head, 1) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_type != ET_DYN)
    return "it is no shared library";
  if (head.e_ident[EI_CLASS] != ELFCLASS64) return {};
  const std::string damaged = "its headers are damaged; copy or build it again";
  if (head.e_phentsize != sizeof(Elf64_Phdr) || head.e_phnum == 0) return damaged;
  std::vector<Elf64_Phdr> segments(head.e_phnum);
  const std::string cut = "it is cut off after " + std::to_string(size) + " bytes";
  if (!readAt(file, head.e_phoff, segments.data(), segments.size())) return cut;
  std::uint64_t end = 0;  // of the last loaded segment
  const Elf64_Phdr* dynamic = nullptr;
  for (const Elf64_Phdr& p : segments) {
    if (!within(p.p_offset, p.p_filesz, 0, size)) return cut;
    if (p.p_type == PT_DYNAMIC) dynamic = &p;
    if (p.p_type != PT_LOAD) continue;
    if (isDamagedSegment(p) || p.p_vaddr < end) return damaged;
    end = p.p_vaddr + p.p_memsz;
  }
  if (end == 0 || !dynamic || dynamic->p_filesz < sizeof(Elf64_Dyn) || dynamic->p_filesz > (1u << 20)) return damaged;
  if (std::any_of(segments.begin(), segments.end(), [&](const Elf64_Phdr& p) { return isAstray(p, segments); }))
    return damaged;
  std::vector<Elf64_Dyn> entries(dynamic->p_filesz / sizeof(Elf64_Dyn));
  if (!readAt(file, dynamic->p_offset, entries.data(), entries.size()) || isDamagedDynamic(entries, segments))
    return damaged;
  return {};
}

}  // namespace spark
