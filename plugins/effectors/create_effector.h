#pragma once

#include <algorithm>
#include <vector>

#include "api/joint_command.h"

namespace spark {

/// `(create)`: imports a fixed scene file below the agent, before the next step, once for each action, up to `limit`
/// times. Without a file it has no effect.
class CreateEffector : public Effector {
  SPARK_CLASS(CreateEffector, Effector)
 public:
  static void describe(Description<CreateEffector>& d) {
    d.doc("Imports a fixed scene file below the agent: (create). Without a file it has no effect.");
    d.property("scene", &CreateEffector::scene_).doc("The scene file to import.");
    d.property("limit", &CreateEffector::limit_)
        .min(0)
        .doc("Number of imports, further ones are refused: 1 where the file is the agent's robot; 0: no limit.");
    d.on<&CreateEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "create"; }
  std::string act(const Element& action) override {
    if (limit_ > 0 && created_ + pending_ >= limit_)
      return limit_ == 1 ? "expected one robot, found a request for another: it has a robot already"
                         : fmt::format("expected at most {} imports, found a request for one more", limit_);
    if (pending_ == kMostAtOnce)
      return fmt::format("expected at most {} imports in a cycle, found a request for one more", kMostAtOnce);
    if (scene_.empty()) return "expected a file in its property scene, found none: nothing is created";
    ++pending_;
    return expectNoArguments(action);
  }

 protected:
  void saveState(StateWriter& out) const override { out.write(created_); }
  void loadState(StateReader& in) override { created_ = static_cast<int>(in.readInteger()); }

 private:
  static constexpr int kMostAtOnce = 16;  // a message has room for thousands
  void prepare(const Event&) {
    const int wanted = std::exchange(pending_, 0);
    const Ref<CreateEffector> self(this);  // what it imports may remove it
    for (int i = 0; i < wanted && self; ++i) {
      AgentAspect* const owner = agent();
      if (!owner) return;
      const std::uint64_t before = kernel().lastId();
      try {
        owner->importScene(scene_, {});
        if (self) ++created_;
      } catch (const std::exception& e) {
        if (!self) return;
        const bool inPart = hasNewer(before);  // as files of the installed base may fail
        if (inPart) ++created_;
        refuse(0, [&] { return fmt::format("{} is created: {}", inPart ? "only a part" : "nothing", e.what()); });
      }
    }
  }
  /// Whether the agent has a node that was made after the object of that number.
  bool hasNewer(std::uint64_t id) {
    std::vector<Leaf*> all;
    if (const AgentAspect* const owner = agent()) owner->collect(all);
    return std::any_of(all.begin(), all.end(), [id](const Leaf* leaf) { return leaf->id() > id; });
  }
  std::string scene_;
  int limit_ = 0, pending_ = 0, created_ = 0;
};

}  // namespace spark
