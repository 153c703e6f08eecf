#include "framework/runtime/measures.h"

#include "framework/control/element_values.h"
#include "framework/runtime/part_error.h"

namespace tactus::runtime {

void Measures::observe(const control::ObservedTick& tick) {
  for (const NamedMeasure& named : measures_) {
    const auto fail = [&](const std::string& reason) {
      throw PartError("measure '" + named.name + "' failed at t = " + control::formatNumber(tick.truth.time) +
                      " s: " + reason);
    };
    try {
      named.measure->observe(tick);
    } catch (const std::exception& error) {
      fail(error.what());
    } catch (...) {
      fail("it threw something that is not a std::exception");
    }
  }
}

std::vector<control::LogColumn> Measures::columns() const {
  std::vector<control::LogColumn> all, own;
  for (const NamedMeasure& named : measures_) {
    own.clear();
    named.measure->columns(own);
    for (const control::LogColumn& column : own) all.push_back({"measure/" + named.name + "/" + column.name, column.value});
  }
  return all;
}

std::vector<control::Metric> Measures::metrics() const {
  std::vector<control::Metric> all, own;
  for (const NamedMeasure& named : measures_) {
    own.clear();
    named.measure->metrics(own);
    for (const control::Metric& metric : own) all.push_back({named.name + "_" + metric.name, metric.value});
  }
  return all;
}

void Measures::archive(control::Archive& archive) {
  for (const NamedMeasure& named : measures_) archive(named.name, *named.measure);
}

}  // namespace tactus::runtime
