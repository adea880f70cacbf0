#include "history.h"

#include <zstd.h>

#include <algorithm>

namespace spark::web {

namespace {
constexpr int kLevel = 3;  // of zstd

/// A binary message: the head, and the content compressed.
std::shared_ptr<const std::string> packed(std::string head, std::string_view content) {
  auto out = std::make_shared<std::string>(std::move(head));
  const std::size_t begin = out->size();
  out->resize(begin + ZSTD_compressBound(content.size()));
  out->resize(begin + ZSTD_compress(out->data() + begin, out->size() - begin, content.data(), content.size(), kLevel));
  out->shrink_to_fit();
  return out;
}
}  // namespace

double History::from() const {
  if (empty()) return 0;
  return pieces_.empty() ? builder_.growing()->from : pieces_.front().piece.from;
}

std::size_t History::sizeOf(const Kept& kept) {
  return sizeof kept + kept.piece.environment.size() + kept.piece.changes.size() + kept.message->size();
}

void History::takeScene(std::uint32_t shape, std::string_view message) {
  const auto& scene = scenes_[shape] = packed(sceneHead(shape, Packing::zstd), message);
  used_ += scene->size();
}

void History::take(const Snapshot& snapshot, std::uint32_t shape, const FrameScene& scene) {
  if (snapshot.time < builder_.newest()) clear();
  builder_.addEvents(snapshot);
  if (!snapshot.events.empty()) growing_.reset();
  if (snapshot.time < due() || !scenes_.contains(shape)) return;
  growing_.reset();
  if (std::optional<Piece> piece = builder_.addFrame(snapshot, shape, scene)) keep(std::move(*piece));
}

void History::keep(Piece piece) {
  Message message = packed(pieceHead(piece, true, Packing::zstd), piece.content);
  piece.content = {};
  pieces_.push_back({std::move(piece), std::move(message)});
  used_ += sizeOf(pieces_.back());
  trim();
}

/// Removes what is too old or too much; the piece that grows stays.
void History::trim() {
  while (!pieces_.empty() && (pieces_.front().piece.to < to() - seconds_ || bytes() > bytes_)) {
    used_ -= sizeOf(pieces_.front());
    pieces_.pop_front();
  }
  const std::uint32_t oldest = pieces_.empty() ? builder_.growing()->shape : pieces_.front().piece.shape;
  for (auto scene = scenes_.begin(); scene != scenes_.end() && scene->first < oldest;) {
    used_ -= scene->second->size();
    scene = scenes_.erase(scene);
  }
}

/// The scenes stay: the next frame may be of one of them.
void History::clear() {
  builder_.clear();
  pieces_.clear();
  used_ = 0;
  for (const auto& [shape, scene] : scenes_) used_ += scene->size();
}

std::shared_ptr<const std::string> History::pieceAt(double time) {
  if (empty()) return nullptr;
  const Piece& growing = *builder_.growing();
  if (time < growing.from && !pieces_.empty()) {
    const auto later = std::upper_bound(pieces_.begin(), pieces_.end(), time,
                                        [](double t, const Kept& kept) { return t < kept.piece.from; });
    return (later == pieces_.begin() ? later : std::prev(later))->message;
  }
  if (!growing_) growing_ = packed(pieceHead(growing, false, Packing::zstd), growing.content);
  return growing_;
}

std::shared_ptr<const std::string> History::scene(std::uint32_t shape) const {
  const auto at = scenes_.find(shape);
  return at == scenes_.end() ? nullptr : at->second;
}

std::string History::outline(std::size_t most) const {
  std::vector<const Piece*> pieces;
  for (const Kept& kept : pieces_) pieces.push_back(&kept.piece);
  if (!empty()) pieces.push_back(builder_.growing());
  std::size_t size = 0, first = pieces.size();
  while (first > 0 && size + pieces[first - 1]->changes.size() + pieces[first - 1]->environment.size() <= most)
    size += pieces[--first]->changes.size();
  std::string out = "[";
  if (first < pieces.size()) out += pieces[first]->environment;
  for (std::size_t i = first; i < pieces.size(); ++i) out += pieces[i]->changes;
  return out + "]";
}

}  // namespace spark::web
