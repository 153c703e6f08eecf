#include "apps/tactus/foxglove_schemas.h"

#include <string>
#include <utility>
#include <vector>

namespace tactus::app::foxglove {
namespace {

using nlohmann::ordered_json;
using Properties = std::vector<std::pair<std::string, ordered_json>>;

const ordered_json number{{"type", "number"}}, text{{"type", "string"}}, truth{{"type", "boolean"}},
    count{{"type", "integer"}, {"minimum", 0}}, bytes{{"type", "string"}, {"contentEncoding", "base64"}};

ordered_json object(const std::string& title, const Properties& properties) {
  ordered_json json{{"title", title}, {"type", "object"}, {"properties", ordered_json::object()}};
  for (const auto& [name, schema] : properties) {
    json["properties"][name] = schema;
    json["required"].push_back(name);
  }
  return json;
}

ordered_json message(const std::string& name, const Properties& properties) {
  return object("foxglove." + name, properties);
}

ordered_json arrayOf(const ordered_json& items) { return {{"type", "array"}, {"items", items}}; }

/// One of these names, numbered from 0.
ordered_json choice(const std::string& name, const std::vector<std::string>& names) {
  ordered_json json{{"title", "foxglove." + name}, {"oneOf", ordered_json::array()}};
  for (size_t i = 0; i < names.size(); ++i) json["oneOf"].push_back({{"title", names[i]}, {"const", i}});
  return json;
}

/// Seconds and nanoseconds; neither is required.
ordered_json clock(const std::string& title, const ordered_json& seconds) {
  return {{"type", "object"},
          {"title", title},
          {"properties",
           {{"sec", seconds}, {"nsec", {{"type", "integer"}, {"minimum", 0}, {"maximum", 999999999}}}}}};
}

ordered_json time() { return clock("time", count); }
ordered_json duration() { return clock("duration", {{"type", "integer"}}); }

ordered_json vector3() { return message("Vector3", {{"x", number}, {"y", number}, {"z", number}}); }
ordered_json point3() { return message("Point3", {{"x", number}, {"y", number}, {"z", number}}); }
ordered_json quaternion() {
  return message("Quaternion", {{"x", number}, {"y", number}, {"z", number}, {"w", number}});
}
ordered_json pose() { return message("Pose", {{"position", vector3()}, {"orientation", quaternion()}}); }
ordered_json color() { return message("Color", {{"r", number}, {"g", number}, {"b", number}, {"a", number}}); }

ordered_json sceneEntity() {
  const ordered_json
      key_value = message("KeyValuePair", {{"key", text}, {"value", text}}),
      arrow = message("ArrowPrimitive", {{"pose", pose()},
                                         {"shaft_length", number},
                                         {"shaft_diameter", number},
                                         {"head_length", number},
                                         {"head_diameter", number},
                                         {"color", color()}}),
      cube = message("CubePrimitive", {{"pose", pose()}, {"size", vector3()}, {"color", color()}}),
      sphere = message("SpherePrimitive", {{"pose", pose()}, {"size", vector3()}, {"color", color()}}),
      cylinder = message("CylinderPrimitive", {{"pose", pose()},
                                               {"size", vector3()},
                                               {"bottom_scale", number},
                                               {"top_scale", number},
                                               {"color", color()}}),
      line = message("LinePrimitive", {{"type", choice("LineType", {"LINE_STRIP", "LINE_LOOP", "LINE_LIST"})},
                                       {"pose", pose()},
                                       {"thickness", number},
                                       {"scale_invariant", truth},
                                       {"points", arrayOf(point3())},
                                       {"color", color()},
                                       {"colors", arrayOf(color())},
                                       {"indices", arrayOf(count)}}),
      triangles = message("TriangleListPrimitive", {{"pose", pose()},
                                                    {"points", arrayOf(point3())},
                                                    {"color", color()},
                                                    {"colors", arrayOf(color())},
                                                    {"indices", arrayOf(count)}}),
      label = message("TextPrimitive", {{"pose", pose()},
                                        {"billboard", truth},
                                        {"font_size", number},
                                        {"scale_invariant", truth},
                                        {"color", color()},
                                        {"text", text}}),
      model = message("ModelPrimitive", {{"pose", pose()},
                                         {"scale", vector3()},
                                         {"color", color()},
                                         {"override_color", truth},
                                         {"url", text},
                                         {"media_type", text},
                                         {"data", bytes}});
  return message("SceneEntity", {{"timestamp", time()},
                                 {"frame_id", text},
                                 {"id", text},
                                 {"lifetime", duration()},
                                 {"frame_locked", truth},
                                 {"metadata", arrayOf(key_value)},
                                 {"arrows", arrayOf(arrow)},
                                 {"cubes", arrayOf(cube)},
                                 {"spheres", arrayOf(sphere)},
                                 {"cylinders", arrayOf(cylinder)},
                                 {"lines", arrayOf(line)},
                                 {"triangles", arrayOf(triangles)},
                                 {"texts", arrayOf(label)},
                                 {"models", arrayOf(model)}});
}

}  // namespace

ordered_json frameTransforms() {
  const ordered_json transform = message("FrameTransform", {{"timestamp", time()},
                                                            {"parent_frame_id", text},
                                                            {"child_frame_id", text},
                                                            {"translation", vector3()},
                                                            {"rotation", quaternion()}});
  return message("FrameTransforms", {{"transforms", arrayOf(transform)}});
}

ordered_json sceneUpdate() {
  const ordered_json kind = choice("SceneEntityDeletionType", {"MATCHING_ID", "ALL"});
  const ordered_json deletion = message("SceneEntityDeletion", {{"timestamp", time()}, {"type", kind}, {"id", text}});
  return message("SceneUpdate", {{"deletions", arrayOf(deletion)}, {"entities", arrayOf(sceneEntity())}});
}

ordered_json pointCloud() {
  const ordered_json numeric = choice("NumericType", {"UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32",
                                                      "FLOAT32", "FLOAT64"});
  const ordered_json field = message("PackedElementField", {{"name", text}, {"offset", count}, {"type", numeric}});
  return message("PointCloud", {{"timestamp", time()},
                                {"frame_id", text},
                                {"pose", pose()},
                                {"point_stride", count},
                                {"fields", arrayOf(field)},
                                {"data", bytes}});
}

}  // namespace tactus::app::foxglove
