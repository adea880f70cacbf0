#pragma once
/// \file
/// How an agent asks for perceptors and effectors while it runs.

#include <string>
#include <utility>
#include <vector>

#include "api/agents.h"

namespace spark {

namespace gamecontrol {
/// True if the agent has a robot, loaded by itself or made by a rule: more than what game control gives it, and than a
/// group of colliders, which rules give to agents that are still without one. Objects that are agents need none.
bool hasRobot(const AgentAspect& root);
}  // namespace gamecontrol

/// Tells an agent what became of its requests: `(granted (name gps2))`, `(refused (name gps2) (why there is no class
/// GPX))`, once each. What a request says beyond that is in `(unused colour red)`.
class RequestPerceptor : public Perceptor {
  SPARK_CLASS(RequestPerceptor, Perceptor)
 public:
  /// Its name below an agent's aspect.
  static constexpr const char* kName = "_RequestAnswers";
  static void describe(Description<RequestPerceptor>& d) {
    d.doc("Reports what became of requests: (granted (name n)), (refused (name n) (why words...)).");
  }
  /// `why`: "" if the request was granted. `unused`: words of it that have no effect.
  void add(std::string name, std::string why, std::string unused = {});
  void sense(Predicates& out, const Event& event) override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  struct Answer {
    std::string name, why, unused;
  };
  static constexpr std::size_t kMost = 1024;  ///< answers in one message; the rest of a flood is counted
  std::vector<Answer> answers_;
  std::int64_t unanswered_ = 0;
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
  /// Answers a request that a rule refuses as an action; `why`: one line without a full stop at its end.
  void answerRefused(const Element& action, const std::string& why);

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  struct Request {
    PartRequest::Kind kind = PartRequest::Kind::perceptor;
    std::string type, name, at;
    std::string unused;     ///< its words that have no effect
    bool required = false;  ///< the agent takes part only if it is granted
  };
  /// Reads an action. Returns "", or why it is no request: what could be read is in `request`.
  static std::string read(const Element& action, Request& request);
  void prepare(const Event&);
  /// Answers a request: it was granted if `why` is "". An agent that requires what is refused does not take part.
  void answer(AgentAspect& root, const Request& request, std::string why);
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
