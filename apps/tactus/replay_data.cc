#include "apps/tactus/replay_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <map>

#include "apps/tactus/scene_file.h"
#include "apps/tactus/text.h"
#include "apps/tactus/touched_cloud.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;
using runtime::CsvTable;
using Floats = std::vector<float>;

static_assert(std::endian::native == std::endian::little, "the page reads little-endian numbers");

std::string base64(const Floats& numbers) {
  return app::base64({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)});
}

size_t charactersOf(size_t numbers) { return numbers * sizeof(float) * 4 / 3; }

/// 1 where `numbers` fit into `characters`, else of how many rows one is kept.
size_t strideFor(size_t numbers, size_t characters) {
  return std::max<size_t>(1, (charactersOf(numbers) + characters - 1) / std::max<size_t>(1, characters));
}

std::string everyNth(size_t stride) { return "every " + std::to_string(stride) + (stride == 2 ? "nd" : stride == 3 ? "rd" : "th"); }

/// The columns of a table as rows of floats.
Floats rowsOf(const CsvTable& table, size_t stride) {
  const size_t width = table.columns().size(), rows = (table.rows() + stride - 1) / stride;
  Floats numbers(width * rows);
  for (size_t column = 0; column < width; ++column) {
    const std::vector<double> values = table.numbers(static_cast<int>(column));
    for (size_t row = 0; row < rows; ++row) numbers[row * width + column] = static_cast<float>(values[row * stride]);
  }
  return numbers;
}

/// Names in the order of their first appearance.
struct Names {
  std::vector<std::string> all;
  std::map<std::string, int> index;
  int of(const std::string& name) {
    const auto [found, fresh] = index.emplace(name, static_cast<int>(all.size()));
    if (fresh) all.push_back(name);
    return found->second;
  }
};

ordered_json contactsData(const CsvTable& frames, const CsvTable& contacts, size_t stride) {
  Names links, partners;
  Floats rows;
  if (contacts.rows() > 0 && frames.rows() > 0) {
    const std::vector<double> frame_times = frames.numbers("time"), times = contacts.numbers("time");
    std::vector<std::vector<double>> numbers;
    for (const char* column : {"x", "y", "z", "force_x", "force_y", "force_z"})
      numbers.push_back(contacts.numbers(column));
    const int link = contacts.column("link"), on = contacts.column("on");
    if (link < 0 || on < 0) throw runtime::FileError(contacts.path(), "has no column 'link' or 'on'");
    size_t frame = 0;
    for (size_t row = 0; row < contacts.rows(); ++row) {
      while (frame < frames.rows() && frame_times[frame] < times[row]) ++frame;
      if (frame == frames.rows()) break;                           // cut off between the two files
      if (frame_times[frame] != times[row] || frame % stride != 0) continue;
      rows.push_back(static_cast<float>(frame / stride));
      rows.push_back(static_cast<float>(links.of(contacts.cell(row, link))));
      rows.push_back(static_cast<float>(partners.of(contacts.cell(row, on))));
      for (const auto& column : numbers) rows.push_back(static_cast<float>(column[row]));
    }
  }
  return {{"links", links.all}, {"on", partners.all}, {"data", base64(rows)}};
}

ordered_json touchedData(const CsvTable& touched, size_t most_characters, ordered_json& notes) {
  Floats rows;
  if (touched.rows() > 0) {
    const TouchedCloud cloud = touchedCloud(touched);
    const std::vector<double> time = touched.numbers("time");
    const std::vector<double> normals[] = {touched.numbers("normal_x"), touched.numbers("normal_y"),
                                           touched.numbers("normal_z")};
    constexpr double out = 0.002;
    const size_t stride = strideFor(5 * touched.rows(), most_characters);
    if (stride > 1) notes.push_back("Of the touched points " + everyNth(stride) + " is shown.");
    for (size_t i = 0; i < touched.rows(); i += stride)
      for (const double number : {time[i], cloud.x[i] - out * normals[0][i], cloud.y[i] - out * normals[1][i],
                                  cloud.z[i] - out * normals[2][i], cloud.height_mm[i] / cloud.height_max})
        rows.push_back(static_cast<float>(number));
  }
  return {{"data", base64(rows)}};
}

/// Lines over one time.
struct Plot {
  ordered_json json;
  std::vector<double> time;
  std::vector<std::pair<std::string, std::vector<double>>> lines;
};

