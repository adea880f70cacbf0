#include <catch2/catch.hpp>
#include <cstring>

#include "../stream/frame_decoder.h"
#include "frame_reader.h"

using namespace spark;
using namespace spark::web;
using spark::web::test::FrameReader;

namespace {
/// A position in meters and a rotation in degrees.
Matrix at(float x, float y, float z, float a = 0, float b = 0, float c = 0) {
  Matrix m = rotationDeg(a, b, c);
  m.block<3, 1>(0, 3) = Vec3f(x, y, z);
  return m;
}

// Quanta: an axis of the other transform's frame is right to one of them, an axis of the world to the root of three.
constexpr double kOnAnother = 1.8;

struct Scene {
  std::vector<Matrix> transforms;
  std::vector<std::uint8_t> visible;
  std::vector<std::uint32_t> toggled;
  std::uint32_t shape = 1;
  double time = 0;
  std::vector<Mount> mounts{};
  Instant instant() const { return {shape, time, transforms, visible, toggled, mounts}; }
};
}  // namespace

TEST_CASE("A key frame has every transform with an error below its quantum") {
  Scene scene{{at(1, -2, 3), at(0.1234f, 0, 0, 10, 20, 30), at(-40, 25, 0.5f, 0, 0, 179)}, {1, 0, 1}, {1}, 7, 12.5};
  for (const Precision precision : {kFine, kCoarse}) {
    StreamEncoder encoder(precision);
    encoder.advance(scene.instant());
    CHECK_FALSE(encoder.hasDelta());
    FrameReader reader(3);
    reader.take(encoder.key());
    CHECK(reader.shape == 7);
    CHECK(reader.serial == 1);
    CHECK(reader.time == 12.5);
    for (std::size_t i = 0; i < 3; ++i) CHECK(reader.isNear(i, scene.transforms[i]));
    CHECK(reader.visible == std::map<std::uint64_t, bool>{{1, false}});
  }
}

TEST_CASE("Deltas add up to the next key frame") {
  Scene scene{std::vector<Matrix>(40, Matrix::Identity()), std::vector<std::uint8_t>(50, 1), {}};
  StreamEncoder encoder(kFine);
  FrameReader follower(40);
  for (int k = 0; k < 100; ++k) {
    scene.time = 0.04 * k;
    for (std::size_t i = 0; i < 40; i += 1 + k % 5)
      scene.transforms[i] = at(0.01f * k * i, std::sin(0.1f * k), -2, 5.f * k, 3.f * i, 0.3f * k * i);
    encoder.advance(scene.instant());
    follower.take(k == 0 ? encoder.key() : encoder.delta());
    FrameReader newcomer(40);
    newcomer.take(encoder.key());
    REQUIRE(newcomer.quantised == follower.quantised);
    for (std::size_t i = 0; i < 40; ++i) REQUIRE(newcomer.isNear(i, scene.transforms[i]));
  }
  CHECK(follower.serial == 100);
}

TEST_CASE("Transforms that do not move cost no bytes, and neither does noise below the quantum") {
  Scene scene{std::vector<Matrix>(600, at(1, 2, 3, 10, 20, 30)), std::vector<std::uint8_t>(600, 1), {}};
  StreamEncoder encoder(kFine);
  encoder.advance(scene.instant());
  const std::size_t empty = 20 + 2 + 1;
  encoder.advance(scene.instant());
  CHECK(encoder.delta().size() == empty);
  for (int k = 0; k < 20; ++k) {
    for (Matrix& m : scene.transforms) m(0, 3) = 1 + (k % 2 ? 0.0002f : -0.0002f);
    encoder.advance(scene.instant());
    CHECK(encoder.delta().size() == empty);
  }
  scene.transforms[300](0, 3) = 1.05f;
  encoder.advance(scene.instant());
  CHECK(encoder.delta().size() == empty + 2 + 1 + 1 + 1);  // skip 300 (two bytes), one transform: mask and one number
}

