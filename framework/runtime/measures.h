#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/control/measure.h"

namespace tactus::runtime {

struct NamedMeasure {
  std::string name;
  std::unique_ptr<control::Measure> measure;
};

/// The measures of a run, in the order of the stack.  What one throws is a PartError with its name and the time.
class Measures final : public control::Observer {
 public:
  explicit Measures(std::vector<NamedMeasure> measures) : measures_(std::move(measures)) {}

  void observe(const control::ObservedTick& tick) override;
  /// `measure/<name>/<its own>`.
  std::vector<control::LogColumn> columns() const;
  /// `<name>_<its own>`.
  std::vector<control::Metric> metrics() const;
  void archive(control::Archive& archive);

 private:
  std::vector<NamedMeasure> measures_;
};

}  // namespace tactus::runtime
