// Binary PLY files: of either order of bytes, with numbers of every type, rows that no surface needs, faces of every kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

/** Bytes of numbers, of one order. */
class NumberBytes {
 public:
  explicit NumberBytes(bool big = false) : big_(big) {}

  template <typename T>
  NumberBytes& add(T number) {
    std::string bytes(reinterpret_cast<const char*>(&number), sizeof(number));
    if (big_) std::reverse(bytes.begin(), bytes.end());
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool big_;
  std::string bytes_;
};

std::string plyFile(bool big, const std::string& header, const NumberBytes& rows) {
  return "ply\nformat binary_" + std::string(big ? "big" : "little") + "_endian 1.0\n" + header + "end_header\n" + rows.bytes();
}

const std::string DOUBLE_PLACES = "property double x\nproperty double y\nproperty double z\n";
const std::string FLOAT_PLACES = "property float x\nproperty float y\nproperty float z\n";

NumberBytes unitTriangle() {
  NumberBytes rows;
  for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) rows.add(number);
  return rows;
}

class BinaryPly : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Orders, BinaryPly, testing::Bool());

TEST_P(BinaryPly, KeepsASurveyorsMillimetres) {
  const Vector3 corners[] = {{691000.001, 5334000.002, 519.003}, {691000.501, 5334000.002, 519.003}, {691000.001, 5334000.502, 519.003}};
  NumberBytes rows(GetParam());
  for (const Vector3& corner : corners) rows.add(corner.x()).add(corner.y()).add(corner.z());
  rows.add(std::uint8_t{3}).add(0).add(1).add(2);
  const std::string header =
      "element vertex 3\n" + DOUBLE_PLACES + "element face 1\nproperty list uchar int vertex_indices\ncomment in metres\n";
  const TemporaryFolder folder;
  const LoadedSurface surface = loadSurface(folder.write("a.ply", plyFile(GetParam(), header, rows)));
  ASSERT_EQ(surface.mesh->vertices.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(surface.mesh->vertices[i], corners[i]);
}

TEST_P(BinaryPly, PassesOverWhatNoSurfaceNeeds) {
  NumberBytes rows(GetParam());
  // An element of its own, then faces with a quality, then vertices with colours and a list.
  rows.add(std::uint16_t{2}).add(7.0).add(8.0);
  rows.add(0.5f).add(std::int32_t{4}).add(std::uint16_t{0}).add(std::uint16_t{1}).add(std::uint16_t{2}).add(std::uint16_t{3});
  const int places[][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, -1}};
  for (const auto& [x, y, z] : places)
    rows.add(std::uint8_t{255}).add(std::int16_t(x)).add(std::int8_t(y)).add(std::uint8_t{1}).add(1.f).add(double(z));
  const std::string header =
      "element camera 1\nproperty list ushort double k\n"
      "element face 1\nproperty float quality\nproperty list int ushort vertex_index\n"
      "element vertex 4\nproperty uchar red\nproperty short x\nproperty char y\nproperty list uchar float weights\nproperty double z\n";
  const TemporaryFolder folder;
  const LoadedSurface surface = loadSurface(folder.write("a.ply", plyFile(GetParam(), header, rows)));
  EXPECT_EQ(surface.report.triangles, 2);
  EXPECT_EQ(surface.mesh->bounds().min(), Vector3(0, 0, -1));
  EXPECT_EQ(surface.mesh->bounds().max(), Vector3(2, 1, 0));
}

TEST(BinaryPlyFaces, StripsAlternateAndBeginAnew) {
  NumberBytes rows;
  for (const float x : {0.f, 1.f, 2.f})
    for (const float y : {0.f, 1.f}) rows.add(x).add(y).add(0.f);
  rows.add(std::int32_t{8});
  for (const int corner : {1, 0, 3, 2, -1, 3, 2, 5}) rows.add(corner);
  const std::string header = "element vertex 6\n" + FLOAT_PLACES + "element tristrips 1\nproperty list int int vertex_indices\n";
  const TemporaryFolder folder;
  const LoadedSurface surface = loadSurface(folder.write("a.ply", plyFile(false, header, rows)), Vector3::Ones(), {}, Mending::OFF);
  ASSERT_EQ(surface.mesh->elements.size(), 3u);
  for (const Vector3i& e : surface.mesh->elements) {
    const auto& p = surface.mesh->vertices;
    EXPECT_EQ((p[e[1]] - p[e[0]]).cross(p[e[2]] - p[e[0]]), Vector3(0, 0, 1));
  }
}

