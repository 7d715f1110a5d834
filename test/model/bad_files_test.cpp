// Damaged files are refused with one line that names the file and the fault; none crashes or allocates memory for all that it announces.
#include <gtest/gtest.h>

#include <cctype>
#include <limits>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

const std::string PLY_XYZ = "property float x\nproperty float y\nproperty float z\n";
const std::string PLY_FACES = "property list uchar int vertex_indices\nend_header\n";
const std::string PLY_ROWS = "0 0 0\n1 0 0\n0 1 0\n";

std::string ply(const std::string& format, const std::string& vertices, const std::string& faces, const std::string& rows) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices + "\n" + PLY_XYZ + "element face " + faces + "\n" + PLY_FACES + rows;
}

std::string pcd(const std::string& points, const std::string& data) {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + points +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data;
}

struct BadFileRow {
  const char* name;
  std::string bytes;
  const char* words;
};

class BadFiles : public testing::TestWithParam<BadFileRow> {};

TEST_P(BadFiles, areRefusedInOneLine) {
  const TemporaryFolder folder;
  const std::string file = folder.write(GetParam().name, GetParam().bytes);
  const std::string text = refusal([&] { loadSurface(file); });
  EXPECT_TRUE(isOneLineWith(text, {file, GetParam().words})) << text;
}

std::string nameOf(const testing::TestParamInfo<BadFileRow>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

const std::string FACET = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

INSTANTIATE_TEST_SUITE_P(
    All, BadFiles,
    testing::Values(
        BadFileRow{"empty.stl", "", "empty"}, BadFileRow{"short.stl", "abc", "truncated"},
        BadFileRow{"zero.stl", std::string(84, '\0'), "no triangle"},
        BadFileRow{"huge.stl", std::string(80, ' ') + "\xff\xff\xff\xff", "4294967295 triangles announced"},
        BadFileRow{"cut.stl", "solid a\n" + FACET + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "truncated"},
        BadFileRow{"nothing.stl", "solid a\nendsolid a\n", "no triangle"}, BadFileRow{"text.ply", "hello", "not a PLY"},
        BadFileRow{"header.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "not a PLY"},
        BadFileRow{"count.ply", ply("ascii", "many", "1", PLY_ROWS), "is not understood"},
        BadFileRow{"huge.ply", ply("ascii", "4000000000", "1", PLY_ROWS + "3 0 1 2\n"), "4000000000 rows of element vertex announced"},
        BadFileRow{"huge_faces.ply", ply("binary_little_endian", "1", "4000000000", std::string(12, '\0')),
                   "4000000000 rows of element face announced"},
        BadFileRow{"rows.ply", ply("ascii", "3", "3", PLY_ROWS + "3 0 1 2\n3 0 1 2\n"), "PLY"},
        BadFileRow{"cut.ply", ply("binary_little_endian", "3", "1", std::string(36, '\0') + "\3" + std::string(4, '\0')), "ply"},
        BadFileRow{"list.ply", ply("binary_little_endian", "1", "1", std::string(12, '\0') + std::string(1, '\xff') + std::string(8, '\1')),
                   "ply"},
        BadFileRow{"range.ply", ply("ascii", "3", "1", PLY_ROWS + "3 0 1 3\n"), "names vertex 3"},
        BadFileRow{"negative.ply", ply("ascii", "3", "1", PLY_ROWS + "3 0 1 -1\n"), "names vertex -1"},
        BadFileRow{"polygon.ply", ply("ascii", "3", "1", PLY_ROWS + "5 0 1 2 77 1\n"), "names vertex 77"},
        BadFileRow{"no_vertex.ply", ply("ascii", "0", "0", ""), "no vertex"}, BadFileRow{"text.off", "hello\n", "not an OFF"},
        BadFileRow{"rows.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "3 vertices announced, 2"},
        BadFileRow{"huge.off", "OFF\n4000000000 1 0\n0 0 0\n", "4000000000 vertices announced"},
        BadFileRow{"faces.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "2 faces announced, 1"},
        BadFileRow{"corner.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "fewer than its 3 corners"},
        BadFileRow{"negative.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "names vertex -2"},
        BadFileRow{"split.off", "OFF 3\n1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "not an OFF"},
        BadFileRow{"dimensions.off", "nOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "not an OFF"},
        BadFileRow{"vertex.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "vertex 1 has not three numbers"},
        BadFileRow{"range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "obj"}, BadFileRow{"text.obj", "hello\n", "obj"},
        BadFileRow{"text.dae", "hello", "dae"}, BadFileRow{"empty.dae", "<COLLADA version=\"1.4.1\"></COLLADA>", "dae"},
        BadFileRow{"text.pcd", "hello", "not a PCD"}, BadFileRow{"zero.pcd", pcd("0", "ascii\n"), "no point"},
        BadFileRow{"header_in_data.pcd", pcd("1", "binary\n") + "COLUMNS a b\n", "its data begin like a row of a header"},
        BadFileRow{"huge.pcd", pcd("4000000000", "binary\n"), "4000000000 points"},
        BadFileRow{"cut.pcd", pcd("3", "binary\n") + "1234", "3 points"},
        BadFileRow{"packed.pcd", pcd("3", "binary_compressed\n") + std::string("\4\0\0\0\44\0\0\0\377\377\377\377", 12), "PCD"},
        BadFileRow{"rows.pcd", pcd("3", "ascii\n") + "0.123 0.123 0.123\n0.123 0.123 0.123\n", "PCD"},
        BadFileRow{"fields.pcd", "FIELDS a b\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2\n",
                   "no field 'x'"},
        BadFileRow{"type.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE I I I\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n",
                   "not a float"},
        BadFileRow{"mesh.step", "ISO-10303-21;", "unknown kind of file '.step'"}, BadFileRow{"mesh", "x", "unknown kind of file '.'"},
        BadFileRow{"flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "nothing is left"}),
    nameOf);

TEST(BadSurfaces, missingFilesAndBadNumbers) {
  const TemporaryFolder folder;
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(folder.path("none.stl")); }), {"none.stl", "no such file"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(folder.path()); }), {folder.path()}));
  const std::string file = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(refusal([&] { loadSurface(file); }), "");
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(file, Vector3(1, 0, 1)); }), {file, "scale"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(file, Vector3(1, std::numeric_limits<double>::infinity(), 1)); }), {file, "scale"}));
  CloudOptions options;
  options.point_radius = 0;
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(file, Vector3::Ones(), options); }), {file, "point_radius"}));
  options = CloudOptions();
  options.max_edge = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(file, Vector3::Ones(), options); }), {file, "max_edge"}));
  options = CloudOptions();
  options.as = CloudOptions::As::MESH;
  const std::string sparse = folder.write("sparse.pcd", pcd("3", "ascii\n") + "0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(sparse, Vector3::Ones(), options); }), {sparse, "max_edge"}));
}

}  // namespace
}  // namespace blem_sim::model
