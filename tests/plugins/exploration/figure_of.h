#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "framework/control/controller.h"

namespace tactus::testing {

/// The figure of that name of a signal, a task or a measure; without it a failure.
template <class Part>
double figureOf(const Part& part, const std::string& name) {
  std::vector<control::Metric> metrics;
  part.metrics(metrics);
  for (const control::Metric& metric : metrics)
    if (metric.name == name) return metric.value;
  ADD_FAILURE() << "there is no figure " << name;
  return 0;
}

}  // namespace tactus::testing
