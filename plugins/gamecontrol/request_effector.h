#pragma once
/// \file
/// How an agent asks for perceptors and effectors while it runs.

#include <string>
#include <utility>
#include <vector>

#include "api/agents.h"

namespace spark {

/// Tells an agent what became of its requests: `(granted (name gps2))`, `(refused (name gps2) (why there is no class
/// GPX))`, once each.
class RequestPerceptor : public Perceptor {
  SPARK_CLASS(RequestPerceptor, Perceptor)
 public:
  /// Its name below an agent's aspect.
  static constexpr const char* kName = "_RequestAnswers";
  static void describe(Description<RequestPerceptor>& d) {
    d.doc("Reports what became of requests: (granted (name n)), (refused (name n) (why words...)).");
  }
  /// `why`: "" if the request was granted.
  void add(std::string name, std::string why) { answers_.emplace_back(std::move(name), std::move(why)); }
  void sense(Predicates& out, const Event& event) override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  std::vector<std::pair<std::string, std::string>> answers_;
};

/// `(request (perceptor GPS) (name gps2) (at torso))`, `(request (effector HingeEffector) (name lae9) (at laj9))`,
/// `(request (scene rsg/agent/sensors.rsg) (at torso))`: makes a perceptor, an effector or the contents of a scene file
/// below a node of the agent, in the prepare phase, unless a control aspect refuses it. `at` is a path from the agent's
/// aspect or the name of a node below it; without it the new node is a child of the aspect. Game control gives it to
/// its agents if its property `requests` is true.
class RequestEffector : public Effector {
  SPARK_CLASS(RequestEffector, Effector)
 public:
  static void describe(Description<RequestEffector>& d);
  /// Its name below an agent's aspect.
  static constexpr const char* kName = "_Request";
  /// Gives an agent this effector and the perceptor that reports the results.
  /// `folder`: scene files that it asks for are below it.
  static void addTo(AgentAspect& aspect, const std::string& folder);
  std::string predicate() const override { return "request"; }
  std::string act(const Element& action) override;

 protected:
  void saveState(StateWriter& out) const override { out.write(parts_); }
  void loadState(StateReader& in) override { parts_ = static_cast<int>(in.readInteger()); }

 private:
  struct Request {
    PartRequest::Kind kind;
    std::string type, name, at;
    bool required;  ///< the agent takes part only if it is granted
  };
  void prepare(const Event&);
  /// Makes the node. Returns "", or why it cannot be made.
  std::string grant(const Request& request, AgentAspect& root);
  Node* parentFor(const Request& request, AgentAspect& root) const;

  static constexpr std::size_t kMaxText = 128;   ///< bytes of a name, a class or a file
  static constexpr std::size_t kMaxPending = 8;  ///< requests of one cycle
  int maxParts_ = 32, parts_ = 0, maxCameras_ = 4;
  std::string folder_ = "rsg/agent/";
  std::vector<Request> pending_;
};

}  // namespace spark
