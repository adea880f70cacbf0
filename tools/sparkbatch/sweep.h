#pragma once
/// \file
/// Which worlds a batch has: every combination of the swept settings, with several seeds each.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sparkbatch {

/// A setting that is swept, and its values as they were typed.
struct Parameter {
  std::string key;
  std::vector<std::string> values;
};

/// One world.
struct Run {
  std::int64_t number = 0;  ///< from 1
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, std::string>> point;  ///< key and value of every swept setting
};

/// Cuts at commas, but not inside of brackets or quotes: "1,{2,3}" has two values.
std::vector<std::string> splitValues(const std::string& text);

/// Numbers the runs of a batch: all combinations with the first seed, then all with the second. So a batch that is to
/// have more seeds later keeps the numbers that it has.
class Sweep {
 public:
  Sweep(std::vector<Parameter> parameters, std::uint64_t firstSeed, std::int64_t seeds);
  /// Number of combinations, and of runs.
  std::int64_t points() const { return points_; }
  std::int64_t runs() const { return points_ * seeds_; }
  /// Run `number`, 1..runs(). The last parameter changes first.
  Run run(std::int64_t number) const;

 private:
  std::vector<Parameter> parameters_;
  std::uint64_t firstSeed_;
  std::int64_t seeds_, points_ = 1;
};

}  // namespace sparkbatch
