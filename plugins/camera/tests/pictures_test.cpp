#include <functional>

#include "api/appearance.h"
#include "studio.h"

// Pictures of solids are compared with rays that the test itself casts, by distance functions in double precision.

using namespace spark;
using namespace spark::test;

namespace {

/// Distance from a point to a solid [m], in the solid's own frame; negative inside.
using Distance = std::function<double(const Vec3&)>;

Distance box(const Vec3& edges) {
  return [half = Vec3(edges / 2)](const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - half;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  };
}
Distance sphere(double radius) {
  return [radius](const Vec3& p) { return p.norm() - radius; };
}
Distance capsule(double radius, double length) {
  return [=](const Vec3& p) { return (p - Vec3(0, 0, std::clamp(p.z(), -length / 2, length / 2))).norm() - radius; };
}
Distance cylinder(double radius, double length) {
  return [=](const Vec3& p) {
    const Eigen::Vector2d q(std::hypot(p.x(), p.y()) - radius, std::abs(p.z()) - length / 2);
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  };
}

/// A solid of the scene with its distance function.
struct Thing {
  const Leaf* visual;
  Pose pose;
  Distance distance;
};

/// What a ray meets first: the index of the thing and the depth [m]; -1: nothing.
struct Hit {
  int thing = -1;
  double depth = 0;
};

struct Things : Studio {
  std::vector<Thing> things;
  void add(const char* name, const Vec3f& at, const Vec3f& turnDeg, const char* kind, const char* set, List size,
           Distance distance) {
    Transform& t = place(name, at, turnDeg);
    Leaf& visual = solid(t, kind, set, std::move(size), "grey");
    things.push_back({&visual, toPose(t.world()), std::move(distance)});
  }
  Hit cast(double x, double y) const {
    const Vec3 direction = toPose(shot.pose).rotation * ray(x, y), from = toPose(shot.pose).position;
    Hit nearest{-1, shot.zFar};
    for (std::size_t n = 0; n < things.size(); ++n) {
      const Pose& pose = things[n].pose;
      const Vec3 o = pose.rotation.transpose() * (from - pose.position), d = pose.rotation.transpose() * direction;
      double t = shot.zNear;
      for (int step = 0; step < 3000 && t < nearest.depth; ++step) {
        const double gap = things[n].distance(o + t * d);
        if (gap < 1e-8) {
          nearest = {int(n), t};
          break;
        }
        t += gap / d.norm();
      }
    }
    return nearest;
  }
  /// Calls `check(x, y, hit)` for the pixels of a grid whose small neighbourhoods see one thing.
  template <class F>
  int forEachPixel(int every, F check) const {
    int checked = 0;
    for (int y = every / 2; y < shot.height; y += every)
      for (int x = every / 2; x < shot.width; x += every) {
        const Hit hit = cast(x + 0.5, y + 0.5);
        bool isEdge = false;
        for (const double dx : {-0.02, 0.02})
          for (const double dy : {-0.02, 0.02}) isEdge = isEdge || cast(x + 0.5 + dx, y + 0.5 + dy).thing != hit.thing;
        if (isEdge) continue;
        INFO("pixel " << x << " " << y);
        check(x, y, hit);
        ++checked;
      }
    return checked;
  }
};

/// A line as those of fields.
class Stripe : public SceneNode, public IPaintedLine {
  SPARK_CLASS(Stripe, SceneNode)
 public:
  static void describe(Description<Stripe>& d) { d.implements<IPaintedLine>(); }
  Leaf& leaf() override { return *this; }
  std::array<Vec3f, 2> ends() const override { return {Vec3f(-1, 0, 0), Vec3f(1, 0, 0)}; }
  float width() const override { return 0.1f; }
};

/// Solids of all kinds in front of a wall, on a floor.
struct Still : Things {
  Still() {
    material("grey", "diffuse", {0.5f, 0.5f, 0.5f, 1});
    add("floor", {0, 10, -0.5f}, {0, 0, 0}, "Box", "setExtents", {40.0, 40.0, 1.0}, box({40, 40, 1}));
    add("wall", {0, 12, 3}, {0, 0, 0}, "Box", "setExtents", {30.0, 0.5, 6.0}, box({30, 0.5, 6}));
    add("crate", {-1.5f, 5, 0.6f}, {20, -10, 30}, "Box", "setExtents", {1.0, 0.6, 0.8}, box({1, 0.6, 0.8}));
    add("ball", {0.2f, 4, 0.9f}, {10, 20, 30}, "Sphere", "setRadius", {0.45}, sphere(0.45));
    add("pill", {1.7f, 4.5f, 1.2f}, {35, 40, 0}, "Capsule", "setParams", {0.25, 0.9}, capsule(0.25, 0.9));
    add("can", {0.9f, 6, 1.5f}, {-50, 15, 0}, "Cylinder", "setScale", {0.4, 0.4, 1.1}, cylinder(0.4, 1.1));
    add("far ball", {-3, 10, 1.5f}, {0, 0, 0}, "Sphere", "setRadius", {0.05}, sphere(0.05));
    add("pole", {-0.8f, 3, 1}, {0, 0, 0}, "Cylinder", "setScale", {0.03, 0.03, 3.0}, cylinder(0.03, 3));
    add("lying pill", {0, 3, 0.2f}, {90, 0, 0}, "Capsule", "setParams", {0.15, 0.5}, capsule(0.15, 0.5));
  }
};

}  // namespace

