#include "recorded_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "match_channels.h"
#include "spark/error.h"
#include "spark/numbers.h"

namespace spark {

using Json = nlohmann::json;

namespace {
constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::size_t kMostNodes = 1u << 17;
constexpr int kMostDepth = 40;

/// A text as an atom of a monitor message, which knows no quotes. `blanks`: it may have blanks.
std::string plain(std::string text, bool blanks = false) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((c == ' ' && blanks) || (byte > ' ' && byte != 127 && !std::strchr("()\"';\\", c))) continue;
    c = '_';
  }
  return text;
}

std::string numberOf(const Json& v) {
  const double d = v.is_number() ? v.get<double>() : 0;
  return fmt::format("{:g}", std::isfinite(d) ? d : 0);
}

/// Appends a value of the environment; nothing for an empty text.
void put(std::string& out, const Json& v, int depth = 0) {
  if (v.is_array() && depth < kMostDepth) {
    out += '(';
    for (const Json& element : v) {
      const std::size_t before = out.size();
      put(out, element, depth + 1);
      if (out.size() > before && out[before - 1] != '(') out.insert(before, 1, ' ');
    }
    out += ')';
  } else if (v.is_string()) {
    out += plain(v.get<std::string>());
  } else if (v.is_number_integer()) {
    out += v.dump();
  } else if (v.is_number()) {
    out += fmt::format("{:.10g}", v.get<double>());
  } else if (v.is_boolean()) {
    out += v.get<bool>() ? '1' : '0';
  }
}

/// The first word of an entry; "" if it is none.
std::string nameOf(const Json& entry) {
  return entry.is_array() && !entry.empty() && entry[0].is_string() ? entry[0].get<std::string>() : std::string();
}

std::string colors(const Json& node) {
  constexpr const char* kNames[] = {"setDiffuse", "setAmbient", "setSpecular"};
  const Json all = node.value("colors", Json::array());
  std::string out;
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    out += fmt::format(" ({}", kNames[i]);
    for (std::size_t k = 0; k < 4; ++k)
      out += ' ' + (i < all.size() && all[i].is_array() && k < all[i].size() ? numberOf(all[i][k]) : "1");
    out += ')';
  }
  return out;
}

/// Of a transform that has `before` others before it. Throws Error where it is damaged.
web::Mount mountOf(const Json& node, std::size_t before) {
  web::Mount out;
  const auto on = node.find("on");
  if (on == node.end()) return out;
  const auto pin = node.value("pin", std::vector<double>());
  if (!on->is_number_unsigned() || on->get<std::uint64_t>() >= before || pin.size() != 3)
    throw Error("its scene is damaged: expected a transform before, and a point");
  out.on = on->get<int>();
  const Vec3 point(pin[0], pin[1], pin[2]);
  if (!(point.norm() <= web::kMostPin)) throw Error("its scene is damaged: a point is too far from its transform");
  out.pin = point.cast<float>();
  return out;
}

/// Of a mesh, behind its visibility.
std::string look(const Json& node, bool single) {
  std::string out;
  if (node.value("transparent", false)) out += " (setTransparent)";
  std::string load = plain(node.value("load", std::string()), true);
  out += fmt::format(" (load {}) (sSc", load.empty() ? "none" : load);
  const Json scale = node.value("scale", Json::array());
  for (std::size_t k = 0; k < 3; ++k) out += ' ' + (k < scale.size() ? numberOf(scale[k]) : "1");
  out += ')';
  const Json materials = node.value("materials", Json::array());
  std::string names;
  for (const Json& m : materials)
    if (m.is_string()) names += ' ' + plain(m.get<std::string>());
  if (!names.empty()) out += fmt::format("{}{})", single ? " (sMat" : "(resetMaterials", names);
  return out;
}
}  // namespace

void RecordedMatch::Entries::take(std::string_view text) {
  const Json j = Json::parse(text, nullptr, false);
  if (!j.is_object()) return;
  if (j.value("full", Json()) == true) entries_.clear();
  const auto list = j.find("entries");
  if (list != j.end() && list->is_array())
    for (const Json& entry : *list) {
      const std::string name = nameOf(entry);
      if (name.empty()) continue;
      auto known = std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.first == name; });
      if (known == entries_.end()) known = entries_.insert(known, {name, {}});
      known->second.clear();
      put(known->second, entry);
    }
  if (const auto event = j.find("entry"); event != j.end() && !nameOf(*event).empty()) put(events_, *event);
}

