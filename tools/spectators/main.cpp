#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdio>
#include <vector>

#include "spectator.h"

// Load for the web server: many viewers of a match, some of which do not read. Prints {"connected":N} when all have
// received a frame, and statistics of what they received at the end.

namespace {
using spectators::Settings;
using spectators::Spectator;
using spectators::Tally;
using Clock = std::chrono::steady_clock;

struct Options {
  int count = 1, stalled = 0;
  double seconds = 0;  ///< measured time [s]; 0: until a signal
  Settings settings;
};

int usage(int argc, char** argv, Options& o) {
  CLI::App app{"Watches a match with many WebSockets and tells what came.", "web-spectators"};
  app.add_option("--host", o.settings.host, "IP address of the host")->capture_default_str();
  app.add_option("--port", o.settings.port, "Its web port")->capture_default_str();
  app.add_option("--count", o.count, "Spectators that read")->check(CLI::Range(0, 100000))->capture_default_str();
  app.add_option("--stalled", o.stalled, "Further ones that do not read")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_option("--seconds", o.seconds, "How long, from when all watch; 0: until SIGTERM")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--rate", o.settings.rate, "Frames a second; 0: as the host gives")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--detail", o.settings.detail, "With --rate")
      ->check(CLI::IsMember({"fine", "coarse"}))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return -1;
}

std::string spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  if (values.empty()) values.push_back(0);
  return fmt::format("{{\"min\":{:.1f},\"median\":{:.1f},\"max\":{:.1f}}}", values.front(), values[values.size() / 2],
                     values.back());
}

void printLine(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

/// Prints the statistics since all spectators were connected.
void report(const Options& o, const std::vector<Tally>& before, const std::vector<Tally>& after, double seconds) {
  std::vector<double> bytes, frames;
  Tally sum;
  int closed = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    closed += after[i].closed;
    sum.bad += after[i].bad;
    if (i >= static_cast<std::size_t>(o.count)) continue;
    const std::uint64_t keys = after[i].keys - before[i].keys, deltas = after[i].deltas - before[i].deltas;
    bytes.push_back(static_cast<double>(after[i].bytes - before[i].bytes) / seconds);
    frames.push_back(static_cast<double>(keys + deltas) / seconds);
    sum.keys += keys;
    sum.deltas += deltas;
  }
  printLine(
      fmt::format("{{\"spectators\":{},\"stalled\":{},\"seconds\":{:.3f},\"bytesPerSecond\":{},\"framesPerSecond\":{},"
                  "\"keys\":{},\"deltas\":{},"
                  "\"badFrames\":{},\"closed\":{}}}",
                  o.count, o.stalled, seconds, spread(bytes), spread(frames), sum.keys, sum.deltas, sum.bad, closed));
}
}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): what fails here ends the program
int main(int argc, char** argv) {
  Options o;
  if (const int code = usage(argc, argv, o); code >= 0) return code;
  boost::asio::io_context io(1);
  boost::asio::signal_set stop(io, SIGINT, SIGTERM);
  stop.async_wait([&](const boost::system::error_code&, int) { io.stop(); });
  boost::asio::steady_timer end(io);

  std::vector<std::shared_ptr<Spectator>> all;
  std::vector<Tally> before(static_cast<std::size_t>(o.count + o.stalled));
  const auto tallies = [&] {
    std::vector<Tally> out;
    out.reserve(all.size());
    for (const auto& s : all) out.push_back(s->tally());
    return out;
  };
  int waiting = o.count + o.stalled;
  Clock::time_point begin = Clock::now();
  for (int i = 0; i < o.count + o.stalled; ++i) all.push_back(Spectator::make(io, o.settings, i >= o.count));
  for (const auto& s : all)
    s->start([&] {
      if (--waiting > 0) return;
      begin = Clock::now();
      before = tallies();
      printLine(fmt::format("{{\"connected\":{}}}", all.size()));
      if (o.seconds <= 0) return;
      end.expires_after(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(o.seconds)));
      end.async_wait([&](const boost::system::error_code&) { io.stop(); });
    });
  io.run();
  report(o, before, tallies(), std::chrono::duration<double>(Clock::now() - begin).count());
  return waiting == 0 ? 0 : 1;
}