/** Triangles of a long ribbon, if asked with a quadrilateral for two of them, and with rows that name a vertex that is not there. */
class Ribbon {
 public:
  static constexpr int TRIANGLES = 50000, QUADRILATERAL = 20000;

  explicit Ribbon(bool with_quadrilateral, const std::vector<int>& wrong_rows = {}) {
    for (int i = 0; i < TRIANGLES + 2; ++i) rows_.add(0.5f * static_cast<float>(i)).add(static_cast<float>(i % 2)).add(0.f);
    for (int i = 0; i < TRIANGLES; ++i, ++faces_) {
      const bool quadrilateral = with_quadrilateral && i == QUADRILATERAL;
      const int last = std::count(wrong_rows.begin(), wrong_rows.end(), i) > 0 ? TRIANGLES + 2 : i + 2;
      rows_.add(static_cast<std::uint8_t>(quadrilateral ? 4 : 3)).add(i).add(i + 1);
      if (quadrilateral) rows_.add(++i + 2);
      rows_.add(last);
    }
  }

  LoadedSurface loaded(const TemporaryFolder& folder) const {
    const std::string header = "element vertex " + std::to_string(TRIANGLES + 2) + "\n" + FLOAT_PLACES + "element face " +
                               std::to_string(faces_) + "\nproperty list uchar int vertex_indices\n";
    return loadSurface(folder.write("a.ply", plyFile(false, header, rows_)), Vector3::Ones(), {}, Mending::OFF);
  }

 private:
  NumberBytes rows_;
  int faces_ = 0;
};

TEST(BinaryPlyFaces, ManyKeepTheirOrder) {
  const TemporaryFolder folder;
  for (const bool with_quadrilateral : {false, true}) {
    const LoadedSurface surface = Ribbon(with_quadrilateral).loaded(folder);
    ASSERT_EQ(surface.mesh->vertices.size(), static_cast<std::size_t>(Ribbon::TRIANGLES + 2));
    ASSERT_EQ(surface.mesh->elements.size(), static_cast<std::size_t>(Ribbon::TRIANGLES));
    for (int i = 0; i < Ribbon::TRIANGLES; ++i) {
      if (with_quadrilateral && i / 2 == Ribbon::QUADRILATERAL / 2) continue;
      ASSERT_EQ(surface.mesh->elements[i], Vector3i(i, i + 1, i + 2));
    }
  }
}

TEST(BinaryPlyFaces, TheFirstWrongOneIsTold) {
  const TemporaryFolder folder;
  for (int attempt = 0; attempt < 5; ++attempt) {
    const std::string text = refusal([&] { Ribbon(false, {49000, 40000, 17000, 17001}).loaded(folder); });
    EXPECT_NE(text.find("face 17000 names vertex 50002"), std::string::npos) << text;
  }
}

struct BadRows {
  std::string count_type, index_type;
  NumberBytes face;
  const char* words;
};

class BadBinaryPly : public testing::TestWithParam<BadRows> {};

TEST_P(BadBinaryPly, IsRefusedInOneLine) {
  const BadRows& bad = GetParam();
  const std::string header =
      "element vertex 3\n" + FLOAT_PLACES + "element face 1\nproperty list " + bad.count_type + " " + bad.index_type + " vertex_indices\n";
  const TemporaryFolder folder;
  const std::string name = folder.write("a.ply", plyFile(false, header, unitTriangle()) + bad.face.bytes());
  const std::string text = refusal([&] { loadSurface(name); });
  EXPECT_TRUE(isOneLineWith(text, {name, bad.words})) << text;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadBinaryPly,
    testing::Values(BadRows{"char", "int", NumberBytes().add(std::int8_t{-3}).add(0).add(1).add(2), "a list of -3 values"},
                    BadRows{"uchar", "int", NumberBytes().add(std::uint8_t{3}).add(0).add(1).add(3), "face 0 names vertex 3"},
                    BadRows{"uchar", "int", NumberBytes().add(std::uint8_t{3}).add(0).add(-1).add(2), "face 0 names vertex -1"},
                    BadRows{"uchar", "float", NumberBytes().add(std::uint8_t{3}).add(0.f).add(1.f).add(std::nanf("")),
                            "face 0 names vertex nan"},
                    BadRows{"uchar", "int", NumberBytes().add(std::uint8_t{3}).add(0).add(1), "1 rows of element face announced, 0 there"},
                    BadRows{"uint", "int", NumberBytes().add(4000000000u), "1 rows of element face announced, 0 there"}));

}  // namespace
}  // namespace blem_sim::model
