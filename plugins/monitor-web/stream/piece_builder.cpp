#include "piece_builder.h"

#include <algorithm>
#include <limits>

namespace spark::web {

namespace {
constexpr double kPieceTime = 2;  // s
constexpr std::size_t kPieceBytes = 1u << 20;
constexpr double kTolerance = 1e-6;  // s, of times that are sums of steps

enum class Record : char { text, frame };

/// u8 kind, u8 complete, u8 packing, u8 0, u32 shape, f64 from, f64 to.
std::string head(MessageKind kind, bool complete, Packing packing, std::uint32_t shape, double from, double to) {
  std::string out;
  putRaw(out, kind);
  putRaw(out, static_cast<std::uint8_t>(complete));
  putRaw(out, packing);
  putRaw(out, std::uint8_t{0});
  putRaw(out, shape);
  putRaw(out, from);
  putRaw(out, to);
  return out;
}

void addRecord(std::string& out, Record kind, std::string_view bytes) {
  out.push_back(static_cast<char>(kind));
  putVarint(out, bytes.size());
  out += bytes;
}
}  // namespace

std::string pieceHead(const Piece& piece, bool complete, Packing packing) {
  return head(MessageKind::piece, complete, packing, piece.shape, piece.from, piece.to);
}

std::string sceneHead(std::uint32_t shape, Packing packing) {
  return head(MessageKind::scene, true, packing, shape, 0, 0);
}

double PieceBuilder::newest() const { return growing_ ? growing_->to : std::numeric_limits<double>::lowest(); }

double PieceBuilder::interval() const { return interval_ - kTolerance; }

double PieceBuilder::due() const { return growing_ ? growing_->to + interval() : newest(); }

void PieceBuilder::addEvents(const Snapshot& snapshot) {
  if (!growing_) return;
  std::size_t i = 0;
  for (const Element event : snapshot.events) {
    const std::string message = eventMessage(snapshot.eventTimes[i++], event);
    addRecord(growing_->content, Record::text, message);
    // Sounds are many, and a timeline does not show them.
    if (event.head() != "sound") growing_->changes += "," + message;
  }
}

std::optional<Piece> PieceBuilder::addFrame(const Snapshot& snapshot, std::uint32_t shape, const FrameScene& scene) {
  encoder_.advance(scene.instant(snapshot, shape));
  const std::string entries = environment_.update(snapshot, true), changes = changes_.update(snapshot, false);
  if (!growing_) {
    begin(snapshot, shape);
    return {};
  }
  Piece& piece = *growing_;
  piece.to = snapshot.time;
  if (!changes.empty()) piece.changes += "," + changes;
  if (piece.shape == shape) {
    if (!entries.empty()) addRecord(piece.content, Record::text, entries);
    addRecord(piece.content, Record::frame, encoder_.delta());
    if (piece.to - piece.from < kPieceTime - kTolerance && piece.content.size() < kPieceBytes) return {};
  }
  std::optional<Piece> done = std::move(growing_);
  begin(snapshot, shape);
  return done;
}

void PieceBuilder::begin(const Snapshot& snapshot, std::uint32_t shape) {
  growing_ = Piece{snapshot.time, snapshot.time, shape, fullEnvironmentMessage(snapshot)};
  addRecord(growing_->content, Record::text, growing_->environment);
  addRecord(growing_->content, Record::frame, encoder_.key());
}

void FrameScene::begin(const Snapshot& snapshot) {
  visible_ = snapshot.visible;
  toggled_.clear();
  mounts_ = snapshot.scene->mounts;
}

void FrameScene::update(const std::vector<std::uint8_t>& visible) {
  for (std::uint32_t i = 0; i < visible_.size(); ++i)
    if (visible_[i] != visible[i] && std::find(toggled_.begin(), toggled_.end(), i) == toggled_.end())
      toggled_.push_back(i);
}

}  // namespace spark::web
