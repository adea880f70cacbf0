#pragma once

#include "api/agents.h"
#include "pitch.h"

namespace spark {

class GameStateAspect;

/// Base of the rules of soccer: finds the match and says what is missing.
class SoccerControlAspect : public ControlAspect {
  SPARK_CLASS(SoccerControlAspect, ControlAspect)
 public:
  static void describe(Description<SoccerControlAspect>& d) {
    d.doc("Base of the rules of soccer.");
    d.abstract();
  }

 protected:
  /// The aspect of that class beside this one. Found again when the tree changed; throws nothing.
  template <class T>
  T* beside(T*& cache, std::uint64_t& version) {
    if (version != kernel().structureVersion()) {
      version = kernel().structureVersion();
      cache = parent()->childOf<T>();
    }
    return cache;
  }
  void onLink() override {
    ControlAspect::onLink();
    kernel().root().require<SoccerSettings>("/sys/variables/Soccer");
  }
};

}  // namespace spark
