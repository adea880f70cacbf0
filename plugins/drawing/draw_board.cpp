#include "draw_board.h"

#include <algorithm>
#include <utility>

#include "draw_packet.h"

namespace spark::drawing {

namespace {
constexpr std::size_t kMaxPacketBytes = 512;  // of the drawing port

/// Collects commands into packets and writes these as SimSpark's recorder does: `[1, 0, -3]`, signed bytes.
class Recorder {
 public:
  explicit Recorder(std::string& out) : out_(out), begin_(out.size()) {}
  ~Recorder() { flush(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void add(const std::string& command) {
    if (packet_.size() + command.size() > kMaxPacketBytes) flush();
    packet_ += command;
  }
  /// Number of bytes written so far, about.
  std::size_t size() const { return out_.size() - begin_ + 5 * packet_.size(); }

 private:
  void flush() {
    for (std::size_t i = 0; i < packet_.size(); ++i) {
      out_ += i == 0 ? "[" : ", ";
      out_ += std::to_string(static_cast<int>(static_cast<signed char>(packet_[i])));
    }
    if (!packet_.empty()) out_ += ']';
    packet_.clear();
  }
  std::string& out_;
  std::size_t begin_;
  std::string packet_;
};

/// The byte of an agent in packets.
std::size_t byteOf(const Drawing& text) { return static_cast<unsigned>(text.number - 1 + 128 * text.team); }
}  // namespace

std::size_t DrawBoard::weight(const std::vector<Drawing>& shapes) {
  std::size_t sum = 0;
  for (const Drawing& d : shapes) sum += weight(d);
  return sum;
}

/// Removes a set without shapes, shown or in the back buffer; false if there is none.
bool DrawBoard::makeRoom() {
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (!shown_[i].shapes.empty() || !next_[i].empty()) continue;
    shown_.erase(shown_.begin() + static_cast<std::ptrdiff_t>(i));
    next_.erase(next_.begin() + static_cast<std::ptrdiff_t>(i));
    return true;
  }
  return false;
}

std::size_t DrawBoard::indexOf(std::string_view set) {
  const auto find = [&] {
    return std::lower_bound(shown_.begin(), shown_.end(), set,
                            [](const Set& s, std::string_view name) { return s.name < name; });
  };
  auto at = find();
  if (at != shown_.end() && at->name == set) return static_cast<std::size_t>(at - shown_.begin());
  if (shown_.size() >= kMaxSets && !makeRoom()) return shown_.size();
  at = find();
  const auto index = at - shown_.begin();
  shown_.insert(at, Set{std::string(set), version_, {}});
  next_.insert(next_.begin() + index, std::vector<Drawing>());
  return static_cast<std::size_t>(index);
}

bool DrawBoard::add(std::string_view set, Drawing drawing) {
  if (set == kAgents || points_ + weight(drawing) > kMaxPoints) return false;
  const std::size_t i = indexOf(set);
  if (i == shown_.size() || next_[i].size() >= kMaxShapes) return false;
  points_ += weight(drawing);
  next_[i].push_back(std::move(drawing));
  return true;
}

void DrawBoard::replace(std::size_t i, std::vector<Drawing> shapes) {
  points_ -= weight(shown_[i].shapes);
  shown_[i].shapes = std::move(shapes);
  shown_[i].version = ++version_;
}

void DrawBoard::swap(std::string_view prefix) {
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (!shown_[i].name.starts_with(prefix) || shown_[i].name == kAgents) continue;
    if (shown_[i].shapes.empty() && next_[i].empty()) continue;
    replace(i, std::exchange(next_[i], {}));
  }
}

std::size_t DrawBoard::show(std::string_view set, std::vector<Drawing> shapes) {
  const std::size_t wanted = shapes.size();
  const std::size_t i = set == kAgents ? shown_.size() : indexOf(set);
  if (i == shown_.size()) return wanted;
  if (shapes.size() > kMaxShapes) shapes.resize(kMaxShapes);
  const std::size_t others = points_ - weight(shown_[i].shapes);
  while (!shapes.empty() && others + weight(shapes) > kMaxPoints) shapes.resize(shapes.size() / 2);
  if (shapes.empty() && shown_[i].shapes.empty()) return wanted;
  const std::size_t refused = wanted - shapes.size();
  points_ += weight(shapes);
  replace(i, std::move(shapes));
  return refused;
}

void DrawBoard::setAgentText(const Drawing& text) {
  const std::size_t i = indexOf(kAgents);
  if (i == shown_.size()) return;
  std::vector<Drawing>& texts = shown_[i].shapes;
  std::uint16_t& place = place_[byteOf(text)];
  if (text.text.empty()) {
    if (place == 0) return;
    if (place < texts.size()) {  // the last one takes its place
      place_[byteOf(texts.back())] = place;
      texts[place - 1u] = std::move(texts.back());
    }
    texts.pop_back();
    place = 0;
    --points_;
  } else if (place > 0) {
    texts[place - 1u] = text;
  } else {
    texts.push_back(text);
    place = static_cast<std::uint16_t>(texts.size());
    ++points_;
  }
  labelled_.set(byteOf(text));
  shown_[i].version = ++version_;
}

void DrawBoard::clear() {
  for (auto& shapes : next_) points_ -= weight(shapes), shapes.clear();
  for (std::size_t i = 0; i < shown_.size(); ++i)
    if (!shown_[i].shapes.empty()) replace(i, {});
  place_ = {};
}

void DrawBoard::record(std::uint64_t since, std::string& out) const {
  if (version_ == since) return;
  Recorder recorder(out);
  std::string command;
  const auto write = [&](auto put, const auto&... arguments) {
    command.clear();
    put(arguments..., command);
    recorder.add(command);
  };
  // Clear both buffers of all sets: the second swap removes what the first one has shown.
  if (since == 0) write(writeSwap, ""), write(writeSwap, "");

  // A swap of a set also swaps all sets whose names begin with its name. In order of name these follow immediately, so
  // they are drawn again after it.
  std::string_view swapped;
  bool any = false;
  for (const Set& set : shown_) {
    if (set.name == kAgents) continue;
    const bool follows = any && set.name.starts_with(swapped);
    if ((set.version <= since && !follows) || (since == 0 && set.shapes.empty())) continue;
    if (!follows) swapped = set.name, any = true;
    if (recorder.size() > kMaxRecordBytes) break;
    for (const Drawing& d : set.shapes) write(writeDrawing, d, set.name);
    write(writeSwap, set.name);
  }

  // Agents' texts: all that were ever set, or removed.
  const auto agents = std::find_if(shown_.begin(), shown_.end(), [](const Set& s) { return s.name == kAgents; });
  if (agents == shown_.end() || agents->version <= since) return;
  for (std::size_t i = 0; i < labelled_.size(); ++i) {
    if (!labelled_[i]) continue;
    Drawing none;
    none.kind = Drawing::Kind::agentText;
    none.team = static_cast<int>(i / 128);
    none.number = static_cast<int>(i % 128) + 1;
    write(writeDrawing, place_[i] == 0 ? none : agents->shapes[place_[i] - 1u], "");
  }
}

}  // namespace spark::drawing
