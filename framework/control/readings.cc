#include "framework/control/readings.h"

#include <cmath>

namespace tactus::control {

Readings::Readings(std::vector<ReadingRow> rows) : rows_(std::move(rows)) {
  for (const ReadingRow& row : rows_) {
    vectors_.emplace_back(Eigen::VectorXd::Zero(row.count));
    size_ += row.count;
  }
}

void Readings::take(const Eigen::VectorXd& readings) {
  Eigen::Index at = 0;
  for (Eigen::VectorXd& vector : vectors_)
    for (double& number : vector) {
      if (at < readings.size() && std::isfinite(readings[at])) number = readings[at];
      ++at;
    }
}

const void* Readings::port(const std::string& sensor, const std::string& port) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].sensor != sensor || rows_[i].port != port) continue;
    if (!rows_[i].scalar) return &vectors_[i];
    return rows_[i].count == 1 ? vectors_[i].data() : nullptr;
  }
  return nullptr;
}

void Readings::archive(Archive& archive) {
  for (std::size_t i = 0; i < rows_.size(); ++i) archive(rows_[i].sensor + "." + rows_[i].port, vectors_[i]);
}

}  // namespace tactus::control
