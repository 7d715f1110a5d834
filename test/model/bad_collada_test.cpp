// A damaged COLLADA file is refused before assimp reads it, where assimp would read on for ever, make room for what is only announced, or
// go round in a circle of nodes.
#include <gtest/gtest.h>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

const std::string INPUT = "<input semantic='VERTEX' source='#v' offset='0'/>";
const std::string FACE = "<triangles count='1'>" + INPUT + "<p>0 1 2</p></triangles>";
const std::string NODE = "<node id='a'><instance_geometry url='#g'/></node>";

/** One triangle, in the faces and nodes told. */
std::string colladaText(const std::string& faces, const std::string& scene = NODE, const std::string& more_nodes = "",
                        const std::string& unit = "1") {
  return "<COLLADA version='1.4.1'><asset><unit meter='" + unit +
         "'/></asset><library_geometries><geometry id='g'><mesh><source id='s'><float_array id='f' count='9'>0 0 0 1 0 0 0 1 "
         "0</float_array>"
         "<technique_common><accessor source='#f' count='3' stride='3'><param name='X' type='float'/><param name='Y' type='float'/>"
         "<param name='Z' type='float'/></accessor></technique_common></source>"
         "<vertices id='v'><input semantic='POSITION' source='#s'/></vertices>" +
         faces + "</mesh></geometry></library_geometries><library_nodes>" + more_nodes +
         "</library_nodes><library_visual_scenes><visual_scene id='w'>" + scene +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

std::string polylist(const std::string& count, const std::string& corners) {
  return "<polylist count='" + count + "'>" + INPUT + "<vcount>" + corners + "</vcount><p>0 1 2</p></polylist>";
}

std::string instanceOf(const std::string& node) { return "<instance_node url='#" + node + "'/>"; }

/** Nodes from the top one down, each of which instances the next so many times; n0 shows the triangle. */
std::string tower(int storeys, int times) {
  std::string nodes;
  for (int i = storeys; i > 0; --i) {
    nodes += "<node id='n" + std::to_string(i) + "'>";
    for (int k = 0; k < times; ++k) nodes += instanceOf("n" + std::to_string(i - 1));
    nodes += "</node>";
  }
  return nodes + "<node id='n0'><instance_geometry url='#g'/></node>";
}

std::string onTop(int storeys) { return "<node id='a'>" + instanceOf("n" + std::to_string(storeys)) + "</node>"; }

TEST(BadCollada, isRefusedInOneLine) {
  const TemporaryFolder folder;
  const auto refusalOf = [&](const std::string& bytes) { return refusal([&] { loadSurface(folder.write("a.dae", bytes)); }); };
  const std::string lines = "<lines count='1'>" + INPUT + "<p>0 x</p></lines>";
  const std::string far_input = "<triangles count='1'><input semantic='VERTEX' source='#v' offset='1000000000'/><p>0 1 2</p></triangles>";
  const struct {
    std::string bytes, words;
  } rows[] = {
      {colladaText("<triangles count='1'>" + INPUT + "<p>0 1.5 2</p></triangles>"), "'1.5' where the number of a vertex belongs"},
      {colladaText("<triangles count='1'>" + INPUT + "<p>0 -1 2</p></triangles>"), "'-1' where the number of a vertex belongs"},
      {colladaText("<triangles count='1'>" + INPUT + "<p>0 1 99999999999</p></triangles>"), "'99999999999'"},
      {colladaText("<polygons count='1'>" + INPUT + "<p>0 1, 2</p></polygons>"), "'1,'"},
      {colladaText(FACE + lines), "<p> has 'x'"},
      {colladaText("<triangles count='2147483647'>" + INPUT + "<p>0 1 2</p></triangles>"), "announces 2147483647 of them"},
      {colladaText(far_input), "an offset beyond the 3 vertices"},
      {colladaText(polylist("1", "x")), "<vcount> has 'x'"},
      {colladaText(polylist("1", "2000000000")), "2000000000 corners"},
      {colladaText(polylist("2000000000", "3")), "announces 2000000000 of them"},
      {colladaText(FACE, "<node id='a'>" + instanceOf("a") + "</node>"), "node 'a' instances itself"},
      {colladaText(FACE, onTop(31), tower(31, 2)), "instance each other more than 1000000 times"},
      {colladaText(FACE, onTop(100000), tower(100000, 1)), "in a row"},
      {colladaText(FACE, NODE, "", "x"), "<unit> needs a number above 0"},
      {colladaText(FACE, NODE, "", "-1"), "<unit> needs a number above 0"},
  };
  for (const auto& row : rows) {
    const std::string text = refusalOf(row.bytes);
    EXPECT_TRUE(isOneLineWith(text, {folder.path("a.dae"), row.words})) << text;
  }
}

TEST(BadCollada, soundOnesThatLookLikeItAreLoaded) {
  const TemporaryFolder folder;
  const auto trianglesIn = [&](const std::string& bytes) { return loadSurface(folder.write("a.dae", bytes)).report.triangles; };
  EXPECT_EQ(trianglesIn(colladaText(FACE)), 1);
  EXPECT_EQ(trianglesIn(colladaText(polylist("1", "3"))), 1);
  const std::string none = "<triangles count='0'>" + INPUT + "<input semantic='VERTEX' source='#v' offset='1'/><p></p></triangles>";
  EXPECT_EQ(trianglesIn(colladaText(none + FACE)), 1);
  EXPECT_EQ(trianglesIn(colladaText(FACE, onTop(6), tower(6, 2))), 1) << "64 at one place";
}

}  // namespace
}  // namespace blem_sim::model
