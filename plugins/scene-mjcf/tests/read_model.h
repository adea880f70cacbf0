#pragma once
/// \file
/// Models that are read from MJCF texts.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <map>

#include "robot/model.h"

namespace spark::mjcf::test {

using Files = std::map<std::string, std::string>;

struct Read {
  Unsupported unsupported;
  std::unique_ptr<Document> document;
  Model model;
  explicit Read(const std::string& text, Files files = {}) {
    files["a.xml"] = text;
    document = std::make_unique<Document>("a.xml", [files](const std::string& name) {
      const auto found = files.find(name);
      if (found == files.end()) throw Error("there is no file '" + name + "'");
      return found->second;
    });
    model = readModel(
        *document,
        [](const std::string&) {
          // A cube of 1 m.
          engine::Mesh s;
          for (int i = 0; i < 8; ++i)
            for (int k = 0; k < 3; ++k) s.vertices.push_back((i >> k) & 1);
          s.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
          return s;
        },
        unsupported);
  }
  const Body& body(std::size_t i) const { return model.bodies.at(i); }
  /// The messages about unsupported elements and attributes, one per line.
  std::string messages() const {
    std::string out;
    for (const std::string& s : unsupported.sentences()) out += s + "\n";
    return out;
  }
};

inline std::string world(const std::string& content) {
  return "<mujoco><worldbody>" + content + "</worldbody></mujoco>";
}
inline std::string failure(const std::string& text, Files files = {}) {
  try {
    Read(text, std::move(files));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// What is named of a model that is read nevertheless, one sentence a line.
inline std::string named(const std::string& text, Files files = {}) { return Read(text, std::move(files)).messages(); }

}  // namespace spark::mjcf::test
