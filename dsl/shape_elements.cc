#include "dsl/shape_elements.h"

#include <stdexcept>

#include "dsl/file_value.h"
#include "dsl/height_rows.h"
#include "dsl/mesh_file.h"
#include "framework/geometry/cone.h"
#include "framework/geometry/ellipsoid.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/heights.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/primitives.h"
#include "framework/geometry/revolution.h"
#include "framework/geometry/torus.h"
#include "framework/runtime/file_error.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementError;
using control::ElementValues;
using control::ValueType;
using ShapePointer = std::shared_ptr<const geometry::Shape>;

AttributeRow positiveLength(const std::string& name, const std::string& description) {
  return {.name = name, .type = ValueType::real, .unit = "m", .required = true, .description = description, .lower = 0,
          .lower_open = true};
}

AttributeRow corners(const std::string& name, const std::string& description) {
  return {.name = name, .type = ValueType::points, .unit = "m", .required = true, .description = description,
          .count = 2};
}

std::vector<Eigen::Vector2d> pairs(const std::vector<double>& numbers) {
  std::vector<Eigen::Vector2d> found;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) found.emplace_back(numbers[i], numbers[i + 1]);
  return found;
}

/// What `make` makes; what it refuses is told at the attribute.
template <class Make>
auto at(const std::string& attribute, Make make) {
  try {
    return make();
  } catch (const std::runtime_error& error) {
    throw ElementError(attribute, error.what());
  } catch (const std::invalid_argument& error) {
    throw ElementError(attribute, error.what());
  }
}

AttributeRow cellRow() {
  return {.name = "cell", .type = ValueType::real, .unit = "m",
          .description = "Edge length of the cells in which distances are interpolated; not given: as fine as 300 000 "
                         "nodes allow. What is thinner than a cell is rounded off.",
          .lower = 0, .lower_open = true};
}

ShapePointer meshOf(const geometry::TriangleMesh& triangles, const ElementValues& values) {
  const double cell = values.has("cell") ? values.real("cell") : 0;
  return at("cell", [&] { return std::make_shared<geometry::Mesh>(triangles, cell); });
}

void addPrimitives(control::Registry& registry) {
  registry.addShape({.name = "plane", .description = "The half space below z = 0 of its own frame."},
                    [](const ElementValues&) -> ShapePointer { return std::make_shared<geometry::Plane>(); });
  registry.addShape({.name = "box",
                     .description = "A box about its own origin.",
                     .attributes = {{.name = "size",
                                     .type = ValueType::reals,
                                     .unit = "m",
                                     .required = true,
                                     .description = "Full lengths of its edges along x y z.",
                                     .lower = 0,
                                     .lower_open = true,
                                     .count = 3}}},
                    [](const ElementValues& values) -> ShapePointer {
                      return std::make_shared<geometry::Box>(values.vector3("size"));
                    });
  registry.addShape({.name = "sphere",
                     .description = "A sphere about its own origin.",
                     .attributes = {positiveLength("radius", "Its radius.")}},
                    [](const ElementValues& values) -> ShapePointer {
                      return std::make_shared<geometry::Sphere>(values.real("radius"));
                    });
  registry.addShape(
      {.name = "cylinder",
       .description = "A cylinder along z about its own origin.",
       .attributes = {positiveLength("radius", "Its radius."), positiveLength("length", "Its full height.")}},
      [](const ElementValues& values) -> ShapePointer {
        return std::make_shared<geometry::Cylinder>(values.real("radius"), values.real("length"));
      });
  registry.addShape(
      {.name = "capsule",
       .description = "A capsule along z about its own origin.",
       .attributes = {positiveLength("radius", "Its radius."), positiveLength("length", "Of its straight part.")}},
      [](const ElementValues& values) -> ShapePointer {
        return std::make_shared<geometry::Capsule>(values.real("radius"), values.real("length"));
      });
}

void addRound(control::Registry& registry) {
  registry.addShape(
      {.name = "cone",
       .description = "A cone along z, whole or truncated, about the middle of its axis.",
       .attributes = {{.name = "radius", .type = ValueType::real, .unit = "m", .required = true,
                       .description = "At its lower end.", .lower = 0},
                      {.name = "top-radius", .type = ValueType::real, .unit = "m", .default_text = "0",
                       .description = "At its upper end; 0 = a tip.", .lower = 0},
                      positiveLength("length", "Its full height.")}},
      [](const ElementValues& values) -> ShapePointer {
        const double bottom = values.real("radius"), top = values.real("top-radius");
        return at("radius", [&] { return std::make_shared<geometry::Cone>(bottom, top, values.real("length")); });
      });
  registry.addShape(
      {.name = "ellipsoid",
       .description = "An ellipsoid about its own origin.",
       .source = "D. Eberly, Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid (2013)",
       .attributes = {{.name = "radii", .type = ValueType::reals, .unit = "m", .required = true,
                       .description = "Its half axes along x y z, the longest at most 1000 times the shortest.",
                       .lower = 0, .lower_open = true, .count = 3}}},
      [](const ElementValues& values) -> ShapePointer {
        return at("radii", [&] { return std::make_shared<geometry::Ellipsoid>(values.vector3("radii")); });
      });
  registry.addShape(
      {.name = "torus",
       .description = "What a ball sweeps along an arc about z, in the plane z = 0, half of it either side of x: a "
                      "ring, or a bent rod with round ends.",
       .attributes = {positiveLength("radius", "Of the arc."),
                      positiveLength("tube-radius", "Of the ball, at most that of the arc."),
                      {.name = "angle", .type = ValueType::real, .unit = "rad", .default_text = "6.283185307179586",
                       .description = "How far the arc goes; 2π (to a thousandth) = a ring. The two ends of what goes "
                                      "less far keep clear of each other.",
                       .lower = 0, .upper = 6.29, .lower_open = true}}},
      [](const ElementValues& values) -> ShapePointer {
        const double radius = values.real("radius"), tube = values.real("tube-radius"), angle = values.real("angle");
        return at(tube > radius ? "tube-radius" : "angle",
                  [&] { return std::make_shared<geometry::Torus>(radius, tube, angle); });
      });
}

