#include "plugin_files.h"

#include <dlfcn.h>
#include <elf.h>
#include <sys/resource.h>

#include "absence.h"
#include "temporary_folder.h"

// Which files are accepted as plugins, and when their code is mapped. A refusal names the file and the reason, and has
// no other effect.

using namespace spark;
using namespace spark::test;

TEST_CASE("A scan refuses each bad file with its name and the reason, and continues") {
  TestHost host(false);
  const auto problems = host.kernel.plugins().scan(fixtures("bad-plugins"));
  const std::pair<const char*, const char*> expected[] = {
      {"bad-name", "its name '../escaped' is none"},
      {"missing-dependency", "libspark-gone.so.1: cannot open shared object file"},
      {"missing-symbol", "undefined symbol: _Z22sparkUndefinedFunctionv"},
      {"newer-abi", "it was built for the newer plugin ABI"},
      {"no-descriptor", "it has no symbol sparkPlugin"},
      {"no-headers", "it does not say which headers it was built with"},
      {"not-a-library", "it is no shared library"},
      {"older-abi", "it was built for the older plugin ABI"},
      {"other-headers", "this host has another version of api/of_the_future.h, spark/node.h, or none"},
      {"other-sanitizer", "it was built with"},
      {"wrong-magic", "its descriptor lacks the magic word SPARKPLG"},
  };
  REQUIRE(problems.size() == std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    CHECK_THAT(problems[i], Catch::Contains(bad(expected[i].first).string()) && Catch::Contains(expected[i].second));
    CHECK_THAT(host.text, Catch::Contains(problems[i]));
  }
  // Plugins that fail only when their classes are registered are listed.
  std::vector<std::string> listed;
  for (const auto& p : host.kernel.root().child("plugins")->asNode()->children()) listed.push_back(p->name());
  CHECK(listed ==
        std::vector<std::string>{"duplicate-class", "own-base", "throws-no-exception", "throws-while-registering"});
  for (const auto& [name, reason] : expected) CHECK_FALSE(isMapped(bad(name)));
}

TEST_CASE("useFile refuses bad files too and leaves nothing mapped") {
  TestHost host(false);
  for (const char* name :
       {"bad-name", "missing-dependency", "missing-symbol", "newer-abi", "no-descriptor", "no-headers", "not-a-library",
        "older-abi", "other-headers", "other-sanitizer", "wrong-magic", "duplicate-class", "own-base",
        "throws-no-exception", "throws-while-registering"}) {
    CAPTURE(name);
    CHECK_THAT(refusal([&] { host.kernel.plugins().useFile(bad(name)); }), Catch::Contains(bad(name).string()));
    CHECK(host.kernel.root().child("plugins")->asNode()->children().empty());
    CHECK_FALSE(isMapped(bad(name)));
  }
  host.kernel.plugins().useFile(good("fixture-base"));
  CHECK(host.kernel.root().child("plugins")->asNode()->children().size() == 1);
  CHECK(isMapped(good("fixture-base")));
  CHECK_THAT(refusal([&] { host.kernel.plugins().useFile("/nowhere/x.so"); }),
             Catch::Contains("/nowhere/x.so") && Catch::Contains("No such file"));
}

TEST_CASE("A plugin is accepted if the headers that it includes equal the host's except for comments") {
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  const auto variant = [](const std::string& name) { return fixtures("abi-plugins") / (name + ".so"); };
  CHECK(loader.useFile(variant("other-comments")).registered());
  CHECK(loader.useFile(variant("other-unused")).registered());
  CHECK_THAT(refusal([&] { loader.useFile(variant("other-layout")); }),
             Catch::Contains(variant("other-layout").string()) &&
                 Catch::Contains("this host has another version of api/drawing.h, or none") &&
                 Catch::Contains("Build it again with this host's headers"));
}

