#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/control/controller.h"
#include "framework/control/registry.h"

namespace tactus::bench {

/// A back end as a stack would name it.
struct BackEndChoice {
  std::string label;                                               ///< in the table
  std::string name;
  std::map<std::string, std::string> options;
};

/// A controller to time, and what its robot feels in each of `length` ticks, over and over.
class TickCase {
 public:
  static constexpr int length = 1000;

  virtual ~TickCase() = default;
  const std::string& name() const { return name_; }
  virtual std::unique_ptr<control::Controller> controller(const BackEndChoice& choice) const = 0;
  const control::Sensed& sensed(int k) const { return sensed_[k % length]; }

 protected:
  explicit TickCase(std::string name) : name_(std::move(name)), sensed_(length) {}
  std::string name_;
  std::vector<control::Sensed> sensed_;
};

/// Built-in elements and the shipped plugins.
control::Registry& registry();

/// lwr_allegro with 0, 4, 12 and 20 contacts and a 7-joint arm, both from stacks; a floating humanoid of 36 joints with
/// 4 levels, and chains up to 100 joints, from tasks written here.
std::vector<std::unique_ptr<TickCase>> tickCases();

}  // namespace tactus::bench
