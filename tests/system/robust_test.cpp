#include <elf.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>

#include "absence.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {
std::vector<std::string> host(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), program("sparkhost"));
  return arguments;
}
/// Runs a shell command line.
Finished shell(const std::string& line) { return runToEnd({"sh", "-c", line}); }

const char* kSmall = "include \"house.lua\"\nfiles() simulation() control()\n";

/// A socket folder for this test alone. sparkctl searches /tmp as well, so every call names the process.
struct Runtime : TemporaryFolder {
  Runtime() { setenv("XDG_RUNTIME_DIR", path().c_str(), 1); }
  ~Runtime() { unsetenv("XDG_RUNTIME_DIR"); }
};

/// A program that listens on a Unix socket and never answers.
class Mute {
 public:
  explicit Mute(const std::string& file, unsigned user = 0) {
    int ready[2];
    if (pipe(ready) != 0) throw std::runtime_error("cannot make a pipe");
    pid_ = fork();
    if (pid_ == 0) {
      if (user > 0 && setuid(user) != 0) _exit(1);
      const int s = socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un address = {};
      address.sun_family = AF_UNIX;
      std::strncpy(address.sun_path, file.c_str(), sizeof address.sun_path - 1);
      if (bind(s, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || listen(s, 8) != 0) _exit(1);
      if (write(ready[1], "!", 1) != 1) _exit(1);
      while (true) pause();
    }
    close(ready[1]);
    char c;
    good_ = read(ready[0], &c, 1) == 1;
    close(ready[0]);
  }
  ~Mute() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  bool good() const { return good_; }

 private:
  int pid_ = -1;
  bool good_ = false;
};

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
}  // namespace

TEST_CASE("A config that never returns ends at the first signal and reports the line it was in") {
  TemporaryFolder folder;
  const std::string loops[] = {"log.info('here')\nwhile true do end\n",
                               "log.info('here')\nwhile true do pcall(function() while true do end end) end\n"};
  for (const std::string& loop : loops)
    for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
      Process p(host({"--config", folder.write("loop.lua", loop)}));
      p.waitForError("here");
      p.signal(number);
      CHECK(p.wait() == 2);
      CHECK_THAT(p.errors(), Contains("loop.lua:2: stopped before the config was done: the host was asked to end."));
    }
}

TEST_CASE("SIGHUP ends a host with its result and removes its socket") {
  Runtime runtime;
  Process p(host({"--config", runtime.write("small.lua", kSmall)}));
  p.line();
  const fs::path socket = runtime.path() / "spark" / (std::to_string(p.pid()) + ".sock");
  REQUIRE(fs::exists(socket));
  p.signal(SIGHUP);
  CHECK(Json::parse(p.line())["cycles"].get<int>() >= 0);
  CHECK(p.wait() == 0);
  CHECK_FALSE(fs::exists(socket));
}

TEST_CASE("Under nohup a host survives SIGHUP") {
  Runtime runtime;
  Process p(
      {"sh", "-c", "trap '' HUP; exec " + program("sparkhost") + " --config " + runtime.write("small.lua", kSmall)});
  p.line();
  p.signal(SIGHUP);
  p.signal(SIGTERM);
  CHECK(Json::parse(p.line())["cycles"].get<int>() >= 0);
  CHECK(p.wait() == 0);
}

TEST_CASE("A result that cannot be written to stdout is on stderr, and the exit code is 1") {
  TemporaryFolder folder;
  const Finished f = shell(program("sparkhost") + " --config " + folder.write("small.lua", kSmall) +
                           " --rate max --duration 1 > /dev/full");
  CHECK(f.code == 1);
  CHECK_THAT(f.errors,
             Contains("cannot write to stdout (No space left on device); this line is lost there: {\"cycles\":50,"));
  CHECK(shell(program("sparkhost") + " --list-plugins > /dev/full").code != 0);
  const Finished batch = shell(program("sparkbatch") + " --config " + folder.file("small.lua") + " --results " +
                               folder.file("t.csv") + " --duration 1 > /dev/full");
  CHECK(batch.code == 1);
  CHECK_THAT(batch.errors,
             Contains("cannot write to stdout (No space left on device); this line is lost there: {\"runs\":1,"));
}

