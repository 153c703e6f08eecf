#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>

#include "framework/description/robot.h"

namespace tactus::witness {

struct DeleteMujoco {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using MujocoModel = std::unique_ptr<mjModel, DeleteMujoco>;
using MujocoData = std::unique_ptr<mjData, DeleteMujoco>;

/// MuJoCo's model of what writeMjcf writes; gravity in m/s², world axes.
/// Throws std::runtime_error with the robot's name and MuJoCo's message when it refuses the robot.
MujocoModel loadMujoco(const description::Robot& robot, const Eigen::Vector3d& gravity_W);

}  // namespace tactus::witness