TEST_CASE("A truncated file, an empty file and a folder are refused") {
  TestHost host(false);
  const test::TemporaryFolder folder;
  fs::copy_file(good("fixture-base"), folder.path() / "cut.so");
  fs::resize_file(folder.path() / "cut.so", fs::file_size(good("fixture-base")) / 3);
  std::ofstream(folder.path() / "empty.so").flush();
  fs::create_directory(folder.path() / "folder.so");
  std::ofstream(folder.path() / "readme.txt") << "ignored";
  const auto problems = host.kernel.plugins().scan(folder.path());
  REQUIRE(problems.size() == 3);
  CHECK_THAT(problems[0], Catch::Contains("cut.so") && Catch::Contains("it is cut off"));
  CHECK_THAT(problems[1], Catch::Contains("empty.so") && Catch::Contains("it is no shared library"));
  CHECK_THAT(problems[2], Catch::Contains("folder.so"));
  CHECK_THAT(host.kernel.plugins().scan(folder.path() / "nowhere").at(0), Catch::Contains("cannot read plugin folder"));
}

TEST_CASE("A file with a segment outside of the loaded memory is refused") {
  const std::string whole = bytesOf(good("fixture-base"));
  Elf64_Ehdr head;
  REQUIRE(whole.size() > sizeof head);
  std::memcpy(&head, whole.data(), sizeof head);
  const test::TemporaryFolder folder;
  std::size_t moved = 0;
  for (int i = 0; i < head.e_phnum; ++i) {
    const std::size_t at = head.e_phoff + static_cast<std::size_t>(i) * sizeof(Elf64_Phdr);
    Elf64_Phdr p;
    std::memcpy(&p, whole.data() + at, sizeof p);
    if (p.p_type == PT_LOAD || p.p_type == PT_NULL || p.p_type == PT_GNU_STACK) continue;
    p.p_vaddr += 1 << 30;
    std::string bytes = whole;
    std::memcpy(bytes.data() + at, &p, sizeof p);
    overwrite(folder.path() / ("segment" + std::to_string(i) + ".so"), bytes);
    ++moved;
  }
  REQUIRE(moved >= 2);
  TestHost host(false);
  CHECK(host.kernel.plugins().scan(folder.path()).size() == moved);
}

