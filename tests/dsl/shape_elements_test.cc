// Every built-in shape is made from its element, and what makes no sense is refused at the attribute, each with its
// sentence.  Files of meshes and heights are found from the folder of the file in which they are named.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dsl/height_rows.h"
#include "dsl/mesh_file.h"
#include "dsl/read_stack.h"
#include "framework/geometry/compound.h"
#include "framework/geometry/mesh.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

std::string stackOf(const std::string& shape) {
  return smallStack("<scene><object name=\"thing\" pose=\"0.5 0 0\">" + shape +
                    "</object></scene><level priority=\"1\"><posture name=\"rest\" joints=\"arm\"/></level>");
}

dsl::Stack read(const std::string& shape) {
  static control::Registry registry = makeRegistry();             // what is read points into it
  return dsl::readStack(writeFile("shape.xml", stackOf(shape)), registry, readOptions());
}

double distance(const std::string& shape, const Vector3d& p) {
  return read(shape).objects.at(0).object.primitives.at(0).shape->distance(p).distance;
}

TEST(ShapeElements, AreMadeWithTheirMeasures) {
  EXPECT_NEAR(distance("<cone radius='0.3' length='0.4'/>", {0, 0, 0.25}), 0.05, 1e-15);
  EXPECT_NEAR(distance("<cone radius='0.3' top-radius='0.1' length='0.4'/>", {0.05, 0, 0.25}), 0.05, 1e-15);
  EXPECT_NEAR(distance("<ellipsoid radii='0.1 0.2 0.3'/>", {0, 0.25, 0}), 0.05, 1e-15);
  EXPECT_NEAR(distance("<torus radius='0.1' tube-radius='0.02'/>", {-0.15, 0, 0}), 0.03, 1e-15);
  EXPECT_NEAR(distance("<torus radius='0.1' tube-radius='0.02' angle='3.141592653589793'/>", {-0.05, 0.1, 0}), 0.03,
              1e-15);
  EXPECT_NEAR(distance("<extrusion outline='0 0; 0.2 0; 0.2 0.1; 0 0.1' length='0.5'/>", {0.25, 0.05, 0.2}), 0.05,
              1e-15);
  EXPECT_NEAR(distance("<revolution profile='0.1 0; 0.2 0; 0.2 0.1; 0.1 0.1'/>", {0, 0, 0.05}), 0.1, 1e-15);
  EXPECT_NEAR(distance("<heights rows='0.1 0.1; 0.1 0.1' spacing='0.3 0.3' cell='0.03'/>", {0, 0, 0.15}), 0.05, 1e-6);
  EXPECT_NEAR(distance("<heights rows='0.1 0.1; 0.1 0.1' spacing='0.3 0.3' base='-0.1' cell='0.03'/>", {0, 0, -0.15}),
              0.05, 1e-6);
}

