#pragma once

#include <string>

#include "conformance/broken.h"
#include "conformance/report.h"
#include "dsl/stack.h"
#include "framework/control/registry.h"

/// The laws of conformance.h, each for one row or one instance.
namespace tactus::conformance {

/// An instance in a stack.
struct Subject {
  const dsl::Stack& stack;
  const control::Registry& registry;
  std::string element;
  std::string name;
};

void checkSchema(const control::ElementRow& row, Report& report);
void checkSensor(const Subject& subject, Report& report);
void checkSignal(const Subject& subject, Report& report);
void checkTask(const Subject& subject, Report& report);
/// With the laws of tasks for each that it owns.
void checkController(const Subject& subject, Report& report);
void checkMeasure(const Subject& subject, Report& report);
void checkRecorder(const Subject& subject, Report& report);
/// The stack's back end.
void checkBackEnd(const Subject& subject, Report& report);

/// Runs one law, which throws `Broken` or `NotAsked`, and adds its finding; any other exception is broken too.
template <class Law>
void judge(const Subject& subject, const std::string& name, Report& report, Law law) {
  Finding finding{subject.element, subject.name, name, Outcome::kept, ""};
  try {
    law();
  } catch (const Broken& broken) {
    finding.outcome = Outcome::broken;
    finding.message = broken.message;
  } catch (const NotAsked& reason) {
    finding.outcome = Outcome::not_asked;
    finding.message = reason.message;
  } catch (const std::exception& error) {
    finding.outcome = Outcome::broken;
    finding.message = std::string("it threw: ") + error.what();
  } catch (...) {
    finding.outcome = Outcome::broken;
    finding.message = "it threw something that is not a std::exception";
  }
  report.add(std::move(finding));
}

}  // namespace tactus::conformance