std::string RecordedMatch::Entries::text() const {
  std::string out;
  for (const auto& [name, text] : entries_) out += text;
  return out + events_;
}

void RecordedMatch::describe(Description<RecordedMatch>& d) {
  d.doc("Reads the match in a recording for the log player above it.");
  d.implements<IGameLog>();
}

bool RecordedMatch::recognises(std::string_view begin) const { return begin.starts_with(kMagic); }

void RecordedMatch::close() {
  reader_.reset();
  scenes_.clear();
  pieces_.clear();
  records_.clear();
  piece_ = -1;
  sceneNumber_ = 0;
  interval_ = 0;
}

void RecordedMatch::open(const std::string& file) {
  close();
  auto reader = std::make_unique<mcap::Reader>(file);
  pieceChannel_ = recorder::channelOf(*reader, recorder::kPieces, recorder::kMatchEncoding);
  sceneChannel_ = reader->channelOf(recorder::kScenes);
  if (pieceChannel_ == 0 || sceneChannel_ == 0)
    throw Error(
        fmt::format("{} has no frames to show: it was recorded without a monitor server, or with frames = 0", file));
  reader_ = std::move(reader);
  index();
  if (records_.empty()) {
    close();
    throw Error(fmt::format("{} has no frame that can be shown", file));
  }
  for (const std::string& lack : reader_->lacks()) kernel().log().warning("{}: {}: {}", path(), file, lack);
}

void RecordedMatch::index() {
  double last = -HUGE_VAL;
  std::vector<double> steps;
  for (std::size_t c = 0; c < reader_->chunks().size(); ++c) {
    std::size_t scenes = 0, pieces = 0;
    reader_->forEach(reader_->chunks()[c], [&](const mcap::Message& m) {
      if (m.channel != sceneChannel_ && m.channel != pieceChannel_) return true;
      const Place at{c, m.channel == sceneChannel_ ? scenes++ : pieces++};
      try {
        const auto message = web::PieceMessage::read(m.data);
        if (m.channel == sceneChannel_) {
          scenes_[message.shape] = at;
          return true;
        }
        std::vector<Record> found;
        std::uint32_t frame = 0;
        message.forEach([&](bool isFrame, std::string_view bytes) {
          if (!isFrame) return;
          // The last frame of a piece is the first one of the next.
          if (const double t = web::FrameDecoder::timeOf(bytes); t > last + 1e-6 && std::isfinite(t)) {
            found.push_back({static_cast<std::uint32_t>(pieces_.size()), frame, t});
            if (std::isfinite(last)) steps.push_back(t - last);
            last = t;
          }
          ++frame;
        });
        pieces_.push_back({at, message.shape});
        records_.insert(records_.end(), found.begin(), found.end());
      } catch (const Error& e) {
        kernel().log().warning("{}: a piece at {:.2f} s is passed over: {}", path(), static_cast<double>(m.time) * 1e-9,
                               e.what());
      }
      return true;
    });
  }
  if (steps.empty()) return;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  interval_ = steps[steps.size() / 2];
}

std::string RecordedMatch::messageAt(Place at, std::uint16_t channel) {
  std::string out;
  std::size_t number = 0;
  reader_->forEach(reader_->chunks().at(at.chunk), [&](const mcap::Message& m) {
    if (m.channel != channel || number++ != at.number) return true;
    out = m.data;
    return false;
  });
  return out;
}

const RecordedMatch::Scene& RecordedMatch::sceneOf(std::uint32_t number) {
  if (number == sceneNumber_) return scene_;
  const auto found = scenes_.find(number);
  if (found == scenes_.end()) throw Error("its scene is missing");
  const std::string message = messageAt(found->second, sceneChannel_);
  scene_ = readScene(web::PieceMessage::read(message).content);
  sceneNumber_ = number;
  return scene_;
}

