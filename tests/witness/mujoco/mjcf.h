#pragma once

#include <Eigen/Core>
#include <string>

#include "framework/description/robot.h"

/// A description::Robot in MuJoCo's format, MJCF, written from the description alone: a witness must not share the
/// model of what it is a witness for.
///
/// The root link is MuJoCo's world; every other link is a body of its name in its own frame, on as many of MuJoCo's
/// joints as its joint needs:
///   revolute, prismatic   a hinge or slide NAME;
///   planar                slides NAME.x, NAME.y along planeFrame(axis), then a hinge NAME.angle;
///   spherical             a ball NAME.w;
///   floating              on the root link a free joint NAME; elsewhere, where MuJoCo has none, slides NAME.x, NAME.y,
///                         NAME.z and a ball NAME.w.
/// The rotor is the thin disk of description::Joint::reflectedInertia, added to the inertia of its link: MuJoCo's
/// armature is another model.  Principal moments and axes are written, so that MuJoCo has nothing to diagonalise.
/// No shapes, limits, damping or friction; joints that follow others move on their own.
namespace tactus::witness {

/// How MuJoCo carries a floating joint.
bool isFreeJoint(const description::Robot& robot, const description::Joint& joint);

std::string writeMjcf(const description::Robot& robot, const Eigen::Vector3d& gravity_W);

}  // namespace tactus::witness
