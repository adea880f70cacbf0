#include "sweep.h"

namespace sparkbatch {

std::vector<std::string> splitValues(const std::string& text) {
  std::vector<std::string> out(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote)
      quote = c == quote ? 0 : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '{' || c == '[' || c == '(')
      ++depth;
    else if (c == '}' || c == ']' || c == ')')
      --depth;
    if (c == ',' && depth <= 0 && !quote)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

Sweep::Sweep(std::vector<Parameter> parameters, std::uint64_t firstSeed, std::int64_t seeds)
    : parameters_(std::move(parameters)), firstSeed_(firstSeed), seeds_(seeds) {
  for (const Parameter& p : parameters_) points_ *= static_cast<std::int64_t>(p.values.size());
}

Run Sweep::run(std::int64_t number) const {
  Run run{number, firstSeed_ + static_cast<std::uint64_t>((number - 1) / points_), {}};
  // The index of the combination, in a mixed radix: one digit per parameter.
  std::int64_t index = (number - 1) % points_;
  for (auto p = parameters_.rbegin(); p != parameters_.rend(); ++p) {
    const auto n = static_cast<std::int64_t>(p->values.size());
    run.point.insert(run.point.begin(), {p->key, p->values[static_cast<std::size_t>(index % n)]});
    index /= n;
  }
  return run;
}

}  // namespace sparkbatch
