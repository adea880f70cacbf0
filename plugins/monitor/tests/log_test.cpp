#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "absence.h"
#include "api/drawing.h"
#include "stage.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A file that is removed with the object.
struct TemporaryFile {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("spark-log-{}-{}", ::getpid(), next()++);
  TemporaryFile() = default;
  explicit TemporaryFile(const std::string& text) { std::ofstream(path, std::ios::binary) << text; }
  ~TemporaryFile() { std::filesystem::remove(path); }
  static int& next() {
    static int n = 0;
    return n;
  }
  std::vector<std::string> lines() const {
    std::ifstream in(path, std::ios::binary);
    std::vector<std::string> out;
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
  }
};

bool isFull(const std::string& record) { return record.find(")(RSG 0 1)(") != std::string::npos; }

/// Drawings that record only the versions since the last record.
class TestDrawings : public Node, public IDrawings {
  SPARK_CLASS(TestDrawings, Node)
 public:
  static void describe(Description<TestDrawings>& d) { d.implements<IDrawings>(); }
  std::uint64_t version() const override { return changes; }
  std::span<const Set> sets() const override { return {}; }
  void draw(std::span<const std::byte> packet) override {
    auto& bytes = drawn.emplace_back();
    for (std::byte b : packet) bytes.push_back(static_cast<int>(b));
  }
  void record(std::uint64_t since, std::string& out) const override {
    if (since != changes) out += fmt::format("[{}, {}]", since, changes);
  }
  std::uint64_t changes = 0;
  std::vector<std::vector<int>> drawn;
};

/// A stage with a log.
struct Recorded : Stage {
  TemporaryFile file;
  Leaf& log;
  Recorded() : log(node().create("MonitorLog", "log")) { setProperty(log, "file", file.path.string()); }
};

/// A monitor server that plays a log.
struct Player : TestHost {
  explicit Player(const std::filesystem::path& file) {
    kernel.plugins().use("monitor");
    kernel.plugins().use("monitor-sexp");
    port = &kernel.create<Node>("Node", "/sys/server/net/monitors");
    consumer = &kernel.create<IConnectionConsumer>("MonitorServer", "/sys/server/monitor");
    setProperty(*kernel.root().find("/sys/server/monitor"), "precision", 0.0);
    kernel.create("SexpMonitor", "/sys/server/monitor/encoder");
    player = &kernel.create("LogPlayer", "/sys/server/monitor/player");
    setProperty(*player, "file", file.string());
  }
  FakeConnection& connect() {
    connections.push_back(std::make_unique<FakeConnection>(*port, connections.size() + 1));
    consumer->connected(*connections.back());
    return *connections.back();
  }
  void cycle() {
    ++cycles;
    const Event event{"", 0.02 * cycles, 0.02, cycles, nullptr};
    kernel.events().channel("act").emit(event);
    kernel.events().channel("publish").emit(event);
  }
  /// Runs for the duration of `n` records.
  void records(int n) {
    for (int i = 0; i < 10 * n; ++i) cycle();
  }
  void command(FakeConnection& from, const char* text) {
    consumer->received(from, text);
    cycle(), cycle();
  }
  std::int64_t at() { return getProperty(*player, "record").toInteger(); }
  Node* port;
  IConnectionConsumer* consumer;
  Leaf* player;
  std::vector<std::unique_ptr<FakeConnection>> connections;
  std::int64_t cycles = 0;
};

/// A small log: three records (full, diff, diff) with the mesh 1, 2, 3 m high.
const char* const kFull =
    "((FieldLength 30)(time 0)(score_left 0))(RSG 0 1)((nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1)"
    "(nd StaticMesh (setVisible 1) (load models/a.obj) (sSc 1 1 1)(resetMaterials x y))))";
const char* const kSecond =
    "((time 0.2)(foul 1 2 1 7))(RDS 0 1)((nd (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 2 1)(nd StaticMesh (setVisible 0))))";
const char* const kThird =
    "((time 0.4)(score_left 1))(RDS 0 1)((nd (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 3 1)(nd StaticMesh (setVisible 1))))";

std::string join(std::initializer_list<std::string> lines) {
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

}  // namespace