#ifdef __x86_64__
TEST_CASE("A file whose relocations, versions or hash tables are damaged is refused, and the linker never reads them") {
  const std::string whole = bytesOf(good("fixture-base"));
  const auto at = [&whole]<class T>(T, std::size_t offset) {
    T out;
    REQUIRE(offset + sizeof out <= whole.size());
    std::memcpy(&out, whole.data() + offset, sizeof out);
    return out;
  };
  const test::TemporaryFolder folder, intact;
  std::size_t written = 0;
  const auto put = [](std::string& bytes, std::size_t offset, const auto& damaged) {
    REQUIRE(offset + sizeof damaged <= bytes.size());
    std::memcpy(bytes.data() + offset, &damaged, sizeof damaged);
  };
  const auto writeAll = [&](const std::string& bytes) {
    overwrite(folder.path() / (std::to_string(written++) + ".so"), bytes);
  };
  const auto write = [&](std::size_t offset, const auto& damaged) {
    std::string bytes = whole;
    put(bytes, offset, damaged);
    writeAll(bytes);
  };
  const auto head = at(Elf64_Ehdr(), 0);
  const auto sectionAt = [&](std::size_t i) { return at(Elf64_Shdr(), head.e_shoff + i * sizeof(Elf64_Shdr)); };
  const auto sectionOf = [&](Elf64_Word type) {
    for (std::size_t i = 0; i < head.e_shnum; ++i)
      if (sectionAt(i).sh_type == type) return sectionAt(i);
    FAIL("no section of type " << type);
    return Elf64_Shdr();
  };
  for (std::size_t i = 0; i < head.e_shnum; ++i) {
    const auto section = sectionAt(i);
    if (section.sh_type == SHT_RELA) {
      const auto last = section.sh_offset + section.sh_size - sizeof(Elf64_Rela);  // it has a symbol
      auto r = at(Elf64_Rela(), last);
      r.r_offset ^= std::uint64_t{1} << 40;
      write(last, r);
      r = at(Elf64_Rela(), last);
      r.r_info ^= std::uint64_t{1} << 60;
      write(last, r);
      r = at(Elf64_Rela(), last);
      r.r_info ^= 0x80;
      write(last, r);
      // The first one may be relative. The linker looks at its symbol, too.
      r = at(Elf64_Rela(), section.sh_offset);
      r.r_info ^= std::uint64_t{1} << 50;
      write(section.sh_offset, r);
    } else if (section.sh_type == SHT_GNU_verneed) {
      auto library = at(Elf64_Verneed(), section.sh_offset);
      library.vn_file ^= 0x100;
      write(section.sh_offset, library);
      library = at(Elf64_Verneed(), section.sh_offset);
      library.vn_aux = 1 << 30;
      write(section.sh_offset, library);
      library = at(Elf64_Verneed(), section.sh_offset);
      library.vn_cnt = 0;
      write(section.sh_offset, library);
      // Records that overlap: the same ones again, in steps of a byte.
      std::string bytes = whole;
      library = at(Elf64_Verneed(), section.sh_offset);
      library.vn_aux = sizeof library;
      library.vn_cnt = 1;
      library.vn_next = 1;
      put(bytes, section.sh_offset, library);
      writeAll(bytes);
    } else if (section.sh_type == SHT_GNU_versym) {
      write(section.sh_offset + sizeof(Elf64_Half), Elf64_Half{0x7f00});  // of the first symbol
    }
  }

  // The dynamic section has room behind its end, which the linker does not read.
  const auto dynamic = sectionOf(SHT_DYNAMIC), versions = sectionOf(SHT_GNU_verneed);
  std::size_t end = dynamic.sh_offset;
  while (at(Elf64_Dyn(), end).d_tag != DT_NULL) end += sizeof(Elf64_Dyn);
  REQUIRE(end + 4 * sizeof(Elf64_Dyn) <= dynamic.sh_offset + dynamic.sh_size);
  const auto entry = [](Elf64_Sxword tag, std::uint64_t value) {
    Elf64_Dyn d{};
    d.d_tag = tag;
    d.d_un.d_val = value;
    return d;
  };
  std::string behind = whole;
  put(behind, end + sizeof(Elf64_Dyn), entry(DT_NEEDED, std::uint64_t{1} << 40));
  overwrite(intact.path() / "behind.so", behind);
  auto library = at(Elf64_Verneed(), versions.sh_offset);
  library.vn_file = 0;  // no library's name
  put(behind, versions.sh_offset, library);
  writeAll(behind);
  // What the linker calls is code: functions, and the entries of arrays, which relocations change.
  const auto dynamicAt = [&](Elf64_Sxword tag) {
    std::size_t i = dynamic.sh_offset;
    while (at(Elf64_Dyn(), i).d_tag != tag) REQUIRE((i += sizeof(Elf64_Dyn)) < end);
    return i;
  };
  for (const Elf64_Sxword tag : {DT_INIT, DT_FINI}) write(dynamicAt(tag), entry(tag, dynamic.sh_addr));
  for (const Elf64_Sxword tag : {DT_INIT_ARRAYSZ, DT_FINI_ARRAYSZ}) {
    write(dynamicAt(tag), entry(tag, 16 * sizeof(Elf64_Addr)));
    write(dynamicAt(tag), entry(DT_DEBUG, 0));
  }
  write(dynamicAt(DT_RELA), entry(DT_DEBUG, 0));
  write(dynamicAt(DT_VERSYM), entry(DT_DEBUG, 0));
  // Packed relocations: an address, and the next 63 words; they lie behind the end of the dynamic section.
  const auto packed = [&](std::initializer_list<Elf64_Addr> words) {
    constexpr Elf64_Sxword kRelrSize = 35, kRelr = 36, kRelrEntry = 37;
    std::size_t to = end + 4 * sizeof(Elf64_Dyn);
    REQUIRE(to + words.size() * sizeof(Elf64_Addr) <= dynamic.sh_offset + dynamic.sh_size);
    std::string bytes = whole;
    put(bytes, end, entry(kRelr, dynamic.sh_addr + (to - dynamic.sh_offset)));
    put(bytes, end + sizeof(Elf64_Dyn), entry(kRelrSize, words.size() * sizeof(Elf64_Addr)));
    put(bytes, end + 2 * sizeof(Elf64_Dyn), entry(kRelrEntry, sizeof(Elf64_Addr)));
    for (const Elf64_Addr word : words) {
      put(bytes, to, word);
      to += sizeof word;
    }
    return bytes;
  };
  const Elf64_Addr room = dynamic.sh_addr + dynamic.sh_size - 2 * sizeof(Elf64_Addr);  // the linker does not read it
  fs::create_directory(folder.path() / "packed");
  overwrite(folder.path() / "packed" / "packed.so", packed({room, 3}));
  writeAll(packed({0}));                                                         // what is not written to
  writeAll(packed({Elf64_Addr{1} << 40}));                                       // outside
  writeAll(packed({at(Elf64_Dyn(), dynamicAt(DT_INIT_ARRAY)).d_un.d_val + 1}));  // bits without an address
  // More relocations are relative than the first ones; the last entry with a tag counts.
  const auto relocations = sectionOf(SHT_RELA);
  write(end, entry(DT_RELACOUNT, relocations.sh_size / sizeof(Elf64_Rela)));
  write(end, entry(DT_STRTAB, std::uint64_t{1} << 40));

  // Hash tables: number of buckets, first symbol, words of the filter, shift, the filter, buckets, lists.
  using Word = Elf64_Word;
  const std::size_t hash = sectionOf(SHT_GNU_HASH).sh_offset;
  const std::size_t buckets = hash + 4 * sizeof(Word) + at(Word(), hash + 2 * sizeof(Word)) * sizeof(std::uint64_t);
  const Word first = at(Word(), hash + sizeof(Word));
  for (const Word count : {Word{0}, Word{1} << 30}) write(hash, count);
  for (const Word filter : {0u, 3u, 1u << 28}) write(hash + 2 * sizeof(Word), filter);
  write(hash + 3 * sizeof(Word), Word{64});
  for (const Word bucket : {first - 1, first + (1u << 28)}) write(buckets, bucket);
  const auto symbols = sectionOf(SHT_DYNSYM);
  auto symbol = at(Elf64_Sym(), symbols.sh_offset + first * sizeof(Elf64_Sym));
  symbol.st_name = 1 << 30;
  write(symbols.sh_offset + first * sizeof symbol, symbol);
  // The older kind: numbers of buckets and symbols, buckets, lists. It lies behind the end of the dynamic section.
  const auto older = [&](std::initializer_list<Word> table) {
    std::size_t to = end + 2 * sizeof(Elf64_Dyn);
    std::string bytes = whole;
    put(bytes, end, entry(DT_HASH, dynamic.sh_addr + (to - dynamic.sh_offset)));
    for (const Word word : table) {
      put(bytes, to, word);
      to += sizeof word;
    }
    return bytes;
  };
  overwrite(intact.path() / "older.so", older({1, 3, 2, 0, 0, 1}));
  writeAll(older({0, 3, 0, 0, 0}));            // no bucket
  writeAll(older({1, 3, 3, 0, 0, 0}));         // a symbol that does not exist
  writeAll(older({1, 3, 2, 0, 2, 1}));         // a list without end
  writeAll(older({1, 1u << 30, 2, 0, 0, 1}));  // larger than the file
  REQUIRE(written == 40);

  for (const char* name : {"behind.so", "older.so"}) {
    TestHost other(false);
    CHECK(other.kernel.plugins().useFile(intact.path() / name).registered());
  }
  TestHost host(false);
  const auto problems = host.kernel.plugins().scan(folder.path());
  for (const std::string& problem : problems) CHECK_THAT(problem, Catch::Contains("its headers are damaged"));
  // The linker takes packed relocations only of libraries that need a version of it that has them.
  const auto packedProblems = host.kernel.plugins().scan(folder.path() / "packed");
  CHECK(packedProblems.size() <= 1);
  for (const std::string& problem : packedProblems) CHECK(lacks(problem, "its headers are damaged", problems.at(0)));
  CHECK(problems.size() == written);
}
#endif

