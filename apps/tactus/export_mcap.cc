#include "apps/tactus/export_mcap.h"

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "apps/tactus/foxglove_schemas.h"
#include "apps/tactus/mcap_writer.h"
#include "apps/tactus/replay_data.h"
#include "apps/tactus/text.h"
#include "apps/tactus/touched_cloud.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/percentile.h"
#include "framework/runtime/version.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;
using runtime::CsvTable;
using Nanoseconds = std::uint64_t;
using Pose = std::array<double, 7>;                                // x, y, z, qw, qx, qy, qz, as in all files of a run
using Colour = std::array<double, 4>;

static_assert(std::endian::native == std::endian::little, "point clouds are little-endian");

constexpr const char* world = "world";
constexpr Pose identity{0, 0, 0, 1, 0, 0, 0};
constexpr Colour plain{0.91, 0.91, 0.88, 1}, skin{0.4, 0.52, 0.6, 1}, force_colour{0.84, 0.16, 0.12, 1},
    mark_colour{0.76, 0.09, 0.5, 1};
constexpr std::array<Colour, 3> object_colours{{{0.85, 0.78, 0.64, 1}, {0.66, 0.75, 0.58, 1}, {0.72, 0.65, 0.81, 1}}};
constexpr double usual_arrow = 0.07;                               // m, of the force that nine of ten stay below
constexpr double cloud_growth = 1.02;                              // from one message to the next

/// The times of a table's rows, which rise.
std::vector<Nanoseconds> timesOf(const CsvTable& table) {
  constexpr double latest = 9e9;                                   // s; nanoseconds have room for twice as much
  std::vector<Nanoseconds> times;
  if (table.rows() == 0) return times;
  for (const double time : table.numbers("time")) {
    const bool fits = time >= 0 && time < latest;
    const Nanoseconds next = fits ? static_cast<Nanoseconds>(std::llround(time * 1e9)) : 0;
    if (!fits || (!times.empty() && next < times.back()))
      throw runtime::FileError(table.path(), "row " + std::to_string(times.size() + 1) + ": the time " +
                                                 rounded(time, 9) + " does not follow those before it");
    times.push_back(next);
  }
  return times;
}

ordered_json timeToJson(Nanoseconds time) { return {{"sec", time / 1'000'000'000}, {"nsec", time % 1'000'000'000}}; }
ordered_json vector(double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}}; }
ordered_json quaternion(double w, double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}, {"w", w}}; }
ordered_json toJson(const Colour& colour) {
  return {{"r", colour[0]}, {"g", colour[1]}, {"b", colour[2]}, {"a", colour[3]}};
}
ordered_json toJson(const Pose& pose) {
  return {{"position", vector(pose[0], pose[1], pose[2])},
          {"orientation", quaternion(pose[3], pose[4], pose[5], pose[6])}};
}

template <size_t count>
std::array<double, count> numbersOf(const ordered_json& json) {
  std::array<double, count> numbers{};
  for (size_t i = 0; i < count; ++i) numbers[i] = json[i].get<double>();
  return numbers;
}

/// At `position`, with `axis` of its own along `direction`; to 1e-6.
Pose poseAlong(const Eigen::Vector3d& position, const Eigen::Vector3d& axis, const Eigen::Vector3d& direction) {
  const auto q = Eigen::Quaterniond::FromTwoVectors(axis, direction);
  Pose pose{position.x(), position.y(), position.z(), q.w(), q.x(), q.y(), q.z()};
  for (double& number : pose) number = std::round(number * 1e6) / 1e6 + 0.0;
  return pose;
}

ordered_json entity(Nanoseconds time, const std::string& frame, const std::string& id) {
  ordered_json json{{"timestamp", timeToJson(time)}, {"frame_id", frame}, {"id", id},
                    {"lifetime", timeToJson(0)},     {"frame_locked", true}, {"metadata", ordered_json::array()}};
  for (const char* kind : {"arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"})
    json[kind] = ordered_json::array();
  return json;
}

ordered_json sceneUpdate(ordered_json entities) {
  return {{"deletions", ordered_json::array()}, {"entities", std::move(entities)}};
}

