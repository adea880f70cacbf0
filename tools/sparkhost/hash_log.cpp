#include "hash_log.h"

#include <fmt/format.h>

#include "api/phases.h"
#include "spark/error.h"
#include "spark/state.h"

namespace sparkhost {

using namespace spark;

void HashLog::describe(Description<HashLog>& d) {
  d.doc("Writes the hashes of the state and of the configuration to a file.");
  d.on<&HashLog::write>(phase::kPublish);
}

void HashLog::install(Kernel& kernel, const std::string& file, std::int64_t every) {
  kernel.registerClass<HashLog>();
  auto& log = kernel.create<HashLog>("HashLog", kPath);
  log.file_ = file;
  log.every_ = every;
  log.out_ = std::make_unique<OutputFile>(file, "the hashes");
}

void HashLog::write(const Event& event) {
  if (failed_ || event.cycle % every_ != 0) return;
  const Leaf& root = kernel().root();
  const std::string line = fmt::format("{} {:016x} {:016x}\n", event.cycle, stateHash(root), configurationHash(root));
  try {
    out_->write(line);
  } catch (const Error& e) {
    failed_ = true;
    kernel().log().error("--hashes: cannot write {}: it ends before cycle {}: {}", file_, event.cycle, e.what());
  }
}

}  // namespace sparkhost
