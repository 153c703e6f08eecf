#include "dsl/shape_elements.h"

#include "framework/geometry/primitives.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementValues;
using control::ValueType;
using ShapePointer = std::shared_ptr<const geometry::Shape>;

AttributeRow positiveLength(const std::string& name, const std::string& description) {
  return {.name = name, .type = ValueType::real, .unit = "m", .required = true, .description = description, .lower = 0,
          .lower_open = true};
}

}  // namespace

void addShapeElements(control::Registry& registry) {
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

}  // namespace tactus::dsl
