#include "library.h"

#include <cstring>
#include <mutex>

#include "spark/error.h"

namespace spark::mujoco {

namespace {

thread_local Session* session = nullptr;
std::mutex compiling;  // MuJoCo's parser keeps the last model for the process

/// MuJoCo's filter: 1 discards the pair.
int discard(const mjModel* m, mjData*, int geom1, int geom2) {
  // The rule that applies without a callback: types and affinities of contacts.
  const bool mayTouch = (m->geom_contype[geom1] & m->geom_conaffinity[geom2]) != 0 ||
                        (m->geom_contype[geom2] & m->geom_conaffinity[geom1]) != 0;
  if (!mayTouch) return 1;
  return session && session->model == m && session->filter && !session->filter(session->context, geom1, geom2);
}

void onStage(const mjModel* m, mjData*) {
  if (session && session->model == m && session->stage) session->stage(session->context);
}

void onWarning(const char* text) {
  if (session) *session->text = text;
}

std::mutex installing;
int guards = 0;  // number of LibraryGuards

}  // namespace

LibraryGuard::LibraryGuard() {
  const std::lock_guard lock(installing);
  if (guards++ > 0) return;
  mju_user_warning = onWarning;
  mju_user_error = [](const char* text) { throw Error(std::string("MuJoCo: ") + text); };
  mjcb_contactfilter = discard;
  mjcb_control = onStage;
}

LibraryGuard::~LibraryGuard() {
  const std::lock_guard lock(installing);
  if (--guards > 0) return;
  mju_user_warning = nullptr;
  mju_user_error = nullptr;
  mjcb_contactfilter = nullptr;
  mjcb_control = nullptr;
}

Session::Session(std::string& to, const mjModel* m, Filter f, void* c, Stage s)
    : text(&to), model(m), filter(f), context(c), stage(s), outer_(session) {
  session = this;
}

Session::~Session() { session = outer_; }

ModelPointer compile(const std::string& mjcf) {
  const std::lock_guard lock(compiling);
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  constexpr const char* kName = "world.xml";
  if (mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(mjcf.size())) != 0)
    throw Error("MuJoCo does not take a model of this size");
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kName)], mjcf.data(), mjcf.size());
  char message[1000] = "";
  ModelPointer model(mj_loadXML(kName, files.get(), message, sizeof message));
  mj_deleteVFS(files.get());
  if (!model) throw Error(std::string("MuJoCo: ") + message);
  return model;
}

}  // namespace spark::mujoco