/// Of columns of the log that `labelOf` gives a label for ("" leaves it out).
template <class LabelOf>
Plot plotOf(const CsvTable& log, ordered_json json, LabelOf labelOf) {
  Plot plot{std::move(json), {}, {}};
  for (size_t column = 0; column < log.columns().size(); ++column) {
    const std::string label = labelOf(log.columns()[column]);
    if (!label.empty()) plot.lines.emplace_back(label, log.numbers(static_cast<int>(column)));
  }
  if (!plot.lines.empty()) plot.time = log.numbers("time");
  return plot;
}

/// "task/close/error" between "task/" and "/error" is "close".
std::string between(const std::string& text, const std::string& start, const std::string& end) {
  if (text.size() <= start.size() + end.size() || !text.starts_with(start) || !text.ends_with(end)) return "";
  return text.substr(start.size(), text.size() - start.size() - end.size());
}

std::vector<Plot> plotsOf(const RunRecord& run, const CsvTable& timing) {
  const CsvTable& log = run.log;
  std::vector<Plot> plots;
  const auto oneOf = [](std::map<std::string, std::string> labels) {
    return [labels = std::move(labels)](const std::string& column) {
      const auto found = labels.find(column);
      return found == labels.end() ? std::string() : found->second;
    };
  };
  ordered_json forces{{"title", "Contact forces (N)"}};
  if (const auto wanted = run.run().at("wanted_force_N").number()) forces["wanted"] = *wanted;
  plots.push_back(plotOf(log, forces, oneOf({{"contact/mean_N", "desired, mean"},
                                             {"contact/max_N", "desired, largest"},
                                             {"contact/undesired_max_N", "undesired, largest"},
                                             {"contact/self_max_N", "on itself, largest"}})));
  plots.push_back(plotOf(log, {{"title", "Contacts"}, {"stepped", true}},
                         oneOf({{"contact/links", "links"}, {"contact/contacts", "contacts"}})));
  plots.push_back(plotOf(log, {{"title", "Task errors"}, {"scale", "log"}},
                         [](const std::string& column) { return between(column, "task/", "/error"); }));
  const auto perLevel = [](const std::string& what) {
    return [what](const std::string& column) {
      const std::string level = between(column, "level/", "/" + what);
      return level.empty() ? level : "level " + level;
    };
  };
  plots.push_back(plotOf(log, {{"title", "Level ranks"}, {"stepped", true}}, perLevel("rank")));
  plots.push_back(plotOf(log, {{"title", "Active inequalities"}, {"stepped", true}}, perLevel("active")));
  plots.push_back(plotOf(timing, {{"title", "Tick time (µs)"}, {"scale", "log"}}, oneOf({{"tick_us", "tick"}})));
  std::erase_if(plots, [](const Plot& plot) { return plot.time.empty(); });
  return plots;
}

/// Of every `stride` rows the time of the first and the largest values.
ordered_json toJson(const Plot& plot, size_t stride) {
  ordered_json json = plot.json;
  const auto add = [&](const std::string& label, const std::vector<double>& values, bool largest) {
    Floats kept;
    for (size_t first = 0; first < values.size(); first += stride) {
      const auto end = values.begin() + static_cast<long>(std::min(values.size(), first + stride));
      const auto begin = values.begin() + static_cast<long>(first);
      kept.push_back(static_cast<float>(largest ? *std::max_element(begin, end) : *begin));
    }
    json["series"].push_back({{"label", label}, {"data", base64(kept)}});
  };
  add("time", plot.time, false);
  for (const auto& [label, values] : plot.lines) add(label, values, true);
  return json;
}

ordered_json plotsData(const RunRecord& run, size_t most_characters, ordered_json& notes) {
  constexpr size_t tick_rows = 4000;                               // more than there are pixels
  const std::vector<Plot> plots = plotsOf(run, readIfThere(run.folder + "/timing.csv"));
  ordered_json json = ordered_json::array();
  for (const Plot& plot : plots) {
    const size_t share = most_characters / plots.size();
    const bool ticks = plot.lines.front().first == "tick";
    const size_t stride = std::max(strideFor(plot.time.size() * (plot.lines.size() + 1), share),
                                   ticks ? (plot.time.size() + tick_rows - 1) / tick_rows : 1);
    if (stride > 1)
      notes.push_back("The plot '" + plot.json["title"].get<std::string>() + "' shows the largest of every " +
                      std::to_string(stride) + (ticks ? " ticks." : " rows of log.csv."));
    json.push_back(toJson(plot, stride));
  }
  return json;
}

