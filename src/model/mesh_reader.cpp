#include <assimp/config.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "checks/file_check.h"
#include "ply/ply_rows.h"
#include "soup/soup_faces.h"
#include "soup/surface_soup.h"

namespace blem_sim::model {
namespace {

using Matrix4 = Eigen::Matrix4d;

Matrix4 toMatrix(const aiMatrix4x4& m) {
  Matrix4 matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return matrix;
}

/** assimp's readers pass indices on unchecked. */
void checkIndices(const std::string& file, const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned c = 0; c < mesh.mFaces[f].mNumIndices; ++c)
        if (mesh.mFaces[f].mIndices[c] >= mesh.mNumVertices)
          throw InputError(fmt::format("{}: face {} names vertex {}, but there are only {}; write the file anew", file, f,
                                       static_cast<int>(mesh.mFaces[f].mIndices[c]), mesh.mNumVertices));
  }
}

/** Gathers the meshes of a scene. */
class SoupBuilder {
 public:
  SoupBuilder(const aiScene& scene, SurfaceSoup* soup) : scene_(scene), soup_(*soup), faces_(1, SoupFaces(&soup->mesh.vertices)) {}

  void appendNode(const aiNode& node, const Matrix4& X_MP) {
    const Matrix4 X_MN = X_MP * toMatrix(node.mTransformation);
    for (unsigned m = 0; m < node.mNumMeshes; ++m) appendMesh(*scene_.mMeshes[node.mMeshes[m]], X_MN);
    for (unsigned c = 0; c < node.mNumChildren; ++c) appendNode(*node.mChildren[c], X_MN);
  }

  /** The last call: the soup gets its faces. */
  void finish() { SoupFaces::give(std::move(faces_), &soup_); }

 private:
  void appendMesh(const aiMesh& mesh, const Matrix4& X_MN) {
    const int first = static_cast<int>(soup_.mesh.vertices.size());
    makeRoom(mesh.mNumVertices, &soup_.mesh.vertices);
    faces_.front().makeRoom(mesh.mNumFaces);
    const bool moved = X_MN != Matrix4::Identity();
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const Vector3 p(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z);
      soup_.mesh.vertices.push_back(moved ? Vector3(X_MN.topLeftCorner<3, 3>() * p + X_MN.topRightCorner<3, 1>()) : p);
    }
    const bool mirrored = X_MN.topLeftCorner<3, 3>().determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) appendFace(mesh.mFaces[f], first, mirrored);
  }

  /** A mirroring node turns the winding, so that outside stays outside. */
  void appendFace(const aiFace& face, int first, bool mirrored) {
    corners_.assign(face.mIndices, face.mIndices + face.mNumIndices);
    for (int& corner : corners_) corner += first;
    if (mirrored) std::reverse(corners_.begin(), corners_.end());
    faces_.front().append(corners_);
  }

  const aiScene& scene_;
  SurfaceSoup& soup_;
  std::vector<SoupFaces> faces_;  // one list
  std::vector<int> corners_;      // of the face at hand
};

/** Refuses a PLY of fewer vertices or faces than its header announces: assimp ends early without a word where rows are missing. */
void checkPlyArrived(const std::string& file, const PlyHeader& announced, const aiScene& scene) {
  std::size_t vertices = 0, faces = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    vertices += scene.mMeshes[m]->mNumVertices;
    faces += scene.mMeshes[m]->mNumFaces;
  }
  if (vertices < announced.countOf("vertex") || faces < announced.countOf("face"))
    throw InputError(fmt::format("{}: truncated PLY: {} vertices and {} faces announced, {} and {} there; write the file anew", file,
                                 announced.countOf("vertex"), announced.countOf("face"), vertices, faces));
}

}  // namespace

SurfaceSoup readMesh(const std::string& file, const std::string& extension) {
  SurfaceSoup soup;
  std::string bytes = readBytes(file);
  PlyHeader announced;
  if (extension == "stl") checkStl(file, &bytes, &soup.notes);
  if (extension == "off") checkOff(file, &bytes);
  if (extension == "dae") checkCollada(file, bytes);
  if (extension == "ply") {
    announced = readPlyHeader(file, bytes);
    if (announced.format != PlyHeader::Format::ASCII) return readBinaryPly(file, bytes, announced);
    checkAsciiPly(file, bytes, announced);
  }

  Assimp::Importer importer;
  // Root transformation: units stay, the turn to y-up goes, see loadSurface.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
  if (!scene || !scene->mRootNode || scene->mNumMeshes == 0) {
    const std::string reason = scene ? "it holds no mesh" : geometry::oneLine(importer.GetErrorString());
    throw InputError(fmt::format("{}: not a readable {} mesh: {}; export it again", file, extension, reason));
  }
  std::string().swap(bytes);  // the scene has its own copy
  if (extension == "ply") checkPlyArrived(file, announced, *scene);
  checkIndices(file, *scene);
  SoupBuilder builder(*scene, &soup);
  builder.appendNode(*scene->mRootNode, Matrix4::Identity());
  builder.finish();
  soup.width = static_cast<int>(soup.mesh.vertices.size());
  return soup;
}

}  // namespace blem_sim::model
