#pragma once
/// \file
/// Kernels with the importer of MJCF.

#include <fmt/format.h>

#include "../../physics/tests/physics_house.h"
#include "api/agents.h"
#include "temporary_folder.h"

namespace spark::test {

struct MjcfHost : PhysicsHost {
  TemporaryFolder folder;
  MjcfHost() {
    for (const char* plugin : {"files", "scene-mjcf"}) kernel.plugins().use(plugin);
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", folder.path().string());
    kernel.create("MjcfImporter", "/sys/server/scene/mjcf");
  }
  void import(const std::string& text, const List& arguments = {}) {
    folder.write("m.xml", text);
    List all{"m.xml"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    call(scene, "importScene", all);
  }
  std::string failure(const std::string& text) {
    try {
      import(text);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  template <class T>
  T& at(const std::string& path) {
    return kernel.root().require<T>("/usr/scene/" + path);
  }
  Vec3 position(const std::string& body) { return at<IRigidBody>(body).state().position; }
};

/// With perceptors and effectors.
struct RobotHost : MjcfHost {
  RobotHost() {
    for (const char* plugin : {"gamecontrol", "sensors", "effectors"}) kernel.plugins().use(plugin);
  }
  Leaf* find(const std::string& path) { return kernel.root().find("/usr/scene/" + path); }
  std::vector<std::string> messageNames() {
    std::vector<std::string> out;
    std::vector<Perceptor*> perceptors;
    std::vector<Effector*> effectors;
    scene.collect(perceptors);
    scene.collect(effectors);
    for (const Perceptor* p : perceptors) out.push_back(p->messageName());
    for (const Effector* e : effectors) out.push_back(e->predicate());
    return out;
  }
  /// Sends an action to an effector.
  std::string act(const std::string& path, const std::string& text) {
    Predicates action;
    readSexp(text, action);
    return at<Effector>(path).act(*action.begin());
  }
};

}  // namespace spark::test
