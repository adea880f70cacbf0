#include "hash_log.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

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
  log.out_.open(file, std::ios::binary | std::ios::trunc);
  if (!log.out_) throw Error(fmt::format("--hashes: cannot write {}: {}", file, std::strerror(errno)));
}

void HashLog::write(const Event& event) {
  if (failed_ || event.cycle % every_ != 0) return;
  const Leaf& root = kernel().root();
  const auto line = fmt::format("{} {:016x} {:016x}\n", event.cycle, stateHash(root), configurationHash(root));
  if (out_.write(line.data(), static_cast<std::streamsize>(line.size())).flush()) return;
  failed_ = true;
  kernel().log().error("--hashes: cannot write {}: it ends before cycle {}", file_, event.cycle);
}

}  // namespace sparkhost