TEST_CASE("each pixel of a depth picture is the distance along the optical axis, to a millimetre") {
  Still still;
  still.take(PictureKind::depth);
  const int checked = still.forEachPixel(3, [&](int x, int y, const Hit& hit) {
    const int expected = hit.thing < 0 ? 0 : int(std::lround(1000 * hit.depth));
    if (std::abs(still.number(x, y) - expected) > 1) CHECK(still.number(x, y) == expected);
  });
  CHECK(checked > 8000);
}

TEST_CASE("each pixel of a segmentation is the number of the solid that the ray through its centre meets") {
  Still still;
  still.take(PictureKind::segmentation);
  std::vector<std::uint16_t> numbers, seen;
  for (const Thing& t : still.things) numbers.push_back(still.numberOf(*t.visual));
  const int checked = still.forEachPixel(2, [&](int x, int y, const Hit& hit) {
    const std::uint16_t expected = hit.thing < 0 ? std::uint16_t(0) : numbers[std::size_t(hit.thing)];
    if (still.number(x, y) != expected) CHECK(still.number(x, y) == expected);
  });
  CHECK(checked > 18000);
  std::sort(numbers.begin(), numbers.end());
  CHECK(still.picture.seen == numbers);  // all are in the picture, and nothing else
}

TEST_CASE("a camera that is turned and has another lens sees the same scene") {
  Still still;
  still.shot.pose = rotationDeg(-12, 7, 15);
  still.shot.pose.block<3, 1>(0, 3) = Vec3f(0.5f, -1, 1.6f);
  still.shot.width = 200, still.shot.height = 150, still.shot.fovDeg = 95;
  still.take(PictureKind::depth);
  const int checked = still.forEachPixel(3, [&](int x, int y, const Hit& hit) {
    const int expected = hit.thing < 0 ? 0 : int(std::lround(1000 * hit.depth));
    if (std::abs(still.number(x, y) - expected) > 1) CHECK(still.number(x, y) == expected);
  });
  CHECK(checked > 3000);
}

TEST_CASE("only what is between zNear and zFar is seen, and not the inside of solids") {
  Studio studio;
  studio.material("grey", "diffuse", {1, 1, 1, 1});
  studio.shot.zNear = 1, studio.shot.zFar = 20;
  const auto middle = [&] { return studio.take(PictureKind::depth), studio.number(160, 120); };
  Transform& t = studio.place("crate", {0, 4, 1});
  studio.solid(t, "Box", "setExtents", {1.0, 1.0, 1.0}, "grey");
  CHECK(middle() == 3500);
  t.setLocalPos({0, 1.4f, 1});  // it begins before zNear
  CHECK(middle() == 0);
  t.setLocalPos({0, 21, 1});  // it begins behind zFar
  CHECK(middle() == 0);
  t.setLocalPos({0, 20, 1});
  CHECK(middle() == 19500);
  studio.shot.zFar = 100;
  t.setLocalPos({0, 70, 1});
  CHECK(middle() == 65535);  // as far as 16 bits go
  Studio::call(*t.find("Box"), "setVisible", {0});
  CHECK(middle() == 0);
}

TEST_CASE("in ambient light alone a solid has the product of both colours") {
  Studio studio;
  studio.material("rose", "ambient", {0.8f, 0.4f, 0.2f, 1});
  studio.light({0, 0, 5}, {1, 0.5f, 1, 1}, {0, 0, 0, 1});
  studio.solid(studio.place("ball", {0, 3, 1}), "Sphere", "setRadius", {0.5}, "rose");
  setProperty(*studio.camera, "background", List{0.2, 0.4, 0.6, 1});
  studio.take(PictureKind::colour);
  CHECK(studio.colour(160, 120) == std::array{204, 51, 51});
  CHECK(studio.colour(145, 140) == std::array{204, 51, 51});
  CHECK(studio.colour(5, 5) == std::array{51, 102, 153});
}

