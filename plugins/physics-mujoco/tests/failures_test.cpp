// MuJoCo ends the process at an error: here it is an exception with its text, and the world goes on.

#include <catch2/catch.hpp>
#include <utility>

#include "../library.h"
#include "spark/error.h"

using namespace spark;
using namespace spark::mujoco;

namespace {

/// A ball in a hinge, with room for a given count of numbers in MuJoCo's stack.
ModelPointer ballWithStack(int numbers) {
  return compile("<mujoco><size nstack='" + std::to_string(numbers) +
                 "'/><worldbody><body><joint axis='0 1 0'/><geom size='0.1' pos='1 0 0'/></body></worldbody></mujoco>");
}

}  // namespace

TEST_CASE("errors of MuJoCo are exceptions with its text, warnings go to the session") {
  const LibraryGuard guard;
  CHECK_THROWS_WITH(mju_error("a rule does not hold"), "MuJoCo: a rule does not hold");
  std::string text;
  {
    const Session session(text, nullptr, nullptr, nullptr);
    CHECK_NOTHROW(mju_warning("a remark"));
  }
  CHECK(text == "a remark");
}

TEST_CASE("a model or step for which MuJoCo has no room is an exception, and the next one steps") {
  const LibraryGuard guard;
  CHECK_THROWS_WITH(ballWithStack(8), Catch::Contains("MuJoCo: ") && Catch::Contains("Stack overflow"));
  const ModelPointer wide = ballWithStack(100000);
  const int enough = std::exchange(wide->nstack, 8);
  const DataPointer cramped(mj_makeData(wide.get()));
  CHECK_THROWS_WITH(mj_step(wide.get(), cramped.get()), "MuJoCo: Stack overflow");
  wide->nstack = enough;
  const DataPointer data(mj_makeData(wide.get()));
  CHECK_NOTHROW(mj_step(wide.get(), data.get()));
  CHECK(data->qvel[0] > 0);
}

TEST_CASE("a model that MuJoCo does not take is an exception that names the cause") {
  const LibraryGuard guard;
  CHECK_THROWS_WITH(compile("<mujoco><worldbody><body><joint/></body></worldbody></mujoco>"),
                    Catch::Contains("MuJoCo: ") && Catch::Contains("mjMINVAL"));
}
