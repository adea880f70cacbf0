// Recorded monitor messages. For any log, the scene can be encoded, and the encoded message can be read again.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "../../plugins/monitor-sexp/sexp_monitor.h"
#include "../../plugins/monitor/recorded_scene.h"
#include "fake_scene.h"

namespace {

void checkNodes(const spark::MonitorFrame& frame, const std::vector<std::uint64_t>& ids) {
  if (ids.size() != frame.nodes.size()) std::abort();
  int depth = -1;
  for (const spark::FrameNode& node : frame.nodes) {
    if (node.depth < 0 || node.depth > depth + 1) std::abort();
    if ((node.kind == spark::FrameNode::Kind::transform) != (node.visual == nullptr)) std::abort();
    depth = node.depth;
  }
}

std::string encode(const spark::MonitorFrame& frame) {
  spark::MonitorUpdate update{frame, true, {}, {}, {}};
  for (const auto& entry : frame.env.entries) update.env.push_back(entry.token);
  std::string out;
  spark::SexpMonitor().encode(update, out);
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  spark::test::FakeVisual owner;
  spark::RecordedScene scene(owner), again(owner);
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    if (!scene.take(rest.substr(0, end)).empty()) {
      spark::MonitorFrame kept;
      std::vector<std::uint64_t> ids;
      scene.copyTo(kept, ids, true);
      checkNodes(kept, ids);
    } else {
      spark::MonitorFrame frame;
      std::vector<std::uint64_t> ids;
      scene.copyTo(frame, ids, true);
      checkNodes(frame, ids);
      if (!again.take(encode(frame)).empty()) std::abort();
      spark::MonitorFrame copy;
      again.copyTo(copy, ids, true);
      if (copy.nodes.size() != frame.nodes.size()) std::abort();
    }
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  }
  return 0;
}