RecordedMatch::Scene RecordedMatch::readScene(std::string_view text) {
  const Json j = Json::parse(text, nullptr, false);
  if (!j.is_object() || !j.contains("nodes") || !j["nodes"].is_array() || j["nodes"].size() > kMostNodes)
    throw Error("its scene is damaged");
  Scene out;
  std::vector<int> depths;
  try {
    for (const Json& node : j["nodes"]) {
      const int parent = node.value("parent", -1);
      if (parent >= static_cast<int>(depths.size()))
        throw Error("its scene is damaged: a node stands before its parent");
      SceneNode n;
      n.depth = parent < 0 ? 0 : depths[static_cast<std::size_t>(parent)] + 1;
      if (n.depth > kMostDepth) throw Error("its scene is damaged: it is too deep");
      depths.push_back(n.depth);
      const std::string kind = node.value("kind", std::string());
      n.isTransform = kind == "transform";
      n.hasVisibility = kind == "mesh";
      const bool single = node.value("single", false);
      n.head = n.isTransform ? "(nd TRF" : kind == "light" ? "(nd Light" : single ? "(nd SMN" : "(nd StaticMesh";
      if (kind == "light") n.rest = colors(node);
      if (n.hasVisibility) n.rest = look(node, single);
      if (n.isTransform) out.mounts.push_back(mountOf(node, out.mounts.size()));
      out.visible.push_back(node.value("visible", true));
      out.nodes.push_back(std::move(n));
    }
  } catch (const Json::exception& e) {
    throw Error(fmt::format("its scene is damaged: {}", e.what()));
  }
  return out;
}

/// Writes the message of the frame that was decoded last.
void RecordedMatch::write() {
  std::string& out = message_;
  out = fmt::format("({})(RSG 0 1)(", entries_.text());
  std::size_t transform = 0;
  int depth = 0;  // of the nodes that are open
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    const SceneNode& node = scene_.nodes[i];
    for (; depth > node.depth; --depth) out += ')';
    out += node.head;
    if (node.isTransform) {
      const Matrix m = decoder_.transform(transform++);
      char numbers[16 * (1 + kGeneralRoom)], *at = numbers;
      for (int k = 0; k < 16; ++k) {
        *at++ = ' ';
        at = putGeneral(at, m.data()[k]);
      }
      out.append(" (SLT").append(numbers, at).append(1, ')');
    }
    if (node.hasVisibility) out += decoder_.visible()[i] ? " (setVisible 1)" : " (setVisible 0)";
    out += node.rest;
    ++depth;
  }
  out.append(static_cast<std::size_t>(depth) + 1, ')');
}

void RecordedMatch::openPiece(std::uint32_t piece) {
  piece_ = piece;
  frame_ = -1;
  nextPart_ = 0;
  parts_.clear();
  entries_ = {};
  pieceBytes_ = messageAt(pieces_.at(piece).at, pieceChannel_);
  web::PieceMessage::read(pieceBytes_).forEach([this](bool isFrame, std::string_view bytes) {
    parts_.emplace_back(isFrame, bytes);
  });
  const Scene& scene = sceneOf(pieces_.at(piece).scene);
  decoder_.begin(scene.mounts, scene.visible);
}

/// Decodes the next frame of the piece, with the texts before it.
void RecordedMatch::advance() {
  entries_.endFrame();
  for (bool isFrame = false; !isFrame;) {
    if (nextPart_ == parts_.size()) throw Error("a frame is missing");
    const auto [frame, bytes] = parts_[nextPart_++];
    isFrame = frame;
    if (isFrame)
      decoder_.take(bytes);
    else
      entries_.take(bytes);
  }
  ++frame_;
}

const std::string& RecordedMatch::read(std::size_t i) {
  const Record& record = records_.at(i);
  try {
    if (piece_ != record.piece || frame_ > record.frame) openPiece(record.piece);
    while (frame_ < record.frame) advance();
  } catch (const Error& e) {
    piece_ = -1;
    kernel().log().warning("{}: the frame at {:.2f} s is passed over: {}", path(), record.time, e.what());
    return none_;
  }
  write();
  return message_;
}

}  // namespace spark
