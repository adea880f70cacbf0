// The reader of Webots files, run on arbitrary texts. The text is a world and every PROTO of another file, and every
// mesh is a tetrahedron. For any input, the reader makes models or throws an Error, within its limits, and no name of a
// file leads out of the folder of files. Templates write their first pieces.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "../../plugins/scene-webots/webots_reader.h"

using namespace spark;

namespace {

void checkName(const std::string& name) {
  if (name.starts_with('/') || name == ".." || name.starts_with("../")) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  mjcf::Unsupported unsupported;
  const webots::Sources sources{
      [&](const std::string& name) {
        checkName(name);
        return name == "a/a.wbt" || name.ends_with(".proto") ? std::optional(input) : std::nullopt;
      },
      // What programs write: the first pieces, once, with a value.
      [](const std::string&) { return std::string(R"({"pieces": [[0, "1"], [1, "2"], [2, "3"]], "said": ["x"]})"); },
      {"b"}};
  const webots::ReadMesh tetrahedron = [](const std::string& of, const std::string& url) {
    for (const std::string& name : webots::fileNames(of, url)) checkName(name);
    engine::Mesh s;
    s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    return s;
  };
  try {
    const webots::Document document("a/a.wbt", sources, unsupported);
    webots::readWorld(document, webots::Base::byFile, tetrahedron, unsupported);
  } catch (const Error&) {
    // Most inputs are invalid.
  }
  unsupported.sentences();
  webots::isWebots(input);
  return 0;
}
