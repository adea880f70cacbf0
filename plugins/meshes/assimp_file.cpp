#include "assimp_file.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <fmt/format.h>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <memory>

#include "spark/error.h"

namespace spark::meshes {

namespace {
/// Files that a mesh file names, such as materials, are not opened: they would be any file of this machine.
struct NoFiles : Assimp::IOSystem {
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

/// Leaves the readers of one format. Otherwise assimp, when they do not take a file, looks for another one by words in
/// it, and some of the others crash on damaged files. Throws Error if there is none.
void keepReadersOf(const std::string& format, Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string formats = fmt::format(" {} ", importer.GetImporterInfo(i)->mFileExtensions);
    if (!format.empty() && formats.find(' ' + format + ' ') != std::string::npos) continue;
    const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i));
    importer.UnregisterLoader(other.get());
  }
  if (importer.GetImporterCount() == 0)
    throw Error(fmt::format("expected a mesh file of a known kind, such as .obj, .stl, .dae, .glb or .msh, found '.{}'",
                            format));
}
}  // namespace

std::string formatOf(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string format = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (char& c : format) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return format;
}

AssimpFile::AssimpFile(const std::string& format, const std::string& bytes) {
  importer_.SetIOHandler(new NoFiles);  // which owns it
  keepReadersOf(format, importer_);
  importer_.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  scene_ = importer_.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices | aiProcess_SortByPType,
      format.c_str());
  if (!scene_) throw Error(importer_.GetErrorString());
}

}  // namespace spark::meshes
