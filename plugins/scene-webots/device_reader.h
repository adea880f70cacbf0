#pragma once
/// \file
/// Reads sensors and other devices, each of which is a solid as well.

#include "reading.h"

namespace spark::webots {

/// Adds what agents sense by a device, `node`, whose body is that of the frame. What is not supported is named. Throws
/// Error.
void readDevice(const Node& node, const Frame& frame, mjcf::Model& model, Reading& reading);

/// Noise and resolution of a PositionSensor. `slides`: its joint slides. Throws Error.
void readPositionSensor(const Node& node, bool slides, mjcf::Sensor& sensor, Reading& reading);

/// Fields of a device beside those of a solid, which no reader of solids needs to know.
void ignoreDeviceFields(const Node& node, Fields& fields);

}  // namespace spark::webots
