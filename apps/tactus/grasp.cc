#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/tactus/command.h"
#include "apps/tactus/json_place.h"
#include "apps/tactus/text.h"
#include "dsl/nearest_name.h"
#include "framework/runtime/file_error.h"
#include "plugins/grasp/grasp_wrench_space.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

struct GraspFile {
  plugins::GraspWrenchOptions options;
  std::vector<plugins::GraspContact> contacts;
};

/// Refuses members that nobody reads: a misspelled one must not count as left out.
void expectMembers(const JsonPlace& place, const std::vector<std::string>& known) {
  for (const auto& [key, value] : place.members()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string nearest = dsl::nearestName(key, known);
    place.refuse("no member '" + key + "'" + (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)") + " beside " +
                 joined(known));
  }
}

double numberAt(const JsonPlace& place, double least, const std::string& expected) {
  const std::optional<double> number = place.number();
  if (!number || !std::isfinite(*number) || *number < least) place.refuse(expected);
  return *number;
}

Eigen::Vector3d vectorAt(const JsonPlace& place) {
  constexpr const char* expected = "three numbers";
  if (!place.exists()) place.refuse(expected);
  const std::vector<JsonPlace> items = place.items();
  if (items.size() != 3) place.refuse(expected);
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> number = items[static_cast<size_t>(i)].number();
    if (!number) items[static_cast<size_t>(i)].refuse("a number");
    vector[i] = *number;
  }
  return vector;
}

GraspFile readGrasp(const std::string& path) {
  const ordered_json json = readJson(path);
  const JsonPlace root(path, json);
  if (!json.is_object()) root.refuse("an object with friction and contacts");
  expectMembers(root, {"format", "friction", "edges", "centre", "scale", "contacts"});
  GraspFile file;
  file.options.friction = numberAt(root.at("friction"), 0, "a number ≥ 0");
  if (const JsonPlace edges = root.at("edges"); edges.exists()) {
    const double number = numberAt(edges, 3, "a whole number from 3 to 1000");
    if (number != std::floor(number) || number > 1000) edges.refuse("a whole number from 3 to 1000");
    file.options.edges = static_cast<int>(number);
  }
  if (const JsonPlace centre = root.at("centre"); centre.exists()) file.options.centre = vectorAt(centre);
  if (const JsonPlace scale = root.at("scale"); scale.exists())
    file.options.scale = numberAt(scale, std::numeric_limits<double>::min(), "a number > 0");
  if (!root.at("contacts").exists()) root.at("contacts").refuse("an array of contacts");
  for (const JsonPlace& place : root.at("contacts").items()) {
    expectMembers(place, {"position", "normal"});
    const plugins::GraspContact contact{vectorAt(place.at("position")), vectorAt(place.at("normal"))};
    if (!(contact.normal.norm() > 0)) place.at("normal").refuse("a direction into the object");
    file.contacts.push_back(contact);
  }
  return file;
}

int printGrasp(const std::string& path, bool json) {
  const GraspFile file = readGrasp(path);
  plugins::GraspWrenchSpace space;
  try {
    space = plugins::graspWrenchSpace(file.contacts, file.options);
  } catch (const plugins::HullError& error) {
    throw NumericalError(path + ": " + error.what());
  }
  if (!std::isfinite(space.epsilon) || !std::isfinite(space.volume))
    throw NumericalError(path + ": its wrenches are too large: epsilon or volume is no number");
  if (json) {
    const ordered_json answer{{"epsilon", space.epsilon}, {"volume", space.volume},
                              {"contacts", file.contacts.size()}, {"rank", space.rank}};
    std::cout << jsonText(answer, 2) << "\n";
    return exit_done;
  }
  std::cout << file.contacts.size() << " contacts, friction " << rounded(file.options.friction) << ", "
            << file.options.edges << " edges a cone\n"
            << "epsilon  " << rounded(space.epsilon) << "\nvolume   " << rounded(space.volume) << "\n";
  if (space.rank < 6)
    std::cout << "The wrenches span " << space.rank << " of 6 dimensions: some pushes and turns meet no resistance.\n";
  else if (space.epsilon == 0)
    std::cout << "0 is not inside the hull: some wrench breaks the grasp, however hard it presses.\n";
  return exit_done;
}

}  // namespace

void addGrasp(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("grasp", "Grasp wrench space of a set of contacts: epsilon and volume");
  const auto file = std::make_shared<std::string>();
  command->add_option("FILE", *file, "JSON: {friction, edges, centre, scale, contacts: [{position, normal}]}")
      ->required()
      ->type_name("FILE");
  command->add_flag("--json", context.json, "Print JSON on stdout");
  command->footer(R"(Contacts are hard; `normal` points into the object.  Cones of friction have `edges` (8) edges, torques are about
`centre` (0 0 0) over `scale` (1, m).  The space is the convex hull of all edges' wrenches and 0.

Example: a ball between two fingers
  echo '{"friction": 0.5, "contacts": [{"position": [1, 0, 0], "normal": [-1, 0, 0]},
        {"position": [-1, 0, 0], "normal": [1, 0, 0]}]}' > pinch.json
  tactus grasp pinch.json)");
  command->callback([=, &context] { context.action = [=, &context] { return printGrasp(*file, context.json); }; });
}

}  // namespace tactus::app