/// A box of two units, its faces quadrilaterals.
const char* const box_obj =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string boxStl() {
  const geometry::TriangleMesh box = dsl::readMeshFile(writeFile("box.obj", box_obj));
  std::string text = "solid box\n";
  const auto vertex = [&](int i) {
    const Vector3d& v = box.vertices[i];
    text += "vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  };
  for (const auto& triangle : box.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int i : triangle) vertex(i);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid box\n";
}

TEST(MeshElement, ReadsObjAndStl) {
  writeFile("box.obj", box_obj);
  writeFile("box.stl", boxStl());
  for (const char* file : {"box.obj", "box.stl"}) {
    const dsl::Stack stack = read("<mesh file='" + std::string(file) + "' scale='0.05' cell='0.005'/>");
    const auto& mesh = dynamic_cast<const geometry::Mesh&>(*stack.objects[0].object.primitives[0].shape);
    EXPECT_NEAR(mesh.exactDistance({0, 0.08, 0}).distance, 0.03, 1e-9) << file;
    EXPECT_NEAR(mesh.distance({0, 0.06, 0}).distance, 0.01, 1e-6) << file;
    EXPECT_NEAR(mesh.exactDistance({0.01, 0, 0}).distance, -0.04, 1e-9) << file;
    EXPECT_DOUBLE_EQ(mesh.cell(), 0.005);
  }
}

TEST(MeshElement, FileIsFoundFromTheFolderOfTheFileThatNamesIt) {
  const std::string inner = std::filesystem::path(writeFile("shape.xml", "")).parent_path().string() + "/inner";
  std::filesystem::create_directories(inner);
  std::ofstream(inner + "/only_here.obj") << box_obj;
  std::ofstream(inner + "/scene.xml")
      << "<stack><scene><object name='block'><mesh file='only_here.obj' cell='0.2'/></object></scene></stack>";
  static control::Registry registry = makeRegistry();             // what is read points into it
  const std::string stack = smallStack("<include file=\"inner/scene.xml\"/>"
                                       "<level priority=\"1\"><posture name=\"rest\" joints=\"arm\"/></level>");
  const dsl::Stack read = dsl::readStack(writeFile("outer.xml", stack), registry, readOptions());
  EXPECT_EQ(read.objects.at(0).object.primitives.size(), 1u);

  // What is resolved stands elsewhere, and still finds it.
  const std::string resolved = dsl::writeResolved(read);
  const auto full = std::filesystem::absolute(inner + "/only_here.obj").lexically_normal();
  EXPECT_THAT(resolved, HasSubstr("file=\"" + full.string() + "\""));
  EXPECT_NO_THROW(dsl::readStack(writeFile("resolved.xml", resolved), registry, readOptions()));
}

TEST(HeightsElement, ReadsAFile) {
  writeFile("ground.txt", "0.1 0.1 0.1\n\n0.1, 0.1, 0.1\r\n");
  EXPECT_NEAR(distance("<heights file='ground.txt' spacing='0.1 0.3' cell='0.03'/>", {0, 0, 0.15}), 0.05, 1e-6);
}

TEST(HeightRows, ByHand) {
  const Eigen::MatrixXd rows = dsl::parseRows("1 2 3; 4,5 , 6 ;", ';');
  ASSERT_EQ(rows.rows(), 2);
  ASSERT_EQ(rows.cols(), 3);
  EXPECT_EQ(rows(0, 2), 3);
  EXPECT_EQ(rows(1, 0), 4);
}

/// The message of the only error, and the text of the attribute under its caret.
std::pair<std::string, std::string> refusal(const std::string& shape) {
  try {
    read(shape);
  } catch (const dsl::InvalidStack& invalid) {
    EXPECT_EQ(invalid.diagnostics.size(), 1u) << shape;
    const dsl::Diagnostic& first = invalid.diagnostics.front();
    EXPECT_EQ(first.code, "E061") << first.message;
    const std::string text = stackOf(shape);
    std::size_t at = 0;
    for (int line = 1; line < first.place.line; ++line) at = text.find('\n', at) + 1;
    at += static_cast<std::size_t>(first.place.column) - 1;
    return {first.message, text.substr(at, text.find('\'', at) - at)};
  }
  return {"accepted", ""};
}

void expectRefused(const std::string& shape, const std::string& message, const std::string& at) {
  const auto [said, caret] = refusal(shape);
  EXPECT_THAT(said, HasSubstr(message)) << shape;
  EXPECT_EQ(caret, at) << shape;
}

TEST(ShapeElements, RefuseWhatMakesNoSense) {
  expectRefused("<cone radius='0' length='0.1'/>", "the larger radius of a cone is finite and > 0", "0");
  expectRefused("<ellipsoid radii='1 0.0005 1'/>", "at most 1000 times the shortest", "1 0.0005 1");
  expectRefused("<torus radius='0.1' tube-radius='0.2'/>", "no thicker than its circle", "0.2");
  expectRefused("<torus radius='0.1' tube-radius='0.02' angle='6.1'/>", "the two ends of a torus keep clear", "6.1");
  expectRefused("<extrusion outline='0 0; 1 1; 1 0; 0 1' length='1'/>", "the outline meets itself: its edge between",
                "0 0; 1 1; 1 0; 0 1");
  expectRefused("<extrusion outline='0 0; 1 1' length='1'/>", "three corners or more, not 2", "0 0; 1 1");
  expectRefused("<revolution profile='-1 0; 1 0; 1 1'/>", "corner 1 of the outline lies across the axis",
                "-1 0; 1 0; 1 1");
  expectRefused("<heights rows='1 2; 3' spacing='1 1'/>", "row 2 has 1 number, those before it 2", "1 2; 3");
  expectRefused("<heights rows='1 2; 3 x' spacing='1 1'/>", "row 2: what stands at place 2 is not a finite number",
                "1 2; 3 x");
  expectRefused("<heights rows='1 2' spacing='1 1'/>", "two rows and two columns or more", "1 2");
  expectRefused("<heights rows='1 2; 3 0' spacing='1 1'/>", "every height lies above the base", "1 2; 3 0");
  expectRefused("<heights rows='1 2; 3 4' spacing='1 1' cell='1e-6'/>", "more than 4 million nodes", "1e-6");
  expectRefused("<heights file='none.txt' spacing='1 1'/>", "none.txt", "none.txt");
}

TEST(MeshElement, RefusesWhatBoundsNoSolid) {
  expectRefused("<mesh file='none.obj'/>", "none.obj", "none.obj");
  expectRefused("<mesh file='shape.xml'/>", "is neither an OBJ nor a STL file", "shape.xml");
  writeFile("empty.obj", "# nothing\n");
  expectRefused("<mesh file='empty.obj'/>", "empty.obj'", "empty.obj");
  writeFile("noise.stl", "\x01\x02 no solid");
  expectRefused("<mesh file='noise.stl'/>", "cannot be read as a mesh", "noise.stl");
  const std::string text = box_obj;
  writeFile("open.obj", text.substr(0, text.rfind("f ")));
  expectRefused("<mesh file='open.obj'/>", "the mesh is not closed: 4 edges have a triangle on one side only",
                "open.obj");
  writeFile("turned.obj", text.substr(0, text.rfind("f ")) + "f 8 5 1 4\n");
  expectRefused("<mesh file='turned.obj'/>", "the triangles do not agree which side is outside: at 4 edges",
                "turned.obj");
  writeFile("box.obj", box_obj);
  expectRefused("<mesh file='box.obj' cell='1e-4'/>", "more than 4 million nodes", "1e-4");
}

TEST(MeshFile, OpensNothingElse) {
  const std::string with_material = "mtllib /etc/passwd\nusemtl x\n" + std::string(box_obj);
  EXPECT_EQ(dsl::readMeshFile(writeFile("material.obj", with_material)).triangles.size(), 12u);
}

}  // namespace
}  // namespace tactus::dsl_test