/// A ball at each end and a cylinder between them.
void addCapsule(ordered_json& to, const ordered_json& capsule, const Colour& colour) {
  const auto p = numbersOf<3>(capsule["from"]), q = numbersOf<3>(capsule["to"]);
  const Eigen::Vector3d from(p.data()), end(q.data()), along = end - from;
  const double width = 2 * capsule["radius"].get<double>(), length = along.norm();
  for (const Eigen::Vector3d& centre : {from, end})
    to["spheres"].push_back({{"pose", toJson(Pose{centre.x(), centre.y(), centre.z(), 1, 0, 0, 0})},
                             {"size", vector(width, width, width)},
                             {"color", toJson(colour)}});
  if (length < 1e-9) return;
  to["cylinders"].push_back({{"pose", toJson(poseAlong((from + end) / 2, Eigen::Vector3d::UnitZ(), along))},
                             {"size", vector(width, width, length)},
                             {"bottom_scale", 1},
                             {"top_scale", 1},
                             {"color", toJson(colour)}});
}

/// Messages that one file of the run gives, row by row.
struct Stream {
  std::vector<Nanoseconds> times;
  std::function<void(size_t row, Nanoseconds time)> write;
  size_t next = 0;
};

/// Schemas of Foxglove's messages; each is written once, where a channel has it.
struct Schemas {
  McapWriter& mcap;
  std::map<std::string, std::uint16_t> numbers = {};
  std::uint16_t of(const ordered_json& schema) {
    const std::string name = schema["title"];
    if (!numbers.contains(name)) numbers[name] = mcap.addSchema(name, jsonText(schema));
    return numbers[name];
  }
};

/// Where something is that has a frame: at rest, and in columns of replay.csv.
struct Moving {
  std::string frame;
  Pose rest = identity;
  std::vector<std::vector<double>> columns;                        // seven, or none where it never moves
  Pose at(size_t row) const {
    Pose pose = rest;
    for (size_t i = 0; i < columns.size(); ++i) pose[i] = columns[i][row];
    return pose;
  }
};

/// The numbers of "<path>/<ending>" for each ending; none where the table has no such path, or no row.
std::vector<std::vector<double>> numbersOf(const CsvTable& table, const std::string& path,
                                           const std::vector<std::string>& endings) {
  std::vector<std::vector<double>> numbers;
  if (table.rows() == 0 || table.column(path + "/" + endings.front()) < 0) return numbers;
  for (const std::string& ending : endings) numbers.push_back(table.numbers(path + "/" + ending));
  return numbers;
}

/// Everything with a frame; an object whose name a link has is "object/<name>".
std::vector<Moving> movingOf(const ordered_json& scene, const CsvTable& frames) {
  const std::vector<std::string> endings{"x", "y", "z", "qw", "qx", "qy", "qz"};
  std::vector<Moving> moving;
  std::set<std::string> taken{world};
  for (const auto& [kind, path] : {std::pair{"links", "link/"}, std::pair{"objects", "object/"}})
    for (const ordered_json& one : scene[kind]) {
      if (one.contains("moves") && !one["moves"]) continue;
      const std::string name = one["name"];
      moving.push_back({taken.insert(name).second ? name : path + name, numbersOf<7>(one["pose"]),
                        numbersOf(frames, path + name, endings)});
    }
  return moving;
}

ordered_json linkEntity(const ordered_json& link, const std::string& frame, Nanoseconds time) {
  ordered_json json = entity(time, frame, "link/" + link["name"].get<std::string>());
  const Colour& colour = link.value("skin", false) ? skin : plain;
  for (const ordered_json& capsule : link["capsules"]) addCapsule(json, capsule, colour);
  for (const ordered_json& box : link["boxes"]) {
    const auto size = numbersOf<3>(box["size"]);
    json["cubes"].push_back({{"pose", toJson(numbersOf<7>(box["pose"]))},
                             {"size", vector(size[0], size[1], size[2])},
                             {"color", toJson(colour)}});
  }
  return json;
}

