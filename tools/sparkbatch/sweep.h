#pragma once
/// \file
/// The runs of a batch: all combinations of the swept settings, each with several seeds.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sparkbatch {

/// A swept setting and its values as text.
struct Parameter {
  std::string key;
  std::vector<std::string> values;
};

/// The parameters of one run.
struct Run {
  std::int64_t number = 0;  ///< from 1
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, std::string>> point;  ///< keys and values of the swept settings
};

/// Splits at commas, except those in brackets or quotes: "1,{2,3}" has two values.
std::vector<std::string> splitValues(const std::string& text);

/// Numbers the runs of a batch: all combinations with the first seed, then all with the second, so that further seeds
/// do not change the numbers of earlier runs.
class Sweep {
 public:
  /// `seeds`: number of runs of each combination.
  Sweep(std::vector<Parameter> parameters, std::uint64_t firstSeed, std::int64_t seeds);
  /// Number of combinations.
  std::int64_t points() const { return points_; }
  /// Number of runs.
  std::int64_t runs() const { return points_ * seeds_; }
  /// Run `number`, 1..runs(). The last parameter changes fastest.
  Run run(std::int64_t number) const;

 private:
  std::vector<Parameter> parameters_;
  std::uint64_t firstSeed_;
  std::int64_t seeds_, points_ = 1;
};

}  // namespace sparkbatch