TEST_CASE("An answer that cannot be written to stdout is an error of sparkctl") {
  Runtime runtime;
  Process p(host({"--config", runtime.write("small.lua", kSmall)}));
  p.line();
  std::string command;
  for (const std::string& word : sparkctl(p.pid())) command += word + " ";
  const Finished f = shell(command + "plugins > /dev/full");
  CHECK(f.code == 1);
  CHECK_THAT(f.errors, Contains("cannot write to stdout: No space left on device"));
}

TEST_CASE("sparkctl times out when the simulation is stopped or never answers") {
  Runtime runtime;
  Process p(host({"--config", runtime.write("small.lua", kSmall)}));
  p.line();
  const std::string pid = std::to_string(p.pid());
  REQUIRE(runToEnd(joined(sparkctl(p.pid()), {"get", "/sys/server/simulation.step"})).code == 0);
  p.signal(SIGSTOP);
  const Finished stopped =
      runToEnd({program("sparkctl"), "--pid", pid, "--timeout", "0.3", "get", "/sys/server/simulation.step"});
  CHECK(stopped.code == 1);
  CHECK_THAT(stopped.errors, Contains("did not answer within 0.3 s"));
  p.signal(SIGCONT);
  const std::string file = (runtime.path() / "mute.sock").string();
  const Mute mute(file);
  REQUIRE(mute.good());
  CHECK_THAT(runToEnd({program("sparkctl"), "--timeout", "0.3", "--socket", file, "tree"}).errors,
             Contains("did not answer within 0.3 s"));
}

TEST_CASE("sparkctl trusts neither a folder that other users can write to nor a program of another user") {
  Runtime runtime;
  const fs::path folder = runtime.path() / "spark";
  fs::create_directory(folder);
  chmod(folder.c_str(), 0755);
  const Mute mute((folder / "1.sock").string());
  REQUIRE(mute.good());
  const Finished open =
      runToEnd({program("sparkctl"), "--pid", "1", "--timeout", "0.3", "set", "/sys/server/web.token", "secret"});
  CHECK(open.code == 1);
  CHECK_THAT(open.errors, Contains("spark is open to other users: skipped") && Contains("process 1 has no simulation"));
  if (geteuid() != 0) return;  // the rest needs a second user
  chmod(folder.c_str(), 0700);
  REQUIRE(chown(folder.c_str(), 65534, 65534) == 0);
  CHECK_THAT(runToEnd({program("sparkctl"), "--pid", "1", "tree"}).errors,
             Contains("spark is another user's: skipped"));
  chmod(runtime.path().c_str(), 0777);
  const std::string file = (runtime.path() / "other.sock").string();
  const Mute other(file, 65534);
  REQUIRE(other.good());
  const Finished foreign = runToEnd({program("sparkctl"), "--timeout", "0.3", "--socket", file, "tree"});
  CHECK(foreign.code == 1);
  CHECK_THAT(foreign.errors, Contains("is another user's; it is told nothing"));
}

TEST_CASE("Includes are searched beside the config and in Spark, not in the working directory") {
  TemporaryFolder folder;
  folder.write("house.lua", "log.warning('taken over')\n");
  const std::string cd = "cd " + folder.path().string() + " && ";
  const Finished shared = shell(cd + program("sparkhost") + " --config boxes.lua --check");
  CHECK(shared.code == 0);
  // The files beside a config are used for any working directory.
  const std::string mine = folder.write("mine.lua", "include 'house.lua'\ninclude 'parts/a.lua'\n");
  folder.write("parts/a.lua", "include 'b.lua'\n");
  folder.write("parts/b.lua", "log.info('b is beside a')\n");
  for (const std::string& line : {cd + program("sparkhost") + " --config mine.lua --check",
                                  program("sparkhost") + " --config " + mine + " --check"}) {
    const Finished f = shell(line);
    CHECK(f.code == 0);
    CHECK_THAT(f.errors, Contains("b is beside a"));
    CHECK(lacks(shared.errors, "taken over", f.errors));
  }
}

