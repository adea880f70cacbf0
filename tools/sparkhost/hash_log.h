#pragma once
/// \file
/// Writes the hashes of a run to a file.

#include <memory>
#include <string>

#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/output_file.h"

namespace sparkhost {

/// At the end of every N-th cycle: a line with its number, the state hash and the configuration hash. It has no state
/// and does not influence the simulation.
class HashLog : public spark::Node {
  SPARK_CLASS(HashLog, spark::Node)
 public:
  static constexpr const char* kPath = "/sys/host/hashes";
  static void describe(spark::Description<HashLog>& d);
  /// Creates one in the kernel's tree. `every`: N, 1 or more. Throws Error if the file cannot be written.
  static void install(spark::Kernel& kernel, const std::string& file, std::int64_t every);

 private:
  void write(const spark::Event& event);
  std::unique_ptr<spark::OutputFile> out_;
  std::string file_;
  std::int64_t every_ = 1;
  bool failed_ = false;
};

}  // namespace sparkhost
