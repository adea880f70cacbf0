#pragma once
/// \file
/// Agents with latencies of their own.

#include <string>

#include "agent_mind.h"
#include "spark/describe.h"
#include "spark/leaf.h"

namespace spark {

/// Describes the two properties of a class that has latencies.
template <class T>
void describeLatencies(Description<T>& d, int T::*sense, int T::*act) {
  d.property("senseLatency", sense)
      .unit("steps")
      .range(1, 10000)
      .doc("Time from sensing to the arrival of the sensation at the agent.");
  d.property("actLatency", act)
      .unit("steps")
      .range(1, 10000)
      .doc("Time from the end of a thought until its acts take effect.");
}

/// A child of SpadesServer: latencies of the agents of one type, in place of those of all. It counts if it is there
/// when they are started.
class TypeLatency : public Leaf {
  SPARK_CLASS(TypeLatency, Leaf)
 public:
  static void describe(Description<TypeLatency>& d) {
    d.doc("Latencies of the agents of one type; a child of SpadesServer, whose own are those of all others.");
    d.property("type", &TypeLatency::type_).doc("The agent type.");
    describeLatencies(d, &TypeLatency::sense_, &TypeLatency::act_);
  }
  const std::string& type() const { return type_; }
  spades::Latencies latencies() const { return {sense_, act_}; }

 private:
  std::string type_;
  int sense_ = 10, act_ = 10;
};

}  // namespace spark
