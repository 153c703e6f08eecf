#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/control/contact_set.h"
#include "framework/control/tick.h"
#include "framework/description/scene.h"

/// What only the judge of a run may know: where things of the scene really are.  The controller never sees it.
namespace tactus::runtime {

/// The highest point of an object (W, z up); the middle of it where a whole edge or face is highest.
/// None for an object of planes alone, which has no end.
std::optional<Eigen::Vector3d> highestPoint(const description::Object& object);

/// `<name>_found` (1 or 0), and where it was found and `truth` is known:
/// `<name>_position_error_m`, the horizontal distance between the estimated top and the true one, and
/// `<name>_height_error_m`, the vertical one.
std::vector<control::Metric> featureMetrics(const std::string& name, const control::FeatureEstimate& estimate,
                                            const std::optional<Eigen::Vector3d>& truth);

}  // namespace tactus::runtime
