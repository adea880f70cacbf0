#pragma once
/// \file
/// A perceptor written in Lua.

#include "api/agents.h"
#include "spark/describe.h"

namespace spark {

/// Its script's handler of `perceive` returns what the percept tells: `{distance = 1.5, bearing = 30}` of a perceptor
/// named `opponent` becomes `(opponent (bearing 30) (distance 1.5))`. There is one Lua state, while agents sense in
/// several threads: so the script runs in share(), in the simulation's thread, and sense() only copies the result.
class ScriptPerceptor : public Perceptor, public ISharedView {
  SPARK_CLASS(ScriptPerceptor, Perceptor)
 public:
  static void describe(Description<ScriptPerceptor>& d);
  void share(std::uint64_t round) override;
  void sense(Predicates& out, const Event& event) override;

 protected:
  void onLink() override;
  void saveState(StateWriter& out) const override { out.write(percept_); }
  void loadState(StateReader& in) override { percept_ = in.readValue(); }

 private:
  void script(const std::string& file, const Value& arguments);
  void refuse(const std::string& why);

  Link<ISimulation> simulation_;
  Value percept_;            ///< what the script returned last; nil: none
  std::uint64_t round_ = 0;  ///< of the last share()
  bool isRefused_ = false;   ///< a percept that cannot be written has been logged
};

}  // namespace spark
