#include "library_file.h"

#include <elf.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "open_file.h"

// Checks what the dynamic linker asserts or uses unchecked: the header tables are inside the file, segments are in
// order and aligned, and the dynamic section and the tables it refers to are inside loaded segments; relocations, the
// symbols that they use, hash tables and needed versions refer to what exists. ELF specification 1.2; System V gABI,
// chapters 4 and 5; its AMD64 supplement, chapter 4.4.1; Drepper, How to write shared libraries, chapter 1.5.3 (hash
// tables) and appendix A (versions).

namespace spark {

namespace {
/// True if [begin, begin + size) is part of [from, from + length). Overflowing sums are handled.
bool within(std::uint64_t begin, std::uint64_t size, std::uint64_t from, std::uint64_t length) {
  return begin >= from && begin - from <= length && size <= length - (begin - from);
}

/// True if a loaded segment is misaligned, larger in the file than in memory, beyond 4 GiB, or unreadable.
bool isDamagedSegment(const Elf64_Phdr& p) {
  const bool oddAlignment =
      p.p_align > 1 && (!std::has_single_bit(p.p_align) || (p.p_vaddr - p.p_offset) % p.p_align != 0);
  return p.p_filesz > p.p_memsz || oddAlignment || !within(p.p_vaddr, p.p_memsz, 0, 1ull << 32) || !(p.p_flags & PF_R);
}

/// True if a segment that only describes a range is not inside a loaded one, where the linker would read it.
bool isOutsideLoaded(const Elf64_Phdr& p, const std::vector<Elf64_Phdr>& segments) {
  constexpr std::uint64_t kPageRest = 0xfff;  // the last page is loaded as a whole
  if (p.p_type == PT_LOAD || p.p_type == PT_GNU_STACK || p.p_type == PT_NULL) return false;
  const std::uint64_t size = p.p_type == PT_TLS ? p.p_filesz : p.p_memsz;
  return std::none_of(segments.begin(), segments.end(), [&](const Elf64_Phdr& load) {
    return load.p_type == PT_LOAD && within(p.p_vaddr, size, load.p_vaddr, load.p_memsz + kPageRest);
  });
}

/// The contents of the loaded segments.
class Contents {
 public:
  Contents(int file, const std::vector<Elf64_Phdr>& segments) : file_(file), segments_(segments) {
    for (const Elf64_Phdr& p : segments) end_ = std::max(end_, p.p_offset + p.p_filesz);
  }

  /// Reads `count` objects at an address. Returns false unless one segment of the file contains all of them.
  template <class T>
  bool read(std::uint64_t address, std::uint64_t count, std::vector<T>& to) const {
    for (const Elf64_Phdr& p : segments_) {
      if (p.p_type != PT_LOAD || count > p.p_filesz || !within(address, count * sizeof(T), p.p_vaddr, p.p_filesz))
        continue;
      to.resize(count);
      return readBytes(p.p_offset + (address - p.p_vaddr), reinterpret_cast<char*>(to.data()), count * sizeof(T));
    }
    return false;
  }

 private:
  /// A part of the file. Tables are read an entry at a time, some of them in turns.
  struct Block {
    std::uint64_t begin = 0;
    std::vector<char> bytes;
  };
  static constexpr std::uint64_t kBlock = 1 << 16;

  bool readBytes(std::uint64_t at, char* to, std::uint64_t size) const {
    if (size > kBlock) return readAt(file_, at, to, size);
    for (std::uint64_t n = 0; size > 0; at += n, to += n, size -= n) {
      const std::uint64_t begin = at - at % kBlock;
      Block& block = blocks_[begin / kBlock % blocks_.size()];
      if (block.bytes.empty() || block.begin != begin) {
        block.bytes.resize(std::min(kBlock, end_ - begin));
        block.begin = begin;
        if (!readAt(file_, begin, block.bytes.data(), block.bytes.size())) return block.bytes.clear(), false;
      }
      n = std::min(size, begin + block.bytes.size() - at);
      std::copy_n(block.bytes.data() + (at - begin), n, to);
    }
    return true;
  }

