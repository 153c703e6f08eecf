#pragma once

#include "framework/control/registry.h"
#include "framework/runtime/csv_writer.h"

namespace probe {

/// `<probe.touches>`: writes every touch, felt or not, into a file of the run folder: time, link, object, what the
/// force is and what of it is felt at that link.
class TouchList final : public tactus::control::Observer {
 public:
  explicit TouchList(const tactus::control::RecorderContext& context);
  static void registerIn(tactus::control::Registry& registry);

  void observe(const tactus::control::ObservedTick& tick) override;
  void close() override { file_.close(); }

 private:
  std::vector<std::string> links_;
  double from_;                                                    // N
  tactus::runtime::CsvWriter file_;
};

}  // namespace probe
