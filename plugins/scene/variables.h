#pragma once
/// \file
/// Named variables for scene files.

#include <map>

#include "api/scene.h"

namespace spark {

/// A group of variables, a child of /sys/variables. Its name is that of the group: scene files read `Robot.Mass` from
/// the group `Robot`. Without a member, as in `NaoType[0]['UseToe']`, they read the group's own `value`. All are state.
class Variables : public Leaf, public IVariables {
  SPARK_CLASS(Variables, Leaf)
 public:
  static void describe(Description<Variables>& d);
  /// The value of a variable, nil when there is none; "" is the group's own value.
  Value variable(std::string_view name) const override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;
  using Map = std::map<std::string, Value, std::less<>>;
  /// All variables, sorted by name.
  const Map& all() const { return variables_; }

 private:
  void set(std::string name, Value value);
  Value get(const std::string& name) const { return variable(name); }
  std::vector<std::string> names() const;
  Value value_;
  Map variables_;
};

}  // namespace spark