TEST_CASE("a log has a record every 0.2 s, and full records at the start, after 3 s and after changes of the scene") {
  Recorded stage;
  for (int i = 0; i < 1000; ++i) {
    if (i == 600) stage.scene.markModified();
    stage.cycle();
  }
  const auto lines = stage.file.lines();
  REQUIRE(lines.size() == 100);
  CHECK(getProperty(stage.log, "records") == Value(100));
  std::vector<int> fulls;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (isFull(lines[i])) fulls.push_back(static_cast<int>(i));
  CHECK(fulls == std::vector<int>{0, 16, 32, 48, 60, 76, 92});
  Replica replica;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    replica.take(lines[i]);
    CHECK(replica.time == Approx(0.04 + 0.2 * i));  // 0.04 s: the first frame
  }
}

TEST_CASE("a log is complete independently of the monitors, with its own diffs and every event once") {
  Recorded stage;
  FakeConnection& monitor = stage.connect();
  Replica live, logged;
  live.take(monitor.read());
  for (int i = 0; i < 502; ++i) {  // the log records the last one
    if (i % 37 == 0) stage.item->waiting = 2;
    stage.item->score = i / 50;
    stage.head->shown = (i / 20) % 2;
    stage.cycle();
    if (!monitor.idle()) live.take(monitor.read());
  }
  for (const std::string& line : stage.file.lines()) logged.take(line);
  CHECK(same(logged, freshReplica(stage), 0.005001));
  CHECK(logged.events == live.events);
  CHECK(logged.events.size() > 20);
}

TEST_CASE("drawings precede a record, all of them for a full record and the changes for a diff") {
  Recorded stage;
  stage.kernel.registerClass<TestDrawings>();
  auto& drawings = stage.kernel.create<TestDrawings>("TestDrawings", "/sys/server/drawing");
  for (int i = 0; i < 400; ++i) {
    if (i == 100 || i == 101 || i == 150) ++drawings.changes;
    if (i == 300) stage.kernel.root().require<Node>("/sys/server").remove(drawings);
    stage.cycle();
  }
  const auto lines = stage.file.lines();
  std::vector<std::pair<std::size_t, std::string>> drawn;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].front() == '[') drawn.emplace_back(i, lines[i].substr(0, lines[i].find('(')));
  REQUIRE(drawn.size() == 3);
  CHECK(drawn[0] == std::pair<std::size_t, std::string>(10, "[0, 2]"));  // from version 0 to 2
  CHECK(drawn[1] == std::pair<std::size_t, std::string>(15, "[2, 3]"));
  CHECK(drawn[2] == std::pair<std::size_t, std::string>(16, "[0, 3]"));  // the full record
  CHECK(isFull(lines[16]));

  // The player reads the records with and without drawings.
  Player player(stage.file.path);
  CHECK(getProperty(*player.player, "records") == Value(static_cast<std::int64_t>(lines.size())));
  CHECK(getProperty(*player.player, "damaged") == Value(0));
}

TEST_CASE("drawings of a recorded game are shown again, and removed when the playback jumps") {
  Recorded stage;
  for (int i = 0; i < 100; ++i) stage.cycle();
  std::string text;
  auto lines = stage.file.lines();
  lines[2].insert(0, "[1, -128][127, 0]");
  lines[5].insert(0, "[3]");
  lines[6].insert(0, "[junk, 4, 5");
  for (const std::string& line : lines) text += line + "\n";
  TemporaryFile edited(text);
  Player player(edited.path);
  player.kernel.registerClass<TestDrawings>();
  auto& drawings = player.kernel.create<TestDrawings>("TestDrawings", "/sys/server/drawing");
  const auto go = [&](std::int64_t record) {
    drawings.drawn.clear();
    setProperty(*player.player, "record", record);
    return drawings.drawn;
  };
  using Packets = std::vector<std::vector<int>>;
  CHECK(go(1).empty());
  CHECK(go(4) == Packets{{1, 128}, {127, 0}});
  drawings.changes = 1;  // drawings are shown now
  const Packets again = go(5);
  REQUIRE(again.size() == 4);
  CHECK(again[0].size() == 6 + 3 * 256);
  CHECK(again[3] == std::vector<int>{3});
  CHECK(go(0).size() == 1);
}

TEST_CASE("a log that cannot be written is reported once, and the server continues") {
  Stage stage;
  Leaf& log = stage.node().create("MonitorLog", "log");
  setProperty(log, "file", "/nonexistent/folder/x.log");
  FakeConnection& monitor = stage.connect();
  monitor.read();
  for (int i = 0; i < 100; ++i) stage.cycle();
  CHECK(!monitor.idle());
  CHECK_THAT(stage.text, Catch::Contains("cannot write the log /nonexistent/folder/x.log: No such file or directory"));
  CHECK(count(stage.text, "cannot write the log") == 1);
}

