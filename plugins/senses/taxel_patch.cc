#include "plugins/senses/taxel_patch.h"

#include <algorithm>
#include <cmath>

namespace tactus::plugins {

TaxelPatch::TaxelPatch(const description::Link& link, TaxelPlan plan, double spread, double adjacency)
    : surface_(link), taxels_(std::move(plan.taxels)), pitch_(plan.pitch), spread_(spread) {
  const auto cells = static_cast<Eigen::Index>(plan.cells.size());
  cells_.resize(cells, 3);
  cell_normals_.resize(cells, 3);
  areas_.resize(cells);
  pressed_.reserve(plan.cells.size());
  distances_.resize(cells);
  owners_.assign(plan.cells.size(), -1);
  for (Eigen::Index c = 0; c < cells; ++c) {
    const SurfaceCell& cell = plan.cells[static_cast<std::size_t>(c)];
    cells_.row(c) = cell.position_L.transpose();
    cell_normals_.row(c) = cell.normal_L.transpose();
    areas_[c] = cell.area;
  }
  for (int i = 0; i < count(); ++i)
    for (const int cell : taxels_[static_cast<std::size_t>(i)].cells) owners_[static_cast<std::size_t>(cell)] = i;

  const double reach = adjacency * pitch_;
  for (const Taxel& taxel : taxels_) {
    first_neighbour_.push_back(static_cast<int>(neighbours_.size()));
    for (int j = 0; j < count(); ++j) {
      const Taxel& other = taxels_[static_cast<std::size_t>(j)];
      if (&other != &taxel && (other.position_L - taxel.position_L).norm() <= reach) neighbours_.push_back(j);
    }
  }
  first_neighbour_.push_back(static_cast<int>(neighbours_.size()));
  pending_.reserve(taxels_.size());
  seen_.assign(taxels_.size(), 0);
}

void TaxelPatch::press(const Eigen::Vector3d& point_L, double force_N, double depth,
                       Eigen::Ref<Eigen::VectorXd> forces_N) {
  if (!(force_N > 0) || cells_.rows() == 0) return;
  const SurfacePoint place = surface_.nearest(point_L);
  const double hertz2 = surface_.radiusNear(point_L) * std::max(0.0, depth);  // a²
  const double variance = spread_ * spread_ + hertz2 / 5;
  const Eigen::Vector3d &s = place.position_L, &n = place.normal_L;
  distances_ = (cells_.col(0) - s.x()).square() + (cells_.col(1) - s.y()).square() + (cells_.col(2) - s.z()).square();
  distances_ = (cell_normals_.col(0) * n.x() + cell_normals_.col(1) * n.y() + cell_normals_.col(2) * n.z() > 0)
                   .select(distances_, INFINITY);
  const double least = distances_.minCoeff();
  if (least == INFINITY) return;
  const double farthest = least + 9 * variance;
  pressed_.clear();
  double sum = 0;
  for (Eigen::Index c = 0; c < distances_.size(); ++c) {
    if (distances_[c] > farthest) continue;
    const double weight = areas_[c] * std::exp(-(distances_[c] - least) / (2 * variance));
    sum += weight;
    pressed_.push_back({owners_[static_cast<std::size_t>(c)], weight});
  }
  for (const auto& [taxel, weight] : pressed_)
    if (taxel >= 0) forces_N[taxel] += force_N * (weight / sum);
}

void TaxelPatch::read(Eigen::Ref<const Eigen::VectorXd> forces_N, int min_taxels, double min_force,
                      std::vector<TaxelContact>& contacts) {
  std::fill(seen_.begin(), seen_.end(), 0);
  for (int first = 0; first < count(); ++first) {
    if (seen_[static_cast<std::size_t>(first)] || !(forces_N[first] > 0)) continue;
    int taxels = 0;
    double force = 0;
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    pending_.assign(1, first);
    seen_[static_cast<std::size_t>(first)] = 1;
    while (!pending_.empty()) {
      const int i = pending_.back();
      pending_.pop_back();
      ++taxels;
      force += forces_N[i];
      weighted += forces_N[i] * taxels_[static_cast<std::size_t>(i)].position_L;
      const auto at = static_cast<std::size_t>(i);
      for (int k = first_neighbour_[at]; k < first_neighbour_[at + 1]; ++k) {
        const int j = neighbours_[static_cast<std::size_t>(k)];
        if (seen_[static_cast<std::size_t>(j)] || !(forces_N[j] > 0)) continue;
        seen_[static_cast<std::size_t>(j)] = 1;
        pending_.push_back(j);
      }
    }
    if (taxels < min_taxels || force < min_force) continue;
    contacts.push_back({surface_.nearest(weighted / force), force});
  }
}

}  // namespace tactus::plugins