TEST_CASE("A rotation keeps its quaternion's sign from frame to frame, so a continuous rotation never jumps") {
  Scene scene{{Matrix::Identity()}, {1}, {}};
  StreamEncoder encoder(kFine);
  encoder.advance(scene.instant());
  for (int degrees = 0; degrees < 1080; degrees += 5) {
    scene.transforms[0] = at(0, 0, 0, 0, 0, static_cast<float>(degrees));
    encoder.advance(scene.instant());
    CHECK(encoder.delta().size() <= 20 + 2 + 1 + 2 * 2 + 3);
  }
}

TEST_CASE("A limb that moves with its robot costs nothing, and one that turns at its joint a number") {
  Scene scene{std::vector<Matrix>(4, Matrix::Identity()), std::vector<std::uint8_t>(4, 1), {}};
  const Vec3f pin(0, 0, 0.1f);
  for (int i = 0; i < 4; ++i) scene.mounts.push_back({i - 1, pin});
  const auto pose = [&](const Matrix& torso, float joint) {
    scene.transforms[0] = torso;
    for (int i = 1; i < 4; ++i)  // each 20 cm below the one before
      scene.transforms[i] = scene.transforms[i - 1] * at(0, 0, -0.1f) * at(0, 0, 0, joint) * at(0, 0, -0.1f);
  };
  StreamEncoder encoder(kFine);
  pose(Matrix::Identity(), 0);
  encoder.advance(scene.instant());
  FrameReader follower(4);
  follower.mounts = scene.mounts;
  follower.take(encoder.key());
  std::size_t most = 0;
  for (int k = 1; k < 200; ++k) {
    const auto t = static_cast<float>(k);
    pose(at(0.05f * t, -10, 1, t, 7 * t, 0.3f * t), k < 100 ? 0 : t - 100);
    encoder.advance(scene.instant());
    follower.take(encoder.delta());
    for (std::size_t i = 0; i < 4; ++i) REQUIRE(follower.isNear(i, scene.transforms[i], kOnAnother));
    if (k < 100) REQUIRE(encoder.delta().size() <= 20 + 2 + 1 + 2 + 7 * 2);
    most = std::max(most, encoder.delta().size());
  }
  CHECK(most <= 20 + 2 + 1 + 2 + 7 * 2 + 3 * 2);
  FrameReader newcomer(4);
  newcomer.mounts = scene.mounts;
  newcomer.take(encoder.key());
  CHECK(newcomer.quantised == follower.quantised);
}

TEST_CASE("Errors do not add up along a chain of limbs") {
  constexpr std::size_t kLimbs = 60;
  Scene scene{std::vector<Matrix>(kLimbs, Matrix::Identity()), std::vector<std::uint8_t>(kLimbs, 1), {}};
  for (std::size_t i = 0; i < kLimbs; ++i) scene.mounts.push_back({static_cast<int>(i) - 1, Vec3f(0, 0, 0.5f)});
  for (const Precision precision : {kFine, kCoarse}) {
    StreamEncoder encoder(precision);
    FrameReader reader(kLimbs);
    reader.mounts = scene.mounts;
    for (int k = 0; k < 50; ++k) {
      const auto t = static_cast<float>(k);
      for (std::size_t i = 1; i < kLimbs; ++i)
        scene.transforms[i] =
            scene.transforms[i - 1] * at(0.01f, 0, 0.5f, t, 0.7f * t, 3.f * static_cast<float>(i % 7));
      encoder.advance(scene.instant());
      reader.take(k == 0 ? encoder.key() : encoder.delta());
      for (std::size_t i = 0; i < kLimbs; ++i) REQUIRE(reader.isNear(i, scene.transforms[i], kOnAnother));
    }
  }
}