TEST_CASE("a recorded game is played to a monitor record by record, and late monitors can join") {
  Recorded stage;
  for (int i = 0; i < 400; ++i) {
    if (i % 60 == 30) stage.item->waiting = 1;
    if (i == 200) stage.parts[1]->create("FakeVisual", "hat");
    stage.item->score = i / 50;
    stage.head->shown = (i / 20) % 2;
    stage.cycle();
  }
  const auto lines = stage.file.lines();
  Player player(stage.file.path);
  CHECK(getProperty(*player.player, "records") == Value(static_cast<std::int64_t>(lines.size())));
  for (int i = 0; i < 50; ++i) player.cycle();
  CHECK(player.at() == 0);  // there is no monitor yet
  FakeConnection& monitor = player.connect();
  Replica seen, logged;
  seen.take(monitor.read());
  logged.take(lines[0]);
  CHECK(same(seen, logged, 0));
  player.cycle(), player.cycle();  // the player detects the monitor
  for (std::size_t i = 1; i < lines.size(); ++i) {
    for (int k = 0; k < 10; ++k) {
      player.cycle();
      if (!monitor.idle()) seen.take(monitor.read());
    }
    logged.take(lines[i]);
    CAPTURE(i);
    REQUIRE(same(seen, logged, 0));
    REQUIRE(seen.time == logged.time);
    REQUIRE(seen.events == logged.events);
  }
  CHECK(seen.events.size() > 3);
  CHECK(seen.fulls == 2);  // the first one, and one for the hat
  player.records(5);
  CHECK(player.at() == static_cast<std::int64_t>(lines.size()) - 1);  // it stops at the end
  Replica late;
  late.take(player.connect().read());
  CHECK(same(late, logged, 0));
  CHECK(late.lastEnv == std::vector<std::string>{"FieldLength", "time", "score"});
}

TEST_CASE("a player can be paused, stepped, reversed, accelerated and moved to a record") {
  std::string text = join({kFull});
  for (int i = 1; i < 60; ++i) {
    std::string line = i % 15 == 0 ? kFull : i % 2 ? kSecond : kThird;
    line.replace(line.find("(time"), line.find(')', line.find("(time")) - line.find("(time"),
                 fmt::format("(time {:g}", 0.2 * i));
    text += line + "\n";
  }
  const TemporaryFile file(text);
  Player player(file.path);
  FakeConnection& monitor = player.connect();
  const auto height = [&] {
    Replica now;
    FakeConnection& newcomer = player.connect();
    now.take(newcomer.read());
    player.consumer->disconnected(newcomer);
    REQUIRE(now.nodes.size() == 2);
    return now.nodes[0].matrix[14];
  };
  player.command(monitor, "(p)");
  const std::int64_t stopped = player.at();
  player.records(5);
  CHECK(player.at() == stopped);
  player.command(monitor, "(record 20)");
  CHECK(player.at() == 20);
  CHECK(height() == 3);
  player.command(monitor, "(f)");
  CHECK(player.at() == 21);
  CHECK(height() == 2);
  player.command(monitor, "(b)(b)(b)(b)(b)(b)");
  CHECK(player.at() == 15);
  CHECK(height() == 1);
  player.command(monitor, "(speed 5)(p)");
  player.records(2);
  CHECK(player.at() == 26);
  player.command(monitor, "(l)(speed 1)");
  const std::int64_t turned = player.at();
  player.records(4);
  CHECK(player.at() == turned - 4);
  player.records(100);
  CHECK(player.at() == 0);
  CHECK(height() == 1);
  for (const char* wild : {"(speed nan)", "(speed -1)", "(speed)", "(record)", "(record 1e30)", "(record (a))",
                           "(nosuch 1)", "(speed inf)", "garbage"})
    player.command(monitor, wild);
  auto& server = player.kernel.root().require<IMonitorServer>();
  const auto answer = [&server](const char* text) { return server.command("a test", text); };
  CHECK(answer("(speed)") == "speed: expected a number of 0 or more");
  CHECK(answer("(speed 500)") == "speed: expected at most 100, which it is now");
  CHECK(answer("(p now)") == "p: expected no argument, found 1: the rest is ignored");
  CHECK(answer("(time 3 4)") == "time: expected one argument, found 2: the rest is ignored");
  CHECK(answer("(p)(record 3)(p)(speed 1)(l)(l)") == "");
  CHECK(player.at() <= 59);
  CHECK(getProperty(*player.player, "speed") == Value(1.0));
}

