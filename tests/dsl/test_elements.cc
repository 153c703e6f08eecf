#include "tests/dsl/test_elements.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "framework/control/objective_options.h"
#include "tasks/register_tasks.h"

namespace tactus::dsl_test {
namespace {

using namespace control;

class Probe final : public Signal {
 public:
  explicit Probe(const BuildContext& context) {
    if (context.values.has("from")) source_ = &context.port<double>("from");
    if (context.values.flag("refuse")) throw ElementError("refuse", "this probe refuses");
  }

 private:
  void doUpdate(const Tick& tick) override { value_ = source_ ? *source_ + 1 : tick.time; }
  const void* doPort(std::string_view name) const override { return name == "value" ? &value_ : nullptr; }

  const double* source_ = nullptr;
  double value_ = 0;
};

/// Asks for nothing; looks up what its attributes name.
class Pull final : public Task {
 public:
  Pull(const BuildContext& context, Relation relation, bool contact = false) : Task(relation, 1, contact) {
    if (context.values.has("frame")) context.frame("frame");
    if (context.values.has("links")) context.frames("links");
    if (context.values.has("joints")) context.joints("joints");
    if (context.values.has("from")) source_ = &context.port<double>("from");
    if (context.values.has("stiffness") && context.values.real("stiffness") > 1000)
      throw ElementError("stiffness", "no spring is that stiff");
  }

 private:
  void doUpdate(const Tick&, TickTask& rows) override {
    rows.rows = 0;
    error_ = source_ ? *source_ : 0;
  }
  const double* source_ = nullptr;
};

class NoTorque final : public BackEnd {
 public:
  explicit NoTorque(Abilities abilities) : BackEnd(abilities) {}

 private:
  void doPrepare(const TickProblem& shape) override { dof_ = shape.dof; }
  void doSolve(const TickProblem&, TickSolution& solution) override { solution.torque.setZero(dof_); }
  int dof_ = 0;
};

ElementRow pullRow(const std::string& name) {
  return {
      .name = name,
      .kind = ElementKind::task,
      .description = "A task of the tests.",
      .attributes = {{.name = "frame", .type = ValueType::link},
                     {.name = "links", .type = ValueType::links},
                     {.name = "joints", .type = ValueType::joints, .choices = {"free"}},
                     {.name = "object", .type = ValueType::object},
                     {.name = "from", .type = ValueType::port, .port_type = "scalar"},
                     {.name = "on", .type = ValueType::port, .port_type = "contact-set"},
                     {.name = "along", .type = ValueType::points, .unit = "m", .count = 3},
                     {.name = "stiffness",
                      .type = ValueType::real,
                      .unit = "N/m",
                      .default_text = "100",
                      .lower = 0,
                      .lower_open = true},
                     {.name = "damping", .type = ValueType::real, .unit = "N s/m", .default_text = "10", .lower = 0},
                     {.name = "friction", .type = ValueType::real, .default_text = "0.2", .lower = 0}}};
}

void addBackEnd(Registry& registry, const std::string& name, Abilities abilities,
                std::vector<control::AttributeRow> more = {}) {
  std::vector<control::AttributeRow> attributes = {
      {.name = "projection",
       .type = ValueType::choice,
       .default_text = "augmented",
       .choices = {"successive", "augmented"}},
      {.name = "tolerance", .type = ValueType::real, .default_text = "1e-8", .lower = 0}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  registry.addBackEnd(
      {.name = name,
       .kind = ElementKind::back_end,
       .description = "A back end of the tests.",
       .attributes = attributes},
      [abilities](const ElementValues& values) {
        if (values.real("tolerance") > 1) throw ElementError("tolerance", "that is no tolerance");
        return std::make_unique<NoTorque>(abilities);
      });
}

}  // namespace

Registry makeRegistry() {
  Registry registry;
  dsl::addStructureElements(registry);
  tasks::registerBuiltIns(registry);
  registry.addSignal({.name = "test.probe",
                      .kind = ElementKind::signal,
                      .description = "A signal of the tests.",
                      .attributes = {{.name = "from", .type = ValueType::port, .port_type = "scalar"},
                                     {.name = "refuse", .type = ValueType::flag, .default_text = "false"}},
                      .ports = {{"value", "scalar", "1", "A number."}, {"hollow", "scalar", "1", "Nothing."}}},
                     [](const BuildContext& context) { return std::make_unique<Probe>(context); });
  registry.addTask(pullRow("test.pull"),
                   [](const BuildContext& context) { return std::make_unique<Pull>(context, Relation::equality); });
  registry.addTask(pullRow("test.guard"),
                   [](const BuildContext& context) { return std::make_unique<Pull>(context, Relation::inequality); });
  registry.addTask(pullRow("test.press"), [](const BuildContext& context) {
    return std::make_unique<Pull>(context, Relation::equality, true);
  });
  std::vector<control::AttributeRow> of_cascades = control::objectiveAttributes();
  of_cascades.push_back({.name = "inequalities", .type = ValueType::choice, .default_text = "exact",
                         .choices = {"one-pass", "exact"}});
  addBackEnd(registry, "null-space", {.strict_levels = true, .inequalities = true}, of_cascades);
  addBackEnd(registry, "all", {true, true, true, true, true});
  addBackEnd(registry, "none", {});
  addBackEnd(registry, "first", {.strict_first_level = true, .why_not_strict = "it is only strict at the top"});
  return registry;
}

dsl::ReadOptions readOptions() {
  dsl::ReadOptions options;
  options.model_path = {std::string(TACTUS_SOURCE_DIR) + "/models"};
  options.load_plugin = [](const std::string& name) {
    if (name != "known") throw std::runtime_error("looked for " + name + ".so in no folder at all");
  };
  return options;
}

std::string testFile(const std::string& name) { return std::string(TACTUS_SOURCE_DIR) + "/tests/dsl/" + name; }

std::string writeFile(const std::string& name, const std::string& text) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string folder_name = std::string("tactus_") + test->test_suite_name() + "_" + test->name();
  for (char& c : folder_name)
    if (c == '/') c = '_';
  const auto folder = std::filesystem::path(testing::TempDir()) / folder_name;
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << text;
  return (folder / name).string();
}

std::string smallStack(const std::string& inside, const std::string& controller) {
  return "<stack format=\"1\" name=\"small\">\n<robot model=\"lwr_4plus\"/>\n" + inside + "\n" + controller +
         "\n</stack>\n";
}

}  // namespace tactus::dsl_test