ordered_json objectEntity(const ordered_json& object, const std::string& frame, const Colour& colour,
                          Nanoseconds time) {
  ordered_json json = entity(time, frame, "object/" + object["name"].get<std::string>());
  ordered_json points = ordered_json::array();
  const ordered_json& numbers = object["vertices"];
  for (size_t i = 0; i < numbers.size(); i += 3)
    points.push_back({{"x", numbers[i]}, {"y", numbers[i + 1]}, {"z", numbers[i + 2]}});
  json["triangles"].push_back({{"pose", toJson(frame == world ? numbersOf<7>(object["pose"]) : identity)},
                               {"points", points},
                               {"color", toJson(colour)},
                               {"colors", ordered_json::array()},
                               {"indices", object["triangles"]}});
  return json;
}

/// One message, at the beginning.
Stream sceneStream(Schemas& schemas, const ordered_json& scene, const std::vector<Moving>& moving, Nanoseconds start) {
  const auto channel = schemas.mcap.addChannel("/scene", schemas.of(foxglove::sceneUpdate()));
  return {{start}, [&, channel](size_t, Nanoseconds time) {
            ordered_json entities = ordered_json::array();
            size_t frame = 0;
            for (const ordered_json& link : scene["links"])
              entities.push_back(linkEntity(link, moving[frame++].frame, time));
            for (size_t i = 0; i < scene["objects"].size(); ++i) {
              const ordered_json& object = scene["objects"][i];
              const bool moves = object.value("moves", false);
              entities.push_back(objectEntity(object, moves ? moving[frame++].frame : world,
                                              object_colours[i % object_colours.size()], time));
            }
            schemas.mcap.write(channel, time, jsonText(sceneUpdate(std::move(entities))));
          }};
}

Stream transformStream(Schemas& schemas, const std::vector<Moving>& moving, std::vector<Nanoseconds> times) {
  const auto channel = schemas.mcap.addChannel("/tf", schemas.of(foxglove::frameTransforms()));
  return {std::move(times), [&, channel](size_t row, Nanoseconds time) {
            ordered_json transforms = ordered_json::array();
            for (const Moving& one : moving) {
              const Pose pose = one.at(row);
              transforms.push_back({{"timestamp", timeToJson(time)},
                                    {"parent_frame_id", world},
                                    {"child_frame_id", one.frame},
                                    {"translation", vector(pose[0], pose[1], pose[2])},
                                    {"rotation", quaternion(pose[3], pose[4], pose[5], pose[6])}});
            }
            schemas.mcap.write(channel, time, jsonText({{"transforms", std::move(transforms)}}));
          }};
}

/// Touches of all frames; a frame without any takes the arrows of the one before away.
Stream contactStream(Schemas& schemas, const CsvTable& contacts, std::vector<Nanoseconds> frames) {
  struct Touch {
    std::string names;
    Eigen::Vector3d point, force_N;
  };
  std::vector<Touch> touches;
  std::vector<double> forces_N;
  const std::vector<Nanoseconds> times = timesOf(contacts);
  if (!times.empty()) {
    const int link = contacts.column("link"), on = contacts.column("on");
    if (link < 0 || on < 0) throw runtime::FileError(contacts.path(), "has no column 'link' or 'on'");
    std::vector<std::vector<double>> numbers;
    for (const char* column : {"x", "y", "z", "force_x", "force_y", "force_z"})
      numbers.push_back(contacts.numbers(column));
    for (size_t row = 0; row < times.size(); ++row) {
      touches.push_back({contacts.cell(row, link) + " on " + contacts.cell(row, on),
                         {numbers[0][row], numbers[1][row], numbers[2][row]},
                         {numbers[3][row], numbers[4][row], numbers[5][row]}});
      forces_N.push_back(touches.back().force_N.norm());
    }
  }
  const double usual_N = forces_N.empty() ? 0 : runtime::percentile(forces_N, 0.9);
  const double scale = usual_N > 0 ? usual_arrow / usual_N : usual_arrow;  // m/N
  const auto channel = schemas.mcap.addChannel("/contacts", schemas.of(foxglove::sceneUpdate()));
  const auto toArrow = [scale](const Touch& touch) {
    const double length = scale * touch.force_N.norm(), head = std::min(0.018, length / 2);
    const Eigen::Vector3d along = touch.force_N.normalized();
    return ordered_json{{"pose", toJson(poseAlong(touch.point - length * along, Eigen::Vector3d::UnitX(), along))},
                        {"shaft_length", length - head},
                        {"shaft_diameter", 0.0044},
                        {"head_length", head},
                        {"head_diameter", 0.8 * head},
                        {"color", toJson(force_colour)}};
  };
  return {std::move(frames), [&mcap = schemas.mcap, channel, toArrow, times, touches = std::move(touches),
                              next = size_t{0}](size_t, Nanoseconds time) mutable {
            ordered_json arrows = entity(time, world, "contacts");
            for (; next < times.size() && times[next] <= time; ++next) {
              const Touch& touch = touches[next];
              if (times[next] < time || !(touch.force_N.norm() > 0)) continue;
              arrows["arrows"].push_back(toArrow(touch));
              arrows["metadata"].push_back({{"key", touch.names}, {"value", rounded(touch.force_N.norm()) + " N"}});
            }
            mcap.write(channel, time, jsonText(sceneUpdate({std::move(arrows)})));
          }};
}

