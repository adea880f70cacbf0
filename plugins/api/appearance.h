#pragma once
/// \file
/// How things look, for what draws the scene.

#include <array>
#include <string>

#include "api/math.h"
#include "spark/abi/api/appearance.h"
#include "spark/node.h"

namespace spark {

/// A material that scenes name. Offered by the children of the material server.
class IMaterial {
 public:
  SPARK_INTERFACE(IMaterial, 1);
  /// The folder of all materials: the material server.
  static constexpr const char* kFolder = "/sys/server/material";
  virtual ~IMaterial() = default;
  /// Colours and highlights, as in OpenGL's lighting equation; see MaterialSolid for the defaults.
  struct Look {
    Color ambient{0.2f, 0.2f, 0.2f, 1};  ///< in ambient light
    Color diffuse{1, 1, 1, 1};           ///< in direct light; its fourth number is the opacity
    Color specular{0, 0, 0, 1};          ///< of highlights
    Color emission{0, 0, 0, 1};          ///< without any light
    double shininess = 128;              ///< exponent of highlights, 0..128
  };
  virtual Look look() const = 0;
  /// Resource name of a picture (PNG) that multiplies the colours, "textures/grass.png"; "": none.
  virtual const std::string& texture() const = 0;
};

/// A painted line that is no visual node, because only the textures of viewers have it. Offered by the lines of fields.
class IPaintedLine {
 public:
  SPARK_INTERFACE(IPaintedLine, 1);
  virtual ~IPaintedLine() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Both ends, in the frame of the nearest transform above [m].
  virtual std::array<Vec3f, 2> ends() const = 0;
  /// Its width on the ground [m].
  virtual float width() const = 0;
};

}  // namespace spark
