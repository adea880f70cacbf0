#pragma once
/// \file
/// Fixture of the importer's tests: a kernel with files in memory, and probes that record calls of their methods.

#include <map>

#include "api/files.h"
#include "api/scene.h"
#include "test_support.h"

namespace spark::test {

/// Files in memory.
class MemoryFiles : public Leaf, public IFileSystem {
  SPARK_CLASS(MemoryFiles, Leaf)
 public:
  static void describe(Description<MemoryFiles>& d) {
    d.doc("Files in memory.");
    d.implements<IFileSystem>();
  }
  void write(const std::string& name, std::string text) { files_[name] = {std::move(text), ++writes_}; }
  std::optional<std::string> read(const std::string& name) override {
    const auto found = files_.find(name);
    return found == files_.end() ? std::nullopt : std::optional(found->second.first);
  }
  std::uint64_t stamp(const std::string& name) override {
    const auto found = files_.find(name);
    return found == files_.end() ? 0 : found->second.second;
  }
  std::string where() const override { return "memory"; }

 private:
  std::map<std::string, std::pair<std::string, std::uint64_t>> files_;
  std::uint64_t writes_ = 0;
};

/// The records of all probes.
inline std::vector<std::string>& records() {
  static std::vector<std::string> all;
  return all;
}

/// Records its position when it is linked, and calls of its methods.
class Probe : public SceneNode {
  SPARK_CLASS(Probe, SceneNode)
 public:
  static void describe(Description<Probe>& d) {
    d.doc("Records what happens to it.");
    d.property("number", &Probe::number_).doc("A number.");
    d.property("integer", &Probe::integer_).doc("An integer.");
    d.property("flag", &Probe::flag_).doc("A bool.");
    d.property("vector", &Probe::vector_).doc("Three numbers.");
    d.property("slip", &Probe::slip_).doc("Exactly one number.");
    d.method("tell", &Probe::tell).parameters({"text"}).doc("Records a text.");
    d.method("attach", &Probe::attach).parameters({"path"}).doc("Records whether something is at the path.");
    d.method("setScale", &Probe::tellScale).parameters({"x"}).doc("Records.");
    d.method("setMaterial", &Probe::tellMaterial).parameters({"name"}).doc("Records.");
  }
  double number() const { return number_; }
  int integer() const { return integer_; }
  bool flag() const { return flag_; }
  const Vec3& vector() const { return vector_; }
  double slip() const { return slip_; }

 protected:
  void onLink() override {
    const Vec3f p = transform() ? positionOf(transform()->worldNow()) : Vec3f::Zero();
    records().push_back(fmt::format("link {:g} {:g} {:g}", p.x(), p.y(), p.z()));
  }

 private:
  void tell(std::string text) { records().push_back(text); }
  void attach(std::string path) { records().push_back(path + (find(path) ? " is there" : " is missing")); }
  void tellScale(double v) { records().push_back(fmt::format("scale {:g}", v)); }
  void tellMaterial(std::string name) { records().push_back("material " + name); }
  double number_ = -1, slip_ = 0.005;
  int integer_ = -1;
  bool flag_ = false;
  Vec3 vector_ = Vec3::Zero();
};

/// A kernel with file, scene and material servers, the importer and files in memory.
struct SceneHost {
  TestHost host;
  Kernel& kernel = host.kernel;
  MemoryFiles* files = nullptr;
  Node* scene = nullptr;
  Leaf* importer = nullptr;

  SceneHost() {
    records().clear();
    for (const char* plugin : {"files", "scene", "scene-rsg"}) kernel.plugins().use(plugin);
    kernel.registerClass<MemoryFiles>();
    kernel.registerClass<Probe>();
    kernel.create("FileServer", "/sys/server/file");
    files = &kernel.create<MemoryFiles>("MemoryFiles", "/sys/server/file/memory");
    kernel.create("SceneServer", "/sys/server/scene");
    importer = &kernel.create("RsgImporter", "/sys/server/scene/rsg");
    scene = &kernel.create<Node>("Scene", "/usr/scene");
  }
  void write(const std::string& name, const std::string& text) { files->write(name, text); }
  /// Imports a file below the scene.
  void import(const std::string& name, const List& arguments = {}) {
    kernel.root().require<ISceneServer>("/sys/server/scene").importScene(name, *scene, arguments);
  }
  /// Imports a file with this body below the scene.
  void run(const std::string& body, const List& arguments = {}) {
    write("test.rsg", "(RSG 0 1)\n(" + body + ")");
    import("test.rsg", arguments);
  }
  /// The error message of such an import; "" if it succeeds.
  std::string failure(const std::string& body, const List& arguments = {}) {
    try {
      run(body, arguments);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  void set(const std::string& property, const Value& v) { setProperty(*importer, property, v); }
  std::int64_t count(const std::string& property) { return getProperty(*importer, property).toInteger(); }
  Probe& probe(const std::string& path) { return scene->require<Probe>(path); }
  bool logged(const std::string& part) const { return host.text.find(part) != std::string::npos; }
  std::size_t timesLogged(const std::string& part) const {
    std::size_t n = 0;
    for (std::size_t i = host.text.find(part); i != std::string::npos; i = host.text.find(part, i + 1)) ++n;
    return n;
  }
};

using Texts = std::vector<std::string>;

}  // namespace spark::test
