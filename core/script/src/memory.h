#pragma once
/// \file
/// Private to the script server: what scripts keep from event to event, as state.

#include <memory>
#include <set>
#include <vector>

#include "spark/random.h"
#include "spark/ref.h"
#include "spark/state.h"
#include "state.h"

namespace spark::script {

/// The random numbers of an environment. The first draw seeds them from the owner's path, so the owner must exist then.
struct Stream {
  Ref<Leaf> owner;
  RandomStream numbers;
  bool seeded = false;
};

/// The environments of all scripts that may run again, with their random numbers and their tables `state`. What a
/// script keeps elsewhere (globals, locals of its chunk) is not saved.
class Memory {
 public:
  ~Memory();
  /// Adds the environment at `environment`, an absolute index, of a script at `owner`; its stream is the userdata on
  /// top of the stack. It is forgotten when the owner or its Lua state is gone.
  void add(lua_State* L, Leaf& owner, int environment);
  /// The addresses of all tables that are saved, of the scripts in the Lua state of a thread.
  std::set<const void*> tables(lua_State* L);
  /// Writes the random numbers and the tables, in the order in which the scripts were started. A table that cannot be
  /// saved is left out, which is logged once.
  void save(StateWriter& out);
  /// Reads them again; tables stay where they are, so that a script may hold them. Throws Error for other scripts.
  void load(StateReader& in);

 private:
  struct Entry {
    std::weak_ptr<State> state;
    Ref<Leaf> owner;
    int environment = LUA_NOREF, stream = LUA_NOREF;  ///< references
    bool reported = false;                            ///< that its table cannot be saved
  };
  void forgetGone();
  std::vector<Entry> entries_;
};

}  // namespace spark::script
