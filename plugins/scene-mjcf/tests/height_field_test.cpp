#include <cstring>

#include "../height_file.h"
#include "read_model.h"

namespace spark::mjcf::test {

namespace {

std::string field(const std::string& attributes) {
  return "<mujoco><asset><hfield name='hill' " + attributes +
         "/></asset><worldbody><geom name='g' type='hfield' hfield='hill' pos='1 2 3'/></worldbody></mujoco>";
}

/// A file of MuJoCo's own format.
std::string heightFile(std::int32_t rows, std::int32_t columns, const std::vector<float>& heights) {
  std::string out(8 + 4 * heights.size(), '\0');
  std::memcpy(out.data(), &rows, 4);
  std::memcpy(out.data() + 4, &columns, 4);
  std::memcpy(out.data() + 8, heights.data(), 4 * heights.size());
  return out;
}

}  // namespace

TEST_CASE("a height field has its lowest point at 0 and its highest one at its elevation, whatever its numbers are") {
  const Read r(field("nrow='2' ncol='3' size='2 1 0.5 0.1' elevation='10 11 12 13 14 30'"));
  CHECK(r.messages().empty());
  const Geom& g = r.body(0).geoms.at(0);
  REQUIRE(g.shape.shape == engine::Shape::heightField);
  const engine::HeightField& f = *g.shape.heightField;
  CHECK((f.columns == 3 && f.rows == 2 && f.width == 4 && f.depth == 2));
  // The first row of the file has the greatest y.
  const std::vector<float> expected{0.075f, 0.1f, 0.5f, 0, 0.025f, 0.05f};
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(f.heights.at(i) == Approx(expected[i]));
  CHECK((f.low == 0 && f.high == 0.5f));
  CHECK(g.contact.thickness == 0.1);
  CHECK(g.pose.position == Vec3(1, 2, 3));
}

TEST_CASE("a height field without heights is flat") {
  const Read r(field("nrow='2' ncol='2' size='1 1 5 0.1'"));
  CHECK(r.body(0).geoms.at(0).shape.heightField->heights == std::vector<float>(4, 0));
}

TEST_CASE("a bad height field costs its geoms") {
  const std::pair<const char*, const char*> cases[] = {
      {"nrow='2' ncol='2' size='1 1 0 0.1'", "<hfield> 'hill' is left out: expected four numbers above 0 for 'size'"},
      {"nrow='1' ncol='2' size='1 1 1 0.1'", "expected a file, or 2 to 2048 points for 'nrow' and 'ncol'"},
      {"nrow='2' ncol='2' size='1 1 1 0.1' elevation='1 2 3'", "expected 4 numbers for 'elevation', found 3"},
  };
  for (const auto& [attributes, message] : cases) {
    const Read r(field(attributes));
    CHECK_THAT(r.messages(), Catch::Contains(message));
    CHECK_THAT(r.messages(), Catch::Contains("<geom> 'g' is left out: there is no <hfield> 'hill'"));
    CHECK(r.model.unsupportedGeoms.contains("g"));
  }
}

TEST_CASE("a file of heights says how many rows and columns it has") {
  const engine::HeightField f = readHeightFile("hill.bin", heightFile(2, 3, {1, 2, 3, 4, 5, 6}));
  CHECK((f.rows == 2 && f.columns == 3));
  CHECK(f.heights == std::vector<float>{1, 2, 3, 4, 5, 6});
  CHECK_THROWS_WITH(readHeightFile("hill.bin", heightFile(2, 2, {1, 2, 3})), Catch::Contains("expected 24 bytes"));
  CHECK_THROWS_WITH(readHeightFile("hill.bin", heightFile(1, 2, {1, 2})), Catch::Contains("2 to 2048 rows"));
  CHECK_THROWS_WITH(readHeightFile("hill.bin", "abc"), Catch::Contains("found 0 and 0"));
  CHECK_THROWS_WITH(readHeightFile("hill.bin", heightFile(2, 2, {1, 2, 3, NAN})), Catch::Contains("finite"));
  CHECK_THROWS_WITH(readHeightFile("hill.png", "abc"), Catch::Contains("expected a PNG file"));
}

}  // namespace spark::mjcf::test