TEST_CASE("a lamp lights a surface by the cosine of its angle") {
  Studio studio;
  studio.material("white", "diffuse", {1, 0.5f, 0.25f, 1});
  studio.light({1, 1, 3}, {0, 0, 0, 1}, {1, 1, 1, 1});
  studio.solid(studio.place("wall", {0, 4.5f, 1}), "Box", "setExtents", {10.0, 1.0, 10.0}, "white");
  studio.take(PictureKind::colour);
  for (int y = 5; y < 240; y += 23)
    for (int x = 5; x < 320; x += 31) {
      const Vec3 point = Vec3(0, 0, 1) + 4 * studio.ray(x + 0.5, y + 0.5), to = Vec3(1, 1, 3) - point;
      const double cosine = -to.normalized().y();
      INFO(x << " " << y);
      CHECK(studio.colour(x, y)[0] == Approx(255 * cosine).margin(1));
      CHECK(studio.colour(x, y)[1] == Approx(127.5 * cosine).margin(1));
    }
}

TEST_CASE("a transparent solid shows what is behind it, and only pictures in colour have it") {
  Studio studio;
  studio.light({0, 0, 1}, {1, 1, 1, 1}, {0, 0, 0, 1});
  studio.material("red", "ambient", {1, 0, 0, 1});
  studio.material("glass", "ambient", {0, 0, 1, 1});
  setProperty(*studio.materials->child("glass"), "diffuse", List{0, 0, 0, 0.25});
  Leaf& pane = studio.solid(studio.place("pane", {0, 2, 1}), "Box", "setExtents", {9.0, 0.1, 9.0}, "glass");
  Studio::call(pane, "setTransparent", {});
  Leaf& wall = studio.solid(studio.place("wall", {0, 5, 1}), "Box", "setExtents", {9.0, 1.0, 9.0}, "red");
  studio.take(PictureKind::colour);
  CHECK(studio.colour(160, 120) == std::array{191, 0, 64});
  studio.take(PictureKind::segmentation);
  CHECK(studio.number(160, 120) == studio.numberOf(wall));
}

TEST_CASE("painted lines are seen on the ground, white and as wide as they are") {
  Studio studio;
  studio.kernel.registerClass<Stripe>();
  studio.light({0, 0, 5}, {1, 1, 1, 1}, {0, 0, 0, 1});
  studio.material("green", "ambient", {0, 1, 0, 1});
  Leaf& ground = studio.solid(studio.place("ground", {0, 5, -0.5f}), "Box", "setExtents", {20.0, 20.0, 1.0}, "green");
  Leaf& line = studio.place("line", {0, 3, 0}).create("Stripe", "line");
  studio.shot.pose = rotationDeg(-90, 0, 0);  // down, with y upwards in the picture
  studio.shot.pose.block<3, 1>(0, 3) = Vec3f(0, 3, 2);
  const auto at = [&](double x, double y) {
    const double pixels = 120 / std::tan(degToRad(30)) / 2;  // of a metre on the ground
    return std::array{int(160 + pixels * x), int(120 + pixels * y)};
  };
  const std::array inside{at(0, 0), at(0.9, 0.04), at(-0.9, -0.04), at(1.04, 0)};
  const std::array outside{at(0, 0.06), at(0, -0.06), at(1.07, 0), at(-0.5, 0.3)};
  studio.take(PictureKind::colour);
  for (const auto& [x, y] : inside) CHECK(studio.colour(x, y) == std::array{255, 255, 255});
  for (const auto& [x, y] : outside) CHECK(studio.colour(x, y) == std::array{0, 255, 0});
  studio.take(PictureKind::segmentation);
  for (const auto& [x, y] : inside) CHECK(studio.number(x, y) == studio.numberOf(line));
  for (const auto& [x, y] : outside) CHECK(studio.number(x, y) == studio.numberOf(ground));
}

TEST_CASE("a picture that OpenGL cannot hold fails alone: the next one is drawn") {
  Studio studio;
  studio.solid(studio.place("crate", {0, 3, 1}), "Box", "setExtents", {1, 1, 1}, "none");
  studio.take(PictureKind::segmentation);
  const CameraShot usual = studio.shot;
  studio.shot.width = 1 << 20;
  CHECK_THROWS_WITH(studio.camera->as<ICameraRenderer>()->render(studio.shot, studio.picture),
                    Catch::Contains("OpenGL"));
  studio.shot = usual;
  studio.take(PictureKind::segmentation);
  CHECK(studio.number(usual.width / 2, usual.height / 2) == 1);
}
