#pragma once
/// \file
/// Agents with latencies of their own.

#include <string>

#include "spark/describe.h"
#include "spark/leaf.h"

namespace spark {

/// A child of SpadesServer: latencies of the agents of one type, in place of those of all.
class TypeLatency : public Leaf {
  SPARK_CLASS(TypeLatency, Leaf)
 public:
  static void describe(Description<TypeLatency>& d) {
    d.doc("Latencies of the agents of one type; a child of SpadesServer, whose own are those of all others.");
    d.property("type", &TypeLatency::type_).doc("The agent type.");
    d.property("senseLatency", &TypeLatency::sense_)
        .unit("steps")
        .range(1, 10000)
        .doc("Time from sensing to the arrival of the sensation at the agent.");
    d.property("actLatency", &TypeLatency::act_)
        .unit("steps")
        .range(1, 10000)
        .doc("Time from the end of a thought until its acts take effect.");
  }
  const std::string& type() const { return type_; }
  int sense() const { return sense_; }
  int act() const { return act_; }

 private:
  std::string type_;
  int sense_ = 10, act_ = 10;
};

}  // namespace spark
