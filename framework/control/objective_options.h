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

/// How a level's rows become an objective.  With `damping` λ > 0, below the first level, it is
///
///   ‖W (J_i M⁻¹ τ − a_i)‖² + λ² w² τᵀM⁻¹τ,
///
/// w what the heaviest of its rows weighs (1 in the inertia metric).  In a direction of which the levels above have left
/// the singular value σ the torque is then σ/(σ² + λ²) ≤ 1/(2λ) times what is asked, instead of 1/σ (Nakamura and Hanafusa
/// 1986).
struct ObjectiveOptions {
  RowMetric metric = RowMetric::identity;
  ContactForces contacts = ContactForces::moving;
  double damping = 0;                                              ///< λ, dimensionless
};

/// The attributes of a back end that say so, `metric`, `contact-forces` and `damping`, and what they say.
std::vector<AttributeRow> objectiveAttributes();
ObjectiveOptions objectiveOptions(const ElementValues& values);

}  // namespace tactus::control