/// Drawn as a polygon.
void addDrawn(control::Registry& registry) {
  registry.addShape(
      {.name = "extrusion",
       .description = "A prism along z over a polygon, convex or not, the middle of its height at z = 0.",
       .attributes = {corners("outline", "Its corners x y one after another, either way round; its edges meet in the "
                                         "corners only."),
                      positiveLength("length", "Its full height.")}},
      [](const ElementValues& values) -> ShapePointer {
        const auto outline = pairs(values.numbers("outline"));
        return at("outline", [&] { return std::make_shared<geometry::Extrusion>(outline, values.real("length")); });
      });
  registry.addShape(
      {.name = "revolution",
       .description = "What a polygon sweeps in a whole turn about z: cups, bowls, bottles.",
       .attributes = {corners("profile", "Its corners r z one after another, either way round, r from the axis and not "
                                         "below 0; its edges meet in the corners only.")}},
      [](const ElementValues& values) -> ShapePointer {
        const auto profile = pairs(values.numbers("profile"));
        return at("profile", [&] { return std::make_shared<geometry::Revolution>(profile); });
      });
}

/// The rows of <heights>, of the attribute or of the file.
Eigen::MatrixXd rowsOf(const ElementValues& values) {
  if (values.has("rows")) return parseRows(values.text("rows"), ';');
  return parseRows(runtime::readFile(fileOf(values.value("file"))), '\n');
}

/// Distances of these are interpolated.
void addSampled(control::Registry& registry) {
  registry.addShape(
      {.name = "heights",
       .description = "Ground of given heights above z = 0, flat between them, down to a base; the middle of the field "
                      "lies at the origin. Distances are interpolated.",
       .attributes = {{.name = "rows", .type = ValueType::text, .unit = "m",
                       .description = "Heights, numbers in two or more rows separated by ';', all of one length: along "
                                      "x, the rows one after another along y."},
                      {.name = "file", .type = ValueType::file,
                       .description = "A text file with the rows, one a line, numbers separated by blanks or commas; "
                                      "found from the folder of the file in which it is named."},
                      {.name = "spacing", .type = ValueType::reals, .unit = "m", .required = true,
                       .description = "From height to height along x and along y.",
                       .lower = 0, .lower_open = true, .count = 2},
                      {.name = "base", .type = ValueType::real, .unit = "m", .default_text = "0",
                       .description = "Where the ground ends below; every height lies above it."},
                      cellRow()},
       .presence = {{control::Presence::one_of, {"rows", "file"}}}},
      [](const ElementValues& values) -> ShapePointer {
        const std::vector<double>& spacing = values.numbers("spacing");
        const geometry::TriangleMesh triangles = at(values.has("rows") ? "rows" : "file", [&] {
          return geometry::heightMesh(rowsOf(values), {spacing[0], spacing[1]}, values.real("base"));
        });
        return meshOf(triangles, values);
      });
  registry.addShape(
      {.name = "mesh",
       .description = "The solid that the triangles of a file bound. They are closed, and counter-clockwise when "
                      "looked at from outside. Distances are interpolated.",
       .source = "J. A. Baerentzen, H. Aanaes, Signed distance computation using the angle weighted pseudonormal "
                 "(2005)",
       .attributes = {{.name = "file", .type = ValueType::file, .required = true,
                       .description = "An OBJ or STL file, found from the folder of the file in which it is named."},
                      {.name = "scale", .type = ValueType::real, .unit = "1", .default_text = "1",
                       .description = "Metres per unit of the file: 0.001 for one in millimetres.",
                       .lower = 0, .lower_open = true},
                      cellRow()}},
      [](const ElementValues& values) -> ShapePointer {
        const geometry::TriangleMesh triangles = at("file", [&] {
          geometry::TriangleMesh read = readMeshFile(fileOf(values.value("file")));
          for (Eigen::Vector3d& vertex : read.vertices) vertex *= values.real("scale");
          geometry::requireClosed(read);
          return read;
        });
        return meshOf(triangles, values);
      });
}

}  // namespace

void addShapeElements(control::Registry& registry) {
  addPrimitives(registry);
  addRound(registry);
  addDrawn(registry);
  addSampled(registry);
}

}  // namespace tactus::dsl
