// The reader of URDF files, run on arbitrary texts. Every mesh is a tetrahedron. For any input, the reader makes a
// model or throws an Error, within its limits, and no name of a mesh leads out of the folder of files.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "../../plugins/scene-urdf/urdf_reader.h"

using namespace spark;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  mjcf::Unsupported unsupported;
  try {
    const urdf::Document document("a/a.urdf", std::string(input));
    const auto tetrahedron = [](const std::string& name) {
      for (const std::string& candidate : urdf::meshNames("a/a.urdf", name))
        if (candidate.starts_with('/') || candidate == ".." || candidate.starts_with("../")) std::abort();
      engine::Mesh s;
      s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
      return s;
    };
    urdf::readModel(document, urdf::Base::byFile, tetrahedron, unsupported);
  } catch (const Error&) {
    // Most inputs are invalid.
  }
  unsupported.sentences();
  mjcf::firstTag(input);
  return 0;
}