TEST_CASE("A misspelt global and a misspelt channel are errors that suggest the nearest names") {
  TemporaryFolder folder;
  const auto failure = [&](const std::string& line) {
    const Finished f = runToEnd(host({"--config", folder.write("typo.lua", std::string(kSmall) + line), "--check"}));
    CHECK(f.code == 2);
    return f.errors;
  };
  CHECK_THAT(failure("phsyics()\n"),
             Contains("typo.lua:3: attempt to call a nil value (global 'phsyics'). Did you mean 'physics'"));
  CHECK_THAT(failure("on('actt', function() end)\n"),
             Contains("typo.lua:3: there is no event channel 'actt'") && Contains("Did you mean 'act'?"));
  CHECK_THAT(failure("get('/sys'):on('sence', function() end)\n"),
             Contains("typo.lua:3: there is no event channel 'sence'") && Contains("'sense'"));
  // Channels are checked only once the run loop exists.
  const Finished early = runToEnd(host(
      {"--config", folder.write("early.lua", "include 'house.lua'\non('rule', function() end)\nfiles() simulation()\n"),
       "--check"}));
  CHECK(early.code == 0);
  const Finished earlyTypo = runToEnd(
      host({"--config",
            folder.write("early.lua", "include 'house.lua'\non('rulle', function() end)\nfiles() simulation()\n"),
            "--check"}));
  CHECK(earlyTypo.code == 2);
  CHECK_THAT(earlyTypo.errors, Contains("early.lua:2: there is no event channel 'rulle'"));
}

TEST_CASE("A named pipe in a plugin folder is refused and does not block the host") {
  TemporaryFolder folder;
  const fs::path broken = folder.path() / "broken";
  fs::create_directory(broken);
  REQUIRE(mkfifo((broken / "x.so").c_str(), 0600) == 0);
  const Finished f =
      runToEnd(host({"--config", folder.write("small.lua", kSmall), "--check", "--plugin-path", broken.string()}));
  CHECK(f.code == 0);
  CHECK_THAT(f.errors, Contains("x.so: it is no regular file"));
}

TEST_CASE("Plugins with damaged headers are refused before the dynamic linker loads them") {
  TemporaryFolder folder;
  const fs::path broken = folder.path() / "broken";
  fs::create_directory(broken);
  const std::string good = contentOf(pluginFolder() / "files.so");
  Elf64_Ehdr head;
  REQUIRE(good.size() > sizeof head);
  std::memcpy(&head, good.data(), sizeof head);
  std::vector<std::pair<std::size_t, std::size_t>> parts{{16, 48}, {head.e_phoff, head.e_phnum * sizeof(Elf64_Phdr)}};
  for (int i = 0; i < head.e_phnum; ++i) {
    Elf64_Phdr p;
    std::memcpy(&p, good.data() + head.e_phoff + static_cast<std::size_t>(i) * sizeof p, sizeof p);
    if (p.p_type == PT_DYNAMIC) parts.emplace_back(p.p_offset, p.p_filesz);
  }
  REQUIRE(parts.size() == 3);
  std::mt19937 draw(1);
  constexpr int kCopies = 60, kFlips = 20;
  for (int copy = 0; copy < kCopies; ++copy) {
    std::string bytes = good;
    for (int i = 0; i < kFlips; ++i) {
      const auto& [from, size] = parts[draw() % parts.size()];
      bytes[from + draw() % size] ^= static_cast<char>(1 + draw() % 255);
    }
    std::ofstream(broken / fmt::format("copy{}.so", copy), std::ios::binary) << bytes;
  }
  const Finished f =
      runToEnd(host({"--config", folder.write("small.lua", kSmall), "--check", "--plugin-path", broken.string()}));
  CHECK(f.code == 0);
  for (int copy = 0; copy < kCopies; ++copy) CHECK_THAT(f.errors, Contains(fmt::format("copy{}.so", copy)));
}
