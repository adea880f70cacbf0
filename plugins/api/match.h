#pragma once
/// \file
/// What a game tells other plugins of its agents: who they are, who joins, what their eyes saw, what a sonar hears.
/// Plugins that know no game work with these.

#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/api/match.h"
#include "spark/node.h"
#include "spark/predicates.h"

namespace spark {

/// Who an agent is in the game. Offered by a node below the agent's aspect, at any depth; the first in tree order
/// counts. May be read in the sense phase by several threads.
class IAgentIdentity {
 public:
  SPARK_INTERFACE(IAgentIdentity, 1);
  virtual ~IAgentIdentity() = default;
  /// Name of its team; "" while it has none.
  virtual const std::string& team() const = 0;
  /// Its number in the team, from 1; 0 while it has none.
  virtual int number() const = 0;
};

/// Reads who joins from what agents say. Offered by a child of game control. With one, agents that are expected
/// (`--expect`) are waited for until they have said who they are, and are numbered by that; without one they have no
/// names, and what they said of their robot decides.
class IJoinPolicy {
 public:
  SPARK_INTERFACE(IJoinPolicy, 1);
  virtual ~IJoinPolicy() = default;
  /// Who an agent says it is.
  struct Name {
    std::string_view team;    ///< leads into the action that was read
    std::int64_t number = 0;  ///< 0: none
  };
  /// Head of the list with which an agent says who it is: "init". Valid as long as the policy.
  virtual std::string_view predicate() const = 0;
  /// Reads such a list; what is missing is empty or 0. Does not throw.
  virtual Name read(const Element& action) const = 0;
};

/// Reads the percept of an eye, for viewers that show what an agent saw. Offered beside IEye, whose percept it reads
/// and whose placeOf() takes the coordinates. Used between two cycles, in the simulation's thread.
class ISightReader {
 public:
  SPARK_INTERFACE(ISightReader, 1);
  virtual ~ISightReader() = default;
  /// Coordinates as IEye::placeOf() takes them.
  struct Polar {
    double distance = 0, horizontalDeg = 0, verticalDeg = 0;  ///< m, deg, deg
  };
  /// What a percept holds.
  struct Sightings {
    struct Thing {
      std::string name;  ///< as IEye::Sight has it
      Polar at;
    };
    struct Line {
      Polar from, to;
    };
    std::vector<Thing> things;
    std::vector<Line> lines;
  };
  /// Appends what a percept holds, in its order. What makes no sense is left out; nothing is thrown.
  virtual void read(const Element& percept, Sightings& out) const = 0;
};

/// Marks a transform as something that sonars hear: offered by a scene node, whose nearest transform is the place.
/// Sonars do not hear what belongs to their own agent.
class IEchoTarget {
 public:
  SPARK_INTERFACE(IEchoTarget, 1);
  virtual ~IEchoTarget() = default;
};

}  // namespace spark
