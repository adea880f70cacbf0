// The reader of MJCF files, run on arbitrary texts.
//
// Input: texts that end with a zero byte: the model a.xml, and the file b.xml, which a.xml may include. Every mesh is a
// tetrahedron. For any input, the reader makes a model or throws an Error, within its limits.

#include <cstdint>
#include <string>
#include <string_view>

#include "../../plugins/scene-mjcf/robot/model.h"

using namespace spark;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(input.find('\0'), input.size());
  const std::string a(input.substr(0, end)), b(input.substr(std::min(end + 1, input.size())));
  mjcf::Unsupported unsupported;
  try {
    mjcf::Document document("a.xml", [&](const std::string& name) {
      if (name == "a.xml") return a;
      if (name == "b.xml") return b;
      throw Error("no such file");
    });
    const auto tetrahedron = [](const std::string&) {
      engine::Mesh s;
      s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
      s.triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
      return s;
    };
    mjcf::readModel(document, tetrahedron, unsupported);
  } catch (const Error&) {
    // Most inputs are invalid.
  }
  unsupported.sentences();
  return 0;
}
