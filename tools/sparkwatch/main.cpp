// sparkwatch: a monitor on Spark's library. It has a kernel of its own, into whose scene it imports the messages of a
// host's monitor port, and prints where things are. README.md explains it step by step.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "api/files.h"
#include "api/scene.h"
#include "spark/client/connection.h"
#include "spark/kernel.h"
#include "spark/predicates.h"
#include "spark/printable.h"

namespace fs = std::filesystem;

/// The scene of the last message, as the only file of its file system: importers read files.
class Frame : public spark::Leaf, public spark::IFileSystem {
  SPARK_CLASS(Frame, spark::Leaf)
 public:
  static constexpr const char* kName = "frame.rsg";
  static void describe(spark::Description<Frame>& d) {
    d.doc("The scene of the last message.");
    d.implements<spark::IFileSystem>();
  }
  void set(std::string text) { text_ = std::move(text), ++stamp_; }
  std::optional<std::string> read(const std::string& name) override {
    return name == kName ? std::optional(text_) : std::nullopt;
  }
  std::uint64_t stamp(const std::string& name) override { return name == kName ? stamp_ : 0; }
  std::string where() const override { return "the last message"; }

 private:
  std::string text_;
  std::uint64_t stamp_ = 0;
};

/// A copy of a host's scene.
class Copy {
 public:
  Copy() {
    const fs::path bin = fs::canonical("/proc/self/exe").parent_path();
    kernel_.plugins().scan(fs::exists(bin / "../plugins") ? bin / "../plugins" : bin / SPARK_PLUGIN_FOLDER);
    for (const char* plugin : {"files", "scene", "scene-rsg"}) kernel_.plugins().use(plugin);
    kernel_.registerClass<Frame>();
    kernel_.create("FileServer", "/sys/server/file");
    frame_ = &kernel_.create<Frame>("Frame", "/sys/server/file/frame");
    server_ = &kernel_.create<spark::ISceneServer>("SceneServer", "/sys/server/scene");
    importer_ = &kernel_.create<spark::ISceneImporter>("RsgImporter", "/sys/server/scene/rsg");
    // A full message, (RSG 0 1), replaces the scene; a difference, (RDS 0 1), changes the nodes that are there.
    setProperty(dynamic_cast<spark::Leaf&>(*importer_), "unlinkOnCompleteScenes", true);
    scene_ = &kernel_.create<spark::Node>("Scene", spark::ISceneServer::kDefaultScene);
  }

  /// Applies a message: its first list is the environment, the rest is a scene file.
  void take(const std::string& message) {
    spark::Predicates environment;
    const spark::ReadResult read = spark::readSexp(message, environment, {}, 1);
    if (environment.empty() || !(*environment.begin()).isList())
      throw std::runtime_error("this is no message of a monitor port: expected ((time 0.1))(RSG 0 1)..., found " +
                               message.substr(0, 40));
    if (const spark::Element time = (*environment.begin()).named("time")) time_ = time.at(1).number();
    frame_->set(message.substr(read.consumed));
    importer_->import(Frame::kName, *scene_, {});
    server_->placeScene(*scene_);
  }

  /// Prints a line for each visible mesh whose name contains `mesh`. Returns their number.
  int print(const std::string& mesh) const { return printBelow(*scene_, mesh); }

 private:
  int printBelow(const spark::Node& node, const std::string& mesh) const {
    int found = 0;
    for (const auto& child : node.children()) {
      const auto* visual = dynamic_cast<const spark::IVisual*>(child.get());
      const auto* transform = dynamic_cast<const spark::Transform*>(&node);
      if (visual && transform && visual->visible() && visual->load().find(mesh) != std::string::npos) {
        const spark::Vec3f at = spark::positionOf(transform->world());
        fmt::print("{{\"time\":{:.2f},\"mesh\":\"{}\",\"position\":[{:.6g},{:.6g},{:.6g}],\"node\":\"{}\"}}\n", time_,
                   visual->load(), at[0], at[1], at[2], child->path());
        ++found;
      }
      if (const auto* inner = dynamic_cast<const spark::Node*>(child.get())) found += printBelow(*inner, mesh);
    }
    return found;
  }

  spark::Kernel kernel_;
  Frame* frame_;
  spark::ISceneServer* server_;
  spark::ISceneImporter* importer_;
  spark::Node* scene_;
  double time_ = 0;
};

/// The exit code of an error.
static int fail(const std::exception& e) {
  fmt::print(stderr, "sparkwatch: {}\n", spark::printable(e.what()));
  return 1;
}

// NOLINTNEXTLINE(bugprone-exception-escape): options that are set up wrongly end the program
int main(int argc, char** argv) {
  std::string host = "127.0.0.1", mesh;
  int port = 3200, messages = 0;
  CLI::App app("Prints where the meshes of a running host are, a JSON line for each in each message", "sparkwatch");
  app.add_option("--host", host, "The host")->capture_default_str();
  app.add_option("--port", port, "Its monitor port, with S-expressions")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  app.add_option("--mesh", mesh, "Only meshes whose name contains this text, such as Sphere");
  app.add_option("--messages", messages, "End after this many; 0: with the host")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  int taken = 0, found = 0;
  try {
    Copy copy;
    spark::client::Connection connection(host, port, 10);
    for (; messages == 0 || taken < messages; ++taken) {
      copy.take(*connection.receive());
      found += copy.print(mesh);
      std::fflush(stdout);
    }
  } catch (const spark::client::Closed& e) {
    if (taken == 0 || messages > 0) return fail(e);
  } catch (const std::exception& e) {
    return fail(e);
  }
  if (found > 0) return 0;
  fmt::print(stderr, "sparkwatch: no visible mesh has a name that contains '{}'\n", mesh);
  return 1;
}