TEST_CASE("in a log with one full record each record is shown correctly after any jump") {
  std::string text = join({kFull});
  constexpr int kRecords = 5000;
  for (int i = 1; i < kRecords; ++i)
    text += fmt::format(
        "((time {:g})(score_left {}))(RDS 0 1)((nd (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 {} 1)(nd StaticMesh (setVisible "
        "{}))))\n",
        0.2 * i, i / 100, i, i % 2);
  const TemporaryFile file(text);
  Player player(file.path);
  setProperty(*player.player, "paused", true);
  const auto seen = [&] {
    Replica now;
    FakeConnection& newcomer = player.connect();
    now.take(newcomer.read());
    player.consumer->disconnected(newcomer);
    return now.nodes.at(0).matrix[14];
  };
  FakeConnection& monitor = player.connect();
  for (const int record : {4999, 4998, 4997, 100, 4000, 3999, 3998, 31, 32, 33, 4999, 2500, 2499, 1})
    for (const bool command : {false, true}) {
      if (command)
        player.command(monitor, fmt::format("(record {})", record).c_str());
      else
        setProperty(*player.player, "record", std::int64_t{record});
      for (int i = 0; i < (command ? 100 : 3); ++i) player.cycle();  // a long jump takes several frames
      CAPTURE(record, command);
      REQUIRE(player.at() == record);
      REQUIRE(seen() == static_cast<float>(record));
    }
}

TEST_CASE("steps back in a log with one full record do not restart from it, and no frame processes many records") {
  // The player counts skipped records each time.
  std::string text = join({kFull});
  constexpr int kRecords = 20000;
  for (int i = 1; i < kRecords; ++i) text += "(())\n";
  const TemporaryFile file(text);
  Player player(file.path);
  setProperty(*player.player, "paused", true);
  FakeConnection& monitor = player.connect();
  const auto passed = [&](auto what) {
    const std::int64_t before = getProperty(*player.player, "damaged").toInteger();
    what();
    return getProperty(*player.player, "damaged").toInteger() - before;
  };
  setProperty(*player.player, "record", std::int64_t{kRecords - 1});
  CHECK(passed([&] { player.command(monitor, "(b)"); }) <= 200);
  for (int i = 0; i < 300; ++i) CHECK(passed([&] { player.command(monitor, "(b)"); }) <= 200);
  CHECK(passed([&] {
          for (int i = 0; i < 300; ++i) player.command(monitor, "(b)");
        }) <= 300 * 8);
  CHECK(player.at() == kRecords - 1 - 601);
  setProperty(*player.player, "file", file.path.string());  // discards what is known of the file
  CHECK(passed([&] { player.consumer->received(monitor, "(record 19000)"), player.cycle(); }) <= 250);
  CHECK(getProperty(*player.player, "record") == Value(19000));
  CHECK(passed([&] { player.cycle(); }) <= 250);
}

TEST_CASE("a log on a pipe without a reader is refused with an error, and the match continues") {
  Stage stage;
  TemporaryFile pipe;
  REQUIRE(mkfifo(pipe.path.c_str(), 0600) == 0);
  Leaf& log = stage.node().create("MonitorLog", "log");
  setProperty(log, "file", pipe.path.string());
  FakeConnection& monitor = stage.connect();
  monitor.read();
  for (int i = 0; i < 100; ++i) stage.cycle();
  CHECK(!monitor.idle());
  CHECK(stage.text.find("is a pipe that nobody reads") != std::string::npos);
}

