#include "comm_channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "spark/error.h"

namespace spark::spades {

namespace {
constexpr std::uint64_t kTellEvery = 32;  // messages between two acknowledgements
constexpr std::size_t kMostTypes = 1000;

/// The next line of a text, which is removed from it.
std::string_view takeLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text = end == text.npos ? std::string_view() : text.substr(end + 1);
  return line;
}
}  // namespace

std::pair<std::string_view, std::string_view> splitWord(std::string_view text) {
  const std::size_t end = std::min(text.find(' '), text.size());
  return {text.substr(0, end), text.substr(std::min(end + 1, text.size()))};
}

std::uint64_t numberOf(std::string_view word) {
  std::uint64_t n = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), n);
  if (error != std::errc() || end != word.data() + word.size() || word.empty())
    throw Error(fmt::format("expected a number, found '{}'", word.substr(0, 40)));
  return n;
}

std::string CommHello::write() const {
  std::string out = fmt::format("{}\n{}\n{}\n{}\n{}\n", kVersion, session, received, token, name);
  for (const auto& [type, timer] : types) out += fmt::format("{}\t{}\n", type, timer);
  return out;
}

CommHello CommHello::read(std::string_view frame) {
  if (const std::string_view version = takeLine(frame); version != kVersion)
    throw Error(
        fmt::format("expected a communication server of version '{}', found '{}'", kVersion, version.substr(0, 40)));
  CommHello out;
  out.session = takeLine(frame);
  out.received = numberOf(takeLine(frame));
  out.token = takeLine(frame);
  out.name = takeLine(frame);
  if (out.session.size() < 16) throw Error("expected a session of at least 16 characters");
  while (!frame.empty() && out.types.size() < kMostTypes) {
    const std::string_view line = takeLine(frame);
    const std::size_t tab = std::min(line.find('\t'), line.size());
    out.types.emplace_back(line.substr(0, tab), line.substr(std::min(tab + 1, line.size())));
  }
  return out;
}

void CommChannel::attach(std::unique_ptr<FrameStream> stream, std::uint64_t received) {
  acknowledged(received);
  stream_ = std::move(stream);
  lost_.clear();
  told_ = received_;
  for (const std::string& frame : kept_) stream_->send(frame);
}

void CommChannel::send(std::string message) {
  kept_.push_back("M" + std::move(message));
  if (stream_) stream_->send(kept_.back());
}

void CommChannel::poll() {
  if (!stream_) return;
  stream_->poll();
  while (const auto frame = stream_->receive()) {
    if (frame->starts_with('M')) {
      arrived_.emplace_back(frame->substr(1));
      ++received_;
    } else if (frame->starts_with('K')) {
      acknowledged(numberOf(frame->substr(1)));
    }
  }
  if (received_ - told_ >= kTellEvery) acknowledge();
  if (!stream_->lost().empty()) close(stream_->lost());
}

void CommChannel::close(std::string why) {
  lost_ = std::move(why);
  stream_.reset();
}

void CommChannel::acknowledge() {
  told_ = received_;
  stream_->send(fmt::format("K{}", received_));
}

void CommChannel::acknowledged(std::uint64_t count) {
  for (; keptFrom_ < count && !kept_.empty(); ++keptFrom_) kept_.pop_front();
}

std::optional<std::string> CommChannel::receive() {
  if (arrived_.empty()) return std::nullopt;
  std::string message = std::move(arrived_.front());
  arrived_.pop_front();
  return message;
}

}  // namespace spark::spades
