#pragma once
/// \file
/// The match in a recording, as monitors get it.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/game_log.h"
#include "mcap.h"
#include "spark/describe.h"
#include "spark/node.h"
#include "stream/frame_decoder.h"

namespace spark {

/// Reads the channels `/monitor` and `/monitor/scenes` of a recording. Below a LogPlayer it lets it play recordings.
/// Each record is a frame, and a complete monitor message. Recordings are untrusted input: a piece that is damaged has
/// no records.
class RecordedMatch : public Node, public IGameLog {
  SPARK_CLASS(RecordedMatch, Node)
 public:
  static void describe(Description<RecordedMatch>& d);
  bool recognises(std::string_view begin) const override;
  void open(const std::string& file) override;
  std::size_t size() const override { return records_.size(); }
  double interval() const override { return interval_; }
  double time(std::size_t i) const override { return records_.at(i).time; }
  const std::string& read(std::size_t i) override;
  const std::string& readDrawings(std::size_t) override { return none_; }
  std::size_t fullBefore(std::size_t i) const override { return i; }
  bool hasDrawings(std::size_t) const override { return false; }

 private:
  /// Where a message of the recording stands: among those of its channel in a chunk.
  struct Place {
    std::size_t chunk = 0, number = 0;
  };
  struct Piece {
    Place at;
    std::uint32_t scene = 0;
  };
  struct Record {
    std::uint32_t piece = 0, frame = 0;
    double time = 0;  ///< s
  };
  /// A node as a monitor message describes it.
  struct SceneNode {
    bool isTransform = false, hasVisibility = false;
    int depth = 0;
    std::string head, rest;  ///< before and behind what changes
  };
  struct Scene {
    std::vector<SceneNode> nodes;
    std::vector<web::Mount> mounts;  ///< of its transforms
    std::vector<std::uint8_t> visible;
  };

  /// The environment of a frame.
  class Entries {
   public:
    /// Takes a text record of a piece: changes, or an event.
    void take(std::string_view text);
    /// All entries, in the order in which they came first, and the events since the frame before.
    std::string text() const;
    void endFrame() { events_.clear(); }

   private:
    std::vector<std::pair<std::string, std::string>> entries_;  ///< name; `(name value)`
    std::string events_;
  };

  void close();
  void index();
  std::string messageAt(Place at, std::uint16_t channel);
  const Scene& sceneOf(std::uint32_t number);
  void openPiece(std::uint32_t piece);
  void advance();
  static Scene readScene(std::string_view json);
  void write();

  std::unique_ptr<mcap::Reader> reader_;
  std::uint16_t pieceChannel_ = 0, sceneChannel_ = 0;
  std::map<std::uint32_t, Place> scenes_;
  std::vector<Piece> pieces_;
  std::vector<Record> records_;
  double interval_ = 0;  ///< s
  std::uint32_t sceneNumber_ = 0;
  Scene scene_;  ///< the one that was read last

  // The piece of which a frame was read last, up to that frame.
  std::int64_t piece_ = -1;  ///< -1: none
  std::string pieceBytes_;
  std::vector<std::pair<bool, std::string_view>> parts_;  ///< its records: a frame or not, and the bytes
  std::size_t nextPart_ = 0;
  std::int64_t frame_ = -1;  ///< -1: before the first one
  web::FrameDecoder decoder_;
  Entries entries_;

  std::string message_;  ///< that was read last
  const std::string none_;
};

}  // namespace spark