  int file_;
  std::uint64_t end_ = 0;  ///< of the last segment, in the file
  mutable std::array<Block, 16> blocks_;
  const std::vector<Elf64_Phdr>& segments_;
};

/// A table that the dynamic section refers to: the tags of the entries with its address and its size. DT_NULL: no entry
/// has the size.
struct Table {
  Elf64_Sxword address, size;
};
// Packed relative relocations (System V gABI, chapter 5); the headers of older systems do not name them.
constexpr Elf64_Sxword kRelrSize = 35, kRelr = 36, kRelrEntry = 37;
constexpr Table kTables[] = {{DT_STRTAB, DT_STRSZ},
                             {DT_SYMTAB, DT_NULL},
                             {DT_RELA, DT_RELASZ},
                             {DT_JMPREL, DT_PLTRELSZ},
                             {kRelr, kRelrSize},
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

/// The entries of a library's dynamic section before its end, DT_NULL.
class DynamicSection {
 public:
  DynamicSection(const std::vector<Elf64_Dyn>& entries, const std::vector<Elf64_Phdr>& segments, int file)
      : entries_(entries), segments_(segments), contents_(file, segments) {}

  bool isDamaged() {
    return !hasRequired() || !sizesAgree() || !tablesLoaded() || !namesFit() || !versionsFit() || !relocationsFit() ||
           !callsFit() || !gnuHashFits() || !hashFits();
  }

 private:
  /// The last entry with that tag, which is the one that the linker uses, or nullptr.
  const Elf64_Dyn* find(Elf64_Sxword tag) const {
    const auto at = std::find_if(entries_.rbegin(), entries_.rend(), [&](const auto& d) { return d.d_tag == tag; });
    return at == entries_.rend() ? nullptr : &*at;
  }
  bool has(Elf64_Sxword tag) const { return find(tag) != nullptr; }
  std::uint64_t value(Elf64_Sxword tag) const { return find(tag)->d_un.d_val; }
  bool isAbsentOr(Elf64_Sxword tag, std::uint64_t expected) const { return !has(tag) || value(tag) == expected; }
  bool isAbsentOrMultiple(Elf64_Sxword tag, std::uint64_t size) const { return !has(tag) || value(tag) % size == 0; }

  /// True if names and symbols exist, each table has the size that belongs to it, relocations have a kind, and symbols
  /// have versions where there are any.
  bool hasRequired() const {
    const bool areComplete = std::all_of(std::begin(kTables), std::end(kTables), [&](const Table& t) {
      return t.size == DT_NULL || has(t.address) == has(t.size) || (!has(t.address) && value(t.size) == 0);
    });
    return areComplete && has(DT_STRTAB) && has(DT_SYMTAB) && (!has(DT_RELA) || has(DT_RELAENT)) &&
           (!has(DT_JMPREL) || has(DT_PLTREL)) && (has(DT_VERSYM) || !(has(DT_VERNEED) || has(DT_VERDEF))) &&
           (!has(kRelr) || has(kRelrEntry));
  }
  /// True if entries have the sizes of this machine, and tables contain complete entries.
  bool sizesAgree() const {
    return isAbsentOr(DT_SYMENT, sizeof(Elf64_Sym)) && isAbsentOr(DT_RELAENT, sizeof(Elf64_Rela)) &&
           isAbsentOr(DT_PLTREL, DT_RELA) && isAbsentOr(kRelrEntry, sizeof(Elf64_Addr)) &&
           isAbsentOrMultiple(kRelrSize, sizeof(Elf64_Addr)) && isAbsentOrMultiple(DT_RELASZ, sizeof(Elf64_Rela)) &&
           isAbsentOrMultiple(DT_PLTRELSZ, sizeof(Elf64_Rela)) &&
           isAbsentOrMultiple(DT_INIT_ARRAYSZ, sizeof(Elf64_Addr)) &&
           isAbsentOrMultiple(DT_FINI_ARRAYSZ, sizeof(Elf64_Addr)) &&
           (!has(DT_RELACOUNT) || (has(DT_RELASZ) && value(DT_RELACOUNT) <= value(DT_RELASZ) / sizeof(Elf64_Rela)));
  }
  /// True if every table is inside a loaded segment.
  bool tablesLoaded() const {
    return std::all_of(std::begin(kTables), std::end(kTables), [&](const Table& t) {
      const Elf64_Dyn* size = t.size == DT_NULL ? nullptr : find(t.size);
      return !has(t.address) || isLoaded(value(t.address), size ? size->d_un.d_val : 0);
    });
  }
  /// `flags`: those that the segment must have.
  bool isLoaded(std::uint64_t address, std::uint64_t size, Elf64_Word flags = 0) const {
    return std::any_of(segments_.begin(), segments_.end(), [&](const Elf64_Phdr& p) {
      return p.p_type == PT_LOAD && (p.p_flags & flags) == flags &&
             within(address, std::max<std::uint64_t>(size, 1), p.p_vaddr, p.p_memsz);
    });
  }
  /// True if every name is inside the string table.
  bool namesFit() {
    const std::uint64_t size = value(DT_STRSZ);
    if (!contents_.read(value(DT_STRTAB), size, names_) || names_.empty() || names_.back() != 0) return false;
    for (const Elf64_Dyn& d : entries_) {
      const bool isName = d.d_tag == DT_NEEDED || d.d_tag == DT_SONAME || d.d_tag == DT_RPATH || d.d_tag == DT_RUNPATH;
      if (isName && d.d_un.d_val >= size) return false;
    }
    return true;
  }
  /// True if a library of the name at that offset is needed.
  bool isNeeded(std::uint64_t name) const {
    return name < names_.size() && std::any_of(entries_.begin(), entries_.end(), [&](const Elf64_Dyn& d) {
             return d.d_tag == DT_NEEDED && std::strcmp(&names_[d.d_un.d_val], &names_[name]) == 0;
           });
  }
  /// True if needed versions are those of needed libraries and have names, and records do not overlap. Notes the
  /// highest number of a version.
  bool versionsFit() {
    std::vector<Elf64_Verneed> library;
    std::vector<Elf64_Vernaux> version;
    std::uint64_t at = has(DT_VERNEED) ? value(DT_VERNEED) : 0;
    unsigned versions = 0;
    for (std::uint64_t next = at; next != 0 && at != 0; at += next) {
      if (!contents_.read(at, 1, library) || library[0].vn_version != VER_NEED_CURRENT || !isNeeded(library[0].vn_file))
        return false;
      versions += library[0].vn_cnt;
      if (library[0].vn_cnt == 0 || versions > kVersionMask) return false;
      std::uint64_t inner = at + library[0].vn_aux;
      for (int i = 0; i < library[0].vn_cnt; ++i, inner += version[0].vna_next) {
        if (!contents_.read(inner, 1, version) || version[0].vna_name >= names_.size()) return false;
        const bool isLast = i + 1 == library[0].vn_cnt;
        if (isLast ? version[0].vna_next != 0 : version[0].vna_next < sizeof(Elf64_Vernaux)) return false;
        lastVersion_ = std::max<unsigned>(lastVersion_, version[0].vna_other & kVersionMask);
      }
      next = library[0].vn_next;
      if (next != 0 && next < sizeof(Elf64_Verneed)) return false;
    }
    return true;
  }
  /// True if a symbol that the linker uses has a name and a version, and is code if the linker calls it. Only the first
  /// one, which is none, is a local one of nowhere.
  bool symbolFits(std::uint64_t index) {
    std::vector<Elf64_Sym> symbol;
    if (!contents_.read(value(DT_SYMTAB) + index * sizeof(Elf64_Sym), 1, symbol) || symbol[0].st_name >= names_.size())
      return false;
    if (index != 0 && symbol[0].st_shndx == SHN_UNDEF && ELF64_ST_BIND(symbol[0].st_info) == STB_LOCAL) return false;
    if (symbol[0].st_shndx != SHN_UNDEF && ELF64_ST_TYPE(symbol[0].st_info) == STT_GNU_IFUNC &&
        !isLoaded(symbol[0].st_value, 0, PF_X))
      return false;
    std::vector<Elf64_Half> version;
    if (!has(DT_VERSYM) || has(DT_VERDEF)) return true;  // versions of its own are not counted
    return contents_.read(value(DT_VERSYM) + index * sizeof(Elf64_Half), 1, version) &&
           (version[0] & kVersionMask) <= lastVersion_;
  }
  /// True if the hash table has a filter, its buckets refer to symbols of the table, and the last list of symbols ends.
  bool gnuHashFits() {
    constexpr std::uint64_t kHead = 4;  // words: number of buckets, first symbol, size of the filter, shift
    std::vector<Elf64_Word> table, link;
    if (!has(DT_GNU_HASH)) return true;
    if (!contents_.read(value(DT_GNU_HASH), kHead, table)) return false;
    const std::uint64_t buckets = table[0], first = table[1], filter = table[2], shift = table[3];
    const std::uint64_t begin = kHead + 2 * filter, size = begin + buckets;
    if (buckets == 0 || !std::has_single_bit(filter) || shift >= 64) return false;
    if (!contents_.read(value(DT_GNU_HASH), size, table)) return false;
    const auto bucket = table.begin() + static_cast<std::ptrdiff_t>(begin);
    if (std::any_of(bucket, table.end(), [&](Elf64_Word b) { return b != 0 && b < first; })) return false;
    const std::uint64_t last = *std::max_element(bucket, table.end());
    if (last == 0) return true;
    // The lists lie one behind another; the last word of each is odd.
    for (std::uint64_t symbol = first;; ++symbol) {
      if (!contents_.read(value(DT_GNU_HASH) + (size + symbol - first) * sizeof(Elf64_Word), 1, link) ||
          !symbolFits(symbol))
        return false;
      if (symbol >= last && link[0] % 2 == 1) return true;
    }
  }
  /// True if the hash table of the older kind has a bucket, and its lists refer to symbols of the table and end.
  bool hashFits() {
    std::vector<Elf64_Word> table;
    if (!has(DT_HASH)) return true;
    if (!contents_.read(value(DT_HASH), 2, table)) return false;
    const std::uint64_t buckets = table[0], symbols = table[1];
    if (buckets == 0 || !contents_.read(value(DT_HASH), 2 + buckets + symbols, table)) return false;
    std::uint64_t used = 0;  // each symbol is in one list
    for (std::uint64_t i = 0; i < buckets; ++i)
      for (std::uint64_t symbol = table[2 + i]; symbol != STN_UNDEF; symbol = table[2 + buckets + symbol])
        if (symbol >= symbols || ++used > symbols || !symbolFits(symbol)) return false;
    return true;
  }
  bool relocationsFit() {
    return relocationsFit(DT_RELA, DT_RELASZ) && relocationsFit(DT_JMPREL, DT_PLTRELSZ) && relativesFit() &&
           packedFit();
  }
  /// True if the relocations that the linker takes for relative ones are.
  bool relativesFit() const {
#ifdef __x86_64__
    std::vector<Elf64_Rela> relocations;
    return !has(DT_RELACOUNT) || (has(DT_RELA) && contents_.read(value(DT_RELA), value(DT_RELACOUNT), relocations) &&
                                  std::all_of(relocations.begin(), relocations.end(), [](const Elf64_Rela& r) {
                                    return ELF64_R_TYPE(r.r_info) == R_X86_64_RELATIVE;
                                  }));
#else
    return true;
#endif
  }
  /// True if packed relocations change writable memory: an even word is an address, the bits of an odd one say which of
  /// the next 63 words change.
  bool packedFit() {
    std::vector<Elf64_Addr> words;
    if (!has(kRelr)) return true;
    if (!contents_.read(value(kRelr), value(kRelrSize) / sizeof(Elf64_Addr), words)) return false;
    Elf64_Addr next = 0;
    const auto change = [&](Elf64_Addr at) {
      std::vector<Elf64_Addr> function;
      if (isInArray(at)) {
        if (!contents_.read(at, 1, function) || !isLoaded(function[0], 0, PF_X)) return false;
        changed_.push_back(at);
      }
      return isLoaded(at, sizeof(Elf64_Addr), has(DT_TEXTREL) ? 0 : PF_W);
    };
    for (const Elf64_Addr word : words) {
      if (word % 2 == 0) {
        if (!change(word)) return false;
        next = word + sizeof(Elf64_Addr);
        continue;
      }
      for (Elf64_Addr bits = word >> 1, at = next; bits != 0; bits >>= 1, at += sizeof(Elf64_Addr))
        if (bits % 2 == 1 && !change(at)) return false;
      next += 63 * sizeof(Elf64_Addr);
    }
    return true;
  }
  /// True for an address in the arrays of functions that the linker calls.
  bool isInArray(Elf64_Addr at) const {
    const auto isIn = [&](Elf64_Sxword begin, Elf64_Sxword size) {
      return has(begin) && has(size) && at >= value(begin) && at - value(begin) < value(size);
    };
    return isIn(DT_INIT_ARRAY, DT_INIT_ARRAYSZ) || isIn(DT_FINI_ARRAY, DT_FINI_ARRAYSZ);
  }
  /// True if what the linker calls is code: an array's addresses are those of the file until a relocation changes them.
  bool callsFit() {
    const auto isCode = [&](Elf64_Sxword tag) { return !has(tag) || isLoaded(value(tag), 0, PF_X); };
    std::sort(changed_.begin(), changed_.end());
    const auto areChanged = [&](Elf64_Sxword begin, Elf64_Sxword size) {
      for (Elf64_Addr i = 0; has(begin) && i < value(size); i += sizeof(Elf64_Addr))
        if (!std::binary_search(changed_.begin(), changed_.end(), value(begin) + i)) return false;
      return true;
    };
    return isCode(DT_INIT) && isCode(DT_FINI) && areChanged(DT_INIT_ARRAY, DT_INIT_ARRAYSZ) &&
           areChanged(DT_FINI_ARRAY, DT_FINI_ARRAYSZ);
  }
  /// True if the relocations of a table change writable memory by what exists. What they point to is not followed,
  /// unless it is called.
  bool relocationsFit(Elf64_Sxword table, Elf64_Sxword size) {
    std::vector<Elf64_Rela> relocations;
    if (!has(table)) return true;
    return contents_.read(value(table), value(size) / sizeof(Elf64_Rela), relocations) &&
           std::all_of(relocations.begin(), relocations.end(), [&](const Elf64_Rela& r) { return relocationFits(r); });
  }
  bool relocationFits(const Elf64_Rela& r) {
#ifdef __x86_64__
    if (!isLoaded(r.r_offset, sizeof(Elf64_Addr), has(DT_TEXTREL) ? 0 : PF_W)) return false;
    // The linker looks at the symbol of each kind.
    if (!symbolFits(ELF64_R_SYM(r.r_info))) return false;
    const auto target = static_cast<std::uint64_t>(r.r_addend);
    const bool isCalled = isInArray(r.r_offset);
    if (isCalled) changed_.push_back(r.r_offset);
    switch (ELF64_R_TYPE(r.r_info)) {
      case R_X86_64_RELATIVE:
        return !isCalled || isLoaded(target, 0, PF_X);
      case R_X86_64_IRELATIVE:
        return isLoaded(target, 0, PF_X);
      case R_X86_64_64:
      case R_X86_64_GLOB_DAT:
      case R_X86_64_JUMP_SLOT:
      case R_X86_64_DTPMOD64:
      case R_X86_64_DTPOFF64:
      case R_X86_64_TPOFF64:
      case R_X86_64_TLSDESC:
        return true;
      default:
        return ELF64_R_TYPE(r.r_info) == R_X86_64_NONE;
    }
#else
    if (isInArray(r.r_offset)) changed_.push_back(r.r_offset);
    return r.r_offset != 0;
#endif
  }

  static constexpr unsigned kVersionMask = 0x7fff;  ///< the rest of the number says that a version is hidden
  const std::vector<Elf64_Dyn>& entries_;
  const std::vector<Elf64_Phdr>& segments_;
  Contents contents_;
  std::vector<char> names_;
  std::vector<Elf64_Addr> changed_;  ///< addresses in arrays of functions that relocations change
  unsigned lastVersion_ = VER_NDX_GLOBAL;
};
}  // namespace

std::string libraryProblem(const std::string& path) {
  constexpr std::uint64_t kMaxDynamic = 1u << 20;  // bytes
  const OpenFile file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  struct stat s = {};
  if (file < 0 || fstat(file, &s) != 0) return {};
  if (!S_ISREG(s.st_mode)) return "it is no regular file";
  const auto size = static_cast<std::uint64_t>(s.st_size);

  // The file header. The linker itself refuses libraries of another word size.
  Elf64_Ehdr head{};
  if (!readAt(file, 0, &head, 1) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_type != ET_DYN)
    return "it is no shared library";
  if (head.e_ident[EI_CLASS] != ELFCLASS64) return {};
  std::string damaged = "its headers are damaged; copy or build it again";
  if (head.e_phentsize != sizeof(Elf64_Phdr) || head.e_phnum == 0) return damaged;

  // The segments: inside the file, and the loaded ones in order without overlap.
  std::vector<Elf64_Phdr> segments(head.e_phnum);
  std::string cut = fmt::format("it is cut off after {} bytes", size);
  if (!readAt(file, head.e_phoff, segments.data(), segments.size())) return cut;
  std::uint64_t end = 0;  // address behind the last loaded segment
  const Elf64_Phdr* dynamic = nullptr;
  for (const Elf64_Phdr& p : segments) {
    if (!within(p.p_offset, p.p_filesz, 0, size)) return cut;
    if (p.p_type == PT_DYNAMIC) dynamic = &p;
    if (p.p_type != PT_LOAD) continue;
    if (isDamagedSegment(p) || p.p_vaddr < end) return damaged;
    end = p.p_vaddr + p.p_memsz;
  }
  if (end == 0 || !dynamic || dynamic->p_filesz < sizeof(Elf64_Dyn) || dynamic->p_filesz > kMaxDynamic) return damaged;
  if (std::any_of(segments.begin(), segments.end(), [&](const Elf64_Phdr& p) { return isOutsideLoaded(p, segments); }))
    return damaged;

  // The dynamic section.
  std::vector<Elf64_Dyn> entries(dynamic->p_filesz / sizeof(Elf64_Dyn));
  if (!readAt(file, dynamic->p_offset, entries.data(), entries.size())) return damaged;
  const auto null = std::find_if(entries.begin(), entries.end(), [](const auto& d) { return d.d_tag == DT_NULL; });
  if (null == entries.end()) return damaged;
  entries.erase(null, entries.end());
  if (DynamicSection(entries, segments, file).isDamaged()) return damaged;
  return {};
}

}  // namespace spark
