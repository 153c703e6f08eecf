#pragma once

#include <vector>

#include "framework/control/element_values.h"

namespace tactus::control {

/// How the errors of a level's rows are weighed against each other where it cannot meet them all: as they are, or each
/// by the root of the inertia that it meets, (J M⁻¹ Jᵀ)^-½ (Khatib 1987), so that units and limbs do not matter.
enum class RowMetric { identity, inertia };

/// What the forces of contact tasks do in the eyes of the others, J_i M⁻¹ τ = a_i:
///   moving    they move the robot like any other torque, and a level below counters what they would do to its rows;
///   balanced  the surface bears them, as it does in the weighted programme (5.3.6): τ and τ°_i are taken without J_cᵀ F of
///             the contact rows with F > 0 in this level and those above.
enum class ContactForces { moving, balanced };

/// How a level's rows become an objective.
struct ObjectiveOptions {
  RowMetric metric = RowMetric::identity;
  ContactForces contacts = ContactForces::moving;
};

/// The attributes of a back end that say so, `metric` and `contact-forces`, and what they say.
std::vector<AttributeRow> objectiveAttributes();
ObjectiveOptions objectiveOptions(const ElementValues& values);

}  // namespace tactus::control
