#include "conformance/conformance.h"

#include <algorithm>
#include <set>

#include "conformance/bench.h"
#include "conformance/laws.h"
#include "conformance/shape_laws.h"
#include "conformance/specimen.h"
#include "dsl/compile.h"
#include "dsl/diagnostic.h"
#include "framework/runtime/temporary_folder.h"

namespace tactus::conformance {
namespace {

using control::ElementKind;
using control::ElementRow;

/// What the stack's reader and compiler ask for, not the factory.
bool isOfEveryElement(const std::string& attribute) {
  static const std::vector<control::AttributeRow> activity = control::activityAttributes();
  return attribute == "name" || attribute == "class" || attribute == "pose" ||
         std::any_of(activity.begin(), activity.end(), [&](const auto& row) { return row.name == attribute; });
}

/// The values of all instances of an element.
std::vector<control::ElementValues*> instancesIn(dsl::Stack& stack, const ElementRow& row) {
  std::vector<control::ElementValues*> found;
  const auto add = [&](control::ElementValues& values) {
    if (values.row().name == row.name && values.row().kind == row.kind) found.push_back(&values);
  };
  for (dsl::ObjectDescription& object : stack.objects)
    for (control::ElementValues& shape : object.shapes) add(shape);
  for (dsl::ElementInstance& sensor : stack.sensors) add(sensor.values);
  for (dsl::ElementInstance& signal : stack.signals) add(signal.values);
  for (dsl::LevelDescription& level : stack.levels) {
    for (dsl::ElementInstance& task : level.tasks) add(task.values);
    if (level.controller) add(level.controller->values);
  }
  for (dsl::ElementInstance& measure : stack.run.measures) add(measure.values);
  for (dsl::ElementInstance& recorder : stack.run.recorders) add(recorder.values);
  add(stack.back_end);
  return found;
}

std::string nameOf(const control::ElementValues& values) { return values.has("name") ? values.text("name") : ""; }

void checkInstance(const dsl::Stack& stack, const control::Registry& registry, const control::ElementValues& values,
                   Report& report) {
  const Subject subject{stack, registry, values.row().name, nameOf(values)};
  switch (values.row().kind) {
    case ElementKind::shape: {
      const auto shape = registry.makeShape(values);
      for (const ShapeLaw& law : shapeLaws()) judge(subject, law.name, report, [&] { law.check(*shape); });
      return;
    }
    case ElementKind::sensor: return checkSensor(subject, report);
    case ElementKind::signal: return checkSignal(subject, report);
    case ElementKind::task: return checkTask(subject, report);
    case ElementKind::controller: return checkController(subject, report);
    case ElementKind::measure: return checkMeasure(subject, report);
    case ElementKind::recorder: return checkRecorder(subject, report);
    case ElementKind::back_end: return checkBackEnd(subject, report);
    case ElementKind::structure: return;
  }
}

/// The diagnostics of a stack that does not compile, as one sentence.
std::string sentenceOf(const dsl::InvalidStack& invalid) {
  std::string sentence;
  for (const dsl::Diagnostic& diagnostic : invalid.diagnostics)
    sentence += (sentence.empty() ? "" : "; ") + diagnostic.message;
  return sentence;
}

/// Whether the stack compiles; which attributes its factories asked for goes into `reads`.
void checkMaking(dsl::Stack stack, const control::Registry& registry, const ElementRow& row,
                 std::set<std::string, std::less<>>& reads, Report& report) {
  std::string name;
  for (control::ElementValues* values : instancesIn(stack, row)) {
    name = nameOf(*values);
    values->watch(&reads);
  }
  judge({stack, registry, row.name, ""}, "instance", report, [&] {
    try {
      for (const control::ElementValues* values : instancesIn(stack, row))
        if (row.kind == ElementKind::shape) registry.makeShape(*values);
      const auto controller = dsl::compile(stack, registry);
      const runtime::TemporaryFolder folder;
      const description::Scene scene = stack.scene(1);
      if (row.kind == ElementKind::measure) dsl::makeMeasures(stack, registry, *controller, scene, stack.start(1));
      if (row.kind == ElementKind::recorder) dsl::makeRecorders(stack, registry, *controller, folder.path);
    } catch (const dsl::InvalidStack& invalid) {
      throw Broken{sentenceOf(invalid)};
    }
  });
}

/// Of an instance made from defaults nobody can say that it reads all: what one value asks for another may leave out.
void checkReads(const ElementRow& row, const std::set<std::string, std::less<>>& reads, bool from_defaults,
                Report& report) {
  const dsl::Stack none;
  const control::Registry empty;
  judge({none, empty, row.name, ""}, "attributes", report, [&] {
    for (const control::AttributeRow& attribute : row.attributes) {
      if (isOfEveryElement(attribute.name) || reads.contains(attribute.name)) continue;
      if (from_defaults)
        throw NotAsked{"made from its defaults it does not read '" + attribute.name + "'; give a stack that uses it"};
      throw Broken{"no instance reads the attribute '" + attribute.name + "'"};
    }
  });
}

void checkElement(const control::Registry& registry, const ElementRow& row, const dsl::Stack* given, Report& report) {
  checkSchema(row, report);
  if (row.kind == ElementKind::structure) return;

  std::optional<dsl::Stack> stack;
  if (given) stack = *given;
  const bool from_defaults = !stack || instancesIn(*stack, row).empty();
  if (from_defaults) {
    std::string why_not;
    stack = specimenOf(row, registry, why_not);
    if (!stack) {
      report.add({row.name, "", "instance", Outcome::broken,
                  why_not + "; give a stack that holds one (--stack FILE)"});
      return;
    }
  }
  std::set<std::string, std::less<>> reads;
  checkMaking(*stack, registry, row, reads, report);
  if (report.findings.back().outcome == Outcome::broken) return;
  checkReads(row, reads, from_defaults, report);
  for (const control::ElementValues* values : instancesIn(*stack, row))
    checkInstance(*stack, registry, *values, report);
}

}  // namespace

Report checkElements(const control::Registry& registry, const std::vector<std::string>& elements,
                     const dsl::Stack* stack) {
  Report report;
  for (const std::string& name : elements) {
    if (const ElementRow* row = registry.elements().find(name)) checkElement(registry, *row, stack, report);
    if (const ElementRow* row = registry.elements().findBackEnd(name)) checkElement(registry, *row, stack, report);
  }
  return report;
}

Report checkPlugin(const std::string& library, const std::string& stack_file) {
  Workshop workshop({library});
  const std::vector<std::string> elements = workshop.plugins().loaded().front().elements;
  if (stack_file.empty()) return checkElements(workshop.registry(), elements);
  const dsl::Stack stack = workshop.read(stack_file);
  return checkElements(workshop.registry(), elements, &stack);
}

}  // namespace tactus::conformance