TEST_CASE("a log can be written to a pipe that has a reader") {
  Recorded stage;
  std::filesystem::remove(stage.file.path);
  REQUIRE(mkfifo(stage.file.path.c_str(), 0600) == 0);
  const int reader = open(stage.file.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  for (int i = 0; i < 30; ++i) stage.cycle();
  char bytes[1000];
  CHECK(read(reader, bytes, sizeof bytes) > 100);
  CHECK(bytes[0] == '(');
  close(reader);
}

TEST_CASE("damaged lines of a log and draw commands are skipped") {
  const std::string cut(kSecond, 60), huge(9u << 20, 'x'), deep(200, '(');
  const TemporaryFile file(
      join({"[1, 0, 3, 4][2, 1]", "", kSecond, std::string("[1, 0]") + kFull, cut, "garbage", "(())", deep, "(" + huge,
            "((time 0.1))(RDS 0 1)((nd)(nd))", "((time 0.1))(RSG 0 1)((nd BN))",
            "((time 0.1))(RSG 0 1)((nd StaticMesh (setVisible 1)))", "((time 0.1))(RSG 0 1)((nd SMN (load \"a) (b\")))",
            std::string("((time \0 0.1))(RDS 0 1)((nd(nd)))", 31), kSecond, "[1, 0][2]" + std::string(kThird)}) +
      std::string(kThird).substr(0, 70));
  Player player(file.path);
  FakeConnection& monitor = player.connect();
  Replica seen;
  for (int i = 0; i < 200; ++i) {
    if (!monitor.idle()) seen.take(monitor.read());
    player.cycle();
  }
  if (!monitor.idle()) seen.take(monitor.read());
  REQUIRE(seen.nodes.size() == 2);
  CHECK(seen.nodes[0].matrix[14] == 3);
  CHECK(seen.events == std::vector<std::string>{"1"});
  CHECK(getProperty(*player.player, "damaged").toInteger() >= 8);
  CHECK(player.text.find("is passed over: ") != std::string::npos);
}

TEST_CASE("a monitor that connects behind a jump in a log, before the next frame, sees where it leads") {
  std::string text = join({kFull});
  for (int i = 1; i < 5; ++i)
    text +=
        fmt::format("((time {:g}))(RDS 0 1)((nd (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 {} 1)(nd StaticMesh)))\n", 0.2 * i, i);
  const TemporaryFile log(text);
  Player player(log.path);
  setProperty(*player.player, "paused", true);
  player.cycle();
  for (const int record : {4, 2, 3, 1}) {
    setProperty(*player.player, "record", std::int64_t{record});
    Replica now;
    FakeConnection& newcomer = player.connect();
    now.take(newcomer.read());
    CHECK(now.nodes.at(0).matrix[14] == static_cast<float>(record));
  }
}

TEST_CASE("what is known of one log is forgotten when another one is opened") {
  const auto log = [](int records, int lift) {
    std::string text = join({kFull});
    for (int i = 1; i < records; ++i)
      text += fmt::format("((time {:g}))(RDS 0 1)((nd (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 {} 1)(nd StaticMesh)))\n",
                          0.2 * i, i + lift);
    return text;
  };
  const TemporaryFile low(log(5000, 0)), high(log(5000, 10000)), damaged(log(3, 0) + "(())\n");
  Player player(low.path);
  setProperty(*player.player, "paused", true);
  const auto seen = [&](int record) {
    setProperty(*player.player, "record", std::int64_t{record});
    for (int i = 0; i < 3; ++i) player.cycle();  // until there is a frame
    Replica now;
    FakeConnection& newcomer = player.connect();
    now.take(newcomer.read());
    player.consumer->disconnected(newcomer);
    return now.nodes.at(0).matrix[14];
  };
  for (int round = 0; round < 2; ++round) {
    setProperty(*player.player, "file", low.path.string());
    for (const int record : {4999, 4998, 2500, 2499}) CHECK(seen(record) == static_cast<float>(record));
    setProperty(*player.player, "file", high.path.string());
    for (const int record : {4992, 2496, 992}) CHECK(seen(record) == static_cast<float>(record + 10000));
  }
  setProperty(*player.player, "file", damaged.path.string());
  CHECK(player.at() == 3);
  CHECK(getProperty(*player.player, "damaged") == Value(1));
  CHECK(getProperty(*player.player, "records") == Value(4));
  setProperty(*player.player, "file", low.path.string());
  CHECK(getProperty(*player.player, "damaged") == Value(0));
  CHECK(getProperty(*player.player, "records") == Value(5000));
}

TEST_CASE("a file that is not a log is refused with an error") {
  const TemporaryFile empty(""), garbage("hello\nworld\n");
  for (const std::string& name :
       {std::string("/nonexistent.log"), std::string("/tmp"), empty.path.string(), garbage.path.string()}) {
    INFO(name);
    CHECK_THROWS_WITH(Player(name), Catch::Contains("The log '"));
  }
}
