#include "dsl/read_stack.h"
#include "dsl/read_study.h"
#include "framework/control/element_values.h"

namespace tactus::dsl {
namespace {

using control::ElementKind;
using control::ElementRow;
using control::formatNumber;
using control::ValueType;

// Whose members' defaults are the language's.
const Study study;

ElementRow studyRow() {
  return {.name = "study",
          .kind = ElementKind::structure,
          .description = "Runs of one stack under every combination of conditions, for `tactus study`: outermost in a "
                         "file of its own.",
          .attributes = {{.name = "format", .type = ValueType::integer, .required = true,
                          .description = "The version of the language; this one is 1."},
                         {.name = "name", .type = ValueType::identifier,
                          .description = "The name that results are filed under; not given: that of the file."},
                         {.name = "stack", .type = ValueType::file, .required = true,
                          .description = "The stack's file, relative to the folder of this one."},
                         {.name = "duration", .type = ValueType::real, .unit = "s",
                          .description = "Simulated time of each trial; not given: the stack's.", .lower = 0,
                          .upper = longest_run, .lower_open = true},
                         {.name = "keep", .type = ValueType::choice,
                          .default_text = study.keeps_runs ? "runs" : "metrics",
                          .description = "What stays of a trial: its whole run folder, or run.json alone.",
                          .choices = {"runs", "metrics"}}},
          .children = {{"factor"}, {"seeds", 0, 1}, {"backends", 0, 1}, {"metric"}, {"compare"}, {"include"}}};
}

ElementRow factorRow() {
  return {.name = "factor",
          .kind = ElementKind::structure,
          .description = "A <parameter> of the stack and the values that it takes in turn.",
          .attributes = {{.name = "parameter", .type = ValueType::identifier, .required = true,
                          .description = "Its name in the stack."},
                         {.name = "values", .type = ValueType::text, .required = true,
                          .description = "Separated by blanks; by semicolons where a value holds blanks itself."}}};
}

ElementRow seedsRow() {
  return {.name = "seeds",
          .kind = ElementKind::structure,
          .description = "Each condition runs once with each seed; comparisons pair trials of one seed.",
          .attributes = {{.name = "from", .type = ValueType::integer, .default_text = std::to_string(study.first_seed),
                          .description = "The first; 0 draws no jitter.", .lower = 0},
                         {.name = "count", .type = ValueType::integer, .required = true,
                          .description = "How many, one after the other.", .lower = 1}}};
}

ElementRow backendsRow() {
  return {.name = "backends",
          .kind = ElementKind::structure,
          .description = "Back ends that stand in the controller's place in turn; without it, the stack's own.",
          .attributes = {{.name = "names", .type = ValueType::text, .required = true,
                          .description = "Separated by blanks, with variants as for --backend: `qp/active-set`."}}};
}

ElementRow metricRow() {
  return {.name = "metric",
          .kind = ElementKind::structure,
          .description = "A figure to report; without any, all that the trials have.",
          .attributes = {{.name = "name", .type = ValueType::text, .required = true,
                          .description = "A key of `metrics` in run.json, such as contact_force_mean_N."}}};
}

ElementRow compareRow() {
  return {.name = "compare",
          .kind = ElementKind::structure,
          .description = "Holds each level of a factor against a baseline, all else being equal, in pairs of trials "
                         "with the same seed.",
          .attributes = {{.name = "metric", .type = ValueType::text, .required = true,
                          .description = "The figure, one that the study reports."},
                         {.name = "by", .type = ValueType::text, .default_text = "backend",
                          .description = "`backend`, or the parameter of a factor."},
                         {.name = "baseline", .type = ValueType::text, .required = true,
                          .description = "One of that factor's values, or of the back ends."},
                         {.name = "over", .type = ValueType::text,
                          .description = "Other factors, separated by blanks, whose pairs count together: one "
                                         "comparison of all their conditions, not one for each."}}};
}

}  // namespace

void addStudyElements(control::Registry& registry) {
  for (ElementRow row : {studyRow(), factorRow(), seedsRow(), backendsRow(), metricRow(), compareRow()})
    registry.addStructure(std::move(row));
}

}  // namespace tactus::dsl
