#include <fcntl.h>
#include <sys/stat.h>
#include <zip.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "api/files.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace fs = std::filesystem;
using namespace spark;

namespace {

struct Archive {
  test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.zip";
  test::TestHost host;
  IFileServer* server = nullptr;
  Leaf* system = nullptr;

  Archive() {
    host.kernel.plugins().use("files");
    host.kernel.plugins().use("files-zip");
    server = &host.kernel.create<IFileServer>("FileServer", "/sys/server/file");
    system = &host.kernel.create("ZipFileSystem", "/sys/server/file/zip");
    setProperty(*system, "path", file.string());
  }

  void write(const std::vector<std::pair<std::string, std::string>>& members, bool encrypt = false) const {
    fs::remove(file);
    int code = 0;
    zip_t* zip = zip_open(file.c_str(), ZIP_CREATE, &code);
    REQUIRE(zip);
    for (const auto& [name, text] : members) {
      if (name.ends_with('/')) {
        zip_dir_add(zip, name.c_str(), ZIP_FL_ENC_UTF_8);
        continue;
      }
      const auto index =
          zip_file_add(zip, name.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0), ZIP_FL_ENC_UTF_8);
      if (encrypt) zip_file_set_encryption(zip, static_cast<zip_uint64_t>(index), ZIP_EM_AES_128, "secret");
    }
    REQUIRE(zip_close(zip) == 0);
  }
  std::string errorOf(const std::string& resource) const {
    try {
      server->read(resource);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
};

}  // namespace

TEST_CASE("members of an archive are resources, with an optional prefix") {
  Archive a;
  a.write({{"agent/", ""}, {"agent/x.rsg", "text"}, {"empty", ""}, {"../evil", "e"}});
  CHECK(a.server->read("agent/x.rsg") == "text");
  CHECK(a.server->read("empty").empty());
  CHECK_FALSE(a.server->exists("agent/y.rsg"));
  CHECK(a.errorOf("agent").find("found a folder") != std::string::npos);
  CHECK(a.errorOf("../evil").find("'..'") != std::string::npos);
  setProperty(*a.system, "prefix", "rsg");
  CHECK(a.server->read("rsg/agent/x.rsg") == "text");
  CHECK_FALSE(a.server->exists("agent/x.rsg"));
}

TEST_CASE("a changed archive is read again, and a missing one has no members") {
  Archive a;
  CHECK_FALSE(a.server->exists("x"));
  a.write({{"x", "one"}});
  CHECK(a.server->read("x") == "one");
  const auto before = a.server->stamp("x");
  a.write({{"x", "three"}, {"y", ""}});
  CHECK(a.server->read("x") == "three");
  CHECK(a.server->stamp("x") != before);
}

TEST_CASE("an archive that is rewritten in the same second with the same size is read again") {
  Archive a;
  const auto writtenAt = [&](const char* text, long nanoseconds) {
    // Over the same file, so that its inode stays too.
    std::stringstream bytes;
    {
      Archive other;
      other.write({{"x", text}});
      bytes << std::ifstream(other.file, std::ios::binary).rdbuf();
    }
    std::ofstream(a.file, std::ios::binary) << bytes.str();
    const timespec times[] = {{1000, nanoseconds}, {1000, nanoseconds}};
    REQUIRE(utimensat(AT_FDCWD, a.file.c_str(), times, 0) == 0);
    return fs::file_size(a.file);
  };
  const auto size = writtenAt("one", 1);
  CHECK(a.server->read("x") == "one");
  const auto before = a.server->stamp("x");
  CHECK(a.server->stamp("x") == before);
  REQUIRE(writtenAt("two", 2) == size);
  CHECK(a.server->read("x") == "two");
  const auto second = a.server->stamp("x");
  CHECK(second != before);
  // A copy keeps the time of writing too: what is left is the time of the change, which has ticks.
  do writtenAt("six", 2);
  while (a.server->stamp("x") == second);
  CHECK(a.server->read("x") == "six");
}

TEST_CASE("a file that is not an archive, too large or encrypted is refused with the reason") {
  Archive a;
  std::ofstream(a.file) << "no archive at all";
  CHECK(a.errorOf("x").find("cannot open archive") != std::string::npos);
  a.write({{"x", std::string(1000, 'x')}});
  setProperty(*a.system, "maxBytes", 999);
  CHECK(a.errorOf("x").find("too large: 1000 bytes") != std::string::npos);
  setProperty(*a.system, "maxBytes", 1000);
  CHECK(a.server->read("x").size() == 1000);
  a.write({{"x", "secret text"}}, true);
  CHECK(a.errorOf("x").find("encrypted") != std::string::npos);
}

TEST_CASE("a damaged member is refused completely") {
  Archive a;
  std::string noise(600, '\0');
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<char>(i * i * 31 + i / 7);
  a.write({{"x", noise}});
  std::fstream f(a.file, std::ios::in | std::ios::out | std::ios::binary);
  f.seekp(100);
  f.write("\x55\xaa\x55\xaa", 4);
  f.close();
  CHECK(a.errorOf("x").find("cannot read 'x'") != std::string::npos);
}

TEST_CASE("a zip bomb is refused, also one that lies about its size") {
  Archive a;
  a.write({{"robot.rsg", std::string(32u << 20, ' ')}});
  REQUIRE(fs::file_size(a.file) < 100000);
  CHECK(a.errorOf("robot.rsg").find("too large: 33554432 bytes") != std::string::npos);

  // Its unpacked size stands in the member's own header and in the directory of the archive.
  std::stringstream bytes;
  bytes << std::ifstream(a.file, std::ios::binary).rdbuf();
  std::string archive = bytes.str();
  for (const auto& [mark, offset] : {std::pair{"PK\3\4", 22}, std::pair{"PK\1\2", 24}}) {
    const std::size_t at = archive.find(mark);
    REQUIRE(at != std::string::npos);
    archive.replace(at + static_cast<std::size_t>(offset), 4, std::string("\x64\0\0\0", 4));
  }
  std::ofstream(a.file, std::ios::binary) << archive;
  CHECK(a.errorOf("robot.rsg").find("cannot read 'robot.rsg'") != std::string::npos);
}
