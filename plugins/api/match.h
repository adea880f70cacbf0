#pragma once
/// \file
/// Interfaces through which plugins that are independent of the game use its agents: identity, joining, reading of
/// vision percepts, sonar targets. The plugin of a game implements them.

#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/api/match.h"
#include "spark/node.h"
#include "spark/predicates.h"

namespace spark {

/// Team and number of an agent. Offered by a node below the agent's aspect, at any depth; the first in tree order
/// counts. May be read in the sense phase by several threads.
class IAgentIdentity {
 public:
  SPARK_INTERFACE(IAgentIdentity, 1);
  virtual ~IAgentIdentity() = default;
  /// Name of the agent's team; "" while it has none.
  virtual const std::string& team() const = 0;
  /// The agent's number in its team, from 1; 0 while it has none.
  virtual int number() const = 0;
};

/// Reads the action by which an agent gives its team and number. Offered by a child of game control. With a join
/// policy, game control waits until every expected agent (`--expect`) has sent this action, and numbers the agents by
/// it. Without one agents have no names, and the action that loads their robot decides.
class IJoinPolicy {
 public:
  SPARK_INTERFACE(IJoinPolicy, 1);
  virtual ~IJoinPolicy() = default;
  /// The team and number that an agent requests.
  struct Name {
    std::string_view team;    ///< a view into the action that was read
    std::int64_t number = 0;  ///< 0: none
  };
  /// Predicate of the action: "init". Valid as long as the policy lives.
  virtual std::string_view predicate() const = 0;
  /// Reads such an action; a missing team is "", a missing number 0. Does not throw.
  virtual Name read(const Element& action) const = 0;
};

/// Reads a vision percept, for viewers that show what an agent saw. Offered beside IEye: it reads the percept of that
/// sensor, and the coordinates are those of its placeOf(). Used between two cycles, in the simulation's thread.
class ISightReader {
 public:
  SPARK_INTERFACE(ISightReader, 1);
  virtual ~ISightReader() = default;
  /// Arguments of IEye::placeOf().
  struct Polar {
    double distance = 0, horizontalDeg = 0, verticalDeg = 0;  ///< m, deg, deg
  };
  /// The content of a percept.
  struct Sightings {
    /// An object.
    struct Thing {
      std::string name;  ///< as in IEye::Sight
      Polar at;
    };
    /// A line, by its visible ends.
    struct Line {
      Polar from, to;
    };
    std::vector<Thing> things;
    std::vector<Line> lines;
  };
  /// Appends the content of `percept` to `out`, in its order. Skips malformed entries. Does not throw.
  virtual void read(const Element& percept, Sightings& out) const = 0;
};

/// Marks a target of sonars. Offered by a scene node; the target's position is that of the nearest transform above it.
/// Sonars ignore the targets of their own agent.
class IEchoTarget {
 public:
  SPARK_INTERFACE(IEchoTarget, 1);
  virtual ~IEchoTarget() = default;
};

}  // namespace spark
