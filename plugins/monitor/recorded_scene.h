#pragma once
/// \file
/// The scene of a log.

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "api/monitor.h"

namespace spark {

/// The scene and environment that recorded monitor messages describe: full messages replace it, diffs patch it. Logs
/// are untrusted input: an invalid message changes nothing.
class RecordedScene {
 public:
  /// `owner` is returned as the leaf of all recorded visuals, which are not nodes of the tree; it must outlive the
  /// scene.
  explicit RecordedScene(Leaf& owner) : owner_(owner) {}

  /// Applies a message: an S-expression, or JSON, which begins with a bracket and needs `parser`. Returns "" or what is
  /// wrong with it.
  std::string take(std::string_view message, IParser* parser = nullptr);
  /// Removes everything.
  void clear();
  /// Changes whenever nodes, meshes or materials do.
  std::uint64_t shape() const { return shape_; }
  /// Writes nodes and environment into `frame`, and the nodes' ids. `events`: with the events of the last message.
  void copyTo(MonitorFrame& frame, std::vector<std::uint64_t>& ids, bool events) const;

  /// What diffs change.
  struct Snapshot;
  std::shared_ptr<const Snapshot> snapshot() const;
  /// Restores a snapshot. The last applied message must be the full one on which the snapshot is based. False, without
  /// a change, if the number of nodes differs.
  bool restore(const Snapshot& snapshot);

 private:
  /// A recorded light or mesh.
  class Visual : public IVisual {
   public:
    explicit Visual(Leaf& owner) : owner_(&owner) {}
    Leaf& leaf() override { return *owner_; }
    Kind kind() const override { return what; }
    const std::string& load() const override { return mesh; }
    Vec3f scale() const override { return size; }
    bool visible() const override { return shown; }
    void setVisible(bool on) override { shown = on; }
    bool transparent() const override { return glass; }
    const std::vector<std::string>& materials() const override { return names; }
    void setMaterialName(std::size_t i, std::string name) override { names.at(i) = std::move(name); }
    std::array<Color, 3> lightColors() const override { return colors; }
    /// True if all but the visibility is equal.
    bool looksLike(const Visual& o) const;

    Kind what = Kind::mesh;
    std::string mesh;
    Vec3f size{1, 1, 1};
    bool shown = false, glass = false;
    std::vector<std::string> names;
    std::array<Color, 3> colors{};

   private:
    Leaf* owner_;
  };
  struct Entry {
    std::string name;
    Predicates value;
    bool current = false;  ///< it is in the last message
  };
  using Visuals = std::vector<std::unique_ptr<Visual>>;  ///< nullptr for transforms

  std::string readNodes(const Element& list, int depth);
  std::string readNode(const Element& element, int depth);
  std::string checkDiff(const Element& list, int depth, std::size_t& next) const;
  void patch(const Element& list, std::size_t& next);
  void readEnvironment(const Element& list, bool full);
  bool sameShape(const std::vector<FrameNode>& nodes, const Visuals& visuals) const;

  Leaf& owner_;
  Predicates parsed_, events_;
  std::vector<FrameNode> nodes_, newNodes_;  ///< current ones; those of the message that is being read
  Visuals visuals_, newVisuals_;             ///< by node, likewise
  std::vector<std::uint64_t> ids_;           ///< by node
  std::vector<Entry> entries_;
  std::uint64_t shape_ = 0, lastId_ = 0;
  bool known_ = false;  ///< a full message was applied
};

struct RecordedScene::Snapshot {
  std::vector<std::pair<std::array<float, 16>, bool>> nodes;  ///< matrix, visibility
  std::vector<Entry> entries;
  Predicates events;
};

}  // namespace spark
