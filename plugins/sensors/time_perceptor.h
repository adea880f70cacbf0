#pragma once

#include "api/agents.h"

namespace spark {

/// `(time (now 7.36))`: simulated seconds since the start.
class TimePerceptor : public Perceptor {
  SPARK_CLASS(TimePerceptor, Perceptor)
 public:
  static void describe(Description<TimePerceptor>& d) { d.doc("Senses the simulated time: (time (now s))."); }
  void sense(Predicates& out, const Event& event) override { out.open("time").pair("now", event.time).close(); }
};

}  // namespace spark
