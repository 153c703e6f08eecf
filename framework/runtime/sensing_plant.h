#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/control/readings.h"
#include "framework/control/sensor.h"
#include "framework/runtime/plant.h"

namespace tactus::runtime {

struct NamedSensor {
  std::string name;
  std::unique_ptr<control::Sensor> sensor;
  std::vector<control::ReadingRow> rows;                           ///< of its ports, in their order
};

/// Links whose wrenches the sensors read, rising, each once.
std::vector<int> wrenchLinks(const std::vector<NamedSensor>& sensors);

/// A plant felt through sensors: `sense` is what they make of it, `truth` what there is.
class SensingPlant final : public Plant {
 public:
  /// Senses once.  Throws PartError where a sensor throws, as `advance` does.
  SensingPlant(std::unique_ptr<Plant> plant, std::vector<NamedSensor> sensors);

  const control::Sensed& sense() const override { return sensors_.empty() ? plant_->sense() : felt_; }
  const control::Sensed& truth() const override { return plant_->truth(); }
  std::span<const control::ObjectMotion> objects() const override { return plant_->objects(); }
  /// Those of the plant, then those of sensors that are faults.
  void faults(std::vector<const control::FaultRecord*>& records) const override;
  void advance(const Eigen::VectorXd& torque, double duration) override;
  void archive(control::Archive& archive) override;

 private:
  void feel();
  void archiveFelt(control::Archive& archive);

  std::unique_ptr<Plant> plant_;
  std::vector<NamedSensor> sensors_;
  control::Sensed felt_;
  std::vector<control::FaultRecord> faults_;                       // by sensor; without a kind where it is none
};

}  // namespace tactus::runtime
