#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "api/monitor.h"

namespace spark {

/// What recorded monitor messages show: full ones replace it, diffs patch it. Recordings are outside data: a message
/// that does not fit changes nothing.
class RecordedScene {
 public:
  /// `owner` stands for the recorded nodes, which are none of the tree; it must outlive the scene.
  explicit RecordedScene(Leaf& owner) : owner_(owner) {}

  /// Takes one message, an S-expression or what `parser` (may be nullptr) reads, which begins with a bracket. Returns
  /// "" or what is wrong with it.
  std::string take(std::string_view message, IParser* parser = nullptr);
  /// Forgets everything.
  void clear();
  /// Counts changes of nodes, meshes and materials.
  std::uint64_t shape() const { return shape_; }
  /// Copies what it shows. `tellEvents`: also those of the last message.
  void copyTo(MonitorFrame& frame, std::vector<std::uint64_t>& ids, bool tellEvents) const;

  /// What diffs change since the last full message.
  struct Moment;
  std::shared_ptr<const Moment> moment() const;
  /// Is again as it was at a moment after the same full message, which must be the last one taken. False, and
  /// unchanged, when it was another.
  bool restore(const Moment& moment);

 private:
  /// A light or mesh as it was recorded.
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
    bool current = false;  ///< stood in the last message
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
  std::vector<FrameNode> nodes_, newNodes_;
  Visuals visuals_, newVisuals_;
  std::vector<std::uint64_t> ids_;
  std::vector<Entry> entries_;
  std::uint64_t shape_ = 0, lastId_ = 0;
  bool known_ = false;  ///< a full message was taken
};

struct RecordedScene::Moment {
  std::vector<std::pair<std::array<float, 16>, bool>> nodes;  ///< where they are, whether they are shown
  std::vector<Entry> entries;
  Predicates events;
};

}  // namespace spark
