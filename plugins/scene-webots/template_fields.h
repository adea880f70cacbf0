#pragma once
/// \file
/// What a template knows of the instance of its PROTO.

#include <nlohmann/json_fwd.hpp>

#include "syntax.h"

namespace spark::webots {

/// The value of a field in JSON, as programs of templates find it: SFVec3f is {"x": 1, "y": 2, "z": 3}, a list is an
/// array, a node {"node_name": "Box", "fields": {"size": {"value": ...}}}, and NULL null. `type`: that of the PROTO's
/// declaration; "": of a node's field, whose type follows from the value.
nlohmann::json valueFor(const Value& value, std::string_view type);

}  // namespace spark::webots
