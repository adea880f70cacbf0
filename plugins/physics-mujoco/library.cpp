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

/// MuJoCo's functions of collision with a mesh, by the type of the other geom.
mjfCollision withMesh[mjNGEOMTYPES] = {};

int collideMesh(const mjModel* m, const mjData* d, mjContact* out, int geom1, int geom2, mjtNum margin) {
  if (session && session->model == m && session->pieces)
    if (const int count = session->pieces->find(m, d, out, geom1, geom2, margin); count >= 0) return count;
  return withMesh[m->geom_type[geom1]](m, d, out, geom1, geom2, margin);
}

/// Exchanges MuJoCo's functions and this one.
void installCollision(bool on) {
  for (const int type : {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_ELLIPSOID, mjGEOM_CYLINDER, mjGEOM_BOX, mjGEOM_MESH}) {
    mjfCollision& function = mjCOLLISIONFUNC[type][mjGEOM_MESH];
    if (on) withMesh[type] = function;
    function = on ? collideMesh : withMesh[type];
  }
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
  installCollision(true);
}

LibraryGuard::~LibraryGuard() {
  const std::lock_guard lock(installing);
  if (--guards > 0) return;
  mju_user_warning = nullptr;
  mju_user_error = nullptr;
  mjcb_contactfilter = nullptr;
  mjcb_control = nullptr;
  installCollision(false);
}

Session::Session(std::string& to, const mjModel* m, Filter f, void* c, Stage s, PieceContacts* p)
    : text(&to), model(m), filter(f), context(c), stage(s), pieces(p), outer_(session) {
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
