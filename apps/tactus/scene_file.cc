#include "apps/tactus/scene_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/tactus/run_folder.h"
#include "apps/tactus/text.h"
#include "framework/dynamics/kinematics.h"
#include "framework/geometry/surface.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

constexpr size_t most_triangles = 40000;                           ///< of an object

double micrometres(double metres) { return std::round(metres * 1e6) / 1e6 + 0.0; }

ordered_json toJson(const Eigen::Vector3d& p) { return {micrometres(p.x()), micrometres(p.y()), micrometres(p.z())}; }

ordered_json toJson(const Eigen::Isometry3d& pose) {
  ordered_json json = toJson(Eigen::Vector3d(pose.translation()));
  const Eigen::Quaterniond q(pose.linear());
  for (const double number : {q.w(), q.x(), q.y(), q.z()}) json.push_back(micrometres(number));
  return json;
}

void add(ordered_json& link, const description::CapsuleShape& capsule) {
  link["capsules"].push_back({{"from", toJson(capsule.from)}, {"to", toJson(capsule.to)}, {"radius", capsule.radius}});
}

void add(ordered_json& link, const description::BoxShape& box) {
  link["boxes"].push_back({{"pose", toJson(box.pose)}, {"size", toJson(box.size)}});
}

/// With fewer triangles: vertices of one cell become one, in cells as large as it takes.
geometry::TriangleMesh simplified(const geometry::TriangleMesh& mesh, size_t most) {
  geometry::TriangleMesh coarse = mesh;
  double size = 0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) size = std::max(size, vertex.cwiseAbs().maxCoeff());
  for (double cell = size / 512; coarse.triangles.size() > most; cell *= 1.3) {
    coarse = mesh;
    for (Eigen::Vector3d& vertex : coarse.vertices) vertex = (vertex / cell).array().round() * cell;
    coarse = geometry::welded(coarse);
  }
  return coarse;
}

void addSurface(ordered_json& json, const description::Object& object) {
  const geometry::TriangleMesh whole = geometry::surfaceOf(object.primitives);
  const geometry::TriangleMesh mesh = simplified(whole, most_triangles);
  if (mesh.triangles.size() < whole.triangles.size()) json["simplified_from"] = whole.triangles.size();
  json["vertices"] = ordered_json::array();
  json["triangles"] = ordered_json::array();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    for (const double number : vertex) json["vertices"].push_back(micrometres(number));
  for (const auto& triangle : mesh.triangles)
    for (const int index : triangle) json["triangles"].push_back(index);
}

}  // namespace

void writeScene(const std::string& path, const Session& session) {
  const description::Robot& robot = session.stack().robot;
  const dynamics::Model& model = session.controller().model();
  dynamics::Workspace workspace(model);
  dynamics::forwardKinematics(model, session.plant().truth().q, workspace);
  ordered_json links = ordered_json::array();
  for (size_t i = 0; i < robot.links.size(); ++i) {
    if (robot.links[i].shapes.empty()) continue;
    const std::string& name = robot.links[i].name;
    const bool feels = std::find(robot.skin.begin(), robot.skin.end(), name) != robot.skin.end();
    ordered_json link{{"name", name},
                      {"skin", feels},
                      {"pose", toJson(dynamics::framePose(model, workspace, static_cast<int>(i)))},
                      {"capsules", ordered_json::array()},
                      {"boxes", ordered_json::array()}};
    for (const description::LinkShape& shape : robot.links[i].shapes)
      std::visit([&](const auto& one) { add(link, one); }, shape);
    links.push_back(std::move(link));
  }
  ordered_json objects = ordered_json::array();
  const auto motions = session.plant().objects();
  for (size_t i = 0; i < session.scene().objects.size(); ++i) {
    const description::Object& object = session.scene().objects[i];
    ordered_json json{{"name", object.name},
                      {"moves", object.mobility != description::Mobility::fixed},
                      {"pose", toJson(i < motions.size() ? motions[i].pose : object.pose)}};
    addSurface(json, object);
    objects.push_back(std::move(json));
  }
  const ordered_json scene{{"format", scene_format}, {"robot", robot.name}, {"links", links}, {"objects", objects}};
  runtime::writeWhole(path, jsonText(scene, -1) + "\n");
}

}  // namespace tactus::app