TEST_CASE("Overwriting the file of a running plugin does no harm, and loading it again gives the new version") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  loader.scan(folder.path());
  loader.use("fixture-base");
  const std::string whole = bytesOf(file);
  overwrite(file, whole.substr(0, whole.size() / 3));  // like an unfinished copy
  Leaf& made = host.kernel.create("FixtureBase", "/usr/a");
  host.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  CHECK(getProperty(made, "number") == Value(2.0));
  overwrite(file, withVersion(whole, "1.2", "1.3"));
  host.kernel.events().channel("fixtureTick").emit({"fixtureTick", 0, 0, 0, nullptr});
  CHECK(getProperty(made, "number") == Value(3.0));
  CHECK(host.kernel.root().require<Plugin>("/plugins/fixture-base").version() == "1.2");
  made.parent()->remove(made);
  loader.unload("fixture-base");
  CHECK_FALSE(isMapped(file));
  const Plugin& again = loader.use("fixture-base");  // without a scan
  CHECK(again.version() == "1.3");
  CHECK(again.file() == file.string());
  CHECK(host.kernel.create("FixtureBase", "/usr/a").classObject()->plugin() == &again);
}

TEST_CASE("Loading a plugin again is refused while its file is broken, and works once it is repaired") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  const std::string whole = bytesOf(file);
  TestHost host(false);
  Loader& loader = host.kernel.plugins();
  loader.useFile(file);
  loader.unload("fixture-base");
  overwrite(file, whole.substr(0, 4000));  // half of the file could be intact if the rest is debug information
  CHECK_THAT(refusal([&] { loader.use("fixture-base"); }),
             Catch::Contains(file.string()) && Catch::Contains("it is cut off"));
  fs::remove(file);
  CHECK_THAT(refusal([&] { loader.use("fixture-base"); }), Catch::Contains("there is no plugin 'fixture-base'"));
  overwrite(file, whole);
  CHECK(loader.use("fixture-base").registered());
}

