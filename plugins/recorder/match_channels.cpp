#include "match_channels.h"

#include <limits>

#include "about.h"
#include "stream/scene_capture.h"

namespace spark::recorder {

namespace {
constexpr double kNever = std::numeric_limits<double>::lowest();
constexpr double kTolerance = 1e-6;              // s, of times that are sums of steps
constexpr double kSceneInterval = 0.5;           // s, least time between two scenes: they are larger than frames
constexpr std::size_t kOutlineBytes = 8u << 20;  // a page lists far fewer events
constexpr std::uint32_t kMaxEventTokens = 1u << 14;

constexpr const char* kEventSchema =
    R"({"type":"object","properties":{"type":{"type":"string"},"time":{"type":"number"},)"
    R"("entry":{"type":"array"},"entries":{"type":"array"}}})";

std::size_t sizeOf(const web::Snapshot& s) {
  return sizeof s + s.transforms.size() * sizeof(Matrix) + s.visible.size() + s.environment.predicates.size() * 32;
}
}  // namespace

void MatchWriter::take(const web::Snapshot& snapshot, mcap::Time time, const Recording::Put& put) {
  if (snapshot.time < builder_.newest()) builder_.clear();
  if (snapshot.scene) {
    shape_ = snapshot.shape;
    ++number_;
    put(channels_.scenes, time, web::sceneHead(number_, web::Packing::none) + web::sceneMessage(snapshot, number_));
    scene_.begin(snapshot);
  }
  scene_.update(snapshot.visible);
  std::size_t i = 0;
  for (const Element event : snapshot.events)
    put(channels_.events, time, web::eventMessage(snapshot.eventTimes[i++], event));
  if (const std::string changed = changes_.update(snapshot, false); !changed.empty())
    put(channels_.events, time, changed);
  builder_.addEvents(snapshot);
  if (const auto piece = builder_.addFrame(snapshot, number_, scene_)) write(*piece, time, put);
}

void MatchWriter::write(const web::Piece& piece, mcap::Time time, const Recording::Put& put) {
  put(channels_.pieces, time, web::pieceHead(piece, true, web::Packing::none) + piece.content);
  if (outline_.empty()) outline_ = piece.environment;
  if (outline_.size() < kOutlineBytes) outline_ += piece.changes;
}

void MatchWriter::finish(mcap::Time time, const Recording::Put& put) {
  if (const web::Piece* const piece = builder_.growing()) write(*piece, time, put);
  put(channels_.outline, time, "[" + outline_ + "]");
}

MatchChannels::MatchChannels(Recording& recording, double frames)
    : recording_(recording), interval_(1 / frames), last_(kNever), sceneAt_(kNever) {
  const auto add = [&](std::string_view topic, std::string_view encoding) {
    return recording.channel({0, std::string(topic), std::string(encoding)});
  };
  MatchWriter::Channels channels;
  channels.pieces = add(kPieces, kMatchEncoding);
  channels.scenes = add(kScenes, kMatchEncoding);
  channels.outline = add(kOutline, "json");
  channels.events =
      recording.channel({0, std::string(kEvents), "json"}, {"spark.GameEvent", "jsonschema", kEventSchema});
  writer_ = std::make_shared<MatchWriter>(channels, interval_);
}

void MatchChannels::take(const IMonitorServer& server, std::int64_t cycle, double seconds, bool describe) {
  const NewestFrame& newest = server.newest();
  if (newest.frame.cycle != cycle || newest.serial == serial_) return;
  serial_ = newest.serial;
  for (const Environment::Entry& entry : newest.frame.env.entries) {
    if (entry.policy != EnvPolicy::once || events_.size() > kMaxEventTokens) continue;
    events_.append(Element(newest.frame.env.predicates, entry.token));
    eventTimes_.push_back(seconds);
  }
  const bool setBack = seconds < last_;
  if (!setBack && seconds < last_ + interval_ - kTolerance) return;
  const bool newScene = newest.frame.shape != shape_;
  if (newScene && (!describe || (!setBack && seconds < sceneAt_ + kSceneInterval))) return;
  auto snapshot = std::make_shared<web::Snapshot>();
  web::copyFrame(newest, seconds, *snapshot);
  std::swap(snapshot->events, events_);
  std::swap(snapshot->eventTimes, eventTimes_);
  last_ = seconds;
  if (newScene) {
    snapshot->scene = web::describeScene(newest.frame);
    shape_ = newest.frame.shape;
    sceneAt_ = seconds;
  }
  recording_.later(sizeOf(*snapshot), [writer = writer_, snapshot, time = nanoseconds(seconds)](const auto& put) {
    writer->take(*snapshot, time, put);
  });
}

void MatchChannels::finish(mcap::Time time) {
  recording_.later(0, [writer = writer_, time](const auto& put) { writer->finish(time, put); });
}

}  // namespace spark::recorder
