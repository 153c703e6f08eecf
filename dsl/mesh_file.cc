#include "dsl/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "framework/runtime/file_error.h"

namespace tactus::dsl {
namespace {

constexpr unsigned most_triangles = 1'000'000;

/// Materials and textures that a mesh names are not wanted.
class NoFiles final : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

/// "obj", "stl" or another; without the dot.
std::string endingOf(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending.empty() ? ending : ending.substr(1);
}

void append(const aiMesh& part, geometry::TriangleMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i)
    mesh.vertices.emplace_back(part.mVertices[i].x, part.mVertices[i].y, part.mVertices[i].z);
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;                           // points and lines bound nothing
    mesh.triangles.push_back({first + static_cast<int>(face.mIndices[0]), first + static_cast<int>(face.mIndices[1]),
                              first + static_cast<int>(face.mIndices[2])});
  }
}

}  // namespace

geometry::TriangleMesh readMeshFile(const std::string& file) {
  const std::string ending = endingOf(file);
  if (ending != "obj" && ending != "stl")
    throw std::runtime_error("'" + file + "' is neither an OBJ nor a STL file: expected the ending .obj or .stl");
  const std::string content = runtime::readFile(file);
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);                              // the importer's own from now on
  const aiScene* scene =
      importer.ReadFileFromMemory(content.data(), content.size(), aiProcess_Triangulate, ending.c_str());
  if (!scene) throw std::runtime_error("'" + file + "' cannot be read as a mesh: " + importer.GetErrorString());
  geometry::TriangleMesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(*scene->mMeshes[i], mesh);
  if (mesh.triangles.empty()) throw std::runtime_error("'" + file + "' holds no triangles");
  if (mesh.triangles.size() > most_triangles)
    throw std::runtime_error("'" + file + "' holds more than a million triangles: simplify it");
  return geometry::welded(mesh);
}

}  // namespace tactus::dsl
