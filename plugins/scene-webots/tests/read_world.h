#pragma once
/// \file
/// Reads texts as Webots files.

#include <fmt/ranges.h>

#include <catch2/catch.hpp>
#include <map>

#include "../template_process.h"
#include "../webots_reader.h"

namespace spark::webots::test {

struct Read {
  mjcf::Unsupported unsupported;
  std::map<std::string, std::string> files;
  TemplateProcess templates{TemplateProcess::path(), 1};
  Sources sources{[this](const std::string& name) {
                    const auto found = files.find(name);
                    return found == files.end() ? std::nullopt : std::optional(found->second);
                  },
                  [this](const std::string& request) { return templates.ask(request); }};
  Document document;
  ReadMesh readMesh = cube;
  World world;
  explicit Read(const std::string& text, Base base = Base::byFile, std::map<std::string, std::string> others = {})
      : files(with(std::move(others), text)),
        document("a.wbt", sources, unsupported),
        world(readWorld(document, base, readMesh, unsupported)) {}
  static std::map<std::string, std::string> with(std::map<std::string, std::string> files, const std::string& text) {
    files["a.wbt"] = text;
    return files;
  }
  /// A cube of 1 m.
  static engine::Mesh cube(const std::string&, const std::string& url) {
    if (url.ends_with("missing.stl")) throw Error("there is no such file");
    engine::Mesh s;
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 3; ++k) s.vertices.push_back((i >> k) & 1);
    return s;
  }
  const mjcf::Model& model(std::string_view name) const {
    for (const mjcf::Model& m : world.models)
      if (m.name == name) return m;
    FAIL("no model " << name);
    return world.models[0];
  }
  const mjcf::Body& body(std::string_view name) const {
    for (const mjcf::Model& m : world.models)
      for (const mjcf::Body& b : m.bodies)
        if (b.name == name) return b;
    FAIL("no body " << name);
    return world.models[0].bodies[0];
  }
  std::string messages() const { return fmt::format("{}", fmt::join(unsupported.sentences(), "\n")); }
};

inline std::string failure(const std::string& text, std::map<std::string, std::string> others = {}) {
  try {
    Read r(text, Base::byFile, std::move(others));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// A file with these nodes.
inline std::string world(const std::string& nodes) { return "#VRML_SIM R2023b utf8\n" + nodes; }

}  // namespace spark::webots::test
