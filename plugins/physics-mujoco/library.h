#pragma once
/// \file
/// What differs between versions of MuJoCo, and what it has once per process. This project is built with 2.2.2, Debian
/// 12's.

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "piece_contacts.h"

namespace spark::mujoco {

struct Deleter {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};
using ModelPointer = std::unique_ptr<mjModel, Deleter>;
using DataPointer = std::unique_ptr<mjData, Deleter>;

/// Keeps MuJoCo's callbacks, which are functions of this plugin, installed while an object of this class exists.
class LibraryGuard {
 public:
  LibraryGuard();
  ~LibraryGuard();
  LibraryGuard(const LibraryGuard&) = delete;
  LibraryGuard& operator=(const LibraryGuard&) = delete;
};

/// Compiles MJCF text. Throws Error with MuJoCo's message.
ModelPointer compile(const std::string& mjcf);

/// While it exists, MuJoCo's warnings in this thread are written to a string, and it asks `filter` whether
/// two geoms of `model` may collide: false discards the pair. MuJoCo ends the process at an error; here it throws
/// Error.
class Session {
 public:
  using Filter = bool (*)(void* context, int geom1, int geom2);
  /// Called in each further stage of the integrator, when its positions and velocities are known: it sets forces.
  using Stage = void (*)(void* context);
  /// `pieces`: finds the contacts of meshes where it can; nullptr: MuJoCo finds all.
  Session(std::string& text, const mjModel* model, Filter filter, void* context, Stage stage = nullptr,
          PieceContacts* pieces = nullptr);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Of the innermost session of the thread; used by MuJoCo's callbacks.
  std::string* text;
  const mjModel* model;
  Filter filter;
  void* context;
  Stage stage;
  PieceContacts* pieces;

 private:
  Session* outer_;
};

}  // namespace spark::mujoco
