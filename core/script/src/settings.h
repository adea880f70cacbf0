#pragma once
/// \file
/// Private to the script server: the options that configs declare, and what `--set KEY=VALUE` overrides.

#include <string>
#include <string_view>
#include <vector>

#include "spark/kernel.h"

namespace spark::script {

/// Options and overrides. An override is an option, or a member (property or variable) of a node.
class Settings {
 public:
  explicit Settings(Kernel& kernel) : kernel_(kernel) {}
  /// Adds an override, which replaces an older one of the same key. Throws Error for a malformed key.
  void add(std::string key, Value value);
  /// Declares an option, for `option{}`. Returns its value: the override, or the default. Throws Error if the name is
  /// not possible, if it is declared already in another way, or if the value does not fit. `secret`: see secrets().
  Value declare(const std::string& name, const Value& defaultValue, const std::string& doc, const List& choices,
                bool secret = false);
  /// Sets the overridden members of nodes that are new since the last call. Throws Error for an unknown member or a
  /// value that does not fit.
  void apply();
  /// True if `member` of `leaf` is overridden, so that the value that a config assigns must be ignored. Throws as
  /// apply().
  bool shields(const Leaf& leaf, std::string_view member);
  /// Throws Error for overrides that have had no effect, with the nearest names. To be called after a config.
  void finish();
  /// The declared options: [name, default, doc, value] each; "" is shown for a secret.
  std::vector<List> options() const;
  /// The names of the options that were declared as secrets.
  std::vector<std::string> secrets() const;

 private:
  struct Override {
    std::string key;
    Value value;
    std::string path, member;  ///< empty path: an option
    Ref<Leaf> target;          ///< the node where it was set
    bool met = false;          ///< it has had an effect: an option of its name exists, or its target has the member
  };
  struct Option {
    std::string name, doc;
    Value defaultValue, value;
    List choices;
    bool secret = false;
  };
  void set(Override& o, Leaf& target);
  std::string hint(const Override& o) const;
  Kernel& kernel_;
  std::vector<Override> overrides_;
  std::vector<Option> options_;
};

}  // namespace spark::script
