#include "framework/runtime/sensing_plant.h"

#include <set>

#include "framework/control/element_values.h"
#include "framework/control/sensing_guard.h"
#include "framework/runtime/part_error.h"

namespace tactus::runtime {
namespace {

[[noreturn]] void fail(const NamedSensor& sensor, double time, const std::string& reason) {
  throw PartError("sensor '" + sensor.name + "' failed at t = " + control::formatNumber(time) + " s: " + reason);
}

int countOf(const std::vector<control::ReadingRow>& rows) {
  int count = 0;
  for (const control::ReadingRow& row : rows) count += row.count;
  return count;
}

}  // namespace

std::vector<int> wrenchLinks(const std::vector<NamedSensor>& sensors) {
  std::set<int> links;
  for (const NamedSensor& named : sensors)
    for (const int link : named.sensor->wrenchLinks()) links.insert(link);
  return {links.begin(), links.end()};
}

SensingPlant::SensingPlant(std::unique_ptr<Plant> plant, std::vector<NamedSensor> sensors)
    : plant_(std::move(plant)), sensors_(std::move(sensors)) {
  int readings = 0;
  for (const NamedSensor& sensor : sensors_) readings += countOf(sensor.rows);
  felt_.contacts.reserve(control::SensingGuard::contact_capacity);
  felt_.readings.setZero(readings);
  for (const NamedSensor& named : sensors_)
    faults_.push_back({named.name, named.sensor->fault() ? named.sensor->fault()->kind : ""});
  feel();
}

void SensingPlant::faults(std::vector<const control::FaultRecord*>& records) const {
  plant_->faults(records);
  for (const control::FaultRecord& record : faults_)
    if (!record.kind.empty()) records.push_back(&record);
}

void SensingPlant::advance(const Eigen::VectorXd& torque, double duration) {
  plant_->advance(torque, duration);
  feel();
}

void SensingPlant::archive(control::Archive& archive) {
  plant_->archive(archive);
  if (sensors_.empty()) return;
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    archive.within("sensor/" + sensors_[i].name, [&] {
      sensors_[i].sensor->archive(archive);
      if (!faults_[i].kind.empty()) archive("fault", faults_[i]);
    });
  const std::size_t missing = archive.missing().size();
  archiveFelt(archive);
  if (archive.missing().size() != missing) feel();                 // the state is of other sensors
}

void SensingPlant::archiveFelt(control::Archive& archive) {
  archive.within("felt", [&] {
    archive("time", felt_.time);
    archive("q", felt_.q);
    archive("qd", felt_.qd);
    archive.growing("contacts", felt_.contacts);
  });
  int at = 0;
  for (const NamedSensor& named : sensors_) {
    Eigen::VectorXd readings = felt_.readings.segment(at, countOf(named.rows));
    archive("readings/" + named.name, readings);
    felt_.readings.segment(at, readings.size()) = readings;
    at += static_cast<int>(readings.size());
  }
}

void SensingPlant::feel() {
  if (sensors_.empty()) return;
  const control::Sensed& truth = plant_->sense();
  felt_.time = truth.time;
  felt_.q = truth.q;
  felt_.qd = truth.qd;
  felt_.contacts.assign(truth.contacts.begin(), truth.contacts.end());
  int at = 0;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const NamedSensor& named = sensors_[i];
    const int count = countOf(named.rows);
    try {
      named.sensor->sense(truth, felt_, felt_.readings.segment(at, count));
    } catch (const std::exception& error) {
      fail(named, truth.time, error.what());
    } catch (...) {
      fail(named, truth.time, "it threw something that is not a std::exception");
    }
    if (const control::Sensor::Fault* fault = named.sensor->fault()) faults_[i].note(truth.time, fault->strikes);
    at += count;
  }
}

}  // namespace tactus::runtime
