#pragma once
/// \file
/// The height fields of an MJCF model.

#include <map>

#include "compiler.h"
#include "robot/model.h"

namespace spark::mjcf {

/// The elements `hfield` of `asset`. The file of one is read when the first geom needs it, and only once.
class HeightFields {
 public:
  /// `read` must outlive the height fields.
  explicit HeightFields(const ReadHeights& read) : read_(read) {}
  /// Adds an element `hfield`. `folder`: of the files, "" or "a/". Throws Error.
  void add(Attributes& a, const std::string& folder, const Compiler& compiler);
  /// Writes the shape of the geom `a`, which names a height field. Throws Error for unknown ones, and for files that
  /// cannot be read.
  void shape(Attributes& a, Geom& geom);

 private:
  struct Asset {
    Element from;
    std::string file, path;         ///< as the model writes it, and as a resource name
    int columns = 0, rows = 0;      ///< of one without a file
    std::vector<double> elevation;  ///< written in the model, from the greatest y; empty: flat
    std::array<double, 4> size{};   ///< half sizes along x and y, elevation, thickness below [m]
    std::shared_ptr<const engine::HeightField> field;
  };
  engine::HeightField heightsOf(const Asset& asset) const;

  const ReadHeights& read_;
  std::map<std::string, Asset, std::less<>> assets_;  ///< by name
};

}  // namespace spark::mjcf
