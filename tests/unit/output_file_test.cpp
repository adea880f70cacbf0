#include "spark/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "spark/error.h"
#include "temporary_folder.h"

using namespace spark;
using Catch::Contains;

namespace {
std::string textOf(const std::string& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

/// The rules that a test sets end with it.
struct Rules {
  ~Rules() { outputs::setReplace(false); }
};
}  // namespace

TEST_CASE("A file with content is replaced only when the user says so; a new and an empty one are written") {
  const Rules rules;
  test::TemporaryFolder folder;
  const std::string file = folder.file("a");
  OutputFile(file, "the log").write("one");
  CHECK(textOf(file) == "one");
  CHECK_THROWS_WITH(OutputFile(file, "the log"), Contains("cannot write the log " + file) && Contains("--force"));
  CHECK_THROWS_WITH(outputs::check(file, "the log"), Contains("--force"));
  CHECK_THROWS_WITH(FileDraft(file, "the log"), Contains("--force"));
  CHECK(textOf(file) == "one");
  outputs::setReplace(true);
  OutputFile(file, "the log").write("2");
  CHECK(textOf(file) == "2");
  outputs::setReplace(false);
  OutputFile(folder.write("empty", ""), "the log").write("three");
  CHECK(textOf(folder.file("empty")) == "three");
}

TEST_CASE("What a run reads is never replaced, by no name") {
  const Rules rules;
  test::TemporaryFolder folder;
  const std::string file = folder.write("a", "one"), link = folder.file("link");
  std::filesystem::create_symlink(file, link);
  outputs::keep(file);
  outputs::setReplace(true);
  for (const std::string& name : {file, link, (folder.path() / "." / "a").string()}) {
    CHECK_THROWS_WITH(OutputFile(name, "the log"), Contains("this run reads it"));
    CHECK_THROWS_WITH(FileDraft(name, "the log", true), Contains("this run reads it"));
  }
  CHECK(textOf(file) == "one");
}

TEST_CASE("A file is written by one at a time") {
  const Rules rules;
  test::TemporaryFolder folder;
  const std::string file = folder.file("a");
  outputs::setReplace(true);
  {
    OutputFile first(file, "the log");
    first.write("first");
    CHECK_THROWS_WITH(OutputFile(file, "the table"), Contains("another run is writing it"));
    CHECK_THROWS_WITH(FileDraft(file, "the snapshot", true), Contains("another run is writing it"));
    CHECK_THROWS_WITH(outputs::check(file, "the log"), Contains("another run is writing it"));
    first.write(" and last");
  }
  CHECK(textOf(file) == "first and last");
  CHECK_NOTHROW(outputs::check(file, "the log"));
}

TEST_CASE("A file that is replaced keeps its permissions, a new one has the usual ones") {
  const Rules rules;
  test::TemporaryFolder folder;
  const auto modeOf = [](const std::string& file) {
    struct stat about = {};
    REQUIRE(::stat(file.c_str(), &about) == 0);
    return about.st_mode & 0777;
  };
  const mode_t before = ::umask(022);
  const auto write = [](const std::string& file) {
    FileDraft draft(file, "the table", true);
    draft.write("draft");
    draft.finish();
  };
  write(folder.file("new"));
  CHECK(modeOf(folder.file("new")) == 0644);
  outputs::setReplace(true);
  for (const mode_t mode : {0600u, 0640u, 0664u}) {
    const std::string file = folder.write("a", "old");
    REQUIRE(::chmod(file.c_str(), mode) == 0);
    write(file);
    CHECK(textOf(file) == "draft");
    CHECK(modeOf(file) == mode);
    OutputFile(file, "the log").write("log");
    CHECK(modeOf(file) == mode);
  }
  ::umask(before);
}

TEST_CASE("A draft appears as a whole, or not, and leaves nothing and no other file behind") {
  test::TemporaryFolder folder;
  const std::string file = folder.file("a");
  FileDraft(file, "the scene").write("half");
  CHECK_FALSE(std::filesystem::exists(file));
  {
    FileDraft draft(file, "the scene");
    draft.write("whole");
    CHECK_FALSE(std::filesystem::exists(file));
    draft.finish();
  }
  CHECK(textOf(file) == "whole");
  FileDraft late(folder.file("b"), "the scene");
  folder.write("b", "of another");
  late.write("mine");
  CHECK_THROWS_WITH(late.finish(), Contains("it is there already"));
  CHECK(textOf(folder.file("b")) == "of another");
  REQUIRE(::mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(FileDraft(folder.file("pipe"), "the scene", true), Contains("a pipe"));
}

TEST_CASE("A trial names the files that would be written, and writes none") {
  test::TemporaryFolder folder;
  {
    const outputs::Trial trial;
    OutputFile(folder.file("b"), "the log").write("text");
    outputs::check(folder.file("a"), "the log");
    outputs::check(folder.file("b"), "the log");
    CHECK(trial.files() == std::vector{std::filesystem::canonical(folder.path()).string() + "/a",
                                       std::filesystem::canonical(folder.path()).string() + "/b"});
  }
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("A file that was made for a run which never began is removed, one that was there stays") {
  test::TemporaryFolder folder;
  OutputFile made(folder.file("a"), "the recording");
  made.discard();
  OutputFile there(folder.write("b", ""), "the recording");
  there.discard();
  CHECK_FALSE(std::filesystem::exists(folder.file("a")));
  CHECK(std::filesystem::exists(folder.file("b")));
}

TEST_CASE("A pipe that takes nothing is waited for until its writer gives up") {
  test::TemporaryFolder folder;
  const std::string file = folder.file("pipe");
  REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(OutputFile(file, "the recording"), Contains("a pipe that nobody reads"));
  const int end = ::open(file.c_str(), O_RDONLY | O_NONBLOCK);
  OutputFile out(file, "the recording");
  int asked = 0;
  CHECK_THROWS_WITH(out.write(std::string(1 << 20, 'x'), [&] { return ++asked == 2; }), Contains("no more bytes"));
  CHECK(asked == 2);
  ::close(end);
}

// Last, since a confined process stays so.
TEST_CASE("A confined run writes below its folder, what the user names, and what the user asks for") {
  test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "own");
  outputs::confine(folder.path() / "own");
  outputs::permit(folder.file("named"));
  CHECK(outputs::permitted(folder.path() / "own" / "x"));
  CHECK(outputs::permitted(folder.file("named")));
  for (const std::string& file : {folder.file("x"), (folder.path() / "own" / ".." / "x").string(), folder.file("own")})
    CHECK_FALSE(outputs::permitted(file));
  std::filesystem::create_symlink(folder.path(), folder.path() / "own" / "link");
  CHECK_FALSE(outputs::permitted(folder.path() / "own" / "link" / "x"));
  CHECK_THROWS_WITH(OutputFile(folder.file("x"), "the log"), Contains("a recording names it"));
  CHECK_FALSE(std::filesystem::exists(folder.file("x")));
  const outputs::ByUser asked;
  CHECK(outputs::permitted(folder.file("x")));
}