ordered_json featuresData(const JsonPlace& run) {
  ordered_json features = ordered_json::array();
  const auto position = [](const JsonPlace& point) {
    ordered_json json = ordered_json::array();
    for (const JsonPlace& number : point.items()) json.push_back(number.number().value_or(0));
    json.get_ref<ordered_json::array_t&>().resize(3, 0);
    return json;
  };
  for (const JsonPlace& feature : run.at("features").items()) {
    ordered_json json{{"name", feature.at("name").text()}};
    if (feature.at("position_W").exists()) json["position"] = position(feature.at("position_W"));
    if (feature.at("truth_W").exists()) json["truth"] = position(feature.at("truth_W"));
    features.push_back(std::move(json));
  }
  return features;
}

void requireNumbers(const JsonPlace& place, size_t count) {
  const std::vector<JsonPlace> items = place.items();
  if (items.size() != count) place.refuse("an array of " + std::to_string(count) + " numbers");
  for (const JsonPlace& item : items)
    if (!item.number()) item.refuse("a number");
}

/// Readers trust it: everything is there, and of its kind.
void requireScene(const std::string& path, const ordered_json& scene) {
  const JsonPlace place(path, scene);
  if (place.at("format").text("") != scene_format)
    throw runtime::FileError(path, std::string("is not of the format ") + scene_format);
  for (const JsonPlace& link : place.at("links").items()) {
    link.at("name").text();
    requireNumbers(link.at("pose"), 7);
    for (const JsonPlace& capsule : link.at("capsules").items()) {
      requireNumbers(capsule.at("from"), 3);
      requireNumbers(capsule.at("to"), 3);
      if (!capsule.at("radius").number()) capsule.at("radius").refuse("a number");
    }
    for (const JsonPlace& box : link.at("boxes").items()) {
      requireNumbers(box.at("pose"), 7);
      requireNumbers(box.at("size"), 3);
    }
  }
  for (const JsonPlace& object : place.at("objects").items()) {
    object.at("name").text();
    requireNumbers(object.at("pose"), 7);
    const std::vector<JsonPlace> vertices = object.at("vertices").items(), triangles = object.at("triangles").items();
    if (vertices.size() % 3 != 0) object.at("vertices").refuse("three numbers for each vertex");
    if (triangles.size() % 3 != 0) object.at("triangles").refuse("three vertices for each triangle");
    for (const JsonPlace& number : vertices)
      if (!number.number()) number.refuse("a number");
    for (const JsonPlace& index : triangles) {
      const double vertex = index.number().value_or(-1);
      if (!(vertex >= 0 && vertex < static_cast<double>(vertices.size() / 3) && vertex == std::floor(vertex)))
        index.refuse("the index of a vertex");
    }
  }
}

/// What objects are drawn with fewer triangles than they have.
void noteSimplified(const JsonPlace& scene, ordered_json& notes) {
  for (const JsonPlace& object : scene.at("objects").items())
    if (const auto whole = object.at("simplified_from").number())
      notes.push_back("'" + object.at("name").text() + "' is drawn with " +
                      std::to_string(object.at("triangles").items().size() / 3) + " of its " +
                      std::to_string(static_cast<long>(*whole)) + " triangles.");
}

}  // namespace

ordered_json readScene(const std::string& path) {
  ordered_json scene = readJson(path);
  requireScene(path, scene);
  return scene;
}

ordered_json replayData(const RunRecord& run, const std::string& title, size_t most_characters) {
  ordered_json data{{"title", title},
                    {"scene", nullptr}};
  ordered_json notes = ordered_json::array();
  const std::string scene_path = run.folder + "/scene.json";
  if (std::filesystem::exists(scene_path)) {
    ordered_json scene = readScene(scene_path);
    noteSimplified({scene_path, scene}, notes);
    data["scene"] = std::move(scene);
  }
  const size_t used = jsonText(data).size();
  const size_t rest = most_characters - std::min(most_characters / 2, used);
  const CsvTable &frames = run.frames, &contacts = run.contacts;
  if (frames.rows() > 0) frames.numbers("time");                   // says where it is missing
  const size_t stride = strideFor(frames.rows() * frames.columns().size() + 9 * contacts.rows(), rest / 2);
  if (stride > 1)
    notes.push_back("Of the frames of the replay " + everyNth(stride) + " is kept, so that the page stays small.");
  data["frames"] = {{"columns", frames.columns()}, {"data", base64(rowsOf(frames, stride))}};
  data["contacts"] = contactsData(frames, contacts, stride);
  data["touched"] = touchedData(run.touched, rest / 8, notes);
  data["features"] = featuresData(run.run());
  data["plots"] = plotsData(run, rest / 4, notes);
  data["notes"] = std::move(notes);
  return data;
}

std::string replayScript(const ordered_json& data) {
  std::string text = jsonText(data), safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') safe += "\\u003c";
    else safe += c;
  }
  return "<script type='application/json' class='run'>" + safe + "</script>\n";
}

}  // namespace tactus::app