TEST_CASE("Mounted transforms are decoded as a viewer decodes them, also half a turn from each other") {
  Scene scene{std::vector<Matrix>(3, Matrix::Identity()), std::vector<std::uint8_t>(3, 1), {}};
  scene.mounts = {{}, {0, {0.2f, -0.1f, 0.3f}}, {1, {0, 0, 0}}};
  StreamEncoder encoder(kFine);
  FrameReader reader(3);
  reader.mounts = scene.mounts;
  FrameDecoder decoder;
  decoder.begin(scene.mounts, {1, 1, 1});
  for (int k = 0; k < 400; ++k) {
    const auto t = static_cast<float>(k);
    scene.transforms = {at(3, 2, 0.5f, t), at(3, 2.2f, 0.5f, -2 * t, 90, t), at(2.9f, 2, 0.4f, 0, 3 * t)};
    encoder.advance(scene.instant());
    const std::string& frame = k % 50 == 0 ? encoder.key() : encoder.delta();
    reader.take(frame);
    decoder.take(frame);
    for (std::size_t i = 0; i < 3; ++i) {
      REQUIRE(reader.isNear(i, scene.transforms[i], kOnAnother));
      REQUIRE(reader.isNear(i, decoder.transform(i), 0.1));
    }
  }
}

TEST_CASE("Visibility is sent when it changes, and with every key frame") {
  Scene scene{{Matrix::Identity()}, {1, 1, 1}, {}};
  StreamEncoder encoder(kFine);
  encoder.advance(scene.instant());
  FrameReader follower(1);
  follower.take(encoder.key());
  CHECK(follower.visible.empty());
  scene.visible[2] = 0;
  scene.toggled = {2};
  encoder.advance(scene.instant());
  follower.take(encoder.delta());
  CHECK(follower.visible == std::map<std::uint64_t, bool>{{2, false}});
  encoder.advance(scene.instant());
  CHECK(encoder.delta().size() == 23);
  scene.visible[2] = 1;
  encoder.advance(scene.instant());
  FrameReader newcomer(1);
  newcomer.take(encoder.key());
  CHECK(newcomer.visible == std::map<std::uint64_t, bool>{{2, true}});
}

TEST_CASE("A new shape starts with a key frame") {
  Scene scene{{Matrix::Identity(), at(1, 0, 0)}, {1, 1}, {}};
  StreamEncoder encoder(kFine);
  encoder.advance(scene.instant());
  encoder.advance(scene.instant());
  CHECK(encoder.hasDelta());
  scene.shape = 2;
  scene.transforms.push_back(at(0, 5, 0));
  scene.visible.push_back(1);
  encoder.advance(scene.instant());
  CHECK_FALSE(encoder.hasDelta());
  FrameReader reader(3);
  reader.take(encoder.key());
  CHECK(reader.shape == 2);
  CHECK(reader.serial == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(reader.isNear(i, scene.transforms[i]));
}

TEST_CASE("Matrices that are not rotations or not finite give frames that can be decoded") {
  const float nan = std::nanf("");
  Scene scene{{Matrix::Zero(), Matrix::Constant(nan), at(1e30f, -1e30f, 0), Matrix(at(1, 2, 3) * 5)}, {1, 1, 1, 1}, {}};
  StreamEncoder encoder(kFine);
  for (int k = 0; k < 3; ++k) {
    encoder.advance(scene.instant());
    FrameReader reader(4);
    reader.take(encoder.key());
    for (const auto& q : reader.quantised) CHECK(std::abs(q[6]) <= 1 << 11);
    std::swap(scene.transforms[0], scene.transforms[3]);
  }
}

TEST_CASE("Numbers are encoded with seven bits per byte, lowest first") {
  const auto bytes = [](auto put, auto value) {
    std::string out;
    put(out, value);
    return out;
  };
  CHECK(bytes(putVarint, 0u) == std::string(1, '\0'));
  CHECK(bytes(putVarint, 127u) == "\x7f");
  CHECK(bytes(putVarint, 300u) == "\xac\x02");
  CHECK(bytes(putSigned, -1) == "\x01");
  CHECK(bytes(putSigned, 1) == "\x02");
  CHECK(bytes(putSigned, -64) == "\x7f");
  CHECK(bytes(putSigned, 64) == "\x80\x01");
}
