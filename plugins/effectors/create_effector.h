#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(create)`: imports a fixed scene file below the agent, before the next step. Without a file it has no effect.
class CreateEffector : public Effector {
  SPARK_CLASS(CreateEffector, Effector)
 public:
  static void describe(Description<CreateEffector>& d) {
    d.doc("Imports a fixed scene file below the agent: (create). Without a file it has no effect.");
    d.property("scene", &CreateEffector::scene_).doc("The scene file to import.");
    d.on<&CreateEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "create"; }
  std::string act(const Element& action) override {
    if (created_) return "expected one robot, found a request for another: it has a robot already";
    if (scene_.empty()) return "expected a file in its property scene, found none: nothing is created";
    pending_ = true;
    return expectNoArguments(action);
  }

 protected:
  void saveState(StateWriter& out) const override { out.write(created_); }
  void loadState(StateReader& in) override { created_ = in.readBool(); }

 private:
  void prepare(const Event&) {
    if (!pending_) return;
    pending_ = false;
    AgentAspect* owner = agent();
    if (!owner) return;
    try {
      owner->importScene(scene_, {});
      created_ = true;
    } catch (const std::exception& e) {
      refuse(0, [&] { return fmt::format("nothing is created: {}", e.what()); });
    }
  }
  std::string scene_;
  bool pending_ = false, created_ = false;
};

}  // namespace spark