/// What tasks steer for, where any says.
void addReferences(std::vector<Stream>& streams, Schemas& schemas, const CsvTable& frames,
                   const std::vector<Nanoseconds>& times) {
  std::vector<std::pair<std::string, std::vector<std::vector<double>>>> marks;
  for (const std::string& column : frames.columns())
    if (column.starts_with("mark/") && column.ends_with("/x")) {
      const std::string path = column.substr(0, column.size() - 2);
      marks.emplace_back(path.substr(5), numbersOf(frames, path, {"x", "y", "z"}));
    }
  if (marks.empty()) return;
  const auto channel = schemas.mcap.addChannel("/references", schemas.of(foxglove::sceneUpdate()));
  streams.push_back({times, [&mcap = schemas.mcap, channel, marks = std::move(marks)](size_t row, Nanoseconds time) {
                       ordered_json balls = entity(time, world, "references");
                       for (const auto& [name, numbers] : marks) {
                         const Pose pose{numbers[0][row], numbers[1][row], numbers[2][row], 1, 0, 0, 0};
                         if (!std::isfinite(pose[0] + pose[1] + pose[2])) continue;
                         balls["spheres"].push_back({{"pose", toJson(pose)},
                                                     {"size", vector(0.012, 0.012, 0.012)},
                                                     {"color", toJson(mark_colour)}});
                         balls["metadata"].push_back({{"key", name}, {"value", ""}});
                       }
                       mcap.write(channel, time, jsonText(sceneUpdate({std::move(balls)})));
                     }});
}

/// All points so far, in as few messages as cloud_growth allows.
void addTouched(std::vector<Stream>& streams, Schemas& schemas, const CsvTable& touched) {
  const std::vector<Nanoseconds> all = timesOf(touched);
  if (all.empty()) return;
  const TouchedCloud cloud = touchedCloud(touched);
  const std::vector<double> force_N = touched.numbers("force_N");
  std::string bytes;
  for (size_t i = 0; i < all.size(); ++i)
    for (const double number : {cloud.x[i], cloud.y[i], cloud.z[i], cloud.height_mm[i], force_N[i]}) {
      const auto single = std::bit_cast<std::array<char, 4>>(static_cast<float>(number));
      bytes.append(single.data(), single.size());
    }
  ordered_json fields = ordered_json::array();
  for (const char* name : {"x", "y", "z", "height_mm", "force_N"})
    fields.push_back({{"name", name}, {"offset", 4 * fields.size()}, {"type", 7}});
  const size_t stride = 4 * fields.size();

  std::vector<Nanoseconds> times;
  std::vector<size_t> counts;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool last = i + 1 == all.size();
    const double told = counts.empty() ? 0 : static_cast<double>(counts.back());
    if (!last && (all[i + 1] == all[i] || static_cast<double>(i + 1) < cloud_growth * told)) continue;
    times.push_back(all[i]);
    counts.push_back(i + 1);
  }
  const auto channel = schemas.mcap.addChannel("/touched", schemas.of(foxglove::pointCloud()));
  streams.push_back({std::move(times), [&mcap = schemas.mcap, channel, fields, bytes = std::move(bytes), stride,
                                        counts = std::move(counts)](size_t row, Nanoseconds time) {
                       const std::string_view until = std::string_view(bytes).substr(0, stride * counts[row]);
                       mcap.write(channel, time, jsonText({{"timestamp", timeToJson(time)},
                                                           {"frame_id", world},
                                                           {"pose", toJson(identity)},
                                                           {"point_stride", stride},
                                                           {"fields", fields},
                                                           {"data", base64(until)}}));
                     }});
}

