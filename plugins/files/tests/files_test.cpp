#include "api/files.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "temporary_folder.h"
#include "test_support.h"

namespace fs = std::filesystem;
using namespace spark;

namespace {

struct Files {
  test::TestHost host;
  test::TemporaryFolder folder;
  IFileServer* server = nullptr;
  Files() {
    host.kernel.plugins().use("files");
    server = &host.kernel.create<IFileServer>("FileServer", "/sys/server/file");
    mount("one", folder.path(), "");
  }
  Leaf& mount(const std::string& name, const fs::path& path, const std::string& prefix) {
    Leaf& system = host.kernel.create("DirectoryFileSystem", "/sys/server/file/" + name);
    setProperty(system, "path", path.string());
    setProperty(system, "prefix", prefix);
    return system;
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

TEST_CASE("a resource is read by its name, also in a form that is not normalized") {
  Files f;
  f.folder.write("rsg/a/b.rsg", "text");
  CHECK(f.server->read("rsg/a/b.rsg") == "text");
  CHECK(f.server->read("rsg//./a/b.rsg") == "text");
  CHECK(f.server->exists("rsg/a/b.rsg"));
  CHECK_FALSE(f.server->exists("rsg/a/c.rsg"));
  CHECK_FALSE(f.server->exists("rsg/a"));
}

TEST_CASE("file systems are searched in order, and a prefix mounts a folder below a name") {
  Files f;
  test::TemporaryFolder installed;
  f.mount("two", installed.path(), "rsg");
  installed.write("a.rsg", "installed");
  CHECK(f.server->read("rsg/a.rsg") == "installed");
  CHECK(f.errorOf("a.rsg").find("there is no resource 'a.rsg'") != std::string::npos);
  const auto before = f.server->stamp("rsg/a.rsg");
  f.folder.write("rsg/a.rsg", "mine");
  CHECK(f.server->read("rsg/a.rsg") == "mine");
  CHECK(f.server->stamp("rsg/a.rsg") != before);
}

TEST_CASE("the error for a missing resource lists the folders searched") {
  Files f;
  CHECK(f.errorOf("rsg/none.rsg").find(f.folder.path().string()) != std::string::npos);
}

TEST_CASE("names that are absolute, lead upwards or are invalid are refused") {
  Files f;
  f.folder.write("a", "a");
  for (const char* name :
       {"/etc/passwd", "../a", "x/../../a", "x/..", "..", ".", "", "./", "\\\\host\\a", "..\\a", "C:/a", "a\nb"}) {
    INFO(name);
    CHECK(f.errorOf(name).find("expected") != std::string::npos);
    CHECK_THROWS_AS(f.server->exists(name), Error);
  }
  CHECK(f.errorOf(std::string("a\0b", 3)).find("control") != std::string::npos);
}

TEST_CASE("a folder and a device are not files, and a folder does not hide a later file") {
  Files f;
  fs::create_directories(f.folder.path() / "rsg/agent");
  CHECK(f.errorOf("rsg/agent").find("found a folder") != std::string::npos);
  CHECK(f.errorOf("rsg/agent/").find("found a folder") != std::string::npos);
  test::TemporaryFolder second;
  second.write("rsg/agent", "file");
  f.mount("two", second.path(), "");
  CHECK(f.server->read("rsg/agent") == "file");
}

TEST_CASE("a link inside the folder is followed, and one that leads out is refused") {
  Files f;
  test::TemporaryFolder outside;
  outside.write("secret", "s");
  f.folder.write("real", "r");
  fs::create_symlink(f.folder.path() / "real", f.folder.path() / "inside");
  fs::create_symlink(outside.path() / "secret", f.folder.path() / "out");
  fs::create_directory_symlink(outside.path(), f.folder.path() / "outdir");
  CHECK(f.server->read("inside") == "r");
  CHECK(f.server->hostFile("inside") == fs::canonical(f.folder.path() / "real"));
  CHECK_THROWS_AS(f.server->hostFile("out"), Error);
  CHECK_THROWS_AS(f.server->hostFile("outdir/secret"), Error);
  CHECK_FALSE(f.server->hostFile("none"));
  CHECK_THROWS_AS(f.server->hostFile("../up"), Error);
  CHECK(f.errorOf("out").find("a link leads out") != std::string::npos);
  CHECK(f.errorOf("outdir/secret").find("a link leads out") != std::string::npos);
}

TEST_CASE("a stamp changes with the file and with the target of a link") {
  Files f;
  test::TemporaryFolder outside;
  outside.write("secret", "s");
  f.folder.write("one.rsg", "1");
  f.folder.write("two.rsg", "2");
  const fs::path link = f.folder.path() / "link";
  fs::create_symlink(f.folder.path() / "one.rsg", link);
  const auto one = f.server->stamp("link");
  CHECK(one != 0);
  CHECK(f.server->stamp("link") == one);
  f.folder.write("one.rsg", "1, but longer");
  CHECK(f.server->stamp("link") != one);
  const auto longer = f.server->stamp("link");
  const auto linkTo = [&](const fs::path& to) {
    fs::remove(link);
    fs::create_symlink(to, link);
  };
  linkTo(f.folder.path() / "two.rsg");
  CHECK(f.server->stamp("link") != longer);
  linkTo(outside.path() / "secret");
  CHECK_THROWS_AS(f.server->stamp("link"), Error);
  linkTo(f.folder.path() / "one.rsg");
  CHECK(f.server->stamp("link") == longer);
  fs::remove(link);
  CHECK(f.server->stamp("link") == 0);
}

TEST_CASE(
    "a stamp changes with a file that is rewritten in place with its size and its time of writing, as copies keep it") {
  Files f;
  f.folder.write("a.rsg", "1");
  const std::string file = (f.folder.path() / "a.rsg").string();
  const auto status = [&file] {
    struct stat s {};
    REQUIRE(::stat(file.c_str(), &s) == 0);
    return s;
  };
  const struct stat first = status();
  const auto before = f.server->stamp("a.rsg");
  const auto changedAt = [](const struct stat& s) { return std::pair(s.st_ctim.tv_sec, s.st_ctim.tv_nsec); };
  do {  // the clock of file systems has ticks
    std::ofstream(file, std::ios::in) << '2';
    const timespec times[] = {first.st_atim, first.st_mtim};
    REQUIRE(utimensat(AT_FDCWD, file.c_str(), times, 0) == 0);
  } while (changedAt(status()) == changedAt(first));
  REQUIRE(status().st_ino == first.st_ino);
  REQUIRE(status().st_size == first.st_size);
  CHECK(f.server->stamp("a.rsg") != before);
}

TEST_CASE("a file above the size limit is refused") {
  Files f;
  f.folder.write("big", std::string(101, 'x'));
  Leaf& system = *f.host.kernel.root().find("/sys/server/file/one");
  setProperty(system, "maxBytes", 100);
  CHECK(f.errorOf("big").find("too large: 101 bytes, at most 100") != std::string::npos);
  setProperty(system, "maxBytes", 101);
  CHECK(f.server->read("big").size() == 101);
}