TEST_CASE("Kernels share the code of identical files, and each keeps the version that it loaded") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "fixture-base.so";
  fs::copy_file(good("fixture-base"), file);
  const auto codeOf = [](TestHost& host) {
    return reinterpret_cast<const void*>(host.kernel.classOf("FixtureBase").hooks().front()->run);
  };
  TestHost a(false), b(false), c(false);
  a.kernel.plugins().useFile(file);
  b.kernel.plugins().useFile(file);
  CHECK(codeOf(a) == codeOf(b));
  overwrite(file, withVersion(bytesOf(file), "1.2", "1.5"));
  CHECK(c.kernel.plugins().useFile(file).version() == "1.5");
  CHECK(codeOf(a) != codeOf(c));
  CHECK(a.kernel.plugins().useFile(file).version() == "1.2");
  CHECK(b.kernel.plugins().use("fixture-base").version() == "1.2");
}

TEST_CASE("Debuggers find a plugin's code under its file's name") {
  TestHost host(false);
  host.kernel.plugins().useFile(good("fixture-base"));
  Dl_info info = {};
  REQUIRE(dladdr(reinterpret_cast<const void*>(host.kernel.classOf("FixtureBase").hooks().front()->run), &info) != 0);
  CHECK(std::string(info.dli_fname) == good("fixture-base").string());
}

TEST_CASE("If no private copy can be made, the file itself is loaded") {
  TestHost host(false);
  rlimit before = {};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit none{100, before.rlim_max};
  REQUIRE(setrlimit(RLIMIT_FSIZE, &none) == 0);
  Plugin& plugin = host.kernel.plugins().useFile(good("fixture-base"));
  setrlimit(RLIMIT_FSIZE, &before);
  CHECK(plugin.registered());
  CHECK(isMapped(good("fixture-base")));
  host.kernel.plugins().unload("fixture-base");
  CHECK_FALSE(isMapped(good("fixture-base")));
}

TEST_CASE("A library next to a plugin's file is found and is unloaded with the plugin") {
  const test::TemporaryFolder folder;
  fs::copy(fixtures("neighbour-plugins"), folder.path() / "elsewhere", fs::copy_options::recursive);
  TestHost host(false);
  const fs::path file = folder.path() / "elsewhere" / "with-neighbour.so",
                 library = folder.path() / "elsewhere" / "lib" / "libfixture-neighbour.so";
  host.kernel.plugins().useFile(file);
  CHECK(getProperty(host.kernel.create("WithNeighbour", "/usr/a"), "answer") == Value(42));
  CHECK(isMapped(library));
  host.kernel.root().child("usr")->asNode()->removeChildren();
  host.kernel.plugins().unload("with-neighbour");
  CHECK_FALSE(isMapped(file));
  CHECK_FALSE(isMapped(library));
  fs::remove(library);
  CHECK_THAT(refusal([&] { host.kernel.plugins().use("with-neighbour"); }),
             Catch::Contains(file.string()) && Catch::Contains("libfixture-neighbour.so: cannot open"));
}