/// The columns of a log, those of one path in one topic: "task/hold/error" is `error` of /task/hold.
void addLog(std::vector<Stream>& streams, McapWriter& mcap, const CsvTable& log) {
  struct Topic {
    std::uint16_t channel = 0;
    std::vector<std::pair<std::string, std::vector<double>>> fields = {};
  };
  std::vector<std::string> order;
  std::map<std::string, Topic> topics;
  for (size_t column = 0; column < log.columns().size(); ++column) {
    const std::string& name = log.columns()[column];
    if (name == "time") continue;
    const size_t slash = name.rfind('/');
    const std::string path = slash == std::string::npos ? "/log" : "/" + name.substr(0, slash);
    if (!topics.contains(path)) order.push_back(path);
    topics[path].fields.emplace_back(name.substr(slash + 1), log.numbers(static_cast<int>(column)));
  }
  std::vector<Topic> all;
  for (const std::string& path : order) {
    Topic& topic = topics[path];
    ordered_json schema{{"title", "tactus" + path}, {"type", "object"}, {"properties", ordered_json::object()}};
    for (const auto& [field, values] : topic.fields) schema["properties"][field] = {{"type", "number"}};
    topic.channel = mcap.addChannel(path, mcap.addSchema("tactus" + path, jsonText(schema)));
    all.push_back(std::move(topic));
  }
  streams.push_back({timesOf(log), [&mcap, all = std::move(all)](size_t row, Nanoseconds time) {
                       for (const Topic& topic : all) {
                         ordered_json json = ordered_json::object();
                         for (const auto& [field, values] : topic.fields)
                           if (std::isfinite(values[row])) json[field] = values[row];
                         mcap.write(topic.channel, time, jsonText(json));
                       }
                     }});
}

/// All messages, in the order of their times; those of one time in the order of the streams.
void writeInOrder(std::vector<Stream>& streams) {
  for (;;) {
    Stream* first = nullptr;
    for (Stream& stream : streams)
      if (stream.next < stream.times.size() && (!first || stream.times[stream.next] < first->times[first->next]))
        first = &stream;
    if (!first) return;
    first->write(first->next, first->times[first->next]);
    ++first->next;
  }
}

}  // namespace

void exportMcap(const RunRecord& run, const std::string& file) {
  McapWriter mcap(file, std::string("tactus ") + TACTUS_VERSION);
  mcap.addMetadata("run", {{"stack", run.run().at("stack").text()},
                           {"backend", run.run().at("backend").text()},
                           {"seed", rounded(run.run().at("seed").number().value_or(NAN), 17)},
                           {"status", run.cut_off ? "cut off" : run.run().at("status").text()}});
  Schemas schemas{mcap};
  std::vector<Stream> streams;
  ordered_json scene;
  std::vector<Moving> moving;
  const std::vector<Nanoseconds> frames = timesOf(run.frames), rows = timesOf(run.log);
  const std::string scene_file = run.folder + "/scene.json";
  if (std::filesystem::exists(scene_file)) {
    scene = readScene(scene_file);
    moving = movingOf(scene, run.frames);
    const Nanoseconds start = !frames.empty() ? frames.front() : !rows.empty() ? rows.front() : 0;
    streams.push_back(sceneStream(schemas, scene, moving, start));
    // A run that was cut off before its first frame stands still.
    streams.push_back(transformStream(schemas, moving, frames.empty() ? std::vector{start} : frames));
  }
  if (!frames.empty()) {
    streams.push_back(contactStream(schemas, run.contacts, frames));
    addReferences(streams, schemas, run.frames, frames);
  }
  addTouched(streams, schemas, run.touched);
  addLog(streams, mcap, run.log);
  writeInOrder(streams);
  mcap.close();
}

}  // namespace tactus::app
